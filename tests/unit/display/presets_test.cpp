#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include "driver/display/toml.h"
#include "tests/catch.h"

using namespace xorvox;

TEST_CASE("the presets are listed by name, each with a summary of one line") {
    const auto& all = presets();
    REQUIRE(all.size() >= 2);
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

TEST_CASE("cube16-ws2812 is 16 planes of 16 x 16 pixels of 24 bits") {
    const auto display = load_display("cube16-ws2812").value();
    CHECK(display.kind == DisplayKind::StackedPlanes);
    CHECK(display.slices == 16);
    CHECK(bits_per_pixel(display.format) == 24);
    CHECK(frame_pixels(display) == 4096);
    CHECK(frame_bytes(display) == 12288);
    CHECK(display.cycles_per_second >= 60.0);
    CHECK(display.cycles_per_second <= 110.0);
    CHECK(geometry_digest(display) == 0x7bb5765c167872d1u);
}

TEST_CASE("vortex is two panels of 128 x 64 pixels back to back, 360 slices a turn, rgb332") {
    const auto display = load_display("vortex").value();
    CHECK(display.kind == DisplayKind::RotatingPanel);
    CHECK(display.slices == 360);
    CHECK(display.format == PixelFormat::Rgb332);
    REQUIRE(display.panel_count == 2);
    for (std::size_t p = 0; p < 2; ++p) {
        CHECK(display.panels[p].columns == 128);
        CHECK(display.panels[p].rows == 64);
    }
    CHECK(display.panels[1].angle_deg - display.panels[0].angle_deg == 180.0);
    CHECK(frame_bytes(display) == 360 * 2 * 128 * 64);
    CHECK(geometry_digest(display) == 0x1e347c927c784f73u);
}
