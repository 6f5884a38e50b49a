#include "sim/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "driver/wire/packet.h"

namespace xorvox::sim {
namespace {

constexpr std::array<std::string_view, 5> kDark{"", "no_picture", "dead_zone", "not_locked", "fault"};
constexpr std::array<std::string_view, 8> kFaults{"",      "silent_host", "late_scan", "lost_index",
                                                  "stall", "overspeed",   "reversed",  "interlock"};

template <std::size_t N>
std::string object(const std::array<std::string_view, N>& keys, const std::array<std::uint64_t, N>& values) {
    std::string json;
    for (std::size_t i = 1; i < N; ++i) {
        fmt::format_to(std::back_inserter(json), R"({}"{}": {})", i == 1 ? "{" : ", ", keys[i], values[i]);
    }
    return json + "}";
}

template <class Message>
bool read(const wire::Header& header, std::span<const std::byte> payload, Message& message) {
    return header.type == Message::kType && wire::decode(payload, message) == Status::Ok;
}

/// Chunks are most of what comes, and none of them says anything here: they are not checked a second time.
bool is_chunk(std::span<const std::byte> packet) {
    return packet.size() > 3 && packet[3] == static_cast<std::byte>(wire::PacketType::Chunk);
}

}  // namespace

void TimingWatch::received(std::span<const std::byte> packet, std::uint64_t now_ns) {
    if (is_chunk(packet)) return;
    wire::Header header;
    std::span<const std::byte> payload;
    if (wire::decode_packet(packet, header, payload) != Status::Ok) return;
    wire::FrameBegin begin;
    if (header.session != session_) {
        if (header.type != wire::PacketType::HelloRequest) return;
        session_ = header.session;
        last_begun_.reset();
        std::erase_if(open_, [](const auto& frame) { return frame.second.accepted_ns == FrameTiming::kNever; });
    }
    // One that was repeated on the way began when it came first.
    if (!read(header, payload, begin) || begin.frame == last_begun_) return;
    last_begun_ = begin.frame;
    open_.insert_or_assign(
        begin.frame, FrameTiming{.frame = begin.frame, .asked_ns = begin.present_at_ns, .first_packet_ns = now_ns});
    ++timing_.begun;
}

void TimingWatch::sent(std::span<const std::byte> packet, std::uint64_t now_ns) {
    wire::Header header;
    std::span<const std::byte> payload;
    if (wire::decode_packet(packet, header, payload) != Status::Ok) return;
    wire::Acknowledge acknowledge;
    if (read(header, payload, acknowledge) && acknowledge.stage == wire::AckStage::Accepted) {
        const auto found = open_.find(acknowledge.frame);
        if (found == open_.end() || found->second.accepted_ns != FrameTiming::kNever) return;
        found->second.accepted_ns = std::min(acknowledge.device_time_ns, now_ns);
        ++timing_.accepted;
    }
    wire::Nack nack;
    if (read(header, payload, nack)) {
        const auto found = open_.find(nack.frame);
        if (found == open_.end() || found->second.accepted_ns != FrameTiming::kNever) return;
        open_.erase(found);
        ++timing_.refused;
    }
}

void TimingWatch::look(const State& state, std::uint64_t now_ns) {
    now_ns = std::max(now_ns, timing_.until_ns);
    const std::uint64_t passed = now_ns - timing_.until_ns;
    if (state_.dark == device::Dark::No) timing_.lit_ns += passed;
    if (state_.dark != device::Dark::No) timing_.dark_ns[static_cast<std::size_t>(state_.dark)] += passed;
    timing_.until_ns = now_ns;

    if (state.locked && !state_.locked) ++timing_.locked;
    if (!state.locked && state_.locked) ++timing_.lost;
    for (std::uint8_t fault = 1; fault <= wire::kHighestFault; ++fault) {
        const std::uint32_t bit = wire::fault_bit(static_cast<wire::Fault>(fault));
        if ((state.faults & ~state_.faults & bit) != 0) ++timing_.faults[fault];
    }
    if (state.cycle != state_.cycle) {
        lit_in_cycle_ = torn_ = false;
        // Where the rotation was just found, a cycle began without a boundary.
        if (state_.locked) {
            boundary_before_ns_ = boundary_ns_;
            boundary_ns_ = now_ns;
        }
    }
    const bool is_new = state.has_frame && (!state_.has_frame || state.frame != state_.frame);
    state_ = state;
    if (is_new) present(state.frame, now_ns);
    if (state.dark == device::Dark::No) light(state.frame, now_ns);
}

void TimingWatch::present(std::uint32_t frame, std::uint64_t now_ns) {
    const auto found = open_.find(frame);
    if (found == open_.end() || found->second.presented_ns != FrameTiming::kNever) return;
    FrameTiming& timing = found->second;
    timing.presented_ns = now_ns;
    // A frame that is accepted at the time of a boundary comes after it.
    timing.late =
        timing.asked_ns > 0 ? timing.asked_ns <= boundary_before_ns_ : timing.accepted_ns < boundary_before_ns_;
    ++timing_.presented;
    timing_.late += timing.late ? 1 : 0;
    for (auto other = open_.begin(); other != open_.end();) {
        FrameTiming& passed_over = other->second;
        const bool was_due = passed_over.accepted_ns != FrameTiming::kNever && passed_over.asked_ns <= now_ns;
        const bool was_presented = passed_over.presented_ns != FrameTiming::kNever;
        if (other == found || !(was_due || was_presented)) {
            ++other;
            continue;
        }
        if (!was_presented) {
            passed_over.dropped = true;
            ++timing_.dropped;
        }
        finish(passed_over);
        other = open_.erase(other);
    }
}

void TimingWatch::light(std::uint32_t frame, std::uint64_t now_ns) {
    if (!lit_in_cycle_) {
        ++timing_.cycles;
    } else if (frame != lit_frame_ && !torn_) {
        torn_ = true;
        ++timing_.torn;
    }
    lit_in_cycle_ = true;
    lit_frame_ = frame;

    const auto found = open_.find(frame);
    if (found == open_.end() || found->second.presented_ns == FrameTiming::kNever) return;
    found->second.first_light_ns = now_ns;
    const std::uint64_t latency_ns = now_ns - found->second.first_packet_ns;
    Timing::Latency& latency = timing_.latency;
    latency.least_ns = latency.frames == 0 ? latency_ns : std::min(latency.least_ns, latency_ns);
    latency.most_ns = std::max(latency.most_ns, latency_ns);
    latency_sum_ns_ += static_cast<double>(latency_ns);
    latency.mean_ns = latency_sum_ns_ / static_cast<double>(++latency.frames);
    finish(found->second);
    open_.erase(found);
}

void TimingWatch::finish(const FrameTiming& frame) {
    if (done_.size() == kFramesKept) done_.erase(done_.begin());
    done_.push_back(frame);
}

std::string to_json(const Timing& timing) {
    const Timing::Latency& latency = timing.latency;
    const std::string latency_ns = latency.frames == 0
                                       ? "null"
                                       : fmt::format(R"({{"least": {}, "mean": {:.6g}, "most": {}}})", latency.least_ns,
                                                     latency.mean_ns, latency.most_ns);
    return fmt::format(
        R"({{"until_ns": {}, "frames": {{"begun": {}, "accepted": {}, "refused": {}, "presented": {}, "late": {}, )"
        R"("dropped": {}}}, "latency_ns": {}, "cycles": {}, "torn": {}, "lit_ns": {}, "dark_ns": {}, "locked": {}, )"
        R"("lost": {}, "faults": {}}})",
        timing.until_ns, timing.begun, timing.accepted, timing.refused, timing.presented, timing.late, timing.dropped,
        latency_ns, timing.cycles, timing.torn, timing.lit_ns, object(kDark, timing.dark_ns), timing.locked,
        timing.lost, object(kFaults, timing.faults));
}

}  // namespace xorvox::sim
