#include "sim/recording/format.h"

#include <algorithm>

#include "driver/wire/crc32c.h"
#include "driver/wire/packet.h"

namespace xorvox::sim {
namespace {

constexpr std::array<unsigned char, 8> kMagic{0x89, 'X', 'V', 'R', 0x0D, 0x0A, 0x1A, 0x0A};

void put(std::span<std::byte> out, std::uint64_t value) {
    for (std::byte& byte : out) {
        byte = static_cast<std::byte>(value & 0xff);
        value >>= 8;
    }
}

std::uint64_t get(std::span<const std::byte> bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(bytes[i]);
    return value;
}

}  // namespace

std::array<std::byte, kRecordingHeadBytes> encode_head() {
    std::array<std::byte, kRecordingHeadBytes> out{};
    std::ranges::copy(std::as_bytes(std::span(kMagic)), out.begin());
    const std::span<std::byte> bytes(out);
    put(bytes.subspan(8, 2), kRecordingMajor);
    put(bytes.subspan(10, 2), kRecordingMinor);
    put(bytes.subspan(12, 4), wire::crc32c(bytes.first(12)));
    return out;
}

std::array<std::byte, kBlockHeaderBytes> encode(const BlockHeader& header) {
    std::array<std::byte, kBlockHeaderBytes> out{kBlockMark[0], kBlockMark[1], static_cast<std::byte>(header.kind)};
    const std::span<std::byte> bytes(out);
    put(bytes.subspan(4, 4), header.length);
    put(bytes.subspan(8, 8), header.time_ns);
    put(bytes.subspan(16, 4), wire::crc32c(bytes.first(16)));
    return out;
}

std::array<std::byte, kFrameEntryBytes> encode(const FrameEntry& entry) {
    std::array<std::byte, kFrameEntryBytes> out{};
    const std::span<std::byte> bytes(out);
    put(bytes.subspan(0, 8), entry.hello);
    put(bytes.subspan(8, 8), entry.begin);
    put(bytes.subspan(16, 8), entry.time_ns);
    put(bytes.subspan(24, 8), entry.digest);
    put(bytes.subspan(32, 4), entry.id);
    put(bytes.subspan(36, 4), entry.keyframe ? 1 : 0);
    return out;
}

std::array<std::byte, 8> encode_u64(std::uint64_t value) {
    std::array<std::byte, 8> out{};
    put(out, value);
    return out;
}

std::array<std::byte, 4> encode_u32(std::uint32_t value) {
    std::array<std::byte, 4> out{};
    put(out, value);
    return out;
}

bool decode(std::span<const std::byte, kBlockHeaderBytes> bytes, BlockHeader& header) {
    if (bytes[0] != kBlockMark[0] || bytes[1] != kBlockMark[1]) return false;
    if (get(bytes.subspan(16, 4)) != wire::crc32c(bytes.first(16))) return false;
    header.kind = static_cast<BlockKind>(bytes[2]);
    header.length = static_cast<std::uint32_t>(get(bytes.subspan(4, 4)));
    header.time_ns = get(bytes.subspan(8, 8));
    return true;
}

FrameEntry decode_entry(std::span<const std::byte, kFrameEntryBytes> bytes) {
    FrameEntry entry;
    entry.hello = get(bytes.subspan(0, 8));
    entry.begin = get(bytes.subspan(8, 8));
    entry.time_ns = get(bytes.subspan(16, 8));
    entry.digest = get(bytes.subspan(24, 8));
    entry.id = static_cast<std::uint32_t>(get(bytes.subspan(32, 4)));
    entry.keyframe = (get(bytes.subspan(36, 4)) & 1) != 0;
    return entry;
}

std::uint64_t decode_u64(std::span<const std::byte, 8> bytes) {
    return get(bytes);
}

std::uint32_t decode_u32(std::span<const std::byte, 4> bytes) {
    return static_cast<std::uint32_t>(get(bytes));
}

bool plausible(const BlockHeader& header) {
    const std::size_t length = header.length;
    switch (header.kind) {
        case BlockKind::Display: return length > kGeometryBytes && length <= kGeometryBytes + kMaxDisplayTextBytes;
        case BlockKind::FromHost:
        case BlockKind::FromDevice: return length > 0 && length <= wire::kMaxPacketBytes;
        case BlockKind::Frame: return length == kFrameEntryBytes;
        case BlockKind::Index: return length % kFrameEntryBytes == 0;
        case BlockKind::End: return length == kEndBytes;
    }
    return length <= std::size_t{1} << 20;
}

std::uint64_t frame_digest(std::span<const std::byte> frame) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::byte byte : frame) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
    return hash;
}

}  // namespace xorvox::sim
