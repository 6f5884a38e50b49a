#include "sim/recording/device_clock.h"

#include "driver/wire/messages.h"
#include "driver/wire/packet.h"

namespace xorvox::sim {

bool DeviceClock::note(const Block& block) {
    wire::Header header;
    std::span<const std::byte> payload;
    wire::Hello hello;
    const bool told = block.kind == BlockKind::FromDevice &&
                      wire::decode_packet(block.payload, header, payload) == Status::Ok &&
                      header.type == wire::PacketType::Hello && wire::decode(payload, hello) == Status::Ok;
    if (told) ahead_ns_ = hello.device_time_ns - block.time_ns;
    return told;
}

}  // namespace xorvox::sim
