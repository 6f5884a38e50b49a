#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "driver/display/toml.h"
#include "driver/host/pixel.h"
#include "driver/host/slices.h"
#include "tests/catch.h"
#include "tests/displays.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

/// Colours that tell where a point is; counts the points.
class PlaceField final : public ColorField {
public:
    static glm::vec3 color(const glm::vec3& p) {
        return glm::vec3(0.03f, 0.05f, 0.02f) + 0.9f * glm::vec3(p.y, p.z, p.x);
    }
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        for (std::size_t i = 0; i < points.size(); ++i) colors[i] = color(points[i]);
        asked += points.size();
    }
    mutable std::size_t asked = 0;
};

class OneColor final : public ColorField {
public:
    explicit OneColor(glm::vec3 color) : color_(color) {}
    void evaluate(std::span<const glm::vec3>, std::span<glm::vec3> colors) const override {
        for (glm::vec3& color : colors) color = color_;
    }

private:
    glm::vec3 color_;
};

DisplayDescription odd_stack(PixelFormat format) {
    DisplayDescription display;
    display.format = format;
    display.slices = 4;
    display.plane_pitch_mm = 7;
    display.cycles_per_second = 60;
    display.panels[0] = {.columns = 5, .rows = 3, .column_pitch_mm = 2, .row_pitch_mm = 3};
    return display;
}

/// The nearest sample, by looking at all of them.
glm::uvec3 nearest_sample(const Lattice& lattice, const glm::dvec3& place) {
    glm::uvec3 nearest(0);
    double best = 1e300;
    for (std::uint32_t y = 0; y < lattice.ny; ++y) {
        for (std::uint32_t x = 0; x < lattice.nx; ++x) {
            for (std::uint32_t k = 0; k < lattice.nz; ++k) {
                const glm::dvec3 d = sample_position(lattice, x, y, k) - place;
                const double distance = d.x * d.x + d.y * d.y + d.z * d.z;
                if (distance < best) {
                    best = distance;
                    nearest = {x, y, k};
                }
            }
        }
    }
    REQUIRE(best < 1e-18);
    return nearest;
}

std::uint32_t bits_at(std::span<const std::byte> bytes, std::size_t first, std::uint32_t count) {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::size_t bit = first + i;
        value |= (std::to_integer<std::uint32_t>(bytes[bit / 8]) >> (bit % 8) & 1u) << i;
    }
    return value;
}

/// The code of a colour that is bright enough, in double.
std::uint32_t expected_code(const glm::vec3& color, PixelFormat format) {
    const auto level = [](double value, int most) { return static_cast<std::uint32_t>(std::lround(value * most)); };
    switch (format) {
        case PixelFormat::Mono1: return 1;
        case PixelFormat::Rgb111: return level(color.r, 1) | level(color.g, 1) << 1 | level(color.b, 1) << 2;
        case PixelFormat::Rgb332: return level(color.r, 7) << 5 | level(color.g, 7) << 2 | level(color.b, 3);
        case PixelFormat::Rgb555: return level(color.r, 31) << 10 | level(color.g, 31) << 5 | level(color.b, 31);
        case PixelFormat::Mono2: return level(0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b, 3);
        case PixelFormat::Mono4: return level(0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b, 15);
        case PixelFormat::Rgb565: return level(color.r, 31) << 11 | level(color.g, 63) << 5 | level(color.b, 31);
        case PixelFormat::Rgb888: return level(color.r, 255) | level(color.g, 255) << 8 | level(color.b, 255) << 16;
    }
    return 0;
}

BitVolume random_volume(const Lattice& lattice, unsigned seed, unsigned one_in) {
    BitVolume volume(lattice);
    std::mt19937 random(seed);
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                if (random() % one_in == 0) volume.view().flip(x, y, k);
            }
        }
    }
    return volume;
}

/// nearest_sample() of every pixel of a frame, in the order of the wire.
std::vector<glm::uvec3> nearest_samples(const DisplayDescription& display) {
    const DisplayLattice lattice(display);
    std::vector<glm::uvec3> samples;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                for (std::uint32_t column = 0; column < display.panels[p].columns; ++column) {
                    samples.push_back(nearest_sample(lattice.view(), test::drawn(display, slice, p, row, column)));
                }
            }
        }
    }
    return samples;
}

