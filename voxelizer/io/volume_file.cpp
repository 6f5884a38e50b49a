#include "voxelizer/io/volume_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "voxelizer/io/atomic_file.h"
#include "voxelizer/io/file_name.h"

namespace xorvox::io {
namespace {

// The voxels of a byte of the volume, one byte each.
constexpr auto kSpread = [] {
    std::array<std::array<char, 8>, 256> spread{};
    for (std::size_t byte = 0; byte < 256; ++byte) {
        for (std::size_t bit = 0; bit < 8; ++bit) spread[byte][bit] = static_cast<char>((byte >> bit) & 1);
    }
    return spread;
}();

Expected<void> write_nrrd(AtomicFile& file, ConstBitVolumeView volume, const Lattice& lattice) {
    const glm::dvec3 centre = sample_position(lattice, 0, 0, 0);
    const glm::dvec3 pitch = lattice.pitch;
    const std::string header = fmt::format(
        "NRRD0004\n"
        "type: uint8\n"
        "dimension: 3\n"
        "space dimension: 3\n"
        "sizes: {} {} {}\n"
        "space directions: ({},0,0) (0,{},0) (0,0,{})\n"
        "kinds: domain domain domain\n"
        "endian: little\n"
        "encoding: raw\n"
        "space origin: ({},{},{})\n"
        "\n",
        volume.nx, volume.ny, volume.nz, pitch.x, pitch.y, pitch.z, centre.x, centre.y, centre.z);
    if (auto ok = file.write(header); !ok) return ok;

    const std::size_t padded = row_words(volume.nx) * 64;
    std::vector<char> layer(std::size_t{volume.nx} * volume.ny + padded);  // The last row's padding runs over.
    for (std::uint32_t z = 0; z < volume.nz; ++z) {
        char* to = layer.data();
        for (std::uint32_t y = 0; y < volume.ny; ++y, to += volume.nx) {
            const auto bytes = std::as_bytes(volume.row(y, z));
            for (std::size_t i = 0; i < bytes.size(); ++i) {
                std::memcpy(to + 8 * i, kSpread[std::to_integer<std::size_t>(bytes[i])].data(), 8);
            }
        }
        if (auto ok = file.write({layer.data(), std::size_t{volume.nx} * volume.ny}); !ok) return ok;
    }
    return {};
}

// Runs of equal voxels as binvox has them: a byte 0 or 1, a byte for the length.
class RunWriter {
public:
    explicit RunWriter(AtomicFile& file) : file_(file) {}

    Expected<void> add(bool value, std::uint64_t length) {
        if (value == value_) {
            length_ += length;
            return {};
        }
        auto ok = end_run();
        value_ = value;
        length_ = length;
        return ok;
    }
    Expected<void> finish() {
        if (auto ok = end_run(); !ok) return ok;
        return flush();
    }

private:
    static constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

    Expected<void> end_run() {
        while (length_ > 0) {
            const std::uint64_t part = std::min<std::uint64_t>(length_, 255);
            buffer_ += static_cast<char>(value_);
            buffer_ += static_cast<char>(part);
            length_ -= part;
            if (buffer_.size() >= kBufferBytes) {
                if (auto ok = flush(); !ok) return ok;
            }
        }
        return {};
    }
    Expected<void> flush() {
        auto ok = file_.write(buffer_);
        buffer_.clear();
        return ok;
    }

