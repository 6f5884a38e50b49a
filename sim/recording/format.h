// Format: the bytes of a recording (.xvr). docs/recordings.md is the whole format, for other programs too.
//
//   head    byte  0 … 7                         8   9   10  11   12 … 15
//                 89 'X' 'V' 'R' 0D 0A 1A 0A    major   minor    CRC-32C of bytes 0 … 11
//
//   then blocks, one behind the other:
//           byte  0     1    2     3   4 … 7    8 … 15    16 … 19               20 …      20 + length
//                 0xB7  'R'  kind  0   length   time_ns   CRC-32C of the 16     payload   CRC-32C of the payload
//
// The header has a CRC of its own, so that a damaged length cannot swallow what follows. All numbers are little-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace xorvox::sim {

inline constexpr std::size_t kRecordingHeadBytes = 16;
inline constexpr std::uint16_t kRecordingMajor = 1;  ///< Another one is refused.
inline constexpr std::uint16_t kRecordingMinor = 0;  ///< A later one has kinds of blocks that readers skip.

/// What a block holds. The numbers are letters, for people who look at the bytes.
enum class BlockKind : std::uint8_t {
    Display = 'D',     ///< First: geometry digest, then the display file.
    FromHost = '>',    ///< A packet from the host to the device.
    FromDevice = '<',  ///< A packet from the device to the host.
    Frame = 'F',       ///< The packets so far completed a frame: its FrameEntry.
    Index = 'I',       ///< All FrameEntries.
    End = 'E',         ///< Last: where the index is.
};

struct BlockHeader {
    BlockKind kind{};
    std::uint32_t length = 0;   ///< Of the payload.
    std::uint64_t time_ns = 0;  ///< Since the first packet.
};
inline constexpr std::size_t kBlockHeaderBytes = 20;
inline constexpr std::size_t kBlockOverhead = kBlockHeaderBytes + 4;
inline constexpr std::array kBlockMark{std::byte{0xB7}, std::byte{'R'}};
inline constexpr std::size_t kMaxDisplayTextBytes = std::size_t{1} << 20;
inline constexpr std::size_t kGeometryBytes = 8;
inline constexpr std::size_t kEndBytes = 8;  ///< Payload of the end: the offset of the index's block.

/// One frame of a recording: what the host sent whole, whether or not the display showed it.
struct FrameEntry {
    std::uint64_t hello = 0;    ///< Offset of the block with the HelloRequest of its session.
    std::uint64_t begin = 0;    ///< Offset of the block with its FrameBegin.
    std::uint64_t time_ns = 0;  ///< When it was whole: the time of its FrameEnd.
    std::uint64_t digest = 0;   ///< frame_digest() of its bytes.
    std::uint32_t id = 0;       ///< As on the wire.
    bool keyframe = false;      ///< It builds on no other.

    bool operator==(const FrameEntry&) const = default;
};
inline constexpr std::size_t kFrameEntryBytes = 40;

std::array<std::byte, kRecordingHeadBytes> encode_head();
std::array<std::byte, kBlockHeaderBytes> encode(const BlockHeader& header);
std::array<std::byte, kFrameEntryBytes> encode(const FrameEntry& entry);
std::array<std::byte, 8> encode_u64(std::uint64_t value);
std::array<std::byte, 4> encode_u32(std::uint32_t value);

/// False: mark or CRC are wrong, and `header` is as it was.
bool decode(std::span<const std::byte, kBlockHeaderBytes> bytes, BlockHeader& header);
FrameEntry decode_entry(std::span<const std::byte, kFrameEntryBytes> bytes);
std::uint64_t decode_u64(std::span<const std::byte, 8> bytes);
std::uint32_t decode_u32(std::span<const std::byte, 4> bytes);

/// Whether a block of this kind may be so long. Kinds of a later minor version may be up to 1 MiB.
bool plausible(const BlockHeader& header);

/// Of a frame's bytes, in scan-out order: FNV-1a, 64 bits, byte by byte. Two recordings that show the same have the
/// same digests, however their packets were cut and compressed.
std::uint64_t frame_digest(std::span<const std::byte> frame);

}  // namespace xorvox::sim
