// NIfTI-1 and 2; https://nifti.nimh.nih.gov.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "voxelizer/io/inflate.h"
#include "voxelizer/io/load.h"
#include "voxelizer/io/memory.h"
#include "voxelizer/io/text_scanner.h"
#include "voxelizer/io/volume_reader.h"
#include "voxelizer/io/voxel_numbers.h"

namespace xorvox::io {
namespace {

constexpr std::size_t kBytes1 = 348;
constexpr std::size_t kBytes2 = 540;
constexpr std::size_t kMostBytes = 544;  // Of a header, with the four that say whether extensions follow.

constexpr std::int64_t kRgb24 = 128;
constexpr std::int64_t kRgba32 = 2304;
constexpr std::int64_t kLabelIntent = 1002;

struct Header {
    std::int64_t dim[8] = {};
    std::int64_t datatype = 0;
    std::int64_t intent = 0;
    double pixdim[8] = {};
    double vox_offset = 0;
    double slope = 0;
    double intercept = 0;
    std::int64_t units = 0;
    std::int64_t qform = 0;
    std::int64_t sform = 0;
    double quatern[3] = {};
    double qoffset[3] = {};
    double srow[3][4] = {};
    std::endian order = std::endian::little;
    std::size_t header_bytes = kBytes1;
};

// Reads fields of a header, by its own byte order.
struct Fields {
    std::string_view bytes;
    std::endian order;

    template <class T>
    T at(std::size_t byte) const {
        return load<T>(bytes.data() + byte, order);
    }
};

Header header1(const Fields& f) {
    Header h;
    for (std::size_t n = 0; n < 8; ++n) {
        h.dim[n] = f.at<std::int16_t>(40 + 2 * n);
        h.pixdim[n] = double{f.at<float>(76 + 4 * n)};
    }
    h.intent = f.at<std::int16_t>(68);
    h.datatype = f.at<std::int16_t>(70);
    h.vox_offset = double{f.at<float>(108)};
    h.slope = double{f.at<float>(112)};
    h.intercept = double{f.at<float>(116)};
    h.units = f.at<std::uint8_t>(123);
    h.qform = f.at<std::int16_t>(252);
    h.sform = f.at<std::int16_t>(254);
    for (std::size_t n = 0; n < 3; ++n) {
        h.quatern[n] = double{f.at<float>(256 + 4 * n)};
        h.qoffset[n] = double{f.at<float>(268 + 4 * n)};
        for (std::size_t c = 0; c < 4; ++c) h.srow[n][c] = double{f.at<float>(280 + 16 * n + 4 * c)};
    }
    return h;
}

Header header2(const Fields& f) {
    Header h;
    for (std::size_t n = 0; n < 8; ++n) {
        h.dim[n] = f.at<std::int64_t>(16 + 8 * n);
        h.pixdim[n] = f.at<double>(104 + 8 * n);
    }
    h.datatype = f.at<std::int16_t>(12);
    h.vox_offset = static_cast<double>(f.at<std::int64_t>(168));
    h.slope = f.at<double>(176);
    h.intercept = f.at<double>(184);
    h.qform = f.at<std::int32_t>(344);
    h.sform = f.at<std::int32_t>(348);
    for (std::size_t n = 0; n < 3; ++n) {
        h.quatern[n] = f.at<double>(352 + 8 * n);
        h.qoffset[n] = f.at<double>(376 + 8 * n);
        for (std::size_t c = 0; c < 4; ++c) h.srow[n][c] = f.at<double>(400 + 32 * n + 8 * c);
    }
    h.units = f.at<std::int32_t>(500);
    h.intent = f.at<std::int32_t>(504);
    h.header_bytes = kBytes2;
    return h;
}

class Reader {
public:
    explicit Reader(std::string_view source) : source_(source) {}

    Expected<void> read_header(std::string_view bytes) {
        if (bytes.size() < 4) return wrong(bytes.size(), "the file is cut short in its header");
        for (const std::endian order : {std::endian::little, std::endian::big}) {
            const Fields fields{bytes, order};
            const auto size = fields.at<std::uint32_t>(0);
            if (size != kBytes1 && size != kBytes2) continue;
            if (bytes.size() < size + 4) return wrong(bytes.size(), "the file is cut short in its header");
            const std::string_view magic = size == kBytes1 ? bytes.substr(344, 4) : bytes.substr(4, 4);
            if (magic == std::string_view("ni1\0", 4) || magic == std::string_view("ni2\0", 4)) {
                return wrong(size == kBytes1 ? 344 : 4,
                             "the voxels are in another file, .img; write header and voxels into one .nii");
            }
            if (magic != (size == kBytes1 ? std::string_view("n+1\0", 4) : std::string_view("n+2\0", 4))) {
                return wrong(size == kBytes1 ? 344 : 4, "this is no NIfTI header, whose magic is n+1 or n+2");
            }
            header_ = size == kBytes1 ? header1(fields) : header2(fields);
            header_.order = order;
            return check_header();
        }
        return wrong(0, "the file does not begin with the size of a NIfTI header, 348 or 540");
    }

