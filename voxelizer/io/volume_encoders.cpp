#include "voxelizer/io/volume_encoders.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

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

class NrrdEncoder final : public VolumeEncoder {
public:
    NrrdEncoder(const Lattice& lattice, bool gzip) : lattice_(lattice), gzip_(gzip) {}

    Expected<void> begin(VolumeSink& sink) override {
        const glm::dvec3 centre = sample_position(lattice_, 0, 0, 0);
        const glm::dvec3 pitch = lattice_.pitch;
        return sink.write_plain(
            fmt::format("NRRD0004\n"
                        "type: uint8\n"
                        "dimension: 3\n"
                        "space dimension: 3\n"
                        "sizes: {} {} {}\n"
                        "space directions: ({},0,0) (0,{},0) (0,0,{})\n"
                        "kinds: domain domain domain\n"
                        "endian: little\n"
                        "encoding: {}\n"
                        "space origin: ({},{},{})\n"
                        "\n",
                        lattice_.nx, lattice_.ny, lattice_.nz, pitch.x, pitch.y, pitch.z, gzip_ ? "gzip" : "raw",
                        centre.x, centre.y, centre.z));
    }

    Expected<void> add(VolumeSink& sink, ConstBitVolumeView slab, std::uint32_t z) override {
        return sink.write(layer_bytes(slab, z, layer_));
    }

    Expected<void> end(VolumeSink&) override { return {}; }

private:
    Lattice lattice_;
    bool gzip_;
    std::vector<char> layer_;
};

class BitsEncoder final : public VolumeEncoder {
public:
    explicit BitsEncoder(const Lattice& lattice) {
        header_.nx = lattice.nx;
        header_.ny = lattice.ny;
        header_.nz = lattice.nz;
        header_.origin = {lattice.origin.x, lattice.origin.y, lattice.origin.z};
        header_.pitch = {lattice.pitch.x, lattice.pitch.y, lattice.pitch.z};
    }

    Expected<void> begin(VolumeSink& sink) override {
        const auto bytes = std::bit_cast<std::array<char, sizeof(Header)>>(header_);
        return sink.write({bytes.data(), bytes.size()});
    }
    Expected<void> add(VolumeSink& sink, ConstBitVolumeView slab, std::uint32_t z) override {
        const std::size_t layer_words = row_words(slab.nx) * slab.ny;
        const auto layer = slab.words.subspan(z * layer_words, layer_words);
        return sink.write({reinterpret_cast<const char*>(layer.data()), layer.size_bytes()});
    }
    Expected<void> end(VolumeSink&) override { return {}; }

private:
    struct Header {
        std::array<char, 8> magic{'X', 'V', 'B', 'I', 'T', 'S', '\r', '\n'};
        std::uint32_t version = 1;
        std::uint32_t nx, ny, nz;
        std::array<double, 3> origin, pitch;
    };
    static_assert(sizeof(Header) == 72 && offsetof(Header, nx) == 12 && offsetof(Header, origin) == 24);

    Header header_;
};

// Runs of equal voxels as binvox has them: a byte 0 or 1, a byte for the length.
class Runs {
public:
    Expected<void> add(VolumeSink& sink, bool value, std::uint64_t length) {
        if (length == 0) return {};  // Which would cut a run of the other value.
        if (value == value_) {
            length_ += length;
            return {};
        }
        auto ok = end_run(sink);
        value_ = value;
        length_ = length;
        return ok;
    }
    Expected<void> end(VolumeSink& sink) {
        if (auto ok = end_run(sink); !ok) return ok;
        return flush(sink);
    }

private:
    static constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

    Expected<void> end_run(VolumeSink& sink) {
        while (length_ > 0) {
            const std::uint64_t part = std::min<std::uint64_t>(length_, 255);
            buffer_ += static_cast<char>(value_);
            buffer_ += static_cast<char>(part);
            length_ -= part;
            if (buffer_.size() >= kBufferBytes) {
                if (auto ok = flush(sink); !ok) return ok;
            }
        }
        return {};
    }
    Expected<void> flush(VolumeSink& sink) {
        auto ok = sink.write(buffer_);
        buffer_.clear();
        return ok;
    }

    std::string buffer_;
    bool value_ = false;
    std::uint64_t length_ = 0;
};

class BinvoxEncoder final : public VolumeEncoder {
public:
    explicit BinvoxEncoder(const Lattice& lattice)
        : lattice_(lattice), side_(std::max({lattice.nx, lattice.ny, lattice.nz})) {}

    Expected<void> begin(VolumeSink& sink) override {
        return sink.write_plain(fmt::format("#binvox 1\ndim {0} {0} {0}\ntranslate {1} {2} {3}\nscale {4}\ndata\n",
                                            side_, lattice_.origin.x, lattice_.origin.y, lattice_.origin.z,
                                            lattice_.pitch.x * static_cast<double>(side_)));
    }

    Expected<void> add(VolumeSink& sink, ConstBitVolumeView slab, std::uint32_t x) override {
        // 64 planes at a time: their words, gathered once, are read again for each x.
        if (x % 64 == 0) gather(slab, x / 64);
        for (std::uint32_t z = 0; z < slab.nz; ++z) {
            for (std::uint32_t y = 0; y < slab.ny; ++y) {
                const bool value = (words_[std::size_t{z} * slab.ny + y] >> (x % 64)) & 1;
                if (auto ok = runs_.add(sink, value, 1); !ok) return ok;
            }
            if (auto ok = runs_.add(sink, false, side_ - slab.ny); !ok) return ok;
        }
        return runs_.add(sink, false, (side_ - slab.nz) * side_);
    }

    Expected<void> end(VolumeSink& sink) override {
        if (auto ok = runs_.add(sink, false, (side_ - lattice_.nx) * side_ * side_); !ok) return ok;
        return runs_.end(sink);
    }

private:
    void gather(ConstBitVolumeView slab, std::size_t word) {
        words_.resize(std::size_t{slab.ny} * slab.nz);
        const std::size_t words_a_row = row_words(slab.nx);
        for (std::size_t row = 0; row < words_.size(); ++row) words_[row] = slab.words[row * words_a_row + word];
    }

    Lattice lattice_;
    std::uint64_t side_;
    std::vector<std::uint64_t> words_;
    Runs runs_;
};

}  // namespace

std::string_view layer_bytes(ConstBitVolumeView slab, std::uint32_t z, std::vector<char>& bytes) {
    const std::size_t size = std::size_t{slab.nx} * slab.ny;
    bytes.resize(size + row_words(slab.nx) * 64);  // The last row's padding runs over.
    char* to = bytes.data();
    for (std::uint32_t y = 0; y < slab.ny; ++y, to += slab.nx) {
        const auto row = std::as_bytes(slab.row(y, z));
        for (std::size_t i = 0; i < row.size(); ++i) {
            std::memcpy(to + 8 * i, kSpread[std::to_integer<std::size_t>(row[i])].data(), 8);
        }
    }
    return {bytes.data(), size};
}

std::unique_ptr<VolumeEncoder> nrrd_encoder(const Lattice& lattice, bool gzip) {
    return std::make_unique<NrrdEncoder>(lattice, gzip);
}

std::unique_ptr<VolumeEncoder> bits_encoder(const Lattice& lattice) {
    return std::make_unique<BitsEncoder>(lattice);
}

std::unique_ptr<VolumeEncoder> binvox_encoder(const Lattice& lattice) {
    return std::make_unique<BinvoxEncoder>(lattice);
}

}  // namespace xorvox::io
