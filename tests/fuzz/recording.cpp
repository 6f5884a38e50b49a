// Any bytes as a recording: it is refused with one line or read to its end, in bounded memory; what is tolerated gives
// the frames that are whole, whichever way it is read, and a playback sends only packets that a link takes.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto input = std::as_bytes(std::span(data, size));
    const std::vector<std::byte> bytes(input.begin(), input.end());
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
