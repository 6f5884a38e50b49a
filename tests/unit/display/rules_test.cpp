#include <cmath>
#include <limits>
#include <string>

#include "driver/display/toml.h"
#include "tests/catch.h"

using namespace xorvox;
using Catch::Matchers::Contains;

namespace {

DisplayDescription stack() {
    DisplayDescription display;
    display.name = DisplayName("mine");
    display.slices = 4;
    display.cycles_per_second = 60;
    display.panels[0].columns = 5;
    display.panels[0].rows = 3;
    return display;
}

DisplayDescription rotor() {
    DisplayDescription display = stack();
    display.kind = DisplayKind::RotatingPanel;
    display.panel_count = 2;
    display.panels[1] = display.panels[0];
    display.panels[1].angle_deg = 180;
    return display;
}

std::string message(const DisplayDescription& display) {
    const auto valid = validate_display(display);
    REQUIRE_FALSE(valid);
    return valid.error().message;
}

}  // namespace

TEST_CASE("descriptions made in code are validated") {
    CHECK(validate_display(stack()));
    CHECK(validate_display(rotor()));
    CHECK_THAT(message({}), Contains("slices: found 0"));
}

TEST_CASE("each field of a description is checked") {
    auto display = stack();
    display.slices = 4097;
    CHECK(message(display) == "display \"mine\": slices: found 4097; allowed: a whole number from 1 to 4096");
    display = stack();
    display.kind = DisplayKind{7};
    CHECK_THAT(message(display), Contains("kind: found number 7"));
    display = stack();
    display.format = PixelFormat{0};
    CHECK_THAT(message(display), Contains("format: found number 0"));
    display = stack();
    display.panel_count = 2;
    CHECK_THAT(message(display), Contains("panel: found 2 panels; allowed on stacked-planes: exactly one"));
    display = stack();
    display.clockwise = true;
    CHECK_THAT(message(display), Contains("clockwise"));
    display = stack();
    display.plane_pitch_mm = -1;
    CHECK_THAT(message(display), Contains("plane_pitch_mm: found -1"));
    display = stack();
    display.cycles_per_second = std::numeric_limits<double>::quiet_NaN();
    CHECK_THAT(message(display), Contains("cycles_per_second: found nan"));
    display = stack();
    display.panels[0].offset_mm = 2;
    CHECK_THAT(message(display), Contains("panel 1, offset_mm: found 2; allowed: 0"));

    display = rotor();
    display.panel_count = 9;
    CHECK_THAT(message(display), Contains("panel: found 9 panels"));
    display.panel_count = 0;
    CHECK_THAT(message(display), Contains("panel: found 0 panels"));
    display = rotor();
    display.panels[1].columns = 5000;
    CHECK_THAT(message(display), Contains("panel 2, columns: found 5000"));
    display = rotor();
    display.panels[1].rows = 4;
    CHECK_THAT(message(display), Contains("panel 2, rows: found 4; allowed: 3"));
}

TEST_CASE("the digest ignores name and speed and nothing else") {
    const auto digest = geometry_digest(rotor());
    auto display = rotor();
    display.name = DisplayName("other");
    display.cycles_per_second = 1;
    CHECK(geometry_digest(display) == digest);
    display.clockwise = true;
    CHECK(geometry_digest(display) != digest);
    display = rotor();
    display.panels[1].angle_deg = 90;
    CHECK(geometry_digest(display) != digest);
    display = rotor();
    display.format = PixelFormat::Rgb888;
    CHECK(geometry_digest(display) != digest);
}