    AtomicFile& file_;
    std::string buffer_;
    bool value_ = false;
    std::uint64_t length_ = 0;
};

Expected<void> write_binvox(AtomicFile& file, ConstBitVolumeView volume, const Lattice& lattice) {
    const std::uint64_t n = std::max({volume.nx, volume.ny, volume.nz});
    const std::string header =
        fmt::format("#binvox 1\ndim {} {} {}\ntranslate {} {} {}\nscale {}\ndata\n", n, n, n, lattice.origin.x,
                    lattice.origin.y, lattice.origin.z, lattice.pitch.x * static_cast<double>(n));
    if (auto ok = file.write(header); !ok) return ok;

    RunWriter runs(file);
    // 64 columns of x at a time: their words, gathered once, are read again for each x.
    std::vector<std::uint64_t> words(std::size_t{volume.ny} * volume.nz);
    for (std::uint32_t x = 0; x < volume.nx; ++x) {
        if (x % 64 == 0) {
            for (std::size_t row = 0; row < words.size(); ++row)
                words[row] = volume.words[row * row_words(volume.nx) + x / 64];
        }
        for (std::uint32_t z = 0; z < volume.nz; ++z) {
            for (std::uint32_t y = 0; y < volume.ny; ++y) {
                const bool value = (words[std::size_t{z} * volume.ny + y] >> (x % 64)) & 1;
                if (auto ok = runs.add(value, 1); !ok) return ok;
            }
            if (auto ok = runs.add(false, n - volume.ny); !ok) return ok;
        }
        if (auto ok = runs.add(false, (n - volume.nz) * n); !ok) return ok;
    }
    if (auto ok = runs.add(false, (n - volume.nx) * n * n); !ok) return ok;
    return runs.finish();
}

Expected<void> write_bits(AtomicFile& file, ConstBitVolumeView volume, const Lattice& lattice) {
    struct Header {
        std::array<char, 8> magic{'X', 'V', 'B', 'I', 'T', 'S', '\r', '\n'};
        std::uint32_t version = 1;
        std::uint32_t nx, ny, nz;
        std::array<double, 3> origin, pitch;
    };
    static_assert(sizeof(Header) == 72 && offsetof(Header, nx) == 12 && offsetof(Header, origin) == 24);
    Header header;
    header.nx = volume.nx;
    header.ny = volume.ny;
    header.nz = volume.nz;
    header.origin = {lattice.origin.x, lattice.origin.y, lattice.origin.z};
    header.pitch = {lattice.pitch.x, lattice.pitch.y, lattice.pitch.z};
    const auto bytes = std::bit_cast<std::array<char, sizeof(Header)>>(header);
    if (auto ok = file.write({bytes.data(), bytes.size()}); !ok) return ok;
    return file.write({reinterpret_cast<const char*>(volume.words.data()), volume.size_bytes()});
}

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

Expected<void> check(const std::string& path, Format format, ConstBitVolumeView volume, const Lattice& lattice) {
    const std::string name = printable_name(path);
    if (!lattice.is_regular()) {
        return fail(fmt::format("{}: volumes on a table of sample points cannot be written; use a regular grid", name));
    }
    if (const Status status = validate(lattice); status != Status::Ok) {
        return fail(fmt::format("{}: the lattice is not valid ({})", name, to_string(status)));
    }
    if (volume.nx != lattice.nx || volume.ny != lattice.ny || volume.nz != lattice.nz ||
        volume.words.size() != volume_words(volume.nx, volume.ny, volume.nz)) {
        return fail(fmt::format("{}: a volume of {}×{}×{} is not on a lattice of {}×{}×{}", name, volume.nx, volume.ny,
                                volume.nz, lattice.nx, lattice.ny, lattice.nz));
    }
    const glm::dvec3 pitch = lattice.pitch;
    if (format == Format::Binvox && (pitch.x != pitch.y || pitch.x != pitch.z)) {
        return fail(fmt::format("{}: binvox has one pitch for all axes, not {}, {} and {}; write .nrrd or .bits", name,
                                pitch.x, pitch.y, pitch.z));
    }
    return {};
}

}  // namespace

Expected<void> check_volume_path(const std::string& path) {
    auto format = format_of(path);
    if (!format) return tl::unexpected(std::move(format.error()));
    return {};
}

Expected<void> write_volume(const std::string& path, ConstBitVolumeView volume, const Lattice& lattice) {
    auto format = format_of(path);
    if (!format) return tl::unexpected(std::move(format.error()));
    if (auto ok = check(path, *format, volume, lattice); !ok) return ok;
    auto file = AtomicFile::create(path);
    if (!file) return tl::unexpected(std::move(file.error()));
    const auto write = *format == Format::Nrrd ? write_nrrd : *format == Format::Binvox ? write_binvox : write_bits;
    if (auto ok = write(*file, volume, lattice); !ok) return ok;
    return file->commit();
}

}  // namespace xorvox::io
