// RecentValues: the last so many of a series, and their quantiles. A part of FrameStream.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace xorvox::host {

class RecentValues {
public:
    /// Keeps the last `capacity` values, 1 or more.
    explicit RecentValues(std::size_t capacity) : capacity_(capacity) { values_.reserve(capacity); }

    /// Allocates nothing.
    void add(std::uint64_t value) {
        if (values_.size() < capacity_) {
            values_.push_back(value);
        } else {
            values_[oldest_] = value;
            oldest_ = (oldest_ + 1) % capacity_;
        }
    }

    /// The smallest kept value that is not below `part`, 0 to 1, of them; 0 of none. Allocates.
    std::uint64_t quantile(double part) const {
        if (values_.empty()) return 0;
        std::vector<std::uint64_t> sorted = values_;
        const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(sorted.size())));
        const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
        std::nth_element(sorted.begin(), place, sorted.end());
        return *place;
    }

private:
    std::size_t capacity_;
    std::size_t oldest_ = 0;
    std::vector<std::uint64_t> values_;
};

}  // namespace xorvox::host
