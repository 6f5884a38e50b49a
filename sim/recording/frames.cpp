#include "sim/recording/frames.h"

#include <fmt/format.h>

namespace xorvox::sim {

Status RecordedFrames::seek(std::uint64_t time_ns) {
    reader_->rewind();
    const auto key = keyframe_before(reader_->frames(), time_ns);
    if (!key) return Status::Ok;
    const FrameEntry& entry = reader_->frames()[*key];
    reader_->seek(entry.hello);
    Block block;
    const Status status = reader_->next(block);
    if (status == Status::Corrupt) damage_ = reader_->damage();
    if (status == Status::Ok) (void)assembler_.take(block.payload, block.offset);
    // The answer tells the device's clock; it comes soon.
    while (reader_->next(block) == Status::Ok && block.offset < entry.begin && !clock_.note(block)) {
    }
    reader_->seek(entry.begin);
    return status;
}

Status RecordedFrames::next() {
    Block block;
    for (;;) {
        const Status status = reader_->next(block);
        if (status == Status::Corrupt) damage_ = reader_->damage();
        if (status != Status::Ok) return status;
        if (block.kind == BlockKind::FromHost && assembler_.take(block.payload, block.offset)) {
            time_ns_ = block.time_ns;
            return Status::Ok;
        }
        if (clock_.note(block) || block.kind != BlockKind::Frame) continue;
        const FrameEntry entry = decode_entry(block.payload.first<kFrameEntryBytes>());
        const AssembledFrame& last = assembler_.frame();
        if (last.bytes.empty() || entry.begin != last.begin || entry.digest == frame_digest(last.bytes)) continue;
        damage_ = fmt::format(
            "{}: byte {}: the digest of the frame before is not that of its bytes; xorvox replay --keep-going plays "
            "what is whole",
            reader_->name(), block.offset);
        return Status::Corrupt;
    }
}

std::uint64_t RecordedFrames::shown_ns() const {
    const std::uint64_t asked_ns = frame().present_at_ns;
    if (asked_ns == 0) return time_ns_;
    const std::uint64_t moment_ns = clock_.recorded_ns(asked_ns);
    constexpr std::uint64_t kFarthest_ns = 10'000'000'000;  // Beyond, it means nothing, or it wrapped.
    return moment_ns - time_ns_ < kFarthest_ns ? moment_ns : time_ns_;
}

}  // namespace xorvox::sim