void check_against_reference(const DisplayDescription& display, std::span<const glm::uvec3> samples) {
    const FramePainter painter(display);
    const Lattice lattice = painter.lattice().view();
    const BitVolume volume = random_volume(lattice, 7, 2);
    const PlaceField field;
    std::vector<std::byte> frame(frame_bytes(display), std::byte{0xff});
    REQUIRE(painter.paint(volume.view(), field, frame) == Status::Ok);
    CHECK(field.asked == volume.count());

    const DisplayExtent box = extent(display);
    const std::uint32_t bits = bits_per_pixel(display.format);
    std::size_t offset = 0;
    std::size_t pixel = 0;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            for (std::uint32_t row = 0; row < panel.rows; ++row) {
                for (std::uint32_t column = 0; column < panel.columns; ++column) {
                    const glm::dvec3 place = test::drawn(display, slice, p, row, column);
                    const glm::uvec3 at = samples[pixel++];
                    std::uint32_t expected = 0;
                    if (volume.test(at.x, at.y, at.z)) {
                        const glm::vec3 point((place - box.lower) / (box.upper - box.lower));
                        expected = expected_code(PlaceField::color(point), display.format);
                        if (expected == 0) continue;  // Too faint: another test.
                    }
                    INFO("slice " << slice << " panel " << p << " row " << row << " column " << column);
                    REQUIRE(bits_at(frame, 8 * offset + column * bits, bits) == expected);
                }
                const std::size_t used = std::size_t{panel.columns} * bits;
                const std::size_t all = 8 * row_bytes(panel, display.format);
                REQUIRE(bits_at(frame, 8 * offset + used, static_cast<std::uint32_t>(all - used)) == 0);
                offset += row_bytes(panel, display.format);
            }
        }
    }
    CHECK(offset == frame.size());
}

std::vector<std::byte> paint_all(const DisplayDescription& display, glm::vec3 color) {
    const FramePainter painter(display);
    const BitVolume volume = random_volume(painter.lattice().view(), 1, 1);
    std::vector<std::byte> frame(frame_bytes(display), std::byte{0xaa});
    REQUIRE(painter.paint(volume.view(), OneColor(color), frame) == Status::Ok);
    return frame;
}

}  // namespace

TEST_CASE("a frame of every kind of display is what the drawing says, in every format") {
    for (DisplayDescription display : test::odd_displays()) {
        const std::vector<glm::uvec3> samples = nearest_samples(display);
        for (const PixelFormat format : kPixelFormats) {
            display.format = format;
            INFO(std::string(display.name.view()) << ", " << std::string(to_string(format)));
            check_against_reference(display, samples);
        }
    }
}

TEST_CASE("a frame in one colour is the same whether the colour says so or is asked point by point") {
    for (DisplayDescription display : test::odd_displays()) {
        for (const PixelFormat format : kPixelFormats) {
            display.format = format;
            INFO(std::string(display.name.view()) << ", " << std::string(to_string(format)));
            const FramePainter painter(display);
            const BitVolume volume = random_volume(painter.lattice().view(), 3, 3);
            std::vector<std::byte> asked(frame_bytes(display), std::byte{0x5a});
            std::vector<std::byte> said(frame_bytes(display), std::byte{0xa5});
            const auto color = parse_color("constant:#40c0f0").value();
            REQUIRE(color->constant());
            REQUIRE(painter.paint(volume.view(), OneColor(*color->constant()), asked) == Status::Ok);
            REQUIRE(painter.paint(volume.view(), *color, said) == Status::Ok);
            CHECK((asked == said));
        }
    }
}

TEST_CASE("slices that are painted one by one make the same frame, and touch no other slice") {
    for (const DisplayDescription& display : test::odd_displays()) {
        INFO(std::string(display.name.view()));
        const FramePainter painter(display);
        const BitVolume volume = random_volume(painter.lattice().view(), 5, 2);
        const PlaceField field;
        std::vector<std::byte> whole(frame_bytes(display));
        REQUIRE(painter.paint(volume.view(), field, whole) == Status::Ok);
        std::vector<std::byte> parts(whole.size(), std::byte{0x77});
        for (std::uint32_t slice = display.slices; slice-- > 0;) {
            for (std::size_t i = 0; i < slice * slice_bytes(display); ++i) REQUIRE(parts[i] == std::byte{0x77});
            REQUIRE(painter.paint_slices(volume.view(), field, parts, slice, 1) == Status::Ok);
        }
        CHECK((parts == whole));
        CHECK(painter.paint_slices(volume.view(), field, parts, display.slices, 1) == Status::InvalidArgument);
        CHECK(painter.paint_slices(volume.view(), field, parts, 1, display.slices) == Status::InvalidArgument);
    }
}

TEST_CASE("an empty volume is dark and asks for no colour") {
    const FramePainter painter(test::upright_rotor(false, false, 0));
    const BitVolume volume(painter.lattice().view());
    const PlaceField field;
    std::vector<std::byte> frame(frame_bytes(test::upright_rotor(false, false, 0)), std::byte{0x55});
    REQUIRE(painter.paint(volume.view(), field, frame) == Status::Ok);
    for (const std::byte byte : frame) REQUIRE(byte == std::byte{0});
    CHECK(field.asked == 0);
}

