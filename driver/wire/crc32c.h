// CRC-32C, the digest of packets and pages. Freestanding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace xorvox::wire {

/// CRC-32C (Castagnoli, reflected, initial and final value ~0) of `bytes`, continuing from `crc`: crc32c(b, crc32c(a))
/// is that of a followed by b.
std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t crc = 0);

/// The same everywhere without the processor's help: what crc32c() is held against.
std::uint32_t crc32c_by_tables(std::span<const std::byte> bytes, std::uint32_t crc = 0);

}  // namespace xorvox::wire
