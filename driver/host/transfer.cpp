#include "driver/host/transfer.h"

#include <algorithm>
#include <utility>

namespace xorvox::host {

using namespace wire;

namespace {

constexpr std::size_t kMaxUnpresented = 16;  ///< More than a device has pages.
constexpr std::size_t kMaxFates = 64;        ///< More than come between two submissions.

}  // namespace

Transfer::Transfer(SessionStatistics& statistics) : statistics_(&statistics) {
    unpresented_.reserve(kMaxUnpresented + 1);
    fates_.reserve(kMaxFates);
}

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

void Transfer::begin_with(const EncoderLimits& limits, bool other_clock) {
    encoder_ = FrameEncoder(limits);
    has_base_ = false;
    if (other_clock) {
        present_at_ns_ = 0;
        for (FrameFate& fate : fates_) fate.device_time_ns = 0;
    }
    if (unpresented_.empty()) return;
    // The device keeps this one, for its next boundary; after a reset a later frame stands for it.
    Unpresented last = unpresented_.front();
    for (const Unpresented& frame : unpresented_) {
        if (last.is_due_before(frame)) last = frame;
    }
    give_up([&](const Unpresented& frame) { return frame.number != last.number; });
    unpresented_.front().due_ns = 0;
}

void Transfer::submit(std::span<const std::byte> content, std::uint64_t present_at_ns) {
    content_.assign(content.begin(), content.end());
    present_at_ns_ = present_at_ns;
    failed_attempts_ = 0;
    phase_ = Phase::Queued;
    number_ = ++statistics_->frames_submitted;
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
    unpresented_.push_back({.number = number_,
                            .first_id = first_id_,
                            .last_id = id_,
                            .accepted_id = message.frame,
                            .page_crc = message.page_crc,
                            .due_ns = std::max(present_at_ns_, message.device_time_ns)});
    if (unpresented_.size() > kMaxUnpresented) {
        give_up([oldest = unpresented_.front().number](const Unpresented& other) { return other.number == oldest; });
    }
    return true;
}

bool Transfer::presented(std::uint32_t frame, std::uint32_t page_crc, std::uint64_t device_time_ns) {
    const auto found = std::find_if(unpresented_.begin(), unpresented_.end(), [&](const Unpresented& accepted) {
        return accepted.page_crc == page_crc && !is_newer(accepted.first_id, frame) &&
               !is_newer(frame, accepted.last_id);
    });
    if (found == unpresented_.end()) return false;
    const Unpresented shown = *found;
    unpresented_.erase(found);
    give_up([&](const Unpresented& accepted) { return accepted.is_due_before(shown); });
    note({.frame = shown.number, .presented = true, .device_time_ns = device_time_ns});
    ++statistics_->frames_presented;
    last_presented_ = shown.accepted_id;
    return true;
}

bool Transfer::Unpresented::is_due_before(const Unpresented& other) const {
    return due_ns < other.due_ns || (due_ns == other.due_ns && is_newer(other.accepted_id, accepted_id));
}

/// What fulfils `condition` will never be shown.
template <class Condition>
void Transfer::give_up(Condition condition) {
    for (const Unpresented& frame : unpresented_) {
        if (condition(frame)) note({.frame = frame.number});
    }
    std::erase_if(unpresented_, condition);
}

void Transfer::note(const FrameFate& fate) {
    if (fates_.size() == kMaxFates) fates_.erase(fates_.begin());
    fates_.push_back(fate);
}

bool Transfer::next_fate(FrameFate& fate) {
    if (fates_.empty()) return false;
    fate = fates_.front();
    fates_.erase(fates_.begin());
    return true;
}

bool Transfer::awaits_presentation_at(std::uint64_t device_time_ns) const {
    return std::any_of(unpresented_.begin(), unpresented_.end(),
                       [&](const Unpresented& accepted) { return accepted.due_ns <= device_time_ns; });
}

}  // namespace xorvox::host
