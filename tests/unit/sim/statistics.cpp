#include "sim/statistics.h"

#include <cctype>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;

std::vector<std::byte> full_page(const DisplayDescription& display) {
    std::vector<std::byte> page = dark_page(display);
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t panel = 0; panel < display.panel_count; ++panel) {
            for (std::uint32_t row = 0; row < display.panels[panel].rows; ++row) {
                for (std::uint32_t column = 0; column < display.panels[panel].columns; ++column) {
                    set_pixel(display, page, {slice, panel, row, column}, 1);
                }
            }
        }
    }
    return page;
}

sim::Statistics measure_full(const DisplayDescription& display) {
    return sim::measure(display, sim::expose(display, full_page(display), 255), {});
}

/// Whether `text` is one JSON value: objects, strings without escapes but \" \\ \u, numbers and words.
class JsonReader {
public:
    explicit JsonReader(std::string_view text) : text_(text) {}
    bool is_valid() { return value() && at_ == text_.size(); }

private:
    char peek() {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool take(char c) { return peek() == c && (++at_, true); }
    bool word(std::string_view expected) {
        if (text_.substr(at_, expected.size()) != expected) return false;
        at_ += expected.size();
        return true;
    }
    bool string() {
        if (!take('"')) return false;
        for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
            if (static_cast<unsigned char>(text_[at_]) < 0x20) return false;
            if (text_[at_] == '\\') ++at_;
        }
        return at_ < text_.size() && text_[at_++] == '"';
    }
    bool number() {
        const std::size_t start = at_;
        while (at_ < text_.size() && std::string_view("+-.eE0123456789").find(text_[at_]) != std::string_view::npos) {
            ++at_;
        }
        return at_ > start && std::isdigit(static_cast<unsigned char>(text_[at_ - 1])) != 0;
    }
    bool object() {
        if (!take('{')) return false;
        do {
            if (peek() != '"' || !string() || !take(':') || !value()) return false;
        } while (take(','));
        return take('}');
    }
    bool value() {
        switch (peek()) {
            case '{': return object();
            case '"': return string();
            case 't': return word("true");
            case 'f': return word("false");
            case 'n': return word("null");
            default: return number();
        }
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

TEST_CASE("a full stack is evenly bright") {
    const sim::Statistics statistics = measure_full(stack_of(4, 3, 5));
    CHECK(statistics.samples == 60);
    CHECK(statistics.places == 60);
    CHECK(statistics.pixels_lit == 60);
    CHECK(statistics.voxels_lit == 60);
    CHECK(statistics.light_outside == 0);
    CHECK(statistics.brightness_ratio == 1.0);
}

TEST_CASE("a full rotor is as much brighter inside as its LEDs are slower there") {
    DisplayDescription display = rotor_of(32, 2, 20);  // LEDs at 1, 3 … 31 mm to both sides
    for (Panel& panel : display.panels) panel.offset_mm = 2.5;
    const sim::Statistics offset = measure_full(display);
    CHECK(offset.brightness_ratio == Approx(31.0));
    CHECK(offset.samples == 2 * 32 * 2 * 20);
    CHECK(offset.places == 32 * 2 * 20);  // The back panel passes every place of the front one.
    CHECK(offset.voxels_lit == offset.places);
    CHECK(offset.pixels_lit == offset.samples);

    for (Panel& panel : display.panels) panel.offset_mm = 0.0;
    const sim::Statistics centred = measure_full(display);
    CHECK(centred.brightness_ratio == Approx(31.0));
    CHECK(centred.places == 16 * 2 * 20);
}

TEST_CASE("an LED on the axis stands for the disc that it sweeps") {
    DisplayDescription display = rotor_of(3, 1, 8, PixelFormat::Mono1, 1);
    display.panels[0].offset_mm = 0.0;
    // ∫|r|dr over an LED of pitch p: p²/4 on the axis, p·p at r = p.
    CHECK(measure_full(display).brightness_ratio == Approx(4.0));
}

TEST_CASE("a place that one of its two samples lit counts as half as bright") {
    DisplayDescription display = rotor_of(2, 1, 2, PixelFormat::Mono1, 1);
    display.panels[0].offset_mm = 0.0;  // both columns pass both places
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.slice = 0, .column = 0}, 1);
    set_pixel(display, page, {.slice = 0, .column = 1}, 1);
    set_pixel(display, page, {.slice = 1, .column = 1}, 1);
    const sim::Statistics statistics = sim::measure(display, sim::expose(display, page, 255), {});
    CHECK(statistics.pixels_lit == 3);
    CHECK(statistics.voxels_lit == 2);
    CHECK(statistics.brightness_ratio == Approx(2.0));
}

TEST_CASE("visits and coverage tell how often places are lit, and how many") {
    DisplayDescription display = rotor_of(3, 2, 5, PixelFormat::Mono1, 1);
    display.panels[0].offset_mm = 0.0;  // the middle column is on the axis
    const sim::Statistics full = measure_full(display);
    CHECK(full.places == 2 + 2 * 10);
    CHECK(full.visits.least == 1);
    CHECK(full.visits.most == 5);
    CHECK(full.visits.mean == Approx(30.0 / 22.0));
    CHECK(full.coverage == 1.0);
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.slice = 3, .row = 1, .column = 2}, 1);
    const sim::Statistics one = sim::measure(display, sim::expose(display, page, 255), {});
    CHECK(one.visits.most == 1);
    CHECK(one.coverage == Approx(1.0 / 22.0));
}

