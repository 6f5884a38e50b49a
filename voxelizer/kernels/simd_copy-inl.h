// Copies of a layer. Compiled once for each instruction set.
#if defined(XORVOX_KERNELS_SIMD_COPY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef XORVOX_KERNELS_SIMD_COPY_INL_H_
#undef XORVOX_KERNELS_SIMD_COPY_INL_H_
#else
#define XORVOX_KERNELS_SIMD_COPY_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline void copy_layer(const std::uint64_t* parities, std::uint64_t* out, std::size_t words, bool stream) {
    const hn::ScalableTag<std::uint64_t> d;
    const std::size_t lanes = hn::Lanes(d);
    const bool aligned = reinterpret_cast<std::uintptr_t>(out) % (lanes * sizeof(std::uint64_t)) == 0;
    if (!stream || !aligned) {
        std::copy_n(parities, words, out);
        return;
    }
    std::size_t i = 0;
    for (; i + lanes <= words; i += lanes) hn::Stream(hn::LoadU(d, parities + i), d, out + i);
    std::copy(parities + i, parities + words, out + i);
    hwy::FlushStream();
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
