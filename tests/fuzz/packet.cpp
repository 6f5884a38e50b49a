// A packet with its length and CRC repaired, so that the fuzzer gets past them; then its payload as each message. What
// decodes must encode to the bytes that it came from.
#include <cstdlib>
#include <vector>

#include "driver/wire/messages.h"

using namespace xorvox;
using namespace xorvox::wire;

namespace {

void check(bool holds) {
    if (!holds) std::abort();
}

template <class Message>
void try_message(std::span<const std::byte> payload) {
    Message message;
    if (decode(payload, message) != Status::Ok) return;
    std::vector<std::byte> encoded(payload.size());
    std::size_t size = 0;
    check(encode(message, encoded, size) == Status::Ok);
    check(size <= payload.size());
    check(std::equal(encoded.begin(), encoded.begin() + static_cast<std::ptrdiff_t>(size), payload.begin()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::byte> input = std::as_bytes(std::span(data, size));
    Header header;
    std::span<const std::byte> payload;
    (void)decode_packet(input, header, payload);
    if (size < kPacketOverhead) return 0;

    const std::span<const std::byte> body = input.subspan(kHeaderBytes, size - kPacketOverhead);
    const Header sent{
        .type = static_cast<PacketType>(data[3]), .flags = data[4], .session = data[6], .sequence = data[8]};
    std::vector<std::byte> packet(size);
    std::size_t encoded = 0;
    check(encode_packet(sent, body, packet, encoded) == Status::Ok && encoded == size);
    check(decode_packet(packet, header, payload) == Status::Ok);
    check(header.type == sent.type && header.flags == sent.flags && header.session == sent.session);
    check(payload.data() == packet.data() + kHeaderBytes && payload.size() == body.size());

    try_message<HelloRequest>(payload);
    try_message<Hello>(payload);
    try_message<FrameBegin>(payload);
    try_message<Chunk>(payload);
    try_message<FrameEnd>(payload);
    try_message<Control>(payload);
    try_message<Ping>(payload);
    try_message<Pong>(payload);
    try_message<Acknowledge>(payload);
    try_message<Nack>(payload);
    try_message<DeviceStatus>(payload);
    return 0;
}
