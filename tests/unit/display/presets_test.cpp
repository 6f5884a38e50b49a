#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "driver/display/timing.h"
#include "driver/display/toml.h"
#include "tests/catch.h"

using namespace xorvox;

TEST_CASE("the presets are listed by name, each with a summary of one line") {
    const auto& all = presets();
    REQUIRE(all.size() == 9);
    CHECK(std::ranges::is_sorted(all, {}, &Preset::name));
    for (const Preset& preset : all) {
        INFO(preset.name);
        CHECK_FALSE(preset.summary.empty());
        CHECK(preset.summary.find('\n') == std::string_view::npos);
        CHECK(&presets() == &all);
    }
}

TEST_CASE("each preset loads, is valid, and bears its own name") {
    for (const Preset& preset : presets()) {
        const auto display = load_display(std::string(preset.name));
        if (!display) FAIL(display.error().message);
        CHECK(display->name.view() == preset.name);
        CHECK(validate_display(*display));
    }
}

TEST_CASE("the embedded presets are the files") {
    for (const Preset& preset : presets()) {
        std::ifstream file(XORVOX_SOURCE_DIR "/driver/display/presets/" + std::string(preset.name) + ".toml");
        REQUIRE(file);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        CHECK(preset.text == text);
        CHECK(text.find("\nsummary = \"" + std::string(preset.summary) + "\"\n") != std::string::npos);
    }
}

TEST_CASE("every display of the table of facts is a preset") {
    std::string names;
    for (const Preset& preset : presets()) names += std::string(preset.name) + " ";
    CHECK(names == "candle cube16-ws2812 cube20-ws2812 cube8-595 depthcube perspecta rotovox vortex vx1 ");
}

TEST_CASE("each preset says where it is known from and what is assumed") {
    for (const Preset& preset : presets()) {
        INFO(preset.name);
        CHECK(preset.text.find("# Public source") != std::string_view::npos);
        CHECK_FALSE(load_display(std::string(preset.name)).value().assumed.empty());
        CHECK(load_display(std::string(preset.name)).value().summary == preset.summary);
    }
}

TEST_CASE("each preset has time for the bit planes that it shows, and for no more than it says") {
    for (const Preset& preset : presets()) {
        INFO(preset.name);
        const auto display = load_display(std::string(preset.name)).value();
        CHECK(scan_time_ns(display, shown_bit_planes(display)) <= slice_time_ns(display));
        CHECK(fitting_bit_planes(display) == shown_bit_planes(display));
    }
}

TEST_CASE("the presets have the sizes and rates of their displays") {
    const auto is = [](const std::string& name, DisplayKind kind, PixelFormat format, std::uint32_t slices,
                       double cycles_per_second, std::size_t bytes, std::uint64_t digest) {
        INFO(name);
        const auto display = load_display(name).value();
        CHECK(display.kind == kind);
        CHECK(display.format == format);
        CHECK(display.slices == slices);
        CHECK(display.cycles_per_second == cycles_per_second);
        CHECK(frame_bytes(display) == bytes);
        CHECK(geometry_digest(display) == digest);
    };
    using Kind = DisplayKind;
    using Format = PixelFormat;
    is("perspecta", Kind::RotatingPanel, Format::Rgb111, 198, 24, 198 * 768 * 768 / 8 * 3, 0xd94e17d7c5f7fee1u);
    is("depthcube", Kind::StackedPlanes, Format::Rgb555, 20, 50, 20 * 748 * 1024 / 8 * 15, 0x597acceb7b335bb7u);
    is("vx1", Kind::SweptPlane, Format::Mono1, 192, 15, 192 * 912 * 1140 / 8, 0xa90a1da2fb342582u);
    is("vortex", Kind::RotatingPanel, Format::Rgb332, 360, 10, 360 * 2 * 128 * 64, 0xbcb7b724c2abe1fcu);
    is("rotovox", Kind::RotatingPanel, Format::Rgb332, 360, 10, 360 * 2 * 128 * 64, 0x25cc093c536ccd92u);
    is("candle", Kind::RotatingPanel, Format::Mono1, 24, 25, 24 * 10, 0x07b929e308fc732au);
    is("cube8-595", Kind::StackedPlanes, Format::Mono1, 8, 100, 8 * 8, 0x30b04efd7cfc6d9eu);
    is("cube16-ws2812", Kind::StackedPlanes, Format::Rgb888, 16, 60, 4096 * 3, 0xbd66feccf1eb8e57u);
    is("cube20-ws2812", Kind::StackedPlanes, Format::Rgb888, 20, 60, 8000 * 3, 0x86d6a523378fec13u);
}

TEST_CASE("perspecta turns half a turn a frame") {
    const auto display = load_display("perspecta").value();
    CHECK(display.sweep_deg == 180.0);
    CHECK(turns_per_second(display) == 12.0);
}

TEST_CASE("the panels of vortex stand back to back and those of rotovox side by side") {
    const auto vortex = load_display("vortex").value();
    REQUIRE(vortex.panel_count == 2);
    CHECK(vortex.panels[1].angle_deg - vortex.panels[0].angle_deg == 180.0);
    CHECK(vortex.panels[0].offset_mm > 0.0);
    const auto rotovox = load_display("rotovox").value();
    REQUIRE(rotovox.panel_count == 2);
    for (std::size_t p = 0; p < 2; ++p) {
        CHECK(rotovox.panels[p].turned % 2 == 1);
        CHECK(std::abs(rotovox.panels[p].shift_mm) == 32 * rotovox.panels[p].row_pitch_mm);
    }
    CHECK(rotovox.panels[0].shift_mm == -rotovox.panels[1].shift_mm);
}