    /// Of the whole file, unpacked.
    std::size_t file_bytes() const { return first_ + frame_bytes_ * frames_; }

    std::size_t value_bytes() const { return sizeof(float) * volume_.voxel_count() * frames_; }

    Expected<VolumeSequence> volumes(std::string_view bytes) const {
        if (bytes.size() < file_bytes()) {
            return wrong(bytes.size(),
                         fmt::format("the file is cut short; its header announces {} bytes", file_bytes()));
        }
        if (auto ok = check_memory(value_bytes(), source_); !ok) return tl::unexpected(std::move(ok.error()));
        VolumeSequence sequence;
        for (std::size_t frame = 0; frame < frames_; ++frame) {
            SampledVolume volume = volume_;
            const auto voxels = bytes.substr(first_ + frame * frame_bytes_, frame_bytes_);
            if (channels_ != 0) {
                colors(voxels, volume);
            } else if (auto ok = read_values(voxels, format_, volume, source_); !ok) {
                return tl::unexpected(std::move(ok.error()));
            }
            sequence.frames.push_back(std::move(volume));
        }
        const bool whole = format_.type != NumberType::Float32 && format_.type != NumberType::Float64;
        if (whole) mark_binary(sequence);
        return sequence;
    }

private:
    tl::unexpected<Error> wrong(std::size_t byte, std::string_view what) const {
        return fail(fmt::format("{}: byte {}: {}", source_, byte, what));
    }

    Expected<void> check_header() {
        for (const auto step : {&Reader::shape, &Reader::type, &Reader::meaning, &Reader::placement}) {
            if (auto ok = (this->*step)(); !ok) return ok;
        }
        return {};
    }

    Expected<void> shape() {
        const std::size_t where = header_.header_bytes == kBytes1 ? 40 : 16;
        const auto& dim = header_.dim;
        if (dim[0] < 1 || dim[0] > 7) return wrong(where, fmt::format("{} dimensions; 1 to 7 are possible", dim[0]));
        std::uint64_t sides[7] = {1, 1, 1, 1, 1, 1, 1};
        for (std::int64_t n = 0; n < dim[0]; ++n) {
            if (dim[n + 1] < 1) return wrong(where, fmt::format("side {} is {}", n + 1, dim[n + 1]));
            sides[n] = static_cast<std::uint64_t>(dim[n + 1]);
        }
        if (sides[4] != 1 || sides[5] != 1 || sides[6] != 1) {
            return wrong(where, fmt::format("{} dimensions; three of space and one of time are read", dim[0]));
        }
        if (auto ok = check_sides(sides[0], sides[1], sides[2], source_, fmt::format("byte {}", where)); !ok) return ok;
        if (sides[3] > kMaxVolumeFrames) {
            return wrong(where, fmt::format("{} frames; at most {} are read", sides[3], kMaxVolumeFrames));
        }
        volume_.nx = static_cast<std::uint32_t>(sides[0]);
        volume_.ny = static_cast<std::uint32_t>(sides[1]);
        volume_.nz = static_cast<std::uint32_t>(sides[2]);
        frames_ = sides[3];
        return {};
    }

    Expected<void> type() {
        struct Datatype {
            std::int64_t code;
            NumberType type;
        };
        constexpr Datatype kTypes[] = {{2, NumberType::UInt8},    {4, NumberType::Int16},    {8, NumberType::Int32},
                                       {16, NumberType::Float32}, {64, NumberType::Float64}, {256, NumberType::Int8},
                                       {512, NumberType::UInt16}, {768, NumberType::UInt32}, {1024, NumberType::Int64},
                                       {1280, NumberType::UInt64}};
        format_.order = header_.order;
        const auto* known = std::ranges::find(kTypes, header_.datatype, &Datatype::code);
        std::size_t bytes = 0;
        if (header_.datatype == kRgb24 || header_.datatype == kRgba32) {
            channels_ = header_.datatype == kRgb24 ? 3 : 4;
            volume_.kind = VolumeKind::Colors;
            bytes = channels_;
        } else if (known != std::end(kTypes)) {
            format_.type = known->type;
            volume_.kind = VolumeKind::Scalar;
            bytes = bytes_of(known->type);
        } else {
            return wrong(header_.header_bytes == kBytes1 ? 70 : 12,
                         fmt::format("voxels of type {}{} are not read; convert them to numbers of 8 to 64 bits, or "
                                     "RGB24",
                                     header_.datatype, name_of(header_.datatype)));
        }
        frame_bytes_ = volume_.voxel_count() * bytes;
        const double offset = header_.vox_offset;
        if (!(offset >= static_cast<double>(header_.header_bytes) && offset <= 1e9) || offset != std::floor(offset)) {
            return wrong(header_.header_bytes == kBytes1 ? 108 : 168,
                         fmt::format("the voxels begin at byte {}, which is not behind the header", offset));
        }
        first_ = static_cast<std::size_t>(offset);
        if (file_bytes() > kMaxVolumeFileBytes) {
            return wrong(0, fmt::format("more than {} bytes of voxels", kMaxVolumeFileBytes));
        }
        return {};
    }

