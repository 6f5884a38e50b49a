// Semihosting: the debugger, here QEMU, prints and ends the program for us (Arm, "Semihosting for AArch32 and
// AArch64").
#pragma once

namespace semihosting {

void print(const char* text);
[[noreturn]] void exit(int status);

}  // namespace semihosting
