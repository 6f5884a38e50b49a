// Random: numbers that are the same on every machine for the same seed, for faults on purpose. The standard library's
// distributions differ between implementations.
#pragma once

#include <cstddef>
#include <cstdint>

namespace xorvox::transport {

/// SplitMix64 (Steele, Lea and Flood 2014).
class Random {
public:
    explicit constexpr Random(std::uint64_t seed) : state_(seed) {}

    constexpr std::uint64_t next() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    /// 0 to below 1.
    constexpr double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    constexpr bool chance(double probability) { return unit() < probability; }
    /// 0 to below `bound`, which is not 0.
    constexpr std::size_t below(std::size_t bound) { return static_cast<std::size_t>(next() % bound); }

private:
    std::uint64_t state_;
};

}  // namespace xorvox::transport
