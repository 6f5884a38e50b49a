#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "voxelizer/io/volume_encoders.h"

namespace xorvox::io {
namespace {

void append(std::string& to, std::size_t number) {
    const auto value = static_cast<std::uint32_t>(number);
    char bytes[4];
    std::memcpy(bytes, &value, 4);
    to.append(bytes, 4);
}

void append_chunk(std::string& to, std::string_view id, std::string_view content) {
    to += id;
    append(to, content.size());
    append(to, 0);  // No chunks within.
    to += content;
}

// The file tells its sizes first: voxels are kept to the end, at most 64 MiB.
class VoxEncoder final : public VolumeEncoder {
public:
    explicit VoxEncoder(const Lattice& lattice) : lattice_(lattice) {}

    Expected<void> begin(VolumeSink&) override { return {}; }

    Expected<void> add(VolumeSink&, ConstBitVolumeView slab, std::uint32_t index) override {
        for (std::uint32_t y = 0; y < slab.ny; ++y) {
            for (std::uint32_t x = 0; x < slab.nx; ++x) {
                if (!slab.test(x, y, index)) continue;
                voxels_ += {static_cast<char>(x), static_cast<char>(y), static_cast<char>(z_), kColor};
            }
        }
        ++z_;
        return {};
    }

    Expected<void> end(VolumeSink& sink) override {
        std::string size;
        for (const std::uint32_t side : {lattice_.nx, lattice_.ny, lattice_.nz}) append(size, side);
        std::string count;
        append(count, voxels_.size() / 4);
        std::string chunks;
        append_chunk(chunks, "SIZE", size);
        append_chunk(chunks, "XYZI", count + voxels_);
        append_chunk(chunks, "RGBA", std::string(1024, '\xff'));
        std::string file = "VOX ";
        append(file, 150);
        file += "MAIN";
        append(file, 0);
        append(file, chunks.size());
        return sink.write(file + chunks);
    }

private:
    static constexpr char kColor = 1;

    Lattice lattice_;
    std::uint32_t z_ = 0;
    std::string voxels_;
};

}  // namespace

std::unique_ptr<VolumeEncoder> vox_encoder(const Lattice& lattice) {
    return std::make_unique<VoxEncoder>(lattice);
}

}  // namespace xorvox::io
