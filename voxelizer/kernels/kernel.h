// Kernel: the instruction sets that the fast voxelizer has been compiled for. All of them give the same bits.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace xorvox {

enum class Kernel : std::uint8_t {
    Scalar,  ///< Plain C++, one triangle and one sample at a time: the reference of the others.
    Sse4,
    Avx2,
    Avx512,  ///< F, CD, BW, DQ and VL.
    Neon,    ///< Any 64-bit ARM.
};

/// "scalar", "sse4", "avx2", "avx512" or "neon". Static storage.
const char* to_string(Kernel kernel);

/// The kernel of that name, whether or not this machine can run it; nothing for another name.
std::optional<Kernel> kernel_named(std::string_view name);

/// The kernels that this build has and this machine can run, from Scalar to the fastest. Static storage; any thread.
std::span<const Kernel> available_kernels();

/// The last of available_kernels().
Kernel best_kernel();

}  // namespace xorvox
