#include "voxelizer/io/volume_file.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/volume_encoders.h"

namespace xorvox::io {
namespace {

enum class Format : std::uint8_t { Nrrd, Binvox, Bits, Nifti, NiftiGz, Vox, Png };

constexpr std::uint32_t kMostVoxSide = 256;

Expected<Format> format_of(const std::string& path, const VolumeWriteOptions& options) {
    const std::string name = printable_name(path);
    const std::string extension = volume_extension_of(path);
    if (!extension.empty() && std::filesystem::path(path).filename().string().size() == extension.size()) {
        return fail(fmt::format("{}: has no name before its extension; name a file, such as volume.nrrd", name));
    }
    if (options.gzip && extension != ".nrrd") {
        return fail(fmt::format("{}: only .nrrd is packed on request; .nii.gz says it by its name", name));
    }
    if (extension == ".nrrd") return Format::Nrrd;
    if (extension == ".binvox") return Format::Binvox;
    if (extension == ".bits") return Format::Bits;
    if (extension == ".nii") return Format::Nifti;
    if (extension == ".nii.gz") return Format::NiftiGz;
    if (extension == ".vox") return Format::Vox;
    if (extension == ".png") return Format::Png;
    return fail(
        fmt::format("{}: the extension '{}' is of no known volume format; use .nrrd, .binvox, .nii, .nii.gz, .vox, "
                    ".png or .bits",
                    name, printable_name(extension)));
}

Expected<void> check(const std::string& name, Format format, const Lattice& lattice) {
    if (!lattice.is_regular()) {
        return fail(fmt::format("{}: volumes on a table of sample points cannot be written; use a regular grid", name));
    }
    if (const Status status = validate(lattice); status != Status::Ok) {
        return fail(fmt::format("{}: the lattice is not valid ({})", name, to_string(status)));
    }
    const glm::dvec3 pitch = lattice.pitch;
    if (format == Format::Binvox && (pitch.x != pitch.y || pitch.x != pitch.z)) {
        return fail(fmt::format("{}: binvox has one pitch for all axes, not {}, {} and {}; write .nrrd or .bits", name,
                                pitch.x, pitch.y, pitch.z));
    }
    if (format == Format::Vox) {
        if (pitch.x != pitch.y || pitch.x != pitch.z) {
            return fail(fmt::format("{}: voxels of MagicaVoxel are cubes, not {} × {} × {}; write .nrrd or .nii", name,
                                    pitch.x, pitch.y, pitch.z));
        }
        if (std::max({lattice.nx, lattice.ny, lattice.nz}) > kMostVoxSide) {
            return fail(
                fmt::format("{}: a model of MagicaVoxel has at most {} voxels a side, not {} × {} × {}; choose "
                            "a smaller grid, or write .nrrd or .nii",
                            name, kMostVoxSide, lattice.nx, lattice.ny, lattice.nz));
        }
    }
    return {};
}

tl::unexpected<Error> wrong_shape(const std::string& name, ConstBitVolumeView volume, const Lattice& lattice) {
    return fail(fmt::format("{}: a volume of {}×{}×{} is not on a lattice of {}×{}×{}", name, volume.nx, volume.ny,
                            volume.nz, lattice.nx, lattice.ny, lattice.nz));
}

std::unique_ptr<VolumeEncoder> encoder_of(Format format, const Lattice& lattice, const VolumeWriteOptions& options) {
    switch (format) {
        case Format::Nrrd: return nrrd_encoder(lattice, options.gzip);
        case Format::Binvox: return binvox_encoder(lattice);
        case Format::Nifti:
        case Format::NiftiGz: return nifti_encoder(lattice);
        case Format::Vox: return vox_encoder(lattice);
        case Format::Png: return png_encoder();
        case Format::Bits: break;
    }
    return bits_encoder(lattice);
}

Expected<std::unique_ptr<VolumeSink>> sink_of(Format format, const std::string& path, const Lattice& lattice,
                                              const VolumeWriteOptions& options) {
    if (format == Format::Png) return picture_sink(path, lattice.nz);
    return file_sink(path, options.gzip || format == Format::NiftiGz);
}

}  // namespace

Expected<void> check_volume_path(const std::string& path, const VolumeWriteOptions& options) {
    auto format = format_of(path, options);
    if (!format) return tl::unexpected(std::move(format.error()));
    return {};
}

struct VolumeWriter::State {
    std::string name;
    SlabAxis axis;
    Lattice lattice;
    std::stop_token stop;
    std::function<void(double)> progress;
    std::unique_ptr<VolumeSink> sink;
    std::unique_ptr<VolumeEncoder> encoder;
    std::uint32_t written = 0;  // Planes.

