#include "sim/recording/playback.h"

#include <algorithm>
#include <cmath>

#include "driver/wire/messages.h"
#include "driver/wire/packet.h"

namespace xorvox::sim {

Status Playback::seek(std::uint64_t time_ns) {
    reader_->rewind();
    begin_ns_ = 0;
    session_.reset();
    missed_ = true;
    const auto key = keyframe_before(reader_->frames(), time_ns);
    if (!key) return Status::Ok;
    const FrameEntry entry = reader_->frames()[*key];
    Block block;
    Status worst = Status::Ok;
    reader_->seek(entry.begin);
    if (reader_->next(block) == Status::Ok) {
        begin_ns_ = block.time_ns;
    } else {
        begin_ns_ = entry.time_ns;
        worst = note_damage();
    }
    reader_->seek(entry.hello);
    if (reader_->next(block) == Status::Ok) {
        take(block);
        request_first_ = session_.has_value();
    } else {
        worst = note_damage();
    }
    // The answer tells the device's clock; it comes soon.
    while (reader_->next(block) == Status::Ok && block.offset < entry.begin && !clock_.note(block)) {
    }
    reader_->seek(entry.begin);
    return worst;
}

Status Playback::note_damage() {
    damage_ = reader_->damage();
    missed_ = true;
    return Status::Corrupt;
}

Status Playback::next() {
    if (request_first_) {
        request_first_ = false;
        due_ns_ = 0;
        time_ns_ = begin_ns_;
        return Status::Ok;
    }
    if (again_) {
        again_ = false;
        packet_.swap(next_);
        return Status::Ok;
    }
    Block block;
    for (;;) {
        const Status status = reader_->next(block);
        if (status == Status::Corrupt) return note_damage();
        if (status != Status::Ok) return status;
        if (clock_.note(block) || block.kind != BlockKind::FromHost) continue;
        take(block);
        return Status::Ok;
    }
}

/// `block` into packet_; where the request of its session is missing, that into packet_, and `block` into next_.
void Playback::take(const Block& block) {
    packet_.assign(block.payload.begin(), block.payload.end());
    time_ns_ = block.time_ns;
    due_ns_ = replayed_ns(block.time_ns);
    wire::Header header;
    std::span<const std::byte> payload;
    if (wire::decode_packet(block.payload, header, payload) != Status::Ok) return;
    if (header.type == wire::PacketType::HelloRequest) {
        session_ = header.session;
        missed_ = false;
    }
    again_ = header.type == wire::PacketType::FrameBegin && missed_ && session_ != header.session;
    if (again_) session_ = header.session;
    if (session_ == header.session) sequence_ = header.sequence;
    if (header.type == wire::PacketType::FrameBegin) translate(header, payload);
    if (!again_) return;
    missed_ = false;
    next_.swap(packet_);
    packet_.resize(wire::kMaxPacketBytes);
    std::size_t size = 0;
    (void)wire::encode_packet(header.session, header.sequence - 1, wire::HelloRequest{}, packet_, size);
    packet_.resize(size);
}

/// The moment that the frame of packet_ asks for, into the clock of the display.
void Playback::translate(const wire::Header& header, std::span<const std::byte> payload) {
    wire::FrameBegin begin;
    if (wire::decode(payload, begin) != Status::Ok || begin.present_at_ns == 0) return;
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

bool Playback::make_ping(std::uint64_t now_ns, std::span<std::byte> packet, std::size_t& size) {
    if (!session_) return false;
    return wire::encode_packet(*session_, ++sequence_, wire::Ping{.host_time_ns = now_ns}, packet, size) == Status::Ok;
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
