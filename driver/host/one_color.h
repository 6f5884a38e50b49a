// OneColor: rows of pixels in one code, eight at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/display/description.h"

namespace xorvox::host {

class OneColor {
public:
    /// `code` is of `format`.
    OneColor(std::uint32_t code, PixelFormat format);

    std::uint32_t code() const { return code_; }

    /// Writes `bytes`, `rows` rows of the wire: the pixels whose bits are set in `bits`, row_words() words a row, have
    /// the code, all others are dark, as is the padding, whose bits are clear. `rows` is at least 1.
    void paint(std::span<const std::uint64_t> bits, std::uint32_t rows, std::span<std::byte> bytes) const;

private:
    static constexpr std::size_t kMostBytes = 24;

    std::uint32_t code_;
    std::uint32_t bits_;                                          ///< Of a pixel: bytes of eight.
    std::array<std::array<std::byte, kMostBytes>, 256> eight_{};  ///< Entry b has the pixels whose bits b has.
    std::array<std::byte, 8 * kMostBytes> all_{};                 ///< 64 pixels.
};

}  // namespace xorvox::host
