#include "tests/unit/recording/rig.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <unistd.h>

#include "driver/host/encoder.h"
#include "driver/wire/packet.h"
#include "sim/recording/frames.h"
#include "tests/catch.h"

namespace xorvox::test {

namespace fs = std::filesystem;

Folder::Folder() : path_(fs::temp_directory_path() / fmt::format("xorvox-recording-{}", ::getpid())) {
    fs::create_directories(path_);
}

std::vector<std::string> Folder::names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

DisplayFile tiny_display() {
    const auto display = parse_display(R"(name = "tiny"
kind = "stacked-planes"
format = "rgb332"
slices = 2
cycles_per_second = 50
plane_pitch_mm = 1
[[panel]]
columns = 3
rows = 2
column_pitch_mm = 1
row_pitch_mm = 1
)",
                                       "tiny");
    REQUIRE(display);
    return *display;
}

void send_frames(sim::RecordingWriter& writer, const std::vector<Frame>& frames, const Sending& sending) {
    std::vector<std::byte> packet(65536);
    std::size_t size = 0;
    std::uint32_t sequence = 0;
    REQUIRE(wire::encode_packet(sending.session, sequence++, wire::HelloRequest{}, packet, size) == Status::Ok);
    writer.packet(sim::BlockKind::FromHost, 0, std::span(packet).first(size));
    host::FrameEncoder encoder({.max_packet_bytes = sending.max_packet_bytes, .lz4 = sending.lz4});
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::uint64_t now_ns = (i + 1) * sending.every_ns;
        host::FrameToEncode frame{.id = static_cast<std::uint32_t>(i + 1), .content = frames[i]};
        if (sending.present_after_ns > 0) frame.present_at_ns = now_ns + sending.present_after_ns;
        if (sending.deltas && i > 0) {
            frame.base_id = static_cast<std::uint32_t>(i);
            frame.base = frames[i - 1];
        }
        encoder.encode(frame);
        for (std::size_t p = 0; p < encoder.payload_count(); ++p) {
            const host::Payload payload = encoder.payload(p);
            const wire::Header header{.type = payload.type, .session = sending.session, .sequence = sequence++};
            REQUIRE(wire::encode_packet(header, payload.bytes, packet, size) == Status::Ok);
            writer.packet(sim::BlockKind::FromHost, now_ns, std::span(packet).first(size));
        }
    }
}

void record_frames(const std::string& path, const DisplayFile& display, const std::vector<Frame>& frames,
                   const Sending& sending) {
    auto writer = sim::RecordingWriter::create(path, display);
    REQUIRE(writer);
    send_frames(*writer, frames, sending);
    REQUIRE(writer->frames() == frames.size());
    REQUIRE(writer->commit());
}

std::vector<Frame> some_frames(const DisplayDescription& display, std::size_t count) {
    std::vector<Frame> frames(count, Frame(frame_bytes(display)));
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t at = 0; at < frames[i].size(); ++at) {
            frames[i][at] = static_cast<std::byte>((at * at * 7 + at * 13 + i * 29 + 1) & 0xff);
        }
    }
    return frames;
}

std::vector<std::byte> read_bytes(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

sim::ByteSource bytes_source(std::vector<std::byte> bytes) {
    return sim::memory_source(std::move(bytes), "test.xvr");
}

Read read_frames(sim::RecordingReader& reader, const DisplayDescription& display) {
    Read read;
    reader.rewind();
    sim::RecordedFrames frames(reader, display);
    for (Status status = frames.next(); status != Status::Closed; status = frames.next()) {
        if (status == Status::Corrupt) {
            read.damage.push_back(frames.damage());
        } else {
            const auto bytes = frames.frame().bytes;
            read.frames.emplace_back(bytes.begin(), bytes.end());
        }
    }
    return read;
}

sim::RecordingReader open_golden(const std::string& name) {
    auto reader = sim::open_recording(XORVOX_SOURCE_DIR "/tests/golden/recordings/" + name);
    if (!reader) FAIL(reader.error().message);
    return std::move(*reader);
}

}  // namespace xorvox::test