    static std::string_view name_of(std::int64_t datatype) {
        switch (datatype) {
            case 0: return " (unknown)";
            case 1: return " (bits)";
            case 32: return " (complex, 64 bits)";
            case 1536: return " (float, 128 bits)";
            case 1792: return " (complex, 128 bits)";
            case 2048: return " (complex, 256 bits)";
            default: return "";
        }
    }

    Expected<void> meaning() {
        const bool scaled = header_.slope != 0.0 && channels_ == 0;  // 0: the numbers are what is meant.
        if (scaled) {
            format_.slope = header_.slope;
            format_.intercept = header_.intercept;
            if (!std::isfinite(format_.slope) || !std::isfinite(format_.intercept)) {
                return wrong(header_.header_bytes == kBytes1 ? 112 : 176,
                             fmt::format("the values are scaled by {} and {}", format_.slope, format_.intercept));
            }
        }
        if (header_.intent == kLabelIntent && channels_ == 0) volume_.kind = VolumeKind::Labels;
        return {};
    }

    Expected<void> placement() {
        double unit = 1.0;
        switch (header_.units & 7) {
            case 0:  // Not told.
            case 2: break;
            case 1: unit = 1000.0; break;
            case 3: unit = 1e-3; break;
            default: return wrong(0, fmt::format("the unit of space {} is not known", header_.units & 7));
        }
        glm::dmat4& m = volume_.to_mm;
        if (header_.sform > 0) {
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 4; ++column) m[column][row] = unit * header_.srow[row][column];
            }
        } else {
            glm::dmat3 turn(1.0);
            glm::dvec3 offset(0.0);
            glm::dvec3 pitch(0.0);
            for (int axis = 0; axis < 3; ++axis) pitch[axis] = header_.pixdim[axis + 1];
            if (header_.qform > 0) {
                turn = rotation();
                if (header_.pixdim[0] < 0.0) pitch.z = -pitch.z;
                for (int axis = 0; axis < 3; ++axis) offset[axis] = header_.qoffset[axis];
            } else {
                for (int axis = 0; axis < 3; ++axis) {
                    if (axis >= header_.dim[0] || pitch[axis] == 0.0) pitch[axis] = 1.0;
                }
            }
            for (int axis = 0; axis < 3; ++axis) m[axis] = glm::dvec4(turn[axis] * (pitch[axis] * unit), 0.0);
            m[3] = glm::dvec4(offset * unit, 1.0);
        }
        return check_placement(volume_, source_, "header");
    }

    // Of the unit quaternion, of which the header has three parts and the fourth is not below 0.
    glm::dmat3 rotation() const {
        const double b = header_.quatern[0];
        const double c = header_.quatern[1];
        const double d = header_.quatern[2];
        const double a = std::sqrt(std::max(0.0, 1.0 - (b * b + c * c + d * d)));
        return {{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
                {2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
                {2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c}};
    }

    void colors(std::string_view bytes, SampledVolume& volume) const {
        volume.colors.resize(volume.voxel_count());
        for (std::size_t n = 0; n < volume.colors.size(); ++n) {
            volume.colors[n][3] = 255;
            for (std::size_t c = 0; c < channels_; ++c) {
                volume.colors[n][c] = static_cast<std::uint8_t>(bytes[n * channels_ + c]);
            }
        }
    }

    std::string_view source_;
    Header header_;
    SampledVolume volume_;  // What all frames share.
    NumberFormat format_;
    std::size_t channels_ = 0;
    std::size_t frames_ = 1;
    std::size_t first_ = 0;  // Where the voxels begin.
    std::size_t frame_bytes_ = 0;
};

}  // namespace

Expected<VolumeSequence> parse_nifti(std::string_view bytes, std::string_view source) {
    Reader reader(source);
    if (!bytes.starts_with("\x1f\x8b")) {
        if (auto ok = reader.read_header(bytes); !ok) return tl::unexpected(std::move(ok.error()));
        return reader.volumes(bytes);
    }
    const auto begin = inflate_gzip(bytes, kMostBytes, source);
    if (!begin) return tl::unexpected(begin.error());
    if (auto ok = reader.read_header(*begin); !ok) return tl::unexpected(std::move(ok.error()));
    if (!can_inflate_to(bytes, reader.file_bytes())) {
        return fail(fmt::format("{}: {} bytes of gzip data cannot hold the {} bytes that the header announces", source,
                                bytes.size(), reader.file_bytes()));
    }
    if (auto ok = check_memory(reader.file_bytes() + reader.value_bytes(), source); !ok) {
        return tl::unexpected(std::move(ok.error()));
    }
    const auto all = inflate_gzip(bytes, reader.file_bytes(), source);
    if (!all) return tl::unexpected(all.error());
    return reader.volumes(*all);
}

}  // namespace xorvox::io
