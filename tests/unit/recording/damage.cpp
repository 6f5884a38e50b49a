// Recordings that are cut, damaged, of another version, or no recordings.
#include <algorithm>
#include <string>

#include "driver/wire/crc32c.h"
#include "sim/recording/format.h"
#include "tests/catch.h"
#include "tests/unit/recording/rig.h"

namespace xorvox::test {
namespace {

bool contains(const std::string& text, std::string_view words) {
    return text.find(words) != std::string::npos;
}

struct Whole {
    DisplayFile display = tiny_display();
    std::vector<Frame> frames = some_frames(display, 3);
    std::vector<std::byte> bytes;
    std::vector<std::size_t> frame_ends;  ///< Offsets behind each frame's last packet.

    Whole() {
        const Folder folder;
        record_frames(folder.file("a.xvr"), display, frames);
        bytes = read_bytes(folder.file("a.xvr"));
        auto reader = sim::RecordingReader::open(bytes_source(bytes));
        REQUIRE(reader);
        for (sim::Block block; reader->next(block) == Status::Ok;) {
            if (block.kind == sim::BlockKind::Frame) frame_ends.push_back(block.offset);
        }
        REQUIRE(frame_ends.size() == 3);
    }
};

/// The message for `bytes` that are not whole: of open(), or of the first damage among the blocks.
std::string complaint(const std::vector<std::byte>& bytes) {
    auto reader = sim::RecordingReader::open(bytes_source(bytes));
    if (!reader) return reader.error().message;
    sim::Block block;
    for (Status status = reader->next(block); status != Status::Closed; status = reader->next(block)) {
        if (status == Status::Corrupt) return reader->damage();
    }
    return {};
}

}  // namespace

TEST_CASE("a recording that is cut anywhere is refused with the byte, and its whole frames can be read") {
    const Whole whole;
    for (std::size_t length = 0; length < whole.bytes.size(); ++length) {
        CAPTURE(length);
        const std::vector<std::byte> cut(whole.bytes.begin(),
                                         whole.bytes.begin() + static_cast<std::ptrdiff_t>(length));
        const auto refused = sim::RecordingReader::open(bytes_source(cut));
        REQUIRE_FALSE(refused);
        CHECK(refused.error().message.starts_with("test.xvr: "));
        CHECK(refused.error().message.find('\n') == std::string::npos);
        if (length >= 16) CHECK(contains(refused.error().message, "byte "));

        auto reader = sim::RecordingReader::open(bytes_source(cut), sim::Damage::Tolerated);
        const auto expected = static_cast<std::size_t>(std::count_if(
            whole.frame_ends.begin(), whole.frame_ends.end(), [length](std::size_t end) { return length >= end; }));
        if (!reader) {
            CHECK(expected == 0);
            continue;
        }
        const Read read = read_frames(*reader, whole.display);
        REQUIRE(read.frames.size() == expected);
        CHECK(std::equal(read.frames.begin(), read.frames.end(), whole.frames.begin()));
    }
}

TEST_CASE("a recording with any byte damaged is noticed at or before it, and the other frames can be read") {
    const Whole whole;
    for (std::size_t at = 0; at < whole.bytes.size(); ++at) {
        for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
            CAPTURE(at, flip);
            std::vector<std::byte> bad = whole.bytes;
            bad[at] ^= static_cast<std::byte>(flip);
            const std::string message = complaint(bad);
            REQUIRE(message.starts_with("test.xvr: byte "));
            CHECK(message.find('\n') == std::string::npos);
            // What is damaged at the end shows where the file ends.
            const std::size_t told = std::stoul(message.substr(std::string("test.xvr: byte ").size()));
            const bool in_end = at + sim::kBlockOverhead + sim::kEndBytes >= bad.size();
            CHECK((told <= at || (in_end && told == bad.size())));

            auto reader = sim::RecordingReader::open(bytes_source(bad), sim::Damage::Tolerated);
            REQUIRE(reader);
            const Read read = read_frames(*reader, whole.display);
            // One block is lost: at most a frame.
            CHECK(read.frames.size() >= 2);
            for (const Frame& frame : read.frames) {
                CHECK(std::find(whole.frames.begin(), whole.frames.end(), frame) != whole.frames.end());
            }
        }
    }
}

