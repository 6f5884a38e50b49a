#include "driver/host/transfer.h"

#include <algorithm>
#include <utility>

namespace xorvox::host {

using namespace wire;

namespace {

constexpr std::size_t kMaxUnpresented = 16;  ///< More than a device has pages.

}  // namespace

const char* Transfer::refusal_text() const {
    switch (refusal_) {
        case NackReason::NeedKeyframe: return "it needs a keyframe";
        case NackReason::NoPage: return "it has no free page";
        case NackReason::Gap: return "packets were missing";
        case NackReason::BadChunk: return "a chunk did not decode";
        case NackReason::BadCrc: return "the page's checksum was wrong";
        case NackReason::BadFrame:
        case NackReason::BadControl:
        case NackReason::BadVersion: break;
    }
    return "it did not answer";
}

void Transfer::begin_with(const EncoderLimits& limits) {
    encoder_ = FrameEncoder(limits);
    has_base_ = false;
    // The device keeps the last one for its next boundary, or it forgot them all; its clock may be another one.
    for (Unpresented& frame : unpresented_) frame.due_ns = 0;
}

void Transfer::submit(std::span<const std::byte> content, std::uint64_t present_at_ns) {
    content_.assign(content.begin(), content.end());
    present_at_ns_ = present_at_ns;
    failed_attempts_ = 0;
    phase_ = Phase::Queued;
    ++statistics_->frames_submitted;
    statistics_->bytes_raw += content.size();
}

void Transfer::encode(bool delta) {
    if (++id_ == 0) ++id_;  // In a Nack, 0 means no frame.
    if (failed_attempts_ == 0) first_id_ = id_;
    const bool allowed = delta && has_base_;
    encoder_.encode({.id = id_,
                     .content = content_,
                     .present_at_ns = present_at_ns_,
                     .base_id = base_id_,
                     .base = allowed ? std::span<const std::byte>(base_) : std::span<const std::byte>()});
    if (encoder_.is_delta()) ++statistics_->frames_delta;
    next_payload_ = 0;
    phase_ = Phase::Sending;
}

void Transfer::again(NackReason reason) {
    phase_ = Phase::Queued;
    refusal_ = reason;
    has_base_ = false;
    ++failed_attempts_;
    ++statistics_->frames_resent;
}

/// Whether `frame` is the frame on its way, in this attempt or in an earlier one whose answer is late.
bool Transfer::is_an_attempt(std::uint32_t frame) const {
    if (phase_ == Phase::None || (phase_ == Phase::Queued && failed_attempts_ == 0)) return false;
    if (phase_ == Phase::Sending && frame == id_) return false;
    return !is_newer(first_id_, frame) && !is_newer(frame, id_);
}

bool Transfer::accept(const Acknowledge& message) {
    if (!is_an_attempt(message.frame) || message.page_crc != encoder_.page_crc()) return false;
    std::swap(content_, base_);
    base_id_ = last_accepted_ = message.frame;
    // After a late answer, a later attempt of the same content may still become the device's base.
    has_base_ = message.frame == id_;
    phase_ = Phase::None;
    ++statistics_->frames_accepted;
    unpresented_.push_back({.first_id = first_id_,
                            .last_id = id_,
                            .accepted_id = message.frame,
                            .page_crc = message.page_crc,
                            .due_ns = std::max(present_at_ns_, message.device_time_ns)});
    if (unpresented_.size() > kMaxUnpresented) unpresented_.pop_front();
    return true;
}

bool Transfer::presented(std::uint32_t frame, std::uint32_t page_crc) {
    const auto found = std::find_if(unpresented_.begin(), unpresented_.end(), [&](const Unpresented& accepted) {
        return accepted.page_crc == page_crc && !is_newer(accepted.first_id, frame) &&
               !is_newer(frame, accepted.last_id);
    });
    if (found == unpresented_.end()) return false;
    const Unpresented shown = *found;
    std::erase_if(unpresented_, [&](const Unpresented& accepted) {
        return accepted.due_ns < shown.due_ns ||
               (accepted.due_ns == shown.due_ns && !is_newer(accepted.accepted_id, shown.accepted_id));
    });
    ++statistics_->frames_presented;
    last_presented_ = shown.accepted_id;
    return true;
}

bool Transfer::awaits_presentation_at(std::uint64_t device_time_ns) const {
    return std::any_of(unpresented_.begin(), unpresented_.end(),
                       [&](const Unpresented& accepted) { return accepted.due_ns <= device_time_ns; });
}

}  // namespace xorvox::host
