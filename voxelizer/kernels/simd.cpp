// The kernels for vector instructions: this file is compiled once for each of them (Highway's foreach_target). Lanes
// are doubles throughout, because AVX2 has no 64-bit multiply: coordinates relative to a column of the triangle are
// exact below 2^53, as the constants in simd_regular-inl.h say; what is not, is left to voxelizer/kernels/direct.h.
#include "voxelizer/kernels/kernel_table.h"

// Not every instruction set is worth its code, and vectors without a length are not foreseen.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxelizer/kernels/simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Without vectors there is scalar.cpp.
#if HWY_TARGET != HWY_SCALAR
#include "voxelizer/kernels/simd_copy-inl.h"
#include "voxelizer/kernels/simd_pairs-inl.h"
#include "voxelizer/kernels/simd_regular-inl.h"
#include "voxelizer/kernels/simd_rows-inl.h"
#include "voxelizer/kernels/simd_small-inl.h"
#include "voxelizer/kernels/simd_snap-inl.h"
#include "voxelizer/kernels/simd_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {

KernelTable table(Kernel kernel) {
    return {kernel,      snap_points,           pack_regular,        pack_table, cross_regular,
            cross_table, cross_waiting_regular, cross_waiting_table, copy_layer};
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE

#include <array>
#include <string_view>

namespace xorvox {
namespace kernels {
namespace {

/// What this build has, from the slowest to the fastest. The second is the bit of hwy::SupportedTargets(), or 0.
struct Built {
    KernelTable table;
    std::int64_t target;
};

const auto& built_kernels() {
    static const std::array kBuilt {
        Built{kScalarTable, 0},
#if HWY_TARGETS & HWY_NEON
            Built{N_NEON::table(Kernel::Neon), HWY_NEON},
#endif
#if HWY_TARGETS & HWY_SSE4
            Built{N_SSE4::table(Kernel::Sse4), HWY_SSE4},
#endif
#if HWY_TARGETS & HWY_AVX2
            Built{N_AVX2::table(Kernel::Avx2), HWY_AVX2},
#endif
#if HWY_TARGETS & HWY_AVX3
            Built{N_AVX3::table(Kernel::Avx512), HWY_AVX3},
#endif
    };
    return kBuilt;
}

struct Available {
    std::array<Kernel, 5> kernels{};
    std::size_t count = 0;
};

}  // namespace

const KernelTable& kernel_table(Kernel kernel) {
    for (const Built& built : built_kernels()) {
        if (built.table.kernel == kernel) return built.table;
    }
    return kScalarTable;
}

}  // namespace kernels

const char* to_string(Kernel kernel) {
    switch (kernel) {
        case Kernel::Scalar: return "scalar";
        case Kernel::Sse4: return "sse4";
        case Kernel::Avx2: return "avx2";
        case Kernel::Avx512: return "avx512";
        case Kernel::Neon: return "neon";
    }
    return "unknown kernel";
}

std::optional<Kernel> kernel_named(std::string_view name) {
    for (const Kernel kernel : {Kernel::Scalar, Kernel::Sse4, Kernel::Avx2, Kernel::Avx512, Kernel::Neon}) {
        if (name == to_string(kernel)) return kernel;
    }
    return std::nullopt;
}

std::span<const Kernel> available_kernels() {
    static const kernels::Available kAvailable = [] {
        kernels::Available available;
        for (const kernels::Built& built : kernels::built_kernels()) {
            if (built.target != 0 && (hwy::SupportedTargets() & built.target) == 0) continue;
            available.kernels[available.count++] = built.table.kernel;
        }
        return available;
    }();
    return {kAvailable.kernels.data(), kAvailable.count};
}

Kernel best_kernel() {
    return available_kernels().back();
}

}  // namespace xorvox

#endif
