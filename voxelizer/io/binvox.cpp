#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include "voxelizer/io/memory.h"
#include "voxelizer/io/text_scanner.h"
#include "voxelizer/io/volume_reader.h"
#include "voxelizer/io/voxel_numbers.h"

namespace xorvox::io {
namespace {

struct Header {
    std::uint32_t version = 0;
    std::uint32_t dim[3] = {};  // x, z and y: y runs fastest, then z, then x.
    glm::dvec3 translate{0.0};
    double scale = 1.0;
    std::size_t data = 0;  // Where its first byte is.
};

class HeaderReader {
public:
    HeaderReader(std::string_view bytes, std::string_view source) : bytes_(bytes), source_(source), text_(bytes) {}

    Expected<Header> read() {
        Header header;
        if (!text_.next_line() || text_.word() != "#binvox") return wrong("the file does not begin with #binvox");
        const std::string_view version = text_.word();
        if (version != "1" && version != "2") {
            return wrong(fmt::format("version {} is not known; 1 and 2 are read", quoted(version)));
        }
        header.version = version == "1" ? 1 : 2;
        for (;;) {
            if (const auto more = text_.word(); !more.empty()) {
                return wrong(fmt::format("{} stands where the line should end", quoted(more)));
            }
            if (!text_.next_line()) return wrong("there is no line \"data\", after which the voxels would begin");
            const std::string_view key = text_.word();
            if (key == "data") return end(header);
            if (key == "dim") {
                if (auto ok = dim(header); !ok) return tl::unexpected(std::move(ok.error()));
            } else if (key == "translate") {
                for (int axis = 0; axis < 3; ++axis) {
                    if (const char* why = number(header.translate[axis])) return wrong(why);
                }
            } else if (key == "scale") {
                if (const char* why = number(header.scale)) return wrong(why);
                if (!(header.scale > 0.0)) return wrong("the scale must be above 0");
            } else if (!key.starts_with('#')) {
                return wrong(fmt::format("the word {} is not known; dim, translate, scale and data are", quoted(key)));
            } else {
                text_.skip_line();
            }
        }
    }

private:
    tl::unexpected<Error> wrong(std::string_view what) const {
        return fail(fmt::format("{}: line {}: {}; write the file again", source_, text_.line(), what));
    }

    const char* number(double& value) {
        const std::string_view word = text_.word();
        return word.empty() ? "three numbers follow translate, one scale" : read_number(word, value);
    }

    Expected<void> dim(Header& header) {
        for (std::uint32_t& side : header.dim) {
            std::int64_t value = 0;
            const std::string_view word = text_.word();
            if (read_number(word, value) != nullptr || value < 1 || value > SampledVolume::kMostSide) {
                return wrong(fmt::format("three sides from 1 to {} follow dim; found {}", SampledVolume::kMostSide,
                                         quoted(word)));
            }
            side = static_cast<std::uint32_t>(value);
        }
        return check_sides(header.dim[0], header.dim[2], header.dim[1], source_, fmt::format("line {}", text_.line()));
    }

    Expected<Header> end(Header& header) {
        if (header.dim[0] == 0) return wrong("there is no line dim before the data");
        text_.skip_line();
        header.data = bytes_.size() - text_.bytes_left() + 1;  // Behind the newline.
        if (text_.bytes_left() == 0) return wrong("the file is cut short after its header");
        return header;
    }

    std::string_view bytes_;
    std::string_view source_;
    TextScanner text_;
};

SampledVolume empty_volume(const Header& header) {
    SampledVolume volume;
    volume.kind = header.version == 1 ? VolumeKind::Binary : VolumeKind::Labels;
    volume.nx = header.dim[0];
    volume.ny = header.dim[2];
    volume.nz = header.dim[1];
    // Other writers than binvox itself have unequal sides; the longest is then the one that `scale` tells.
    const double pitch = header.scale / static_cast<double>(std::max({volume.nx, volume.ny, volume.nz}));
    for (int axis = 0; axis < 3; ++axis) {
        volume.to_mm[axis][axis] = pitch;
        volume.to_mm[3][axis] = header.translate[axis] + pitch / 2.0;
    }
    return volume;
}

}  // namespace

Expected<VolumeSequence> parse_binvox(std::string_view bytes, std::string_view source) {
    const auto header = HeaderReader(bytes, source).read();
    if (!header) return tl::unexpected(header.error());
    SampledVolume volume = empty_volume(*header);
    if (auto ok = check_placement(volume, source, "header"); !ok) return tl::unexpected(std::move(ok.error()));

    const std::size_t count = volume.voxel_count();
    const std::string_view runs = bytes.substr(header->data);
    std::size_t told = 0;
    std::size_t at = 0;
    for (; at + 1 < runs.size() && told < count; at += 2) {
        const auto value = static_cast<unsigned char>(runs[at]);
        if (value > 1 && header->version == 1) {
            return fail(fmt::format("{}: byte {}: the value {} in a file of version 1, which has 0 and 1", source,
                                    header->data + at, value));
        }
        told += static_cast<unsigned char>(runs[at + 1]);
    }
    if (told != count) {
        return fail(fmt::format("{}: byte {}: the runs hold {}{} voxels and the header announces {}; {}", source,
                                header->data + at, told > count ? "at least " : "", told, count,
                                told < count ? "the file is cut short" : "write the file again"));
    }
    if (runs.size() - at > 1 || (runs.size() > at && runs[at] != '\n')) {
        return fail(fmt::format("{}: byte {}: {} bytes more follow the last voxel; write the file again", source,
                                header->data + at, runs.size() - at));
    }

    if (auto ok = check_memory(sizeof(float) * count, source); !ok) return tl::unexpected(std::move(ok.error()));
    volume.values.resize(count);
    std::size_t n = 0;  // Of the file's order.
    for (std::size_t run = 0; run < at; run += 2) {
        const std::size_t end = n + static_cast<unsigned char>(runs[run + 1]);
        if (runs[run] == 0) {
            n = end;
            continue;
        }
        const auto value = static_cast<float>(static_cast<unsigned char>(runs[run]));
        for (; n < end; ++n) {
            const auto y = static_cast<std::uint32_t>(n % volume.ny);
            const auto z = static_cast<std::uint32_t>(n / volume.ny % volume.nz);
            const auto x = static_cast<std::uint32_t>(n / volume.ny / volume.nz);
            volume.values[volume.index(x, y, z)] = value;
        }
    }
    VolumeSequence sequence;
    sequence.frames.push_back(std::move(volume));
    return sequence;
}

}  // namespace xorvox::io
