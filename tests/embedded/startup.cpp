// From reset to run_firmware() on a Cortex-M3, and the way out through semihosting.
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "tests/embedded/semihosting.h"

int run_firmware();

extern "C" {
extern std::byte data_load[], data_begin[], data_end[], bss_begin[], bss_end[], stack_top[];
extern void (*init_array_begin[])();
extern void (*init_array_end[])();

[[noreturn]] void reset() {
    std::memcpy(data_begin, data_load, static_cast<std::size_t>(data_end - data_begin));
    std::memset(bss_begin, 0, static_cast<std::size_t>(bss_end - bss_begin));
    for (auto initialize = init_array_begin; initialize != init_array_end; ++initialize) (*initialize)();
    semihosting::exit(run_firmware());
}

[[noreturn]] void fault() {
    semihosting::print("the processor took a fault\n");
    semihosting::exit(1);
}
}

namespace {

union Vector {
    std::byte* stack;
    void (*handler)();
};

[[gnu::section(".vectors"), gnu::used]] const Vector kVectors[] = {
    {.stack = stack_top}, {.handler = reset}, {.handler = fault}, {.handler = fault},
    {.handler = fault},   {.handler = fault}, {.handler = fault},
};

std::uintptr_t call_host(std::uintptr_t operation, const void* argument) {
    register std::uintptr_t r0 asm("r0") = operation;
    register const void* r1 asm("r1") = argument;
    asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

}  // namespace

void semihosting::print(const char* text) {
    constexpr std::uintptr_t kWrite0 = 0x04;
    call_host(kWrite0, text);
}

void semihosting::exit(int status) {
    constexpr std::uintptr_t kExitExtended = 0x20;
    const std::uintptr_t application_exit[] = {0x20026, static_cast<std::uintptr_t>(status)};
    call_host(kExitExtended, application_exit);
    for (;;) {
    }
}
