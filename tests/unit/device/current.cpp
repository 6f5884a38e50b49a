#include "driver/device/current.h"

#include <cmath>
#include <random>
#include <vector>

#include "driver/device/config.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::device;

namespace {

using Bytes = std::vector<std::byte>;

Bytes random_bytes(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    Bytes bytes(count);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 0xff);
    return bytes;
}

/// Bits of the channels of a pixel from its least significant bit on, as driver/display/description.h draws them.
std::vector<unsigned> channel_bits(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return {1};
        case PixelFormat::Mono2: return {2};
        case PixelFormat::Mono4: return {4};
        case PixelFormat::Rgb111: return {1, 1, 1};
        case PixelFormat::Rgb332: return {2, 3, 3};
        case PixelFormat::Rgb555: return {5, 5, 5};
        case PixelFormat::Rgb565: return {5, 6, 5};
        case PixelFormat::Rgb888: return {8, 8, 8};
    }
    return {};
}

/// The same by pixels, in floating point: the sum of the levels' shares of led_ua, pixel after pixel.
double reference_ua(const CurrentConfig& config, const Bytes& bytes) {
    double total = 0.0;
    std::size_t row = 0;
    for (std::uint32_t slice = 0; slice < config.slices; ++slice) {
        for (std::uint32_t p = 0; p < config.panel_count; ++p) {
            for (unsigned r = 0; r < config.panels[p].rows; ++r) {
                std::size_t bit = row * 8;
                const auto next_bits = [&](unsigned count) {
                    unsigned value = 0;
                    for (unsigned i = 0; i < count; ++i, ++bit) {
                        value |= (std::to_integer<unsigned>(bytes[bit / 8]) >> bit % 8 & 1u) << i;
                    }
                    return value;
                };
                for (unsigned c = 0; c < config.panels[p].columns; ++c) {
                    for (const unsigned bits : channel_bits(config.format)) {
                        const unsigned shown = std::min(bits, config.bit_planes);
                        total += 1.0 * config.led_ua * (next_bits(bits) >> (bits - shown)) / ((1u << shown) - 1);
                    }
                }
                row = (bit + 7) / 8;
            }
        }
    }
    return total / config.row_groups;
}

CurrentConfig config_of(PixelFormat format, std::uint16_t columns, std::uint16_t rows) {
    CurrentConfig config;
    config.format = format;
    config.bit_planes = bits_per_channel(format);
    config.led_ua = 20'000;
    config.panel_count = 1;
    config.panels[0] = {columns, rows};
    return config;
}

std::size_t bytes_of(const CurrentConfig& config) {
    std::size_t bytes = 0;
    for (std::uint32_t p = 0; p < config.panel_count; ++p) {
        bytes += (config.panels[p].columns * bits_per_pixel(config.format) + 7) / 8 * config.panels[p].rows;
    }
    return bytes * config.slices;
}

}  // namespace

TEST_CASE("the current by bit planes is that by pixels, in every format, width and number of planes") {
    std::uint32_t seed = 0;
    for (const PixelFormat format : kPixelFormats) {
        for (std::uint16_t columns = 1; columns <= 70; ++columns) {
            CurrentConfig config = config_of(format, columns, 3);
            config.panel_count = 2;
            config.panels[1] = {static_cast<std::uint16_t>(71 - columns), 2};
            config.slices = 1 + seed % 3;
            config.row_groups = 1 + seed % 16;
            config.bit_planes = 1 + seed % bits_per_channel(format);
            const Bytes bytes = random_bytes(bytes_of(config), ++seed);
            INFO(to_string(format) << ", " << columns << " columns, " << config.bit_planes << " planes");
            const double reference = reference_ua(config, bytes);
            const auto current = static_cast<double>(current_ua(config, bytes));
            REQUIRE(current >= reference - 1e-3);
            REQUIRE(current <= reference + 10.0);
        }
    }
}

TEST_CASE("all LEDs fully on draw what their number says, and none draw nothing") {
    for (const PixelFormat format : kPixelFormats) {
        const CurrentConfig config = config_of(format, 128, 64);
        const Bytes full(bytes_of(config), std::byte{0xff});
        INFO(to_string(format));
        CHECK(current_ua(config, full) == 128 * 64 * 20'000 * channel_bits(format).size());
        CHECK(current_ua(config, Bytes(full.size())) == 0);
        CHECK(current_ua(config, {}) == 0);
    }
}

TEST_CASE("the brightness keeps a slice within the limit, and no further below it than one step") {
    CurrentConfig config = config_of(PixelFormat::Rgb332, 128, 64);
    config.row_groups = 32;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const Bytes bytes = random_bytes(bytes_of(config), seed);
        const double current = reference_ua(config, bytes);
        config.limit_ua = 200'000 * seed;
        const unsigned brightness = safe_brightness(config, bytes);
        CHECK(current * brightness / 255 <= static_cast<double>(config.limit_ua));
        if (brightness < 255) CHECK(current * (brightness + 2) / 255 > static_cast<double>(config.limit_ua));
    }
    config.limit_ua = 1;
    CHECK(safe_brightness(config, Bytes(bytes_of(config), std::byte{0xff})) == 0);
    CHECK(safe_brightness(config, Bytes(bytes_of(config))) == 255);
    config.limit_ua = 0;
    CHECK(safe_brightness(config, Bytes(bytes_of(config), std::byte{0xff})) == 255);
}

TEST_CASE("an LED is lit no longer than its duty allows") {
    DisplayDescription display;
    display.kind = DisplayKind::RotatingPanel;
    display.slices = 360;
    display.cycles_per_second = 20.0;
    display.panels[0] = {.columns = 128, .rows = 64};
    display.scan.row_groups = 4;
    display.power = {.led_ma = 20.0, .max_duty = 0.125};
    CHECK(current_config(display).most_light == 127);
    display.power.max_duty = 0.25;
    CHECK(current_config(display).most_light == 255);
    // A layer of a cube is lit an eighth of the time.
    display.kind = DisplayKind::StackedPlanes;
    display.slices = 8;
    display.scan.row_groups = 1;
    display.power.max_duty = 0.0625;
    CHECK(current_config(display).most_light == 127);
    display.scan.driver = DriverChip::Dlp;
    CHECK(current_config(display).most_light == 15);
}
