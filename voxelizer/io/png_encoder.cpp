#include <cstdint>
#include <utility>
#include <vector>

#include "voxelizer/io/png_picture.h"
#include "voxelizer/io/volume_encoders.h"

namespace xorvox::io {
namespace {

class PngEncoder final : public VolumeEncoder {
public:
    Expected<void> begin(VolumeSink&) override { return {}; }

    Expected<void> add(VolumeSink& sink, ConstBitVolumeView slab, std::uint32_t z) override {
        const std::size_t stride = (std::size_t{slab.nx} + 7) / 8;
        rows_.assign(stride * slab.ny, 0);
        for (std::uint32_t y = 0; y < slab.ny; ++y) {
            std::uint8_t* const row = rows_.data() + stride * (slab.ny - 1 - y);
            for (std::uint32_t x = 0; x < slab.nx; ++x) {
                if (slab.test(x, y, z)) row[x / 8] |= static_cast<std::uint8_t>(0x80u >> (x % 8));
            }
        }
        const auto picture = encode_png_bits(slab.nx, slab.ny, rows_);
        if (!picture) return tl::unexpected(picture.error());
        return sink.write(*picture);
    }

    Expected<void> end(VolumeSink&) override { return {}; }

private:
    std::vector<std::uint8_t> rows_;
};

}  // namespace

std::unique_ptr<VolumeEncoder> png_encoder() {
    return std::make_unique<PngEncoder>();
}

}  // namespace xorvox::io
