// Exact quotients of doubles. Compiled once for each instruction set.
#if defined(XORVOX_KERNELS_SIMD_QUOTIENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef XORVOX_KERNELS_SIMD_QUOTIENT_INL_H_
#undef XORVOX_KERNELS_SIMD_QUOTIENT_INL_H_
#else
#define XORVOX_KERNELS_SIMD_QUOTIENT_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The largest integers not above n / d, for integers of which n and n + d are below 2^53, and d > 0; `inverse` is 1 /
/// d. `divides` tells where nothing remains.
template <class V, class M>
HWY_INLINE V floor_divide_lanes(V n, V d, V inverse, M& divides) {
    const hn::DFromV<V> tag;
    const auto zero = hn::Zero(tag);
    const auto one = hn::Set(tag, 1.0);
    auto whole = hn::Floor(hn::Mul(n, inverse));
    // The quotient may be off by one; the remainder, which is exact, tells.
    const auto rest = hn::Sub(n, hn::Mul(whole, d));
    whole = hn::Sub(whole, hn::IfThenElseZero(hn::Lt(rest, zero), one));
    whole = hn::Add(whole, hn::IfThenElseZero(hn::Ge(rest, d), one));
    divides = hn::Or(hn::Eq(rest, zero), hn::Eq(hn::Abs(rest), d));
    return whole;
}

/// The largest magnitude of three.
template <class V>
HWY_INLINE V farthest(V a, V b, V c) {
    return hn::Max(hn::Max(hn::Abs(a), hn::Abs(b)), hn::Abs(c));
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
