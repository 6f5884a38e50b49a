#include "sim/recording/reader.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "driver/wire/crc32c.h"

namespace xorvox::sim {
namespace {

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Expected<RecordingReader> RecordingReader::open(ByteSource source, Damage damage) {
    RecordingReader reader(std::move(source), damage);
    if (const auto head = reader.read_head(); !head) return tl::unexpected(head.error());
    for (const auto step : {&RecordingReader::read_display, &RecordingReader::read_index}) {
        const Expected<void> done = (reader.*step)();
        if (done) continue;
        if (damage == Damage::Refused) return tl::unexpected(done.error());
        if (reader.fault_.empty()) reader.fault_ = done.error().message;
    }
    if (damage == Damage::Tolerated) {
        const std::vector<FrameEntry> named = reader.frames_;
        reader.rebuild_index();
        if (reader.fault_.empty() && reader.frames_ != named) {
            reader.fault_ = reader.name() + ": the index does not name the frames that there are";
        }
    }
    if (!reader.display_ && reader.next_header(kRecordingHeadBytes) == reader.source_.size) {
        return fail(reader.name() + ": there is nothing of a recording in it; make a new one with xorvox record");
    }
    reader.rewind();
    return reader;
}

std::string RecordingReader::at(std::uint64_t offset, const std::string& what) const {
    return fmt::format("{}: byte {}: {}", source_.name, offset, what);
}

Expected<void> RecordingReader::read_head() {
    std::array<std::byte, kRecordingHeadBytes> head{};
    const std::size_t there = std::min<std::uint64_t>(head.size(), source_.size);
    if (!source_.read(0, std::span(head).first(there))) return fail(source_.name + ": cannot be read");
    const auto ours = encode_head();
    const std::span<const std::byte> bytes(head);
    const bool marked = std::ranges::equal(bytes.first(8), std::span(ours).first(8));
    if (marked && there == head.size() && decode_u32(bytes.subspan<12, 4>()) == wire::crc32c(bytes.first(12))) {
        const unsigned major = std::to_integer<unsigned>(head[8]) | std::to_integer<unsigned>(head[9]) << 8;
        if (major == kRecordingMajor) return {};
        return fail(at(8, fmt::format("the recording is of version {}, and this program reads version {}; play it with "
                                      "the xorvox that made it, or a later one",
                                      major, kRecordingMajor)));
    }
    if (as_text(bytes.first(8)) == "XORVOX\x01\n") {
        return fail(source_.name +
                    ": is a stream of packets, as --to file: writes them, and no recording; make one with xorvox "
                    "record, or with --record");
    }
    if (there == 0) return fail(source_.name + ": is empty; make a recording with xorvox record");
    if (!marked && damage_is_ == Damage::Refused && there == head.size()) {
        return fail(at(0, "this is not the mark of a recording (.xvr); make one with xorvox record"));
    }
    fault_ = at(0, there < head.size()
                       ? fmt::format("the recording ends after {} bytes, within its head; make a new one", there)
                       : fmt::format("the head of the recording is damaged{}", advice()));
    return damage_is_ == Damage::Refused ? fail(fault_) : Expected<void>();
}

Expected<void> RecordingReader::read_display() {
    Block block;
    at_ = kRecordingHeadBytes;
    const Status status = next(block);
    const std::uint64_t offset = kRecordingHeadBytes;
    const bool another = status == Status::Ok && block.kind != BlockKind::Display;
    first_block_ = another ? offset : at_;
    if (status != Status::Ok || another) {
        return fail(at(offset, fmt::format("the description of the display is {}{}",
                                           offset >= source_.size ? "missing" : "damaged",
                                           damage_is_ == Damage::Tolerated
                                               ? ""
                                               : "; xorvox replay --keep-going plays what is whole, with --display "
                                                 "for the description")));
    }
    Expected<DisplayFile> display = parse_display(as_text(block.payload.subspan(kGeometryBytes)), source_.name);
    if (!display) {
        return fail(at(offset, "the description of the display is not understood; was it made by a later xorvox? " +
                                   display.error().message));
    }
    const std::uint64_t digest = decode_u64(block.payload.first<kGeometryBytes>());
    if (digest != geometry_digest(*display)) {
        return fail(at(offset, fmt::format("the description of {} gives another geometry than was recorded; play it "
                                           "with the xorvox that made it",
                                           display->name.view())));
    }
    display_ = std::move(*display);
    return {};
}

Expected<void> RecordingReader::read_index() {
    constexpr std::uint64_t kWholeEnd = kBlockOverhead + kEndBytes;
    if (source_.size < first_block_ + kWholeEnd) return tl::unexpected(no_end());
    Block block;
    at_ = source_.size - kWholeEnd;
    if (BlockHeader header; !take_header(at_, header) || header.kind != BlockKind::End) {
        return tl::unexpected(no_end());
    }
    if (next(block) != Status::Ok || block.kind != BlockKind::End) return fail(damage_);
    duration_ns_ = block.time_ns;
    const std::uint64_t end = block.offset;
    const std::uint64_t index = decode_u64(block.payload.first<kEndBytes>());
    at_ = index;
    if (index < first_block_ || index >= end) {
        return fail(
            at(end, fmt::format("the end says that the index is at byte {}, where it cannot be{}", index, advice())));
    }
    const Status status = next(block);
    if (status == Status::Corrupt) return fail(damage_);
    if (status != Status::Ok || block.kind != BlockKind::Index || at_ != end) {
        return fail(at(index, fmt::format("the index is not where the end says{}", advice())));
    }
    for (std::size_t i = 0; i < block.payload.size(); i += kFrameEntryBytes) {
        const FrameEntry entry = decode_entry(block.payload.subspan(i).first<kFrameEntryBytes>());
        if (entry.hello < first_block_ || entry.begin < entry.hello || entry.begin >= index) {
            return fail(at(index, fmt::format("frame {} of the index is at no place of the file{}",
                                              i / kFrameEntryBytes, advice())));
        }
        frames_.push_back(entry);
    }
    return {};
}

/// Why the last bytes are no end; finds one before them.
Error RecordingReader::no_end() {
    BlockHeader header;
    for (std::uint64_t offset = first_block_; take_header(offset, header) && plausible(header);) {
        offset += kBlockOverhead + header.length;
        if (offset >= source_.size) break;
        if (header.kind != BlockKind::End) continue;
        end_ = offset;
        const std::uint64_t more = source_.size - offset;
        return {at(offset, fmt::format("{} byte{} more behind the end of the recording{}", more, more == 1 ? "" : "s",
                                       advice()))};
    }
    return {at(source_.size, fmt::format("the recording ends here without its end: it was cut off, or its program was "
                                         "killed{}",
                                         advice()))};
}

void RecordingReader::rebuild_index() {
    frames_.clear();
    duration_ns_ = 0;
    rewind();
    Block block;
    for (Status status = next(block); status != Status::Closed; status = next(block)) {
        if (status != Status::Ok) continue;
        duration_ns_ = std::max(duration_ns_, block.time_ns);
        if (block.kind != BlockKind::Frame) continue;
        const FrameEntry entry = decode_entry(block.payload.first<kFrameEntryBytes>());
        if (entry.hello <= entry.begin && entry.begin < block.offset) frames_.push_back(entry);
    }
}

bool RecordingReader::take_header(std::uint64_t offset, BlockHeader& header) {
    std::array<std::byte, kBlockHeaderBytes> bytes{};
    if (offset > source_.size || source_.size - offset < bytes.size()) return false;
    return source_.read(offset, bytes) && decode(bytes, header);
}

Status RecordingReader::next(Block& block) {
    const std::uint64_t offset = at_;
    if (offset >= end_) return Status::Closed;
    const std::uint64_t left = source_.size - offset;
    BlockHeader header;
    if (!take_header(offset, header) || !plausible(header)) {
        const bool cut = left < kBlockHeaderBytes;
        return corrupt(offset, cut ? "the recording is cut off here" : "here is no block of a recording: it is damaged",
                       next_header(offset + 1));
    }
    const std::uint64_t whole = kBlockOverhead + header.length;
    if (left < whole) {
        return corrupt(offset,
                       fmt::format("the recording is cut off: this block has {} bytes, and {} are left", whole, left),
                       next_header(offset + 1));
    }
    payload_.resize(header.length + 4);
    if (!source_.read(offset + kBlockHeaderBytes, payload_)) {
        return corrupt(offset, "cannot be read", source_.size);
    }
    const std::span<const std::byte> payload = std::span(payload_).first(header.length);
    if (decode_u32(std::span<const std::byte>(payload_).last<4>()) != wire::crc32c(payload)) {
        return corrupt(offset, "the contents of this block are damaged", offset + whole);
    }
    at_ = offset + whole;
    block = {header.kind, offset, header.time_ns, payload};
    return Status::Ok;
}

const char* RecordingReader::advice() const {
    return damage_is_ == Damage::Tolerated ? "" : "; xorvox replay --keep-going plays what is whole";
}

Status RecordingReader::corrupt(std::uint64_t offset, const std::string& what, std::uint64_t go_on_at) {
    damage_ = at(offset, what + advice());
    at_ = go_on_at;
    return Status::Corrupt;
}

/// Where the next block begins whose header is right; the end of the file without one.
std::uint64_t RecordingReader::next_header(std::uint64_t from) {
    std::vector<std::byte> window(4096);
    while (from + kBlockHeaderBytes <= source_.size) {
        const std::size_t there = std::min<std::uint64_t>(window.size(), source_.size - from);
        const std::span<const std::byte> bytes = std::span(window).first(there);
        if (!source_.read(from, std::span(window).first(there))) break;
        for (std::size_t i = 0; i + kBlockHeaderBytes <= there; ++i) {
            BlockHeader header;
            if (decode(bytes.subspan(i).first<kBlockHeaderBytes>(), header)) return from + i;
        }
        from += there - kBlockHeaderBytes + 1;
    }
    return source_.size;
}

Expected<RecordingReader> open_recording(const std::string& path, Damage damage) {
    Expected<ByteSource> source = open_source(path);
    if (!source) return tl::unexpected(source.error());
    return RecordingReader::open(std::move(*source), damage);
}

std::optional<std::size_t> keyframe_before(std::span<const FrameEntry> frames, std::uint64_t time_ns) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < frames.size() && frames[i].time_ns <= time_ns; ++i) {
        if (frames[i].keyframe) found = i;
    }
    return found;
}

}  // namespace xorvox::sim
