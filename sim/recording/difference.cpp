#include "sim/recording/difference.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "sim/recording/frames.h"

namespace xorvox::sim {
namespace {

/// `bits` bits of a row from bit `first` on; missing ones are 0.
std::uint32_t bits_of(std::span<const std::byte> row, std::size_t first, std::uint32_t bits) {
    std::uint32_t code = 0;
    for (std::uint32_t i = 0; i < bits; ++i) {
        const std::size_t bit = first + i;
        if (bit / 8 < row.size()) code |= (std::to_integer<std::uint32_t>(row[bit / 8]) >> (bit % 8) & 1) << i;
    }
    return code;
}

/// "0xff7200", and of formats with colours also what it means: "0xff7200 (#0072ff)".
std::string code_text(PixelFormat format, std::uint32_t code, bool padding) {
    const std::string number = fmt::format("0x{:0{}x}", code, (bits_per_pixel(format) + 3) / 4);
    struct Channel {
        std::uint32_t shift, bits;
    };
    std::array<Channel, 3> channels{};  // Red, green, blue.
    switch (format) {
        case PixelFormat::Rgb111: channels = {{{0, 1}, {1, 1}, {2, 1}}}; break;
        case PixelFormat::Rgb332: channels = {{{5, 3}, {2, 3}, {0, 2}}}; break;
        case PixelFormat::Rgb555: channels = {{{10, 5}, {5, 5}, {0, 5}}}; break;
        case PixelFormat::Rgb565: channels = {{{11, 5}, {5, 6}, {0, 5}}}; break;
        case PixelFormat::Rgb888: channels = {{{0, 8}, {8, 8}, {16, 8}}}; break;
        default: return number;
    }
    if (padding) return number;
    std::string color = "#";
    for (const auto [shift, bits] : channels) {
        const std::uint32_t most = (1u << bits) - 1;
        color += fmt::format("{:02x}", (code >> shift & most) * 255 / most);
    }
    return fmt::format("{} ({})", number, color);
}

}  // namespace

std::optional<FrameDifference> compare_frames(const DisplayDescription& display, std::span<const std::byte> a,
                                              std::span<const std::byte> b) {
    if (std::ranges::equal(a, b)) return std::nullopt;
    const std::uint32_t bits = bits_per_pixel(display.format);
    FrameDifference difference;
    std::size_t offset = 0;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            const std::size_t bytes = row_bytes(panel, display.format);
            for (std::uint32_t row = 0; row < panel.rows; ++row, offset += bytes) {
                const auto row_a = a.subspan(offset, bytes);
                const auto row_b = b.subspan(offset, bytes);
                if (std::ranges::equal(row_a, row_b)) continue;
                // One more column than there are: the padding, less than a byte.
                for (std::uint32_t column = 0; column <= panel.columns; ++column) {
                    const std::uint32_t width = column < panel.columns ? bits : 8;
                    const std::uint32_t code_a = bits_of(row_a, std::size_t{column} * bits, width);
                    const std::uint32_t code_b = bits_of(row_b, std::size_t{column} * bits, width);
                    if (code_a == code_b) continue;
                    if (difference.pixels++ == 0) difference.first = {slice, p, row, column, code_a, code_b};
                }
            }
        }
    }
    return difference;
}

Expected<std::optional<RecordingDifference>> compare_recordings(RecordingReader& a, RecordingReader& b) {
    using What = RecordingDifference::What;
    for (const RecordingReader* reader : {&a, &b}) {
        if (reader->display() == nullptr) return fail(reader->fault());
    }
    const DisplayFile& display = *a.display();
    if (geometry_digest(display) != geometry_digest(*b.display())) return RecordingDifference{What::Geometry, 0, {}};
    a.rewind();
    b.rewind();
    RecordedFrames frames_a(a, display);
    RecordedFrames frames_b(b, display);
    for (std::uint64_t number = 0;; ++number) {
        const Status in_a = frames_a.next();
        if (in_a == Status::Corrupt) return fail(frames_a.damage());
        const Status in_b = frames_b.next();
        if (in_b == Status::Corrupt) return fail(frames_b.damage());
        if (in_a != in_b) return RecordingDifference{in_a == Status::Ok ? What::MoreInA : What::MoreInB, number, {}};
        if (in_a == Status::Closed && number == 0) {
            return fail(
                fmt::format("there is no whole frame in {}, and none in {}; record them anew", a.name(), b.name()));
        }
        if (in_a == Status::Closed) return std::optional<RecordingDifference>();
        const auto pixels = compare_frames(display, frames_a.frame().bytes, frames_b.frame().bytes);
        if (pixels) return RecordingDifference{What::Frame, number, *pixels};
    }
}

std::string describe(const RecordingDifference& difference, const RecordingReader& a, const RecordingReader& b) {
    using What = RecordingDifference::What;
    const auto count = [](std::uint64_t frames) { return fmt::format("{} frame{}", frames, frames == 1 ? "" : "s"); };
    switch (difference.what) {
        case What::Geometry:
            return fmt::format("they are of displays of different geometry: {} in {}, {} in {}",
                               a.display()->name.view(), a.name(), b.display()->name.view(), b.name());
        case What::MoreInA:
            return fmt::format("{} ends after {}, {} goes on", b.name(), count(difference.frame), a.name());
        case What::MoreInB:
            return fmt::format("{} ends after {}, {} goes on", a.name(), count(difference.frame), b.name());
        case What::Frame: break;
    }
    const PixelDifference& first = difference.pixels.first;
    const DisplayFile& display = *a.display();
    const bool padding = first.column >= display.panels[first.panel].columns;
    return fmt::format(
        "frame {}, slice {}, panel {}, row {}, {}: code {} in {}, {} in {}; {} {}", difference.frame, first.slice,
        first.panel, first.row, padding ? "the padding behind it" : fmt::format("column {}", first.column),
        code_text(display.format, first.code_a, padding), a.name(), code_text(display.format, first.code_b, padding),
        b.name(), difference.pixels.pixels, difference.pixels.pixels == 1 ? "pixel differs" : "pixels differ");
}

}  // namespace xorvox::sim
