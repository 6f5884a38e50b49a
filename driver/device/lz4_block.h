// LZ4 block: a bounded decoder of the LZ4 block format (lz4_Block_format.md of the LZ4 project), for memory that must
// not be touched beyond its ends and for bytes that come from anybody.
//
//   sequence  token │ more literal length │ literals │ offset, 2 bytes │ more match length       and so on;
//             hi 4 bits: literal length, lo 4: match length − 4; 15 continues in bytes until one is not 255.
//   The last sequence ends after its literals.
#pragma once

#include <cstddef>
#include <span>

#include "voxelizer/status.h"

namespace xorvox::device {

/// Decodes `block` to exactly `out.size()` bytes. Matches reach back into `out` only: every block stands alone.
/// Ok, or Corrupt (`block` is cut, goes on after the end, has an offset of zero or before the start, or another
/// length): then `out` is partly written. Takes every block that liblz4 takes but those with the offset zero, which the
/// format forbids. Reentrant, no memory of its own.
Status decode_lz4_block(std::span<const std::byte> block, std::span<std::byte> out);

}  // namespace xorvox::device
