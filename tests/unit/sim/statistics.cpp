#include "sim/statistics.h"

#include <cctype>
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

TEST_CASE("light outside the geometry is counted apart") {
    const DisplayDescription display = stack_of(4, 4, 4);
    sim::LightField field;
    field.flashes.push_back({{1.0, 1.5, 3.5}, glm::vec3(1.0f), 1, 0});
    field.flashes.push_back({{1.0, 1.5, 9.0}, glm::vec3(1.0f), 1, 0});
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
    CHECK(json ==
          R"({"display": "stack", "samples": 8, "places": 8, "pixels_lit": 8, "voxels_lit": 8, "light_outside": 0, )"
          R"("brightness_ratio": 1, "frame": 7, "brightness": 200, "blank": false})");
    CHECK(JsonReader(json).is_valid());
}

TEST_CASE("statistics of nothing are JSON with nulls, and names are escaped") {
    DisplayDescription display = stack_of(2, 2, 2);
    display.name = DisplayName("a \"b\" \\ c\n");
    const std::string json = sim::to_json(sim::measure(display, {}, {}));
    CHECK(json.find(R"("display": "a \"b\" \\ c\u000a")") != std::string::npos);
    CHECK(json.find(R"("brightness_ratio": null, "frame": null)") != std::string::npos);
    CHECK(JsonReader(json).is_valid());
}

}  // namespace
}  // namespace xorvox
