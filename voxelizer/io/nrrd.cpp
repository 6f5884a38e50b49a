#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/inflate.h"
#include "voxelizer/io/memory.h"
#include "voxelizer/io/nrrd_header.h"
#include "voxelizer/io/text_scanner.h"
#include "voxelizer/io/volume_reader.h"

namespace xorvox::io {
namespace {

Expected<std::size_t> skip_lines(std::string_view bytes, std::size_t at, std::uint64_t lines, std::string_view source) {
    for (; lines > 0; --lines) {
        const std::size_t end = bytes.find('\n', at);
        if (end == std::string_view::npos) {
            return fail(fmt::format("{}: byte {}: {} lines more should be skipped than there are", source, at, lines));
        }
        at = end + 1;
    }
    return at;
}

// The voxels as they are after unpacking; `unpacked` keeps them where they had to be unpacked.
Expected<std::string_view> voxel_bytes(const NrrdHeader& header, std::string_view bytes, std::size_t at,
                                       std::string_view source, std::string& unpacked) {
    const auto begin = skip_lines(bytes, at, header.line_skip, source);
    if (!begin) return tl::unexpected(begin.error());
    const std::size_t size = header.data_bytes();
    const std::string_view rest = bytes.substr(*begin);
    // Of packed data, the bytes to skip are packed with them.
    const auto skip = static_cast<std::uint64_t>(header.byte_skip < 0 ? 0 : header.byte_skip);
    if (skip > kMaxVolumeFileBytes || size > kMaxVolumeFileBytes) {
        return fail(fmt::format("{}: more than {} bytes of data", source, kMaxVolumeFileBytes));
    }
    const std::size_t value_bytes = sizeof(float) * header.nx * header.ny * header.nz * header.frames;
    if (header.gzip) {
        if (can_inflate_to(rest, skip + size)) {  // Else inflate_gzip_exactly() says so.
            if (auto ok = check_memory(skip + size + value_bytes, source); !ok) return tl::unexpected(ok.error());
        }
        auto all = inflate_gzip_exactly(rest, skip + size, source, *begin);
        if (!all) return tl::unexpected(std::move(all.error()));
        unpacked = std::move(*all);
        return std::string_view(unpacked).substr(skip);
    }
    if (rest.size() < size + skip) {
        return fail(fmt::format("{}: byte {}: the file is cut short: {} bytes of voxels from byte {} on are announced",
                                source, bytes.size(), size, *begin + skip));
    }
    if (auto ok = check_memory(value_bytes, source); !ok) return tl::unexpected(ok.error());
    return rest.substr(header.byte_skip < 0 ? rest.size() - size : skip, size);
}

bool is_whole_type(NumberType type) {
    return type != NumberType::Float32 && type != NumberType::Float64;
}

Expected<VolumeSequence> volumes_of(const NrrdHeader& header, std::string_view voxels, std::string_view source) {
    VolumeSequence sequence;
    const std::size_t frame_bytes = voxels.size() / header.frames;
    for (std::uint32_t f = 0; f < header.frames; ++f) {
        const std::string_view bytes = voxels.substr(f * frame_bytes, frame_bytes);
        SampledVolume volume;
        volume.nx = header.nx;
        volume.ny = header.ny;
        volume.nz = header.nz;
        volume.to_mm = header.to_mm;
        if (header.channels != 0) {
            volume.kind = VolumeKind::Colors;
            volume.colors.resize(volume.voxel_count());
            for (std::size_t n = 0; n < volume.colors.size(); ++n) {
                Rgba& color = volume.colors[n];
                color[3] = 255;
                for (std::size_t c = 0; c < header.channels; ++c) {
                    color[c] = static_cast<std::uint8_t>(bytes[n * header.channels + c]);
                }
            }
        } else {
            volume.kind = header.labels ? VolumeKind::Labels : VolumeKind::Scalar;
            if (auto ok = read_values(bytes, header.format, volume, source); !ok) {
                return tl::unexpected(std::move(ok.error()));
            }
        }
        sequence.frames.push_back(std::move(volume));
    }
    if (!header.labels && is_whole_type(header.format.type)) mark_binary(sequence);
    return sequence;
}

}  // namespace

Expected<VolumeSequence> parse_nrrd(std::string_view bytes, std::string_view source,
                                    const DataFileReader& read_data_file) {
    const auto header = parse_nrrd_header(bytes, source);
    if (!header) return tl::unexpected(header.error());
    std::string unpacked;
    if (header->data_file.empty()) {
        const auto voxels = voxel_bytes(*header, bytes, header->data, source, unpacked);
        if (!voxels) return tl::unexpected(voxels.error());
        return volumes_of(*header, *voxels, source);
    }
    if (!read_data_file) {
        return fail(fmt::format("{}: its data are in the file {}; name the header by its path", source,
                                quoted(header->data_file)));
    }
    auto data = read_data_file(header->data_file);
    if (!data) return tl::unexpected(data.error());
    const std::string data_source = fmt::format("{}: data file {}", source, quoted(header->data_file));
    const auto voxels = voxel_bytes(*header, *data, 0, data_source, unpacked);
    if (!voxels) return tl::unexpected(voxels.error());
    if (header->gzip) std::string().swap(*data);  // The values need the room.
    return volumes_of(*header, *voxels, source);
}

}  // namespace xorvox::io
