// A description as C++: for firmware, which reads no files.
#pragma once

#include <string>
#include <string_view>

#include "driver/display/description.h"

namespace xorvox {

/// A header that defines `display`, which must be valid (validate_display), as a constexpr variable of the namespace
/// xorvox::displays, bit for bit. It includes driver/display/description.h and nothing else, needs no run-time code,
/// and refuses to compile where the geometry's digest comes out otherwise (displays of up to 1000 free points, beyond
/// which compilers give up counting).
std::string to_cpp(const DisplayDescription& display);

/// The variable's name: "kVortex", of "cube16-ws2812" "kCube16Ws2812"; "kDisplay" of a name without letters and digits.
std::string cpp_name(std::string_view display_name);

}  // namespace xorvox
