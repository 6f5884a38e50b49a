#include "sim/recording/playback.h"

#include <algorithm>
#include <cmath>

#include "driver/wire/messages.h"
#include "driver/wire/packet.h"

namespace xorvox::sim {

Status Playback::seek(std::uint64_t time_ns) {
    reader_->rewind();
    begin_ns_ = 0;
    const auto key = keyframe_before(reader_->frames(), time_ns);
    if (!key) return Status::Ok;
    const FrameEntry entry = reader_->frames()[*key];
    Block block;
    reader_->seek(entry.begin);
    if (const Status status = reader_->next(block); status != Status::Ok) return status;
    begin_ns_ = block.time_ns;
    reader_->seek(entry.hello);
    if (const Status status = reader_->next(block); status != Status::Ok) return status;
    packet_.assign(block.payload.begin(), block.payload.end());
    hello_first_ = true;
    // The answer tells the device's clock; it comes soon.
    while (reader_->next(block) == Status::Ok && block.offset < entry.begin && !clock_.note(block)) {
    }
    reader_->seek(entry.begin);
    return Status::Ok;
}

Status Playback::next() {
    if (hello_first_) {
        hello_first_ = false;
        due_ns_ = 0;
        time_ns_ = begin_ns_;
        return Status::Ok;
    }
    Block block;
    for (;;) {
        const Status status = reader_->next(block);
        if (status != Status::Ok) return status;
        if (clock_.note(block) || block.kind != BlockKind::FromHost) continue;
        take(block);
        return Status::Ok;
    }
}

void Playback::take(const Block& block) {
    packet_.assign(block.payload.begin(), block.payload.end());
    time_ns_ = block.time_ns;
    due_ns_ = replayed_ns(block.time_ns);
    wire::Header header;
    std::span<const std::byte> payload;
    wire::FrameBegin begin;
    if (wire::decode_packet(block.payload, header, payload) != Status::Ok) return;
    if (header.type != wire::PacketType::FrameBegin || wire::decode(payload, begin) != Status::Ok) return;
    if (begin.present_at_ns == 0) return;
    const std::uint64_t moment_ns = std::max<std::uint64_t>(replayed_ns(clock_.recorded_ns(begin.present_at_ns)), 1);
    last_present_at_ns_ = std::max(last_present_at_ns_, moment_ns);
    if (moment_ns == begin.present_at_ns) return;
    // Its place is at the same distance from the payload's start in every minor version.
    constexpr std::size_t kPresentAt = 13;
    std::vector<std::byte> changed(payload.begin(), payload.end());
    for (std::size_t i = 0; i < 8; ++i) changed[kPresentAt + i] = static_cast<std::byte>(moment_ns >> (8 * i) & 0xff);
    std::size_t size = 0;
    (void)wire::encode_packet(header, changed, packet_, size);
}

std::uint64_t Playback::replayed_ns(std::uint64_t recorded_ns) const {
    // A moment before the beginning is a negative distance.
    const auto since = static_cast<std::int64_t>(recorded_ns - begin_ns_);
    if (since <= 0) return 0;
    if (speed_ == 1.0) return static_cast<std::uint64_t>(since);
    constexpr double kMost = 9e18;
    return static_cast<std::uint64_t>(std::min(static_cast<double>(since) / speed_, kMost));
}

}  // namespace xorvox::sim
