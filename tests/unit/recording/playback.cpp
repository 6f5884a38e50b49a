// What a display gets of a recording, and when.
#include <string>

#include "driver/wire/messages.h"
#include "driver/wire/packet.h"
#include "sim/recording/frames.h"
#include "sim/recording/playback.h"
#include "tests/catch.h"
#include "tests/unit/recording/rig.h"

namespace xorvox::test {
namespace {

struct Packet {
    std::uint64_t due_ns;
    std::vector<std::byte> bytes;
    bool operator==(const Packet&) const = default;
};

std::vector<Packet> play(sim::Playback& playback) {
    std::vector<Packet> packets;
    while (playback.next() == Status::Ok) {
        packets.push_back({playback.due_ns(), {playback.packet().begin(), playback.packet().end()}});
    }
    return packets;
}

wire::Header header_of(const Packet& packet) {
    wire::Header header;
    std::span<const std::byte> payload;
    REQUIRE(wire::decode_packet(packet.bytes, header, payload) == Status::Ok);
    return header;
}

/// present_at of the frames that begin.
std::vector<std::uint64_t> present_times(const std::vector<Packet>& packets) {
    std::vector<std::uint64_t> times;
    for (const Packet& packet : packets) {
        wire::Header header;
        std::span<const std::byte> payload;
        REQUIRE(wire::decode_packet(packet.bytes, header, payload) == Status::Ok);
        wire::FrameBegin begin;
        if (header.type != wire::PacketType::FrameBegin) continue;
        REQUIRE(wire::decode(payload, begin) == Status::Ok);
        times.push_back(begin.present_at_ns);
    }
    return times;
}

/// Of the tiny display; frames 0, 3 and 6 are keyframes, the others are deltas of few bytes.
struct Recorded {
    Folder folder;
    DisplayFile display = tiny_display();
    std::vector<Frame> frames;