TEST_CASE("a set voxel of a faint colour is lit in its strong channels, in every format") {
    for (const PixelFormat format : kPixelFormats) {
        INFO(std::string(to_string(format)));
        const auto display = odd_stack(format);
        const std::uint32_t bits = bits_per_pixel(format);
        const auto first_pixel = [&](glm::vec3 color) { return bits_at(paint_all(display, color), 0, bits); };
        const auto one = [&](std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
            switch (format) {
                case PixelFormat::Rgb111: return red | green << 1 | blue << 2;
                case PixelFormat::Rgb332: return red << 5 | green << 2 | blue;
                case PixelFormat::Rgb555: return red << 10 | green << 5 | blue;
                case PixelFormat::Rgb565: return red << 11 | green << 5 | blue;
                case PixelFormat::Rgb888: return red | green << 8 | blue << 16;
                default: return 1u;
            }
        };
        CHECK(first_pixel({1e-6f, 0, 0}) == one(1, 0, 0));
        CHECK(first_pixel({0, 1e-6f, 1e-7f}) == one(0, 1, 0));
        CHECK(first_pixel({1e-7f, 1e-7f, 1e-6f}) == one(0, 0, 1));
        CHECK(first_pixel({-1, -1, 1e-30f}) == one(0, 0, 1));
        CHECK(first_pixel({1e-6f, 1e-6f, 0}) == one(1, 1, 0));
        CHECK(first_pixel({1e-7f, 0.6e-6f, 1e-6f}) == one(0, 1, 1));
        CHECK(first_pixel({NAN, 1e-6f, -1}) == one(0, 1, 0));
    }
}

TEST_CASE("faint grey stays grey, in every format") {
    const auto dark_to_light = parse_color("gradient:black,white").value();
    const glm::vec3 point(0.0f, 0.0f, 0.02f);
    glm::vec3 mixed(0.0f);
    dark_to_light->evaluate({&point, 1}, {&mixed, 1});
    REQUIRE(mixed.r > 0.0f);
    for (const glm::vec3 grey : {glm::vec3(1e-6f), mixed}) {
        CHECK(visible_code(grey, PixelFormat::Mono1) == 1);
        CHECK(visible_code(grey, PixelFormat::Rgb111) == 7);
        CHECK(visible_code(grey, PixelFormat::Rgb332) == 0b001'001'01);
        CHECK(visible_code(grey, PixelFormat::Rgb565) == (1u << 11 | 1u << 5 | 1u));
        CHECK(visible_code(grey, PixelFormat::Rgb888) == 0x010101);
    }
}

TEST_CASE("black is dark in every format") {
    for (const PixelFormat format : kPixelFormats) {
        for (const glm::vec3 black : {glm::vec3(0), glm::vec3(-1), glm::vec3(NAN)}) {
            for (const std::byte byte : paint_all(odd_stack(format), black)) REQUIRE(byte == std::byte{0});
        }
    }
}

TEST_CASE("white fills the pixels and leaves the padding dark") {
    const auto frame = paint_all(odd_stack(PixelFormat::Rgb111), glm::vec3(1));
    for (std::size_t i = 0; i < frame.size(); i += 2) {
        CHECK(frame[i] == std::byte{0xff});
        CHECK(frame[i + 1] == std::byte{0x7f});
    }
}

TEST_CASE("painting needs a volume and a frame of the display's shape") {
    const auto display = odd_stack(PixelFormat::Rgb332);
    const FramePainter painter(display);
    const BitVolume volume(painter.lattice().view());
    const PlaceField field;
    std::vector<std::byte> frame(frame_bytes(display), std::byte{3});
    CHECK(painter.paint(volume.view(), field, std::span(frame).first(frame.size() - 1)) == Status::InvalidArgument);
    CHECK(painter.paint(BitVolume(5, 4, 3).view(), field, frame) == Status::InvalidArgument);
    ConstBitVolumeView cut = volume.view();
    cut.words = cut.words.first(1);
    CHECK(painter.paint(cut, field, frame) == Status::InvalidArgument);
    for (const std::byte byte : frame) REQUIRE(byte == std::byte{3});
}

TEST_CASE("quantize clips and rounds each channel to nearest") {
    CHECK(quantize({2, -1, 0.5f}, PixelFormat::Rgb888) == 0x8000ff);
    CHECK(quantize({1, 0, 0}, PixelFormat::Rgb332) == 0xe0);
    CHECK(quantize({0, 1, 0}, PixelFormat::Rgb332) == 0x1c);
    CHECK(quantize({0, 0, 1}, PixelFormat::Rgb332) == 0x03);
    CHECK(quantize({1, 0, 0}, PixelFormat::Rgb565) == 0xf800);
    CHECK(quantize({0, 1, 0}, PixelFormat::Rgb565) == 0x07e0);
    CHECK(quantize({0, 0, 1}, PixelFormat::Rgb565) == 0x001f);
    CHECK(quantize({0.49f, 0.51f, 1}, PixelFormat::Rgb111) == 6);
    CHECK(quantize({0.01f, 0, 0}, PixelFormat::Rgb111) == 0);
    CHECK(quantize({0.01f, 0, 0}, PixelFormat::Mono1) == 1);
    CHECK(quantize({0, 0, 0}, PixelFormat::Mono1) == 0);
}
