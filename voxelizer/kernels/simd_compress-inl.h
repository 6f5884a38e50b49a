// Keeping the lanes of a set. Compiled once for each instruction set.
#if defined(XORVOX_KERNELS_SIMD_COMPRESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef XORVOX_KERNELS_SIMD_COMPRESS_INL_H_
#undef XORVOX_KERNELS_SIMD_COMPRESS_INL_H_
#else
#define XORVOX_KERNELS_SIMD_COMPRESS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>
#include "voxelizer/kernels/compress_table.h"

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Writes the 64-bit lanes of `v` that are in `mask` to `to`, where a whole vector may be overwritten; how many there
/// were.
template <class V, class M>
HWY_INLINE std::size_t store_compressed(V v, M mask, std::uint64_t* to) {
    const hn::DFromV<V> d;
    static_assert(hn::MaxLanes(hn::DFromV<V>()) <= 8);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    const hn::Rebind<std::uint32_t, decltype(d)> d32;
    const auto lanes = hn::PromoteTo(d, hn::PromoteTo(d32, hn::LoadU(d8, kCompressTable.lanes[bits[0]])));
    hn::StoreU(hn::TableLookupLanes(v, hn::IndicesFromVec(d, lanes)), d, to);
    return hn::CountTrue(d, mask);
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