    sim::RecordingReader record(const Sending& sending) {
        frames.assign(9, Frame(frame_bytes(display)));
        for (std::size_t i = 0; i < frames.size(); ++i) {
            for (std::size_t at = 0; at < frames[i].size(); ++at) {
                frames[i][at] = static_cast<std::byte>((i / 3) * 77 + at * 31 * (i / 3 + 1));
            }
            frames[i][0] = static_cast<std::byte>(i);
        }
        record_frames(folder.file("a.xvr"), display, frames, sending);
        auto reader = sim::open_recording(folder.file("a.xvr"));
        REQUIRE(reader);
        return std::move(*reader);
    }
};

}  // namespace

TEST_CASE("played as it was recorded, packets are the same bit for bit and at the same times") {
    Recorded recorded;
    sim::RecordingReader reader = recorded.record({.present_after_ns = 5'000'000});
    std::vector<Packet> written;
    for (sim::Block block; reader.next(block) == Status::Ok;) {
        if (block.kind == sim::BlockKind::FromHost) {
            written.push_back({block.time_ns, {block.payload.begin(), block.payload.end()}});
        }
    }
    reader.rewind();
    sim::Playback playback(reader);
    CHECK(play(playback) == written);
    CHECK(playback.last_present_at_ns() == 9 * 20'000'000 + 5'000'000);
}

TEST_CASE("a frame is to be shown when it asked for, else when it was whole") {
    Recorded recorded;
    for (const std::uint64_t after_ns : {std::uint64_t{0}, std::uint64_t{5'000'000}}) {
        sim::RecordingReader reader = recorded.record({.present_after_ns = after_ns});
        sim::RecordedFrames frames(reader, recorded.display);
        for (std::uint64_t i = 1; i <= 9; ++i) {
            REQUIRE(frames.next() == Status::Ok);
            CHECK(frames.time_ns() == i * 20'000'000);
            CHECK(frames.shown_ns() == frames.time_ns() + after_ns);
        }
    }
}

TEST_CASE("a session whose request is damaged is begun with one that is made, and its frames are read") {
    Recorded recorded;
    (void)recorded.record({.session = 77});
    std::vector<std::byte> bytes = read_bytes(recorded.folder.file("a.xvr"));
    auto whole = sim::RecordingReader::open(bytes_source(bytes));
    REQUIRE(whole);
    const std::uint64_t hello = whole->frames()[0].hello;
    bytes[hello + sim::kBlockHeaderBytes] ^= std::byte{1};
    for (const std::uint64_t from_ns : {0u, 25'000'000u}) {
        auto reader = sim::RecordingReader::open(bytes_source(bytes), sim::Damage::Tolerated);
        REQUIRE(reader);
        sim::Playback playback(*reader);
        (void)playback.seek(from_ns);
        std::vector<Packet> packets;
        for (Status status = playback.next(); status != Status::Closed; status = playback.next()) {
            if (status != Status::Ok) continue;
            packets.push_back({playback.due_ns(), {playback.packet().begin(), playback.packet().end()}});
        }
        REQUIRE(packets.size() >= 2);
        CHECK(header_of(packets[0]).type == wire::PacketType::HelloRequest);
        CHECK(header_of(packets[0]).session == 77);
        CHECK(header_of(packets[1]).type == wire::PacketType::FrameBegin);
        CHECK(header_of(packets[1]).sequence == header_of(packets[0]).sequence + 1);
        std::vector<std::byte> ping(64);
        std::size_t size = 0;
        REQUIRE(playback.make_ping(5, ping, size));
        ping.resize(size);
        CHECK(header_of({0, ping}).sequence == header_of(packets.back()).sequence + 1);
    }
    auto reader = sim::RecordingReader::open(bytes_source(bytes), sim::Damage::Tolerated);
    REQUIRE(reader);
    const Read read = read_frames(*reader, recorded.display);
    CHECK(read.frames == recorded.frames);
    CHECK(read.damage.size() == 1);
}

TEST_CASE("at twice the speed, packets come and frames ask to be presented in half the time") {
    Recorded recorded;
    sim::RecordingReader reader = recorded.record({.present_after_ns = 5'000'000});
    sim::Playback playback(reader, 2.0);
    const std::vector<Packet> packets = play(playback);
    CHECK(packets.back().due_ns == 9 * 10'000'000);
    const std::vector<std::uint64_t> times = present_times(packets);
    REQUIRE(times.size() == 9);
    for (std::size_t i = 0; i < 9; ++i) CHECK(times[i] == (i + 1) * 10'000'000 + 2'500'000);
}

TEST_CASE("the clock of the recorded device becomes that of the one that is played to") {
    const Folder folder;
    const DisplayFile display = tiny_display();
    auto writer = sim::RecordingWriter::create(folder.file("a.xvr"), display);
    REQUIRE(writer);
    constexpr std::uint64_t kHostAt = 1'000, kDeviceAt = 900'000'000'000;
    std::vector<std::byte> packet(65536);
    std::size_t size = 0;
    const auto put = [&](sim::BlockKind kind, std::uint64_t after_ns, std::uint32_t sequence, const auto& message) {
        REQUIRE(wire::encode_packet(7, sequence, message, packet, size) == Status::Ok);
        writer->packet(kind, kHostAt + after_ns, std::span(packet).first(size));
    };
    put(sim::BlockKind::FromHost, 0, 0, wire::HelloRequest{});
    put(sim::BlockKind::FromDevice, 50, 0,
        wire::Hello{.format = PixelFormat::Rgb332,
                    .planes = 8,
                    .frame_bytes = 12,
                    .pages = 2,
                    .max_packet_bytes = 65536,
                    .device_time_ns = kDeviceAt + 50});
    put(sim::BlockKind::FromHost, 100, 1,
        wire::FrameBegin{.frame = 1, .frame_bytes = 12, .present_at_ns = kDeviceAt + 300});
    put(sim::BlockKind::FromHost, 100, 2,
        wire::FrameBegin{.frame = 2, .frame_bytes = 12, .present_at_ns = kDeviceAt - 300});
    REQUIRE(writer->commit());
    auto reader = sim::open_recording(folder.file("a.xvr"));
    REQUIRE(reader);
    sim::Playback playback(*reader);
    // What was asked for before the beginning is due at once, but not "at the next boundary, whenever sent", which is
    // 0.
    CHECK(present_times(play(playback)) == std::vector<std::uint64_t>{300, 1});
}

TEST_CASE("seeking begins with the last keyframe before the moment, after the request of its session") {
    Recorded recorded;
    sim::RecordingReader reader = recorded.record({.deltas = true});
    std::string keys;
    for (const sim::FrameEntry& entry : reader.frames()) keys += entry.keyframe ? 'k' : '.';
    REQUIRE(keys[0] == 'k');
    const std::size_t key = keys.rfind('k');
    INFO(keys);
    REQUIRE(key > 0);
    const std::uint64_t moment_ns = reader.frames().back().time_ns;
    CHECK(sim::keyframe_before(reader.frames(), moment_ns) == key);
    CHECK_FALSE(sim::keyframe_before(reader.frames(), reader.frames()[0].time_ns - 1));

    sim::Playback playback(reader);
    REQUIRE(playback.seek(moment_ns) == Status::Ok);
    const std::vector<Packet> packets = play(playback);
    CHECK(header_of(packets[0]).type == wire::PacketType::HelloRequest);
    CHECK(header_of(packets[1]).type == wire::PacketType::FrameBegin);
    CHECK(packets[1].due_ns == 0);
    CHECK(packets.back().due_ns == (8 - key) * 20'000'000);

    sim::RecordedFrames frames(reader, recorded.display);
    REQUIRE(frames.seek(moment_ns) == Status::Ok);
    for (std::size_t i = key; i < 9; ++i) {
        REQUIRE(frames.next() == Status::Ok);
        CHECK(std::ranges::equal(frames.frame().bytes, recorded.frames[i]));
    }
    CHECK(frames.next() == Status::Closed);
}

TEST_CASE("a frame whose digest is not that of its bytes is told") {
    Recorded recorded;
    (void)recorded.record({});
    std::vector<std::byte> bytes = read_bytes(recorded.folder.file("a.xvr"));
    auto reader = sim::RecordingReader::open(bytes_source(bytes));
    REQUIRE(reader);
    sim::Block block;
    do {
        REQUIRE(reader->next(block) == Status::Ok);
    } while (block.kind != sim::BlockKind::Frame);
    sim::FrameEntry entry = sim::decode_entry(block.payload.first<sim::kFrameEntryBytes>());
    entry.digest ^= 1;
    const auto changed = sim::encode(entry);
    const std::size_t payload = block.offset + sim::kBlockHeaderBytes;
    std::copy(changed.begin(), changed.end(), bytes.begin() + static_cast<std::ptrdiff_t>(payload));
    const auto crc = sim::encode_u32(wire::crc32c(changed));
    std::copy(crc.begin(), crc.end(), bytes.begin() + static_cast<std::ptrdiff_t>(payload + changed.size()));
    auto liar = sim::RecordingReader::open(bytes_source(bytes));
    REQUIRE(liar);
    const Read read = read_frames(*liar, recorded.display);
    CHECK(read.frames.size() == 9);
    REQUIRE(read.damage.size() == 1);
    CHECK(read.damage[0].find("the digest of the frame before") != std::string::npos);
}

}  // namespace xorvox::test