    std::uint32_t planes() const { return axis == SlabAxis::X ? lattice.nx : lattice.nz; }

    Expected<void> add(ConstBitVolumeView slab, std::uint32_t first) {
        const bool along_x = axis == SlabAxis::X;
        const std::uint32_t count = along_x ? slab.nx : slab.nz;
        const bool across = slab.ny == lattice.ny && (along_x ? slab.nz == lattice.nz : slab.nx == lattice.nx);
        if (!across || slab.words.size() != volume_words(slab.nx, slab.ny, slab.nz)) {
            return wrong_shape(name, slab, lattice);
        }
        if (first != written || count > planes() - written) {
            return fail(fmt::format("{}: {} planes from plane {} along {} do not follow the {} of {} that are written",
                                    name, count, first, along_x ? 'x' : 'z', written, planes()));
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            if (stop.stop_requested()) return fail(name + ": stopped; nothing was written");
            if (auto ok = encoder->add(*sink, slab, i); !ok) return ok;
            ++written;
            if (progress) progress(static_cast<double>(written) / planes());
        }
        return {};
    }
};

VolumeWriter::VolumeWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
VolumeWriter::VolumeWriter(VolumeWriter&&) noexcept = default;
VolumeWriter& VolumeWriter::operator=(VolumeWriter&&) noexcept = default;
VolumeWriter::~VolumeWriter() = default;

Expected<VolumeWriter> VolumeWriter::create(const std::string& path, const Lattice& lattice, std::stop_token stop,
                                            std::function<void(double)> progress, const VolumeWriteOptions& options) {
    auto format = format_of(path, options);
    if (!format) return tl::unexpected(std::move(format.error()));
    std::string name = printable_name(path);
    if (auto ok = check(name, *format, lattice); !ok) return tl::unexpected(std::move(ok.error()));
    auto sink = sink_of(*format, path, lattice, options);
    if (!sink) return tl::unexpected(std::move(sink.error()));
    auto state = std::make_unique<State>(State{std::move(name), *format == Format::Binvox ? SlabAxis::X : SlabAxis::Z,
                                               lattice, std::move(stop), std::move(progress), std::move(*sink),
                                               encoder_of(*format, lattice, options)});
    if (auto ok = state->encoder->begin(*state->sink); !ok) return tl::unexpected(std::move(ok.error()));
    return VolumeWriter(std::move(state));
}

SlabAxis VolumeWriter::slab_axis() const {
    return state_->axis;
}

Expected<void> VolumeWriter::write(ConstBitVolumeView slab, std::uint32_t first) {
    return state_->add(slab, first);
}

Expected<void> VolumeWriter::commit() {
    State& state = *state_;
    if (state.written != state.planes()) {
        return fail(fmt::format("{}: only {} of {} planes are written", state.name, state.written, state.planes()));
    }
    if (auto ok = state.encoder->end(*state.sink); !ok) return ok;
    return state.sink->commit();
}

Expected<void> write_volume(const std::string& path, ConstBitVolumeView volume, const Lattice& lattice,
                            std::stop_token stop, const VolumeWriteOptions& options) {
    auto writer = VolumeWriter::create(path, lattice, std::move(stop), {}, options);
    if (!writer) return tl::unexpected(std::move(writer.error()));
    if (volume.nx != lattice.nx || volume.ny != lattice.ny || volume.nz != lattice.nz) {
        return wrong_shape(printable_name(path), volume, lattice);
    }
    if (auto ok = writer->write(volume, 0); !ok) return ok;
    return writer->commit();
}

}  // namespace xorvox::io
