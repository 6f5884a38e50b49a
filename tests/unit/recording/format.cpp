// The bytes of a recording. docs/recordings.md shows the same.
#include <string>

#include <fmt/format.h>

#include "sim/recording/frames.h"
#include "sim/recording/record_link.h"
#include "tests/catch.h"
#include "tests/golden/golden.h"
#include "tests/unit/recording/rig.h"
#include "transport/loopback.h"

namespace xorvox::test {
namespace {

std::string hex(const std::vector<std::byte>& bytes) {
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        text += fmt::format("{:02x}{}", std::to_integer<unsigned>(bytes[i]), i % 16 == 15 ? '\n' : ' ');
    }
    return text;
}

std::string without_blanks(std::string text) {
    std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
    return text;
}

/// One plane of one pixel.
DisplayFile smallest_display() {
    const auto display = parse_display(
        "name=\"p\"\nkind=\"stacked-planes\"\nformat=\"rgb332\"\nslices=1\ncycles_per_second=50\nplane_pitch_mm=1\n"
        "[[panel]]\ncolumns=1\nrows=1\ncolumn_pitch_mm=1\nrow_pitch_mm=1\n",
        "smallest");
    if (!display) FAIL(display.error().message);
    return *display;
}

}  // namespace

TEST_CASE("the bytes of a recording are these, and docs/recordings.md shows them") {
    const Folder folder;
    record_frames(folder.file("a.xvr"), smallest_display(), {Frame{std::byte{0xe3}}});
    const std::vector<std::byte> bytes = read_bytes(folder.file("a.xvr"));
    INFO(hex(bytes));
    CHECK(bytes == read_golden("tests/golden/recording.hex").at(0).bytes);
    CHECK(without_blanks(read_text("docs/recordings.md")).find(without_blanks(hex(bytes))) != std::string::npos);
}

TEST_CASE("a recording is read as it was written") {
    const Folder folder;
    const DisplayFile display = tiny_display();
    const std::vector<Frame> frames = some_frames(display, 3);
    record_frames(folder.file("a.xvr"), display, frames);
    auto reader = sim::open_recording(folder.file("a.xvr"));
    REQUIRE(reader);
    REQUIRE(reader->display() != nullptr);
    CHECK(reader->display()->name.view() == "tiny");
    CHECK(reader->display()->text == display.text);
    CHECK(reader->duration_ns() == 60'000'000);
    REQUIRE(reader->frames().size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(reader->frames()[i].digest == sim::frame_digest(frames[i]));
        CHECK(reader->frames()[i].time_ns == (i + 1) * 20'000'000);
        CHECK(reader->frames()[i].id == i + 1);
        CHECK(reader->frames()[i].keyframe);
    }
    const Read read = read_frames(*reader, display);
    CHECK(read.damage.empty());
    CHECK(read.frames == frames);
}

TEST_CASE("equal packets at equal times give equal files, and times count from the first packet") {
    const Folder folder;
    const DisplayFile display = tiny_display();
    const std::vector<Frame> frames = some_frames(display, 2);
    record_frames(folder.file("a.xvr"), display, frames);
    record_frames(folder.file("b.xvr"), display, frames);
    CHECK(read_bytes(folder.file("a.xvr")) == read_bytes(folder.file("b.xvr")));
    auto writer = sim::RecordingWriter::create(folder.file("c.xvr"), display);
    REQUIRE(writer);
    const Frame packet(20);
    writer->packet(sim::BlockKind::FromHost, 5'000, packet);
    writer->packet(sim::BlockKind::FromDevice, 4'000, packet);  // A clock that goes back stands still.
    writer->packet(sim::BlockKind::FromDevice, 7'000, packet);
    REQUIRE(writer->commit());
    auto reader = sim::open_recording(folder.file("c.xvr"));
    REQUIRE(reader);
    std::vector<std::uint64_t> times;
    for (sim::Block block; reader->next(block) == Status::Ok;) times.push_back(block.time_ns);
    CHECK(times == std::vector<std::uint64_t>{0, 0, 2'000, 2'000, 2'000});  // The last two: index and end.
}

TEST_CASE("a recorded link passes what it would without, and both directions are in the file") {
    const Folder folder;
    auto writer = sim::RecordingWriter::create(folder.file("a.xvr"), tiny_display());
    REQUIRE(writer);
    auto [near_end, far_end] = transport::make_loopback();
    std::uint64_t now_ns = 0;
    for (const sim::LinkEnd end : {sim::LinkEnd::Host, sim::LinkEnd::Device}) {
        const bool host = end == sim::LinkEnd::Host;
        UniqueLink& inner = host ? near_end : far_end;
        const Link other = host ? far_end.get() : near_end.get();
        const UniqueLink link = sim::record_link(std::move(inner), end, *writer, [&now_ns] { return now_ns += 10; });
        const Frame sent{std::byte{1}, std::byte{2}};
        const Frame answer{std::byte{3}};
        REQUIRE(link->send(sent) == Status::Ok);
        Frame buffer(10);
        std::size_t size = 0;
        REQUIRE(other.receive(buffer, size) == Status::Ok);
        CHECK(size == 2);
        REQUIRE(other.send(answer) == Status::Ok);
        REQUIRE(link->receive(buffer, size) == Status::Ok);
        CHECK(size == 1);
        CHECK(link->receive(buffer, size) == Status::WouldBlock);
        inner = {};
        std::tie(near_end, far_end) = transport::make_loopback();
    }
    REQUIRE(writer->commit());
    auto reader = sim::open_recording(folder.file("a.xvr"));
    REQUIRE(reader);
    std::string kinds;
    for (sim::Block block; reader->next(block) == Status::Ok;) kinds += static_cast<char>(block.kind);
    CHECK(kinds == "><<>IE");
}

TEST_CASE("a recorder that is not committed leaves nothing under the name") {
    const Folder folder;
    { const auto writer = sim::RecordingWriter::create(folder.file("a.xvr"), tiny_display()); }
    CHECK(folder.names().empty());
}

}  // namespace xorvox::test
