#include "sim/recording/frames.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace xorvox::sim {

Status RecordedFrames::seek(std::uint64_t time_ns) {
    reader_->rewind();
    number_ = 0;
    block_ns_ = 0;
    const auto key = keyframe_before(reader_->frames(), time_ns);
    if (!key) return Status::Ok;
    const FrameEntry& entry = reader_->frames()[*key];
    number_ = *key;
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
        if (!next_damage_.empty()) {
            damage_ = std::exchange(next_damage_, {});
            return Status::Corrupt;
        }
        const Status status = reader_->next(block);
        if (status == Status::Corrupt) {
            damage_ = reader_->damage();
            assembler_.missed();
            excused_ = true;
        }
        if (status == Status::Closed && index_is_right_ && number_ != reader_->frames().size()) {
            index_is_right_ = false;
            damage_ = reader_->name() + ": the index names more frames than there are" + reader_->advice();
            return Status::Corrupt;
        }
        if (status != Status::Ok) return status;
        if (block.time_ns < block_ns_) next_damage_ = at(block, "time goes back here");
        block_ns_ = block.time_ns;
        latest_ns_ = std::max(latest_ns_, block_ns_);
        if (block.kind == BlockKind::FromHost && assembler_.take(block.payload, block.offset)) {
            time_ns_ = block.time_ns;
            excused_ = false;
            return Status::Ok;
        }
        if (clock_.note(block) || block.kind != BlockKind::Frame) continue;
        if (std::string fault = fault_of(block); !fault.empty()) next_damage_ = std::move(fault);
    }
}

/// What is wrong with a frame's entry, if anything.
std::string RecordedFrames::fault_of(const Block& block) {
    const FrameEntry entry = decode_entry(block.payload.first<kFrameEntryBytes>());
    const std::span<const FrameEntry> index = reader_->frames();
    const bool named = number_ < index.size() && index[number_] == entry;
    ++number_;
    const AssembledFrame& last = assembler_.frame();
    if (last.bytes.empty() || entry.begin != last.begin) {
        if (std::exchange(excused_, true)) return {};
        return at(block,
                  "the frame that ends here is not whole: a packet of it, or of one that it builds on, is missing");
    }
    if (entry.digest != frame_digest(last.bytes)) {
        return at(block, "the digest of the frame before is not that of its bytes");
    }
    if (entry.id != last.id || entry.keyframe != last.keyframe || entry.time_ns != time_ns_) {
        return at(block, "the entry of the frame before is not that of its packets");
    }
    if (named || !std::exchange(index_is_right_, false)) return {};
    return at(block, "the frame before is not in the index, or not in this place");
}

std::string RecordedFrames::at(const Block& block, const char* what) const {
    return fmt::format("{}: byte {}: {}{}", reader_->name(), block.offset, what, reader_->advice());
}

std::uint64_t RecordedFrames::shown_ns() const {
    const std::uint64_t asked_ns = frame().present_at_ns;
    if (asked_ns == 0) return time_ns_;
    const std::uint64_t moment_ns = clock_.recorded_ns(asked_ns);
    constexpr std::uint64_t kFarthest_ns = 10'000'000'000;  // Beyond, it means nothing, or it wrapped.
    return moment_ns - time_ns_ < kFarthest_ns ? moment_ns : time_ns_;
}

}  // namespace xorvox::sim