TEST_CASE("a swept plane of constant speed and a helix are evenly bright, a sine is brighter at its ends") {
    CHECK(measure_full(swept_of(3, 2, 9, MotionProfile::Constant)).brightness_ratio == Approx(1.0));
    CHECK(measure_full(helix_of(6, 4, 7, 2)).brightness_ratio == Approx(1.0));
    // Of 9 slices the middle one is sin 10° high, in halves of the stroke, doubled; the lowest 1 − cos 20°.
    const double degree = std::acos(-1.0) / 180.0;
    CHECK(measure_full(swept_of(3, 2, 9, MotionProfile::Sine)).brightness_ratio ==
          Approx(2.0 * std::sin(10.0 * degree) / (1.0 - std::cos(20.0 * degree))));
}

TEST_CASE("the planes of an uneven stack stand for the space to their neighbours") {
    constexpr double kHeights[] = {0.0, 2.0, 8.0};
    DisplayDescription display = stack_of(3, 2, 3);
    display.plane_heights_mm = kHeights;
    CHECK(measure_full(display).brightness_ratio == Approx(3.0));  // 2, 4 and 6 mm
}

TEST_CASE("a panel that leans sweeps less, and one on its side has columns that were rows") {
    DisplayDescription leaning = rotor_of(4, 1, 8);
    leaning.panels[1].tilt_deg = 60.0;  // its row is the axis of the tilt: it sweeps the same place, half as high
    leaning.panels[1].lift_mm = 50.0;
    const sim::Statistics statistics = measure_full(leaning);
    CHECK(statistics.brightness_ratio == Approx(6.0));  // LEDs at 1 and 3 mm, and upright or leaning
    DisplayDescription turned = rotor_of(2, 4, 8, PixelFormat::Mono1, 1);
    turned.panels[0].turned = 1;
    CHECK(measure_full(turned).brightness_ratio == Approx(3.0));  // LEDs at 2 and 6 mm
}

TEST_CASE("panels of different lifts share the places that both pass") {
    DisplayDescription display = rotor_of(2, 3, 2);  // rows 4 mm apart; back to back
    display.panels[0].offset_mm = display.panels[1].offset_mm = 0.0;
    display.panels[1].lift_mm = 8.0;
    const sim::Statistics statistics = measure_full(display);
    CHECK(statistics.samples == 2 * 2 * 2 * 3);
    CHECK(statistics.places == 2 * 5);  // The top row of one passes where the lowest of the other does.
    CHECK(statistics.visits.least == 2);
    CHECK(statistics.visits.most == 4);
    CHECK(statistics.brightness_ratio == Approx(1.0));
}

TEST_CASE("free points count alone, and two at one place as that place") {
    const sim::Statistics statistics = measure_full(points_of());
    CHECK(statistics.samples == 10);
    CHECK(statistics.places == 9);
    CHECK(statistics.visits.most == 2);
    CHECK(statistics.brightness_ratio == Approx(1.0));
}

TEST_CASE("light outside the geometry is counted apart") {
    const DisplayDescription display = stack_of(4, 4, 4);
    sim::LightField field;
    field.flashes.push_back({{1.0, 1.5, 3.5}, 1, 0});
    field.flashes.push_back({{1.0, 1.5, 9.0}, 1, 0});
    const sim::Statistics statistics = sim::measure(display, field, {});
    CHECK(statistics.pixels_lit == 2);
    CHECK(statistics.voxels_lit == 1);
    CHECK(statistics.light_outside == 1);
}

TEST_CASE("statistics are JSON, in one order") {
    wire::DeviceStatus device;
    device.has_frame = 1;
    device.shown_frame = 7;
    device.brightness = 200;
    const DisplayDescription display = stack_of(2, 2, 2);
    const sim::LightField field = sim::expose(display, full_page(display), 255);
    const std::string json = sim::to_json(sim::measure(display, field, device));
    CHECK(
        json ==
        R"({"display": "stack", "samples": 8, "places": 8, "pixels_lit": 8, "voxels_lit": 8, "light_outside": 0, )"
        R"("coverage": 1, "visits": {"least": 1, "mean": 1, "most": 1}, "brightness_ratio": 1, "frame": 7, "brightness": 200, "blank": false})");
    CHECK(JsonReader(json).is_valid());
}

TEST_CASE("statistics of nothing are JSON with nulls, and names are escaped") {
    DisplayDescription display = stack_of(2, 2, 2);
    display.name = DisplayName("a \"b\" \\ c\n");
    const std::string json = sim::to_json(sim::measure(display, {}, {}));
    CHECK(json.find(R"("display": "a \"b\" \\ c\u000a")") != std::string::npos);
    CHECK(json.find(R"("coverage": 0, "visits": null, "brightness_ratio": null, "frame": null)") != std::string::npos);
    CHECK(JsonReader(json).is_valid());
}

}  // namespace
}  // namespace xorvox
