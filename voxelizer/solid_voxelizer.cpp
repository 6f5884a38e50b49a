#include "voxelizer/solid_voxelizer.h"

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "voxelizer/solid_state.h"

namespace xorvox {

using namespace kernels;

SolidVoxelizer::SolidVoxelizer(SolidOptions options) {
    const auto available = available_kernels();
    if (std::find(available.begin(), available.end(), options.kernel) == available.end()) {
        options.kernel = best_kernel();
    }
    constexpr std::size_t kMostEventBytes = std::size_t{1} << (8 * sizeof(std::size_t) - 8);
    options.event_bytes = std::min(options.event_bytes, kMostEventBytes);
    state_ = std::make_unique<State>(std::move(options));
}

SolidVoxelizer::~SolidVoxelizer() = default;
SolidVoxelizer::SolidVoxelizer(SolidVoxelizer&&) noexcept = default;
SolidVoxelizer& SolidVoxelizer::operator=(SolidVoxelizer&&) noexcept = default;

Kernel SolidVoxelizer::kernel() const {
    return state_->table->kernel;
}

unsigned SolidVoxelizer::threads() const {
    return state_->workers.count();
}

SolidTimes SolidVoxelizer::times() const {
    return state_->times;
}

Status SolidVoxelizer::set_mesh(const MeshView& mesh, SolidReport* report) {
    SolidReport found;
    const Status status = validate(mesh, &found.bad_index);
    if (report != nullptr) *report = found;
    if (status != Status::Ok) return status;
    state_->mesh = mesh;
    state_->has_mesh = true;
    state_->points_are_snapped = state_->keys_are_packed = false;
    return Status::Ok;
}

Status SolidVoxelizer::set_positions(std::span<const glm::dvec3> positions) {
    if (!state_->has_mesh || positions.size() != state_->mesh.positions.size()) return Status::InvalidArgument;
    state_->mesh.positions = positions;
    state_->points_are_snapped = state_->keys_are_packed = false;
    return Status::Ok;
}

Status SolidVoxelizer::set_lattice(const Lattice& lattice) try {
    if (const Status status = validate(lattice); status != Status::Ok) return status;
    State& s = *state_;
    const SnapGrid grid = snap_grid(lattice);
    std::vector<glm::dvec2> plan(lattice.plan.begin(), lattice.plan.end());
    std::vector<double> z0(lattice.z0.begin(), lattice.z0.end());
    std::vector<double> z(lattice.z.begin(), lattice.z.end());
    const bool same_grid =
        s.has_lattice && s.grid.origin == grid.origin && s.grid.length == grid.length && s.grid.shift == grid.shift;
    if (!same_grid) s.points_are_snapped = false;
    s.keys_are_packed = false;
    s.region.reset();
    s.lattice = lattice;
    s.plan = std::move(plan);
    s.z0 = std::move(z0);
    s.z = std::move(z);
    s.lattice.plan = s.plan;
    s.lattice.z0 = s.z0;
    s.lattice.z = s.z;
    s.grid = grid;
    s.has_lattice = true;
    return Status::Ok;
} catch (const std::bad_alloc&) {
    return Status::OutOfMemory;
}

Status SolidVoxelizer::solid(BitVolumeView out, SolidReport* report) {
    return solid(whole(state_->lattice), out, report);
}

Status SolidVoxelizer::solid(const Region& region, BitVolumeView out, SolidReport* report) {
    return state_->run(report, [&](SolidReport& found) {
        if (!state_->has_mesh || !state_->fits(out, region)) return Status::InvalidArgument;
        state_->prepare_region(region, Below::Counts, false);
        return state_->solid(nullptr, out, nullptr, found);
    });
}

Status SolidVoxelizer::solid(const MeshBatches& next, const Region& region, BitVolumeView out, SolidReport* report) {
    return state_->run(report, [&](SolidReport& found) {
        if (!next || !state_->fits(out, region)) return Status::InvalidArgument;
        state_->prepare_region(region, Below::Counts, false);
        return state_->solid(&next, out, nullptr, found);
    });
}

Status SolidVoxelizer::crossings(const Region& region, CrossingLists& lists, SolidReport* report) {
    return state_->run(report, [&](SolidReport& found) {
        if (!state_->has_mesh || !state_->has_lattice || !is_inside(region, state_->lattice)) {
            return Status::InvalidArgument;
        }
        state_->prepare_region(region, Below::Counts, true);
        return state_->crossings(lists, found);
    });
}

Status SolidVoxelizer::slabs(std::uint32_t layers, const SlabSink& sink, SolidReport* report) {
    return state_->run(report, [&](SolidReport& found) {
        State& s = *state_;
        if (!s.has_mesh || !s.has_lattice || layers == 0 || !sink) return Status::InvalidArgument;
        const Lattice& lattice = s.lattice;
        const std::uint32_t most = std::min(layers, lattice.nz);
        const std::size_t layer_words = volume_words(lattice.nx, lattice.ny, 1);
        std::vector<std::uint64_t> words(layer_words * most);
        std::vector<std::uint64_t> carry(layer_words);
        for (std::uint32_t begin = 0; begin < lattice.nz; begin += most) {
            const std::uint32_t count = std::min(most, lattice.nz - begin);
            s.progress_from = static_cast<double>(begin) / lattice.nz;
            s.progress_to = static_cast<double>(begin + count) / lattice.nz;
            // The lowest slab is told layer by layer as well, because it ends with parities for the next one.
            s.prepare_region({{0, 0, begin}, {lattice.nx, lattice.ny, count}},
                             begin == 0 ? Below::Counts : Below::Dropped, true);
            const BitVolumeView volume{std::span(words).first(layer_words * count), lattice.nx, lattice.ny, count};
            if (const Status status = s.solid(nullptr, volume, carry.data(), found); status != Status::Ok)
                return status;
            if (!sink(volume, begin)) return Status::Cancelled;
        }
        return Status::Ok;
    });
}

std::size_t SolidVoxelizer::memory_bytes(std::size_t vertices, const Lattice& lattice) const {
    const State& s = *state_;
    const std::size_t layer_bytes = volume_words(lattice.nx, lattice.ny, 1) * sizeof(std::uint64_t);
    const std::size_t threads = s.workers.count();
    std::size_t bytes = vertices * (sizeof(glm::ivec3) + sizeof(std::uint32_t)) + sizeof(glm::ivec3) + sizeof(State);
    bytes += threads * (EventBins::reserved_bytes(lattice.nz, s.options.event_bytes / threads) + layer_bytes +
                        sizeof(Events) + sizeof(Waiting) + sizeof(SolidPart));
    if (!lattice.is_regular()) {
        bytes += TablePlan::bytes(lattice.column_count()) +
                 lattice.column_count() * (sizeof(glm::dvec2) + sizeof(double)) + lattice.nz * sizeof(double);
    }
    return bytes;
}

}  // namespace xorvox
