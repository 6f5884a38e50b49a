// The chunks of MagicaVoxel.
#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/load.h"
#include "voxelizer/io/text_scanner.h"
#include "voxelizer/io/volume_reader.h"
#include "voxelizer/io/vox_file.h"

namespace xorvox::io {
namespace {

constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kChunkHeaderBytes = 12;

// The colours of a file without any: six steps of red, green and blue from light to dark, blue fastest, without the
// last, which is black; then ten steps each of red, green, blue and grey that the first do not have.
std::vector<Rgba> default_palette() {
    std::vector<Rgba> palette{{0, 0, 0, 0}};
    const auto step = [](int n) { return static_cast<std::uint8_t>(255 - 51 * n); };
    for (int n = 0; n < 215; ++n) palette.push_back({step(n / 36), step(n / 6 % 6), step(n % 6), 255});
    for (int channel = 0; channel < 4; ++channel) {
        for (const int part : {14, 13, 11, 10, 8, 7, 5, 4, 2, 1}) {
            const auto code = static_cast<std::uint8_t>(17 * part);
            const auto of = [&](int c) { return channel == c || channel == 3 ? code : std::uint8_t{0}; };
            palette.push_back({of(0), of(1), of(2), 255});
        }
    }
    return palette;
}

class ChunkReader {
public:
    ChunkReader(std::string_view bytes, std::string_view source) : bytes_(bytes), source_(source) {}

    Expected<VoxFile> read() {
        if (!bytes_.starts_with("VOX ")) return wrong(0, "the file does not begin with \"VOX \"");
        if (bytes_.size() < kHeaderBytes + kChunkHeaderBytes) return wrong(bytes_.size(), "the file is cut short");
        const std::uint32_t version = load<std::uint32_t>(bytes_.data() + 4);
        if (version != 150 && version != 200) {
            return wrong(4, fmt::format("version {} is not known; 150 and 200 are read", version));
        }
        if (bytes_.substr(kHeaderBytes, 4) != "MAIN") return wrong(kHeaderBytes, "the chunk MAIN is not there");
        std::size_t at = kHeaderBytes + kChunkHeaderBytes;
        const std::uint64_t own = number(kHeaderBytes + 4);
        const std::uint64_t inner = number(kHeaderBytes + 8);
        if (own + inner > bytes_.size() - at) {
            return wrong(bytes_.size(), fmt::format("the file is cut short: MAIN has {} bytes", own + inner));
        }
        const std::size_t end = at + own + inner;
        at += own;
        while (at < end) {
            if (end - at < kChunkHeaderBytes) return wrong(at, "a chunk is cut short");
            const std::string_view id = bytes_.substr(at, 4);
            const std::uint64_t size = number(at + 4);
            const std::uint64_t children = number(at + 8);
            at += kChunkHeaderBytes;
            if (size + children > end - at) {
                return wrong(at, fmt::format("the chunk {} of {} bytes is cut short", quoted(id), size + children));
            }
            if (auto ok = chunk(id, bytes_.substr(at, size), at); !ok) return tl::unexpected(std::move(ok.error()));
            at += size + children;
        }
        if (size_) return wrong(at, "the last model has a size and no voxels");
        if (file_.models.empty()) return wrong(at, "there is no model in it");
        if (file_.palette.empty()) file_.palette = default_palette();
        file_.bytes = bytes_.size();
        return std::move(file_);
    }

private:
    tl::unexpected<Error> wrong(std::size_t byte, std::string_view what) const {
        return fail(fmt::format("{}: byte {}: {}; write the file again", source_, byte, what));
    }
    std::uint64_t number(std::size_t at) const { return load<std::uint32_t>(bytes_.data() + at); }

    Expected<void> chunk(std::string_view id, std::string_view content, std::size_t at) {
        if (id == "SIZE") return size(content, at);
        if (id == "XYZI") return voxels(content, at);
        if (id == "RGBA") return colors(content, at);
        if (id == "nTRN" || id == "nGRP" || id == "nSHP") return read_vox_node(id, content, source_, at, file_);
        return {};
    }

    Expected<void> size(std::string_view content, std::size_t at) {
        constexpr std::uint32_t kMostSide = 256;  // Voxels have their places in bytes.
        if (size_) return wrong(at, "a size follows a size, where voxels should");
        if (content.size() < 12) return wrong(at, "the chunk SIZE has fewer than 12 bytes");
        glm::uvec3 size;
        for (int axis = 0; axis < 3; ++axis) size[axis] = load<std::uint32_t>(content.data() + 4 * axis);
        if (std::min({size.x, size.y, size.z}) < 1 || std::max({size.x, size.y, size.z}) > kMostSide) {
            return wrong(at, fmt::format("a model of {} × {} × {} voxels; sides are 1 to {}", size.x, size.y, size.z,
                                         kMostSide));
        }
        size_ = size;
        return {};
    }

    Expected<void> voxels(std::string_view content, std::size_t at) {
        if (!size_) return wrong(at, "voxels without a size before them");
        if (content.size() < 4) return wrong(at, "the chunk XYZI has fewer than 4 bytes");
        const std::uint64_t count = load<std::uint32_t>(content.data());
        if (4 + 4 * count > content.size()) {
            return wrong(at, fmt::format("{} voxels are announced, and the chunk has {} bytes", count, content.size()));
        }
        const VoxModel model{*size_, content.substr(4, 4 * count)};
        for (std::size_t n = 0; n < model.voxels.size(); n += 4) {
            for (int axis = 0; axis < 3; ++axis) {
                const auto place = static_cast<unsigned char>(model.voxels[n + static_cast<std::size_t>(axis)]);
                if (place < model.size[axis]) continue;
                return wrong(at + 4 + n, fmt::format("voxel {} is at {} along {}, and the model has {}", n / 4, place,
                                                     "xyz"[axis], model.size[axis]));
            }
        }
        file_.models.push_back(model);
        size_.reset();
        return {};
    }

    Expected<void> colors(std::string_view content, std::size_t at) {
        if (content.size() < 1024) return wrong(at, "the chunk RGBA has fewer than 1024 bytes");
        file_.palette.assign(256, Rgba{});
        // Colour n of the chunk is that of number n + 1; the last one is of none.
        for (std::size_t n = 0; n < 255; ++n) {
            for (std::size_t c = 0; c < 4; ++c) {
                file_.palette[n + 1][c] = static_cast<std::uint8_t>(content[4 * n + c]);
            }
        }
        return {};
    }

    std::string_view bytes_;
    std::string_view source_;
    VoxFile file_;
    std::optional<glm::uvec3> size_;  // Of the model whose voxels come next.
};

}  // namespace

Expected<VoxFile> read_vox_chunks(std::string_view bytes, std::string_view source) {
    return ChunkReader(bytes, source).read();
}

Expected<VolumeSequence> parse_vox(std::string_view bytes, std::string_view source) {
    const auto file = read_vox_chunks(bytes, source);
    if (!file) return tl::unexpected(file.error());
    return place_vox_models(*file, source);
}

}  // namespace xorvox::io
