// What makes recordings equal, and where they are said to differ.
#include <string>

#include "sim/recording/difference.h"
#include "tests/catch.h"
#include "tests/displays.h"
#include "tests/unit/recording/rig.h"

namespace xorvox::test {
namespace {

using What = sim::RecordingDifference::What;

struct Pair {
    Folder folder;
    DisplayFile display = tiny_display();

    std::optional<sim::RecordingDifference> compare(const std::vector<Frame>& a, const std::vector<Frame>& b,
                                                    const Sending& sent_a = {}, const Sending& sent_b = {}) {
        record_frames(folder.file("a.xvr"), display, a, sent_a);
        record_frames(folder.file("b.xvr"), display, b, sent_b);
        auto reader_a = sim::open_recording(folder.file("a.xvr"));
        auto reader_b = sim::open_recording(folder.file("b.xvr"));
        REQUIRE(reader_a);
        REQUIRE(reader_b);
        const auto difference = sim::compare_recordings(*reader_a, *reader_b);
        if (!difference) FAIL(difference.error().message);
        if (*difference) words = sim::describe(**difference, *reader_a, *reader_b);
        return *difference;
    }
    std::string words;
};

}  // namespace

TEST_CASE("recordings are equal whatever their times, packets, compression, deltas and sessions") {
    Pair pair;
    DisplayFile& display = pair.display;
    display = *parse_display(
        "name = \"larger\"\nkind = \"stacked-planes\"\nformat = \"rgb888\"\nslices = 9\ncycles_per_second = 50\n"
        "plane_pitch_mm = 1\n[[panel]]\ncolumns = 11\nrows = 7\ncolumn_pitch_mm = 1\nrow_pitch_mm = 1\n",
        "larger");
    std::vector<Frame> frames = some_frames(display, 4);
    std::fill(frames[3].begin() + 100, frames[3].end(), std::byte{0});
    frames[2] = frames[3];
    const Sending others[] = {
        {.max_packet_bytes = 256},
        {.lz4 = true},
        {.max_packet_bytes = 300, .lz4 = true, .deltas = true, .session = 9, .every_ns = 1, .present_after_ns = 77},
    };
    for (const Sending& other : others) CHECK_FALSE(pair.compare(frames, frames, {}, other));
}

TEST_CASE("the first difference is named by frame, slice, panel, row, column and codes") {
    Pair pair;
    const std::vector<Frame> frames = some_frames(pair.display, 3);
    std::vector<Frame> others = frames;
    others[1][6 + 3 + 2] ^= std::byte{0x40};  // Slice 1, row 1, column 2.
    others[2][0] ^= std::byte{1};
    const auto difference = pair.compare(frames, others);
    REQUIRE(difference);
    CHECK(difference->what == What::Frame);
    CHECK(difference->frame == 1);
    const auto code = std::to_integer<std::uint32_t>(frames[1][11]);
    CHECK(difference->pixels.first == sim::PixelDifference{1, 0, 1, 2, code, code ^ 0x40});
    CHECK(difference->pixels.pixels == 1);
    CHECK(pair.words.starts_with("frame 1, slice 1, panel 0, row 1, column 2: code 0x"));
    CHECK(pair.words.ends_with("1 pixel differs"));
}

TEST_CASE("every pixel of every kind of display is named when it alone differs") {
    for (const DisplayDescription& display : odd_displays()) {
        for (const PixelFormat format : kPixelFormats) {
            DisplayDescription formatted = display;
            formatted.format = format;
            const Frame dark(frame_bytes(formatted));
            const std::uint32_t bits = bits_per_pixel(format);
            std::size_t offset = 0;
            for (std::uint32_t slice = 0; slice < formatted.slices; ++slice) {
                for (std::uint32_t p = 0; p < formatted.panel_count; ++p) {
                    const Panel& panel = formatted.panels[p];
                    const std::uint32_t row = (slice * 5 + p) % panel.rows;
                    const std::uint32_t column = (slice * 3 + 1) % panel.columns;
                    Frame lit = dark;
                    const std::size_t row_at = offset + row * row_bytes(panel, format);
                    const std::size_t bit = std::size_t{column} * bits + slice % bits;
                    lit[row_at + bit / 8] |= static_cast<std::byte>(1u << (bit % 8));
                    const auto difference = sim::compare_frames(formatted, dark, lit);
                    REQUIRE(difference);
                    CHECK(difference->pixels == 1);
                    const sim::PixelDifference expected{slice, p, row, column, 0, 1u << (slice % bits)};
                    CHECK(difference->first == expected);
                    offset += row_bytes(panel, format) * panel.rows;
                }
            }
        }
    }
}

TEST_CASE("padding behind a row that is not the same is a difference") {
    DisplayDescription display = flat_display("padded", DisplayKind::StackedPlanes, 1);  // 13 columns of mono1.
    const Frame dark(frame_bytes(display));
    Frame dirty = dark;
    dirty[1] = std::byte{0x80};
    const auto difference = sim::compare_frames(display, dark, dirty);
    REQUIRE(difference);
    CHECK(difference->first.column == 13);
    CHECK(difference->pixels == 1);
}

TEST_CASE("a recording that ends earlier is different, and says which") {
    Pair pair;
    const std::vector<Frame> three = some_frames(pair.display, 3);
    const std::vector<Frame> two(three.begin(), three.begin() + 2);
    auto difference = pair.compare(three, two);
    REQUIRE(difference);
    CHECK(difference->what == What::MoreInA);
    CHECK(difference->frame == 2);
    CHECK(pair.words.find("b.xvr ends after 2 frames") != std::string::npos);
    difference = pair.compare(two, three);
    REQUIRE(difference);
    CHECK(difference->what == What::MoreInB);
}

TEST_CASE("recordings of displays that differ only in how they are driven can be compared, others not") {
    Pair pair;
    const std::vector<Frame> frames = some_frames(pair.display, 1);
    record_frames(pair.folder.file("a.xvr"), pair.display, frames);
    std::string text = pair.display.text;
    text.replace(text.find("second = 50"), 11, "second = 60");
    record_frames(pair.folder.file("b.xvr"), *parse_display(text, "b"), frames);
    text.replace(text.find("pitch_mm = 1"), 12, "pitch_mm = 2");
    record_frames(pair.folder.file("c.xvr"), *parse_display(text, "c"), frames);
    auto a = sim::open_recording(pair.folder.file("a.xvr"));
    auto b = sim::open_recording(pair.folder.file("b.xvr"));
    auto c = sim::open_recording(pair.folder.file("c.xvr"));
    CHECK_FALSE(*sim::compare_recordings(*a, *b));
    const auto difference = sim::compare_recordings(*a, *c);
    REQUIRE(*difference);
    CHECK((*difference)->what == What::Geometry);
}

TEST_CASE("two recordings without a frame are an error, not equal") {
    Pair pair;
    for (const char* name : {"a.xvr", "b.xvr"}) record_frames(pair.folder.file(name), pair.display, {});
    auto a = sim::open_recording(pair.folder.file("a.xvr"));
    auto b = sim::open_recording(pair.folder.file("b.xvr"));
    REQUIRE(a);
    REQUIRE(b);
    const auto difference = sim::compare_recordings(*a, *b);
    REQUIRE_FALSE(difference);
    CHECK(difference.error().message.find("there is no whole frame") != std::string::npos);
}

}  // namespace xorvox::test
