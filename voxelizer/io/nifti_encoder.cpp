#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "voxelizer/io/volume_encoders.h"

namespace xorvox::io {
namespace {

// https://nifti.nimh.nih.gov/pub/dist/src/niftilib/nifti1.h; fields that stay 0 are not named one by one.
struct Header {
    std::int32_t sizeof_hdr = 348;
    std::array<char, 34> analyze{};
    char regular = 'r';
    std::uint8_t dim_info = 0;
    std::array<std::int16_t, 8> dim{3, 1, 1, 1, 1, 1, 1, 1};
    std::array<float, 3> intent_p{};
    std::int16_t intent_code = 0;
    std::int16_t datatype = 2;  // uint8
    std::int16_t bitpix = 8;
    std::int16_t slice_start = 0;
    std::array<float, 8> pixdim{1, 1, 1, 1, 0, 0, 0, 0};
    float vox_offset = 352;
    float scl_slope = 1;
    float scl_inter = 0;
    std::int16_t slice_end = 0;
    std::uint8_t slice_code = 0;
    std::uint8_t xyzt_units = 2;  // mm
    float cal_max = 1;
    std::array<float, 3> cal_min_to_toffset{};
    std::array<std::int32_t, 2> analyze_limits{};
    std::array<char, 104> texts{};
    std::int16_t qform_code = 2;  // Aligned with something else: the lattice.
    std::int16_t sform_code = 2;
    std::array<float, 3> quatern{};  // No rotation.
    std::array<float, 3> qoffset{};
    std::array<std::array<float, 4>, 3> srow{};
    std::array<char, 16> intent_name{};
    std::array<char, 4> magic{'n', '+', '1', '\0'};
    std::array<char, 4> extension{};  // None.
};
static_assert(sizeof(Header) == 352 && offsetof(Header, dim) == 40 && offsetof(Header, pixdim) == 76 &&
              offsetof(Header, xyzt_units) == 123 && offsetof(Header, qform_code) == 252 &&
              offsetof(Header, srow) == 280 && offsetof(Header, magic) == 344);

class NiftiEncoder final : public VolumeEncoder {
public:
    explicit NiftiEncoder(const Lattice& lattice) {
        const glm::dvec3 first = sample_position(lattice, 0, 0, 0);
        const std::array<std::uint32_t, 3> sides{lattice.nx, lattice.ny, lattice.nz};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto number = static_cast<int>(axis);
            const auto pitch = static_cast<float>(lattice.pitch[number]);
            header_.dim[axis + 1] = static_cast<std::int16_t>(sides[axis]);
            header_.pixdim[axis + 1] = pitch;
            header_.qoffset[axis] = static_cast<float>(first[number]);
            header_.srow[axis][axis] = pitch;
            header_.srow[axis][3] = header_.qoffset[axis];
        }
    }

    Expected<void> begin(VolumeSink& sink) override {
        const auto bytes = std::bit_cast<std::array<char, sizeof(Header)>>(header_);
        return sink.write({bytes.data(), bytes.size()});
    }
    Expected<void> add(VolumeSink& sink, ConstBitVolumeView slab, std::uint32_t z) override {
        return sink.write(layer_bytes(slab, z, layer_));
    }
    Expected<void> end(VolumeSink&) override { return {}; }

private:
    Header header_;
    std::vector<char> layer_;
};

}  // namespace

std::unique_ptr<VolumeEncoder> nifti_encoder(const Lattice& lattice) {
    return std::make_unique<NiftiEncoder>(lattice);
}

}  // namespace xorvox::io
