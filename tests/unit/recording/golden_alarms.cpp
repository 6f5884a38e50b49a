// The golden recordings catch a driver that breaks: each case paints the voxels of a golden recording again with one
// piece broken, and diff must raise the alarm at the right place; with nothing broken it must be silent.
#include <algorithm>
#include <functional>

#include "driver/display/lattice.h"
#include "driver/host/slices.h"
#include "driver/host/wire_order.h"
#include "sim/recording/difference.h"
#include "sim/recording/frames.h"
#include "tests/catch.h"
#include "tests/unit/recording/rig.h"

namespace xorvox::test {
namespace {

using What = sim::RecordingDifference::What;

/// The colour of rotor.xvr, orange in linear light: sRGB 255, 165, 0.
class Orange final : public host::ColorField {
public:
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        std::fill_n(colors.begin(), points.size(), *constant());
    }
    std::optional<glm::vec3> constant() const override { return glm::vec3(1.0f, 0.3763f, 0.0f); }
};

/// A pixel's code in a frame of rgb332, by its place in scan-out order.
std::uint32_t code_at(const DisplayDescription& display, const Frame& frame, const sim::PixelDifference& place) {
    std::size_t at = place.slice * slice_bytes(display);
    for (std::uint32_t p = 0; p < place.panel; ++p) {
        at += std::size_t{display.panels[p].columns} * display.panels[p].rows;
    }
    at += std::size_t{place.row} * display.panels[place.panel].columns;
    return std::to_integer<std::uint32_t>(frame[at + place.column]);
}

/// The first pixel that differs, found the slow way.
std::optional<sim::PixelDifference> search(const DisplayDescription& display, const Frame& a, const Frame& b) {
    sim::PixelDifference at;
    for (at.slice = 0; at.slice < display.slices; ++at.slice) {
        for (at.panel = 0; at.panel < display.panel_count; ++at.panel) {
            const Panel& panel = display.panels[at.panel];
            for (at.row = 0; at.row < panel.rows; ++at.row) {
                for (at.column = 0; at.column < panel.columns; ++at.column) {
                    at.code_a = code_at(display, a, at);
                    at.code_b = code_at(display, b, at);
                    if (at.code_a != at.code_b) return at;
                }
            }
        }
    }
    return std::nullopt;
}

/// rotor.xvr, and the driver that made it.
struct Rotor {
    Folder folder;
    sim::RecordingReader golden = open_golden("rotor.xvr");
    DisplayFile display = *golden.display();
    DisplayLattice lattice{display};
    std::vector<Frame> frames = read_frames(golden, display).frames;
    BitVolume volume{lattice.view()};

    Rotor() {
        REQUIRE(frames.size() == 2);
        const host::WireOrder order(display, lattice);
        std::size_t at = 0;
        for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
            for (std::uint32_t p = 0; p < display.panel_count; ++p) {
                for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                    for (std::uint32_t column = 0; column < display.panels[p].columns; ++column) {
                        const host::Sample sample = order.sample(slice, p, row, column);
                        if (frames[0][at++] != std::byte{0}) volume.view().flip(sample.x, sample.y, sample.k);
                    }
                }
            }
        }
    }

    /// What the driver paints for `described`: the display, unless something of it is broken.
    Frame paint(const DisplayDescription& described) const {
        const host::FramePainter painter(described);
        Frame frame(frame_bytes(described));
        REQUIRE(painter.paint(volume.view(), Orange(), frame) == Status::Ok);
        return frame;
    }

    /// Records `frame` twice, as the golden one was, and compares.
    std::optional<sim::RecordingDifference> diff(const Frame& frame) {
        record_frames(folder.file("new.xvr"), display, {frame, frame}, {.max_packet_bytes = 1000});
        auto recorded = sim::open_recording(folder.file("new.xvr"));
        REQUIRE(recorded);
        const auto difference = sim::compare_recordings(golden, *recorded);
        if (!difference) FAIL(difference.error().message);
        return *difference;
    }

    void check_alarm(const Frame& broken) {
        const auto expected = search(display, frames[0], broken);
        REQUIRE(expected);
        const auto difference = diff(broken);
        REQUIRE(difference);
        CHECK(difference->what == What::Frame);
        CHECK(difference->frame == 0);
        CHECK(difference->pixels.first == *expected);
    }
};

}  // namespace

TEST_CASE("the driver as it is paints what is in the golden recording") {
    Rotor rotor;
    CHECK_FALSE(rotor.diff(rotor.paint(rotor.display)));
}

TEST_CASE("a broken slice map raises the alarm") {
    Rotor rotor;
    SECTION("the second panel's columns run the wrong way") {
        DisplayFile broken = rotor.display;
        broken.panels[1].mirrored = true;
        const Frame frame = rotor.paint(broken);
        rotor.check_alarm(frame);
        CHECK(rotor.diff(frame)->pixels.first.panel == 1);
    }
    SECTION("two slices are exchanged") {
        Frame frame = rotor.paint(rotor.display);
        const auto bytes = static_cast<std::ptrdiff_t>(slice_bytes(rotor.display));
        std::swap_ranges(frame.begin() + 20 * bytes, frame.begin() + 21 * bytes, frame.begin() + 31 * bytes);
        rotor.check_alarm(frame);
        CHECK(rotor.diff(frame)->pixels.first.slice == 20);
    }
    SECTION("rows are counted from below") {
        DisplayFile broken = rotor.display;
        broken.panels[0].turned = 2;
        broken.panels[0].mirrored = true;
        const Frame frame = rotor.paint(broken);
        rotor.check_alarm(frame);
        CHECK(rotor.diff(frame)->pixels.first.panel == 0);
    }
}

TEST_CASE("a broken bit order raises the alarm") {
    Rotor rotor;
    Frame frame = rotor.paint(rotor.display);
    for (std::byte& byte : frame) {
        unsigned reversed = 0;
        for (unsigned bit = 0; bit < 8; ++bit) reversed |= (std::to_integer<unsigned>(byte) >> bit & 1) << (7 - bit);
        byte = static_cast<std::byte>(reversed);
    }
    rotor.check_alarm(frame);
    // Nothing is dark that was lit: every lit pixel differs, none else.
    const auto lit = static_cast<std::size_t>(
        std::count_if(rotor.frames[0].begin(), rotor.frames[0].end(), [](std::byte b) { return b != std::byte{0}; }));
    CHECK(rotor.diff(frame)->pixels.pixels == lit);
}

TEST_CASE("a broken gamma raises the alarm") {
    Rotor rotor;
    DisplayFile broken = rotor.display;
    broken.light.response = Response::Linear;
    const Frame frame = rotor.paint(broken);
    rotor.check_alarm(frame);
    // Red is full with and without; the level of green is another.
    const sim::PixelDifference first = rotor.diff(frame)->pixels.first;
    CHECK((first.code_a & 0xe3) == (first.code_b & 0xe3));
}

TEST_CASE("a broken phase raises the alarm") {
    Rotor rotor;
    Frame frame = rotor.paint(rotor.display);
    std::rotate(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(slice_bytes(rotor.display)), frame.end());
    rotor.check_alarm(frame);
}

TEST_CASE("one wrong bit of a golden frame raises the alarm, wherever it is") {
    Rotor rotor;
    for (std::size_t i = 0; i < 200; ++i) {
        Frame frame = rotor.frames[0];
        const std::size_t at = i * 7919 % frame.size();
        frame[at] ^= static_cast<std::byte>(1u << (i % 8));
        rotor.check_alarm(frame);
    }
}

}  // namespace xorvox::test
