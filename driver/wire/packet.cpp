#include "driver/wire/packet.h"

#include <cstring>

namespace xorvox::wire {
namespace {

std::uint32_t load16(const std::byte* at) {
    return std::to_integer<std::uint32_t>(at[0]) | std::to_integer<std::uint32_t>(at[1]) << 8;
}
std::uint32_t load32(const std::byte* at) {
    return load16(at) | load16(at + 2) << 16;
}

void store16(std::byte* at, std::uint32_t value) {
    at[0] = static_cast<std::byte>(value & 0xff);
    at[1] = static_cast<std::byte>(value >> 8 & 0xff);
}
void store32(std::byte* at, std::uint32_t value) {
    store16(at, value);
    store16(at + 2, value >> 16);
}

}  // namespace

Status encode_packet(const Header& header, std::span<const std::byte> payload, std::span<std::byte> out,
                     std::size_t& size) {
    if (out.size() < kPacketOverhead || payload.size() > out.size() - kPacketOverhead) return Status::OutOfMemory;
    std::byte* const at = out.data();
    // First the payload: it may overlap the place of the header.
    if (!payload.empty() && payload.data() != at + kHeaderBytes) {
        std::memmove(at + kHeaderBytes, payload.data(), payload.size());
    }
    at[0] = std::byte{kMagic0};
    at[1] = std::byte{kMagic1};
    at[2] = std::byte{kMajor};
    at[3] = static_cast<std::byte>(header.type);
    store16(at + 4, header.flags);
    store16(at + 6, header.session);
    store32(at + 8, header.sequence);
    store32(at + 12, static_cast<std::uint32_t>(payload.size()));
    const std::size_t covered = kHeaderBytes + payload.size();
    store32(at + covered, crc32c(out.first(covered)));
    size = covered + kCrcBytes;
    return Status::Ok;
}

Status decode_packet(std::span<const std::byte> packet, Header& header, std::span<const std::byte>& payload) {
    if (packet.size() < kPacketOverhead) return Status::Corrupt;
    const std::byte* const at = packet.data();
    const std::size_t covered = packet.size() - kCrcBytes;
    if (at[0] != std::byte{kMagic0} || at[1] != std::byte{kMagic1}) return Status::Corrupt;
    if (load32(at + 12) != covered - kHeaderBytes) return Status::Corrupt;
    if (load32(at + covered) != crc32c(packet.first(covered))) return Status::Corrupt;
    header.type = static_cast<PacketType>(at[3]);
    header.flags = static_cast<std::uint16_t>(load16(at + 4));
    header.session = static_cast<std::uint16_t>(load16(at + 6));
    header.sequence = load32(at + 8);
    header.length = load32(at + 12);
    if (at[2] != std::byte{kMajor}) return Status::Unsupported;
    payload = packet.subspan(kHeaderBytes, covered - kHeaderBytes);
    return Status::Ok;
}

}  // namespace xorvox::wire
