// The demo model, as the bytes of its file.
#pragma once

#include <string>

namespace xorvox::examples {

/// The duck as a binary little-endian PLY with float positions: closed, outward, about 70 thousand triangles, in
/// millimetres, z up. The same bytes on every machine.
std::string duck_ply();

}  // namespace xorvox::examples
