// One sample of each message, every field different from its default and from its neighbours. tests/golden/messages.hex
// holds their packets.
#pragma once

#include <array>

#include "driver/wire/messages.h"

namespace xorvox::test {

using namespace xorvox::wire;

inline constexpr std::array kChunkData{std::byte{0xC0}, std::byte{0xC1}, std::byte{0xC2}, std::byte{0xC3},
                                       std::byte{0xC4}};

inline constexpr HelloRequest kHelloRequest{.major = 1, .minor = 0, .host_time_ns = 0x1112131415161718};
inline const Hello kHello{.features = kFeatureDelta | kFeaturePresentAt,
                          .boot_nonce = 0xA1A2A3A4,
                          .serial = DisplayName("XV-0042"),
                          .display = DisplayName("cube8"),
                          .geometry_digest = 0xa45549ebffcb652e,
                          .format = PixelFormat::Mono1,
                          .planes = 1,
                          .frame_bytes = 64,
                          .pages = 3,
                          .max_packet_bytes = 1024,
                          .codecs = 3,
                          .fault = Fault::SilentHost,
                          .free_pages = 2,
                          .device_time_ns = 0x2122232425262728,
                          .host_time_ns = 0x1112131415161718};
inline constexpr FrameBegin kFrameBegin{
    .frame = 8, .flags = kFrameDelta, .base = 7, .frame_bytes = 64, .present_at_ns = 0x3132333435363738};
inline const Chunk kChunk{.frame = 8, .offset = 16, .decoded_length = 5, .codec = Codec::Raw, .data = kChunkData};
inline constexpr FrameEnd kFrameEnd{.frame = 8, .page_crc = 0xB1B2B3B4};
inline constexpr Control kControl{.operation = ControlOperation::Watchdog, .value = 2500};
inline constexpr Ping kPing{.host_time_ns = 0x4142434445464748};
inline constexpr Pong kPong{.host_time_ns = 0x4142434445464748, .device_time_ns = 0x0102030405060708};
inline constexpr Acknowledge kAcknowledge{.stage = AckStage::Presented,
                                          .frame = 8,
                                          .page_crc = 0xB1B2B3B4,
                                          .free_pages = 1,
                                          .device_time_ns = 0x5152535455565758};
inline constexpr Nack kNack{
    .reason = NackReason::NeedKeyframe, .frame = 9, .free_pages = 1, .device_time_ns = 0x6162636465666768};
inline constexpr DeviceStatus kDeviceStatus{.brightness = 200,
                                            .blank = 1,
                                            .silence_action = SilenceAction::Hold,
                                            .watchdog_ms = 2500,
                                            .fault = Fault::LateScan,
                                            .shown_frame = 8,
                                            .has_frame = 1,
                                            .shown_crc = 0xB1B2B3B4,
                                            .free_pages = 2,
                                            .frames_accepted = 100,
                                            .frames_dropped = 3,
                                            .packets_bad = 4,
                                            .device_time_ns = 0x7172737475767778,
                                            .faults = 0x00000006};

/// Calls visit(name in messages.hex, sequence there, sample) for each.
void for_each_sample(auto&& visit) {
    visit("hello-request", 0u, kHelloRequest);
    visit("hello", 1u, kHello);
    visit("frame-begin", 2u, kFrameBegin);
    visit("chunk", 3u, kChunk);
    visit("frame-end", 4u, kFrameEnd);
    visit("control", 5u, kControl);
    visit("ping", 6u, kPing);
    visit("acknowledge", 7u, kAcknowledge);
    visit("nack", 8u, kNack);
    visit("device-status", 9u, kDeviceStatus);
    visit("pong", 10u, kPong);
}

}  // namespace xorvox::test
