#include "driver/host/power_budget.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "driver/host/pixel.h"

namespace xorvox::host {
namespace {

/// What bit `index` of a pixel adds: its part of a channel's highest level, times `unit`, which all highest levels
/// divide.
std::uint32_t bit_weight(const DisplayDescription& display, std::uint32_t index, std::uint32_t unit) {
    for (const ChannelBits& channel : channel_bits(display.format)) {
        if (index < channel.shift || index >= channel.shift + channel.bits) continue;
        const std::uint32_t shown = std::min(channel.bits, shown_bit_planes(display));
        const std::uint32_t hidden = channel.bits - shown;
        const std::uint32_t bit = index - channel.shift;
        return bit < hidden ? 0 : unit / ((1u << shown) - 1) << (bit - hidden);
    }
    return 0;
}

}  // namespace

CurrentMeter::CurrentMeter(const DisplayDescription& display)
    : lit_bytes_(slice_bytes(display) * (keeps_light(display) ? display.slices : 1)) {
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        row_bytes_.insert(row_bytes_.end(), display.panels[p].rows, row_bytes(display.panels[p], display.format));
    }
    std::uint32_t unit = 1;
    for (const ChannelBits& channel : channel_bits(display.format)) {
        unit = std::lcm(unit, (1u << std::min(channel.bits, shown_bit_planes(display))) - 1);
    }
    ma_per_weight_ = display.power.led_ma / unit / display.scan.row_groups;
    const std::uint32_t bits = bits_per_pixel(display.format);
    weights_.resize(std::lcm(bits, 8u) / 8);
    for (std::uint32_t place = 0; place < weights_.size(); ++place) {
        for (std::uint32_t byte = 1; byte < 256; ++byte) {
            const std::uint32_t lowest = static_cast<std::uint32_t>(std::countr_zero(byte));
            weights_[place][byte] =
                weights_[place][byte & (byte - 1)] + bit_weight(display, (place * 8 + lowest) % bits, unit);
        }
    }
}

double CurrentMeter::most_ma(std::span<const std::byte> frame) const {
    std::uint64_t most = 0;
    for (; !frame.empty() && frame.size() >= lit_bytes_; frame = frame.subspan(lit_bytes_)) {
        std::span<const std::byte> lit = frame.first(lit_bytes_);
        std::uint64_t total = 0;
        while (!lit.empty()) {
            for (const std::size_t length : row_bytes_) {
                std::size_t place = 0;
                for (const std::byte byte : lit.first(length)) {
                    total += weights_[place][std::to_integer<std::size_t>(byte)];
                    if (++place == weights_.size()) place = 0;
                }
                lit = lit.subspan(length);
            }
        }
        most = std::max(most, total);
    }
    return static_cast<double>(most) * ma_per_weight_;
}

PowerBudget::PowerBudget(const DisplayDescription& display) : meter_(display) {
    if (display.power.led_ma > 0.0) limit_ma_ = display.power.limit_ma;
}

bool PowerBudget::allows(std::span<const std::byte> frame) {
    if (limit_ma_ <= 0.0) return true;
    // A little below the limit, so that levels which are rounded up do not make another try needed.
    constexpr double kRoom = 0.98;
    const double ma = meter_.most_ma(frame);
    const double fitting = ma > 0.0 ? kRoom * limit_ma_ / ma : static_cast<double>(kRelease);
    if (tries_ > 0 && ma >= last_ma_) {
        factor_ = last_factor_;
    } else if (ma > limit_ma_ && factor_ > kLeast && ++tries_ < kMostTries) {
        last_ma_ = ma;
        last_factor_ = factor_;
        factor_ = std::max(kLeast, factor_ * static_cast<float>(fitting));
        return false;
    }
    tries_ = 0;
    if (fitting > 1.0) factor_ = std::min(1.0f, factor_ * std::min(kRelease, static_cast<float>(fitting)));
    return true;
}

}  // namespace xorvox::host
