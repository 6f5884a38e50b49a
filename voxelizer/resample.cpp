#include "voxelizer/resample.h"

#include <algorithm>
#include <thread>
#include <vector>

#include "voxelizer/volume_place.h"

namespace xorvox {
namespace {

bool fits(const SampledVolume& volume, const Lattice& lattice, const RowRange& rows, const BitVolumeView& out) {
    const bool colors = volume.kind == VolumeKind::Colors;
    const std::size_t entries = colors ? volume.colors.size() : volume.values.size();
    const std::size_t all_rows = std::size_t{lattice.ny} * lattice.nz;
    return volume.nx != 0 && volume.ny != 0 && volume.nz != 0 && entries == volume.voxel_count() &&
           out.nx == lattice.nx && out.ny == lattice.ny && out.nz == lattice.nz &&
           out.words.size() == volume_words(out.nx, out.ny, out.nz) && rows.first <= all_rows &&
           rows.count <= all_rows - rows.first;
}

// Where the samples of a row are in the volume. A row of a regular lattice shares all but its x.
class RegularRow {
public:
    RegularRow(const Lattice& lattice, const glm::dmat4& map, std::uint32_t y, std::uint32_t z)
        : map_(map), origin_x_(lattice.origin.x), pitch_x_(lattice.pitch.x) {
        const glm::dvec3 first = sample_position(lattice, 0, y, z);
        for (int row = 0; row < 3; ++row) rest_[row] = map[1][row] * first.y + (map[2][row] * first.z + map[3][row]);
    }
    glm::dvec3 at(std::uint32_t x) const {
        const double place = origin_x_ + (x + 0.5) * pitch_x_;
        return {map_[0][0] * place + rest_.x, map_[0][1] * place + rest_.y, map_[0][2] * place + rest_.z};
    }

private:
    const glm::dmat4& map_;
    double origin_x_;
    double pitch_x_;
    glm::dvec3 rest_{0.0};
};

class TableRow {
public:
    TableRow(const Lattice& lattice, const glm::dmat4& map, std::uint32_t y, std::uint32_t z)
        : lattice_(lattice), map_(map), y_(y), z_(z) {}
    glm::dvec3 at(std::uint32_t x) const { return mapped(map_, sample_position(lattice_, x, y_, z_)); }

private:
    const Lattice& lattice_;
    const glm::dmat4& map_;
    std::uint32_t y_;
    std::uint32_t z_;
};

template <class Row, class Inside>
void fill(const SampledVolume& volume, const Row& row, std::span<std::uint64_t> words, std::uint32_t nx,
          const Inside& inside) {
    for (std::uint32_t begin = 0; begin < nx; begin += 64) {
        const std::uint32_t end = std::min(begin + 64, nx);
        std::uint64_t word = 0;
        for (std::uint32_t x = begin; x < end; ++x) {
            const glm::dvec3 at = row.at(x);
            if (is_within(volume, at) && inside(at)) word |= std::uint64_t{1} << (x - begin);
        }
        words[begin / 64] = word;
    }
}

template <class Row>
void fill_row(const SampledVolume& volume, double threshold, const Row& row, std::span<std::uint64_t> words,
              std::uint32_t nx) {
    switch (volume.kind) {
        case VolumeKind::Scalar:
            fill(volume, row, words, nx, [&](const glm::dvec3& at) { return value_between(volume, at) >= threshold; });
            break;
        case VolumeKind::Colors:
            fill(volume, row, words, nx,
                 [&](const glm::dvec3& at) { return volume.colors[nearest_voxel(volume, at)][3] != 0; });
            break;
        case VolumeKind::Binary:
        case VolumeKind::Labels:
            fill(volume, row, words, nx,
                 [&](const glm::dvec3& at) { return volume.values[nearest_voxel(volume, at)] != 0.0f; });
            break;
    }
}

}  // namespace

Status resample_rows(const SampledVolume& volume, double threshold, const glm::dmat4& to_volume, const Lattice& lattice,
                     RowRange rows, BitVolumeView out) {
    if (!fits(volume, lattice, rows, out)) return Status::InvalidArgument;
    for (std::size_t number = rows.first; number < rows.first + rows.count; ++number) {
        const auto y = static_cast<std::uint32_t>(number % lattice.ny);
        const auto z = static_cast<std::uint32_t>(number / lattice.ny);
        if (lattice.is_regular()) {
            fill_row(volume, threshold, RegularRow(lattice, to_volume, y, z), out.row(y, z), lattice.nx);
        } else {
            fill_row(volume, threshold, TableRow(lattice, to_volume, y, z), out.row(y, z), lattice.nx);
        }
    }
    return Status::Ok;
}

Status resample(const SampledVolume& volume, double threshold, const glm::dmat4& to_volume, const Lattice& lattice,
                BitVolumeView out, unsigned threads, const std::stop_token& stop) {
    const std::size_t rows = std::size_t{lattice.ny} * lattice.nz;
    if (threads == 0 || !fits(volume, lattice, {0, rows}, out)) return Status::InvalidArgument;
    const auto part = [&](unsigned number) {
        const std::size_t first = rows * number / threads;
        const std::size_t end = rows * (number + 1) / threads;
        for (std::size_t row = first; row < end && !stop.stop_requested(); ++row) {
            // That all fits was seen above.
            (void)resample_rows(volume, threshold, to_volume, lattice, {row, 1}, out);
        }
    };
    {
        std::vector<std::jthread> others;
        for (unsigned number = 1; number < threads; ++number) others.emplace_back(part, number);
        part(0);
    }
    return stop.stop_requested() ? Status::Cancelled : Status::Ok;
}

double otsu_threshold(std::span<const std::span<const float>> frames) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    double total = 0.0;
    for (const std::span<const float> values : frames) {
        if (values.empty()) continue;
        const auto [least_at, most_at] = std::ranges::minmax_element(values);
        least = std::min(least, double{*least_at});
        most = std::max(most, double{*most_at});
        total += static_cast<double>(values.size());
    }
    if (total == 0.0) return 0.0;
    const double span = most - least;
    if (span == 0.0) return least;

    constexpr std::size_t kSteps = 256;
    std::vector<std::uint64_t> histogram(kSteps);
    for (const std::span<const float> values : frames) {
        for (const float value : values) {
            const auto step = static_cast<std::size_t>((double{value} - least) / span * double{kSteps});
            ++histogram[std::min(step, kSteps - 1)];
        }
    }
    double sum = 0.0;
    for (std::size_t step = 0; step < kSteps; ++step) {
        sum += static_cast<double>(step) * static_cast<double>(histogram[step]);
    }
    double below = 0.0;      // How many.
    double below_sum = 0.0;  // Their steps.
    double best = -1.0;
    std::size_t first = 0;  // The splits that are equally good run from here …
    std::size_t last = 0;   // … to here; the middle one is taken.
    for (std::size_t step = 0; step + 1 < kSteps; ++step) {
        below += static_cast<double>(histogram[step]);
        below_sum += static_cast<double>(step) * static_cast<double>(histogram[step]);
        const double above = total - below;
        if (below == 0.0 || above == 0.0) continue;
        const double difference = below_sum / below - (sum - below_sum) / above;
        const double variance = below * above * (difference * difference);
        if (variance > best) {
            best = variance;
            first = step;
        }
        if (variance >= best) last = step;
    }
    return least + span * (static_cast<double>(first + last) / 2.0 + 1.0) / double{kSteps};
}

}  // namespace xorvox
