// Any bytes as a recording: it is refused with one line or read to its end, in bounded memory; what is tolerated gives
// the frames that are whole, whichever way it is read, and a playback sends only packets that a link takes.
// Bytes that begin with '+' are what is in the blocks of a recording instead, whose CRCs and packets are right, since
// few inputs would get past those:
//   kind, length, and that many bytes of payload: of kind '>' and '<' a message's type, then its payload

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "driver/display/toml.h"
#include "driver/wire/crc32c.h"
#include "driver/wire/packet.h"
#include "sim/recording/difference.h"
#include "sim/recording/frames.h"
#include "sim/recording/playback.h"

namespace {

using namespace xorvox;

constexpr std::size_t kMostFrameBytes = 1 << 20;

void require(bool condition) {
    if (!condition) std::abort();
}

void require_line(const std::string& text) {
    require(!text.empty() && text.find('\n') == std::string::npos);
}

void read_all(sim::RecordingReader& reader) {
    sim::Block block;
    std::uint64_t behind = 0;
    for (Status status = reader.next(block); status != Status::Closed; status = reader.next(block)) {
        require(status == Status::Ok || status == Status::Corrupt);
        if (status == Status::Corrupt) {
            require_line(reader.damage());
            continue;
        }
        require(block.offset >= behind);
        behind = block.offset + sim::kBlockOverhead + block.payload.size();
    }
    require(reader.next(block) == Status::Closed);
}

void play(sim::RecordingReader& reader, double speed, std::uint64_t from_ns) {
    sim::Playback playback(reader, speed);
    if (playback.seek(from_ns) == Status::Corrupt) require_line(playback.damage());
    for (Status status = playback.next(); status != Status::Closed; status = playback.next()) {
        if (status != Status::Ok) continue;
        require(!playback.packet().empty() && playback.packet().size() <= wire::kMaxPacketBytes);
    }
}

std::size_t count_frames(sim::RecordingReader& reader) {
    reader.rewind();
    sim::RecordedFrames frames(reader, *reader.display());
    std::size_t count = 0;
    for (Status status = frames.next(); status != Status::Closed; status = frames.next()) {
        if (status == Status::Corrupt) require_line(frames.damage());
        if (status == Status::Ok) {
            require(frames.frame().bytes.size() == frame_bytes(*reader.display()));
            ++count;
        }
    }
    return count;
}

void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
}

void append_block(std::vector<std::byte>& out, sim::BlockKind kind, std::uint64_t time_ns,
                  std::span<const std::byte> payload) {
    append(out, sim::encode(sim::BlockHeader{kind, static_cast<std::uint32_t>(payload.size()), time_ns}));
    append(out, payload);
    append(out, sim::encode_u32(wire::crc32c(payload)));
}

/// A recording for a display of 2 × 1 × 1 pixels of one byte.
std::vector<std::byte> build(std::span<const std::byte> input) {
    constexpr std::string_view kDisplay =
        "name=\"f\"\nkind=\"stacked-planes\"\nformat=\"rgb332\"\nslices=1\ncycles_per_second=50\nplane_pitch_mm=1\n"
        "[[panel]]\ncolumns=2\nrows=1\ncolumn_pitch_mm=1\nrow_pitch_mm=1\n";
    static const std::uint64_t digest = geometry_digest(*parse_display(kDisplay, "fuzz"));
    std::vector<std::byte> out;
    append(out, sim::encode_head());
    std::vector<std::byte> description;
    append(description, sim::encode_u64(digest));
    append(description, std::as_bytes(std::span(kDisplay)));
    append_block(out, sim::BlockKind::Display, 0, description);
    std::vector<std::byte> index;
    std::vector<std::byte> packet(wire::kMinPacketBytes + 256);
    std::uint32_t sequence = 0;
    std::uint64_t time_ns = 0;
    while (input.size() >= 2) {
        const auto kind = static_cast<sim::BlockKind>(input[0]);
        const std::size_t length = std::min(std::to_integer<std::size_t>(input[1]), input.size() - 2);
        std::span<const std::byte> payload = input.subspan(2, length);
        input = input.subspan(2 + length);
        time_ns += 1 + length * 1'000;
        if ((kind == sim::BlockKind::FromHost || kind == sim::BlockKind::FromDevice) && !payload.empty()) {
            const wire::Header header{
                .type = static_cast<wire::PacketType>(payload[0]), .session = 1, .sequence = sequence++};
            std::size_t size = 0;
            require(wire::encode_packet(header, payload.subspan(1), packet, size) == Status::Ok);
            payload = std::span(packet).first(size);
        }
        if (kind == sim::BlockKind::Frame && payload.size() == sim::kFrameEntryBytes) append(index, payload);
        append_block(out, kind, time_ns, payload);
    }
    const std::uint64_t index_at = out.size();
    append_block(out, sim::BlockKind::Index, time_ns, index);
    append_block(out, sim::BlockKind::End, time_ns, sim::encode_u64(index_at));
    return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto input = std::as_bytes(std::span(data, size));
    const bool blocks = !input.empty() && input[0] == std::byte{'+'};
    const std::vector<std::byte> bytes = blocks ? build(input.subspan(1)) : std::vector(input.begin(), input.end());
    auto strict = sim::RecordingReader::open(sim::memory_source(bytes, "fuzz"));
    if (!strict) require_line(strict.error().message);
    auto tolerant = sim::RecordingReader::open(sim::memory_source(bytes, "fuzz"), sim::Damage::Tolerated);
    if (!tolerant) {
        require(!strict);
        require_line(tolerant.error().message);
        return 0;
    }
    read_all(*tolerant);
    play(*tolerant, 1.0, 0);
    play(*tolerant, 0.3, tolerant->duration_ns() / 2);
    if (tolerant->display() == nullptr || frame_bytes(*tolerant->display()) > kMostFrameBytes) return 0;
    const std::size_t frames = count_frames(*tolerant);
    if (!strict) return 0;
    require(count_frames(*strict) == frames);
    const auto difference = sim::compare_recordings(*strict, *tolerant);
    if (difference) require(!*difference);
    return 0;
}
