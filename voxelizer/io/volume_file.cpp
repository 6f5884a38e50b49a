#include "voxelizer/io/volume_file.h"

#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/volume_encoders.h"

namespace xorvox::io {
namespace {

enum class Format : std::uint8_t { Nrrd, Binvox, Bits };

Expected<Format> format_of(const std::string& path) {
    const std::string name = printable_name(path);
    const std::string extension = extension_of(path);
    if (!extension.empty() && std::filesystem::path(path).filename().string().size() == extension.size()) {
        return fail(fmt::format("{}: has no name before its extension; name a file, such as volume.nrrd", name));
    }
    if (extension == ".nrrd") return Format::Nrrd;
    if (extension == ".binvox") return Format::Binvox;
    if (extension == ".bits") return Format::Bits;
    return fail(fmt::format("{}: the extension '{}' is of no known volume format; use .nrrd, .binvox or .bits", name,
                            printable_name(extension)));
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
    return {};
}

tl::unexpected<Error> wrong_shape(const std::string& name, ConstBitVolumeView volume, const Lattice& lattice) {
    return fail(fmt::format("{}: a volume of {}×{}×{} is not on a lattice of {}×{}×{}", name, volume.nx, volume.ny,
                            volume.nz, lattice.nx, lattice.ny, lattice.nz));
}

std::unique_ptr<VolumeEncoder> encoder_of(Format format, const Lattice& lattice) {
    switch (format) {
        case Format::Nrrd: return nrrd_encoder(lattice);
        case Format::Binvox: return binvox_encoder(lattice);
        case Format::Bits: break;
    }
    return bits_encoder(lattice);
}

}  // namespace

Expected<void> check_volume_path(const std::string& path) {
    auto format = format_of(path);
    if (!format) return tl::unexpected(std::move(format.error()));
    return {};
}

struct VolumeWriter::State {
    std::string name;
    SlabAxis axis;
    Lattice lattice;
    std::stop_token stop;
    std::function<void(double)> progress;
    AtomicFile file;
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
            if (auto ok = encoder->add(file, slab, i); !ok) return ok;
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
                                            std::function<void(double)> progress) {
    auto format = format_of(path);
    if (!format) return tl::unexpected(std::move(format.error()));
    std::string name = printable_name(path);
    if (auto ok = check(name, *format, lattice); !ok) return tl::unexpected(std::move(ok.error()));
    auto file = AtomicFile::create(path);
    if (!file) return tl::unexpected(std::move(file.error()));
    auto state = std::make_unique<State>(State{std::move(name), *format == Format::Binvox ? SlabAxis::X : SlabAxis::Z,
                                               lattice, std::move(stop), std::move(progress), std::move(*file),
                                               encoder_of(*format, lattice)});
    if (auto ok = state->encoder->begin(state->file); !ok) return tl::unexpected(std::move(ok.error()));
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
    if (auto ok = state.encoder->end(state.file); !ok) return ok;
    return state.file.commit();
}

Expected<void> write_volume(const std::string& path, ConstBitVolumeView volume, const Lattice& lattice,
                            std::stop_token stop) {
    auto writer = VolumeWriter::create(path, lattice, std::move(stop));
    if (!writer) return tl::unexpected(std::move(writer.error()));
    if (volume.nx != lattice.nx || volume.ny != lattice.ny || volume.nz != lattice.nz) {
        return wrong_shape(printable_name(path), volume, lattice);
    }
    if (auto ok = writer->write(volume, 0); !ok) return ok;
    return writer->commit();
}

}  // namespace xorvox::io
