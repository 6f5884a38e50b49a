// What the device says, and when: everything waits in Device::Answers until the link takes it.
#include <algorithm>

#include "driver/device/device.h"

namespace xorvox::device {

using namespace wire;

template <class Message>
bool Device::send(std::uint16_t session, const Message& message) {
    std::size_t size = 0;
    if (encode_packet(session, sent_sequence_, message, packet_, size) != Status::Ok) return true;
    // A link that is broken or has no way back swallows answers.
    if (link_.send(packet_.first(size)) == Status::WouldBlock) return false;
    ++sent_sequence_;
    return true;
}

bool Device::waiting() const {
    return answers_.hello || answers_.pong || answers_.status || answers_.accepted || answers_.presented ||
           answers_.refusal_count > 0;
}

std::uint32_t Device::events() const {
    return waiting() ? kLinkWritable : kLinkReadable;
}

bool Device::send_answers(std::uint64_t now_ns) {
    const auto say = [this](bool& asked, const auto& message) {
        if (asked && send(session_, message)) asked = false;
        return !asked;
    };
    if (!say(answers_.hello, hello(now_ns))) return false;
    for (; answers_.refusal_count > 0; --answers_.refusal_count) {
        Answers::Refusal& first = answers_.refusals.front();
        first.nack.free_pages = pages_.free_count();
        if (!send(first.session, first.nack)) return false;
        first = answers_.refusals.back();
    }
    answers_.accepted_frame.free_pages = pages_.free_count();
    answers_.presented_frame.free_pages = pages_.free_count();
    return say(answers_.accepted, answers_.accepted_frame) && say(answers_.presented, answers_.presented_frame) &&
           say(answers_.status, status(now_ns)) &&
           say(answers_.pong, Pong{.host_time_ns = answers_.pong_host_time_ns, .device_time_ns = now_ns});
}

void Device::refuse(std::uint16_t session, NackReason reason, std::uint32_t frame, std::uint64_t now_ns) {
    if (answers_.refusal_count == answers_.refusals.size()) return;
    answers_.refusals[answers_.refusal_count++] = {session,
                                                   {.reason = reason, .frame = frame, .device_time_ns = now_ns}};
}

Hello Device::hello(std::uint64_t now_ns) const {
    return {.features = kFeatureDelta | kFeaturePresentAt,
            .boot_nonce = boot_nonce_,
            .serial = serial_,
            .display = display_->name,
            .geometry_digest = geometry_digest_,
            .format = display_->format,
            .planes = static_cast<std::uint8_t>(bits_per_pixel(display_->format)),
            .frame_bytes = static_cast<std::uint32_t>(pages_.frame_bytes()),
            .pages = pages_.count(),
            .max_packet_bytes = std::min(static_cast<std::uint32_t>(packet_.size()), link_.info().max_packet_bytes),
            .codecs = 1u << static_cast<unsigned>(Codec::Raw) | 1u << static_cast<unsigned>(Codec::Lz4),
            .fault = fault(),
            .free_pages = pages_.free_count(),
            .device_time_ns = now_ns,
            .host_time_ns = hello_host_time_ns_};
}

DeviceStatus Device::status(std::uint64_t now_ns) const {
    DeviceStatus status{.brightness = brightness_,
                        .blank = static_cast<std::uint8_t>(blank_ || faults_ != 0 ? 1 : 0),
                        .silence_action = silence_action_,
                        .watchdog_ms = watchdog_ms_,
                        .fault = fault(),
                        .free_pages = pages_.free_count(),
                        .frames_accepted = frames_accepted_,
                        .frames_dropped = frames_dropped_,
                        .packets_bad = packets_bad_,
                        .device_time_ns = now_ns,
                        .faults = faults_};
    if (pages_.shown() != Pages::kNone) {
        status.has_frame = 1;
        status.shown_frame = pages_.page(pages_.shown()).frame;
        status.shown_crc = pages_.page(pages_.shown()).crc;
    }
    return status;
}

}  // namespace xorvox::device