TEST_CASE("an index that was lost is found again by reading all") {
    const Whole whole;
    auto complete = sim::RecordingReader::open(bytes_source(whole.bytes));
    REQUIRE(complete);
    const std::vector<sim::FrameEntry> index(complete->frames().begin(), complete->frames().end());
    std::vector<std::byte> cut = whole.bytes;
    cut.resize(whole.bytes.size() - 1);
    auto reader = sim::RecordingReader::open(bytes_source(cut), sim::Damage::Tolerated);
    REQUIRE(reader);
    CHECK(contains(reader->fault(), "ends here without its end"));
    CHECK(std::ranges::equal(reader->frames(), index));
    CHECK(reader->duration_ns() == complete->duration_ns());
}

TEST_CASE("a recording of a later version is refused, whatever is tolerated") {
    std::vector<std::byte> bytes = Whole().bytes;
    bytes[8] = std::byte{2};
    const auto crc = sim::encode_u32(wire::crc32c(std::span(bytes).first(12)));
    std::copy(crc.begin(), crc.end(), bytes.begin() + 12);
    for (const sim::Damage damage : {sim::Damage::Refused, sim::Damage::Tolerated}) {
        const auto reader = sim::RecordingReader::open(bytes_source(bytes), damage);
        REQUIRE_FALSE(reader);
        CHECK(reader.error().message ==
              "test.xvr: byte 8: the recording is of version 2, and this program reads version 1; play it with the "
              "xorvox that made it, or a later one");
    }
}

TEST_CASE("a later minor version is read, and its new kinds of blocks are passed over") {
    const Whole whole;
    std::vector<std::byte> bytes = whole.bytes;
    bytes[10] = std::byte{7};
    const auto crc = sim::encode_u32(wire::crc32c(std::span(bytes).first(12)));
    std::copy(crc.begin(), crc.end(), bytes.begin() + 12);
    bytes.resize(whole.frame_ends.back());
    const auto header = sim::encode(sim::BlockHeader{static_cast<sim::BlockKind>('?'), 0, 60'000'000});
    bytes.insert(bytes.end(), header.begin(), header.end());
    bytes.insert(bytes.end(), 4, std::byte{0});  // The CRC of nothing.
    auto reader = sim::RecordingReader::open(bytes_source(bytes), sim::Damage::Tolerated);
    REQUIRE(reader);
    const Read read = read_frames(*reader, whole.display);
    CHECK(read.damage.empty());
    CHECK(read.frames == whole.frames);
}

TEST_CASE("what is no recording is told from one that is damaged") {
    const auto refusal = [](std::string_view text, sim::Damage damage) {
        const auto bytes = std::as_bytes(std::span(text));
        const auto reader = sim::RecordingReader::open(bytes_source({bytes.begin(), bytes.end()}), damage);
        REQUIRE_FALSE(reader);
        return reader.error().message;
    };
    for (const sim::Damage damage : {sim::Damage::Refused, sim::Damage::Tolerated}) {
        CHECK(contains(refusal(std::string_view("XORVOX\x01\n\xE7\x4C\x02\x00\xA9\x5F"
                                                "123",
                                                17),
                               damage),
                       "is a stream of packets"));
        CHECK(contains(refusal("", damage), "is empty"));
    }
    CHECK(contains(refusal("ply\nformat ascii 1.0\n", sim::Damage::Refused), "not the mark of a recording"));
    CHECK(contains(refusal("ply\nformat ascii 1.0\n", sim::Damage::Tolerated), "nothing of a recording"));
    CHECK(contains(sim::open_recording("/no/such.xvr").error().message, "cannot be opened: No such file"));
    CHECK(contains(sim::open_recording("/dev/null").error().message, "no regular file"));
}

TEST_CASE("a recording whose description gives another geometry than was recorded is refused") {
    const Whole whole;
    std::vector<std::byte> bytes = whole.bytes;
    // The payload of the description: change its digest, and make its CRC right again.
    constexpr std::size_t kPayload = 16 + sim::kBlockHeaderBytes;
    const std::size_t length = 8 + whole.display.text.size();
    bytes[kPayload] ^= std::byte{1};
    const auto crc = sim::encode_u32(wire::crc32c(std::span(bytes).subspan(kPayload, length)));
    std::copy(crc.begin(), crc.end(), bytes.begin() + kPayload + static_cast<std::ptrdiff_t>(length));
    CHECK(contains(complaint(bytes), "byte 16: the description of tiny gives another geometry"));
}

}  // namespace xorvox::test
