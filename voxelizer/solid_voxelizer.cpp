#include "voxelizer/solid_voxelizer.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "voxelizer/faces.h"
#include "voxelizer/kernels/kernel_table.h"
#include "voxelizer/kernels/layers.h"
#include "voxelizer/kernels/triangle_source.h"
#include "voxelizer/resize_exactly.h"
#include "voxelizer/workers.h"

namespace xorvox {
namespace {

using namespace kernels;

/// Volumes larger than this do not stay in a cache, and are written past it.
constexpr std::size_t kStreamBytes = std::size_t{24} << 20;

/// Of the work on a mesh, what finding its crossings takes, for the progress that is told.
constexpr double kCrossShare = 0.7;

class Stopwatch {
public:
    explicit Stopwatch(double& milliseconds) : milliseconds_(milliseconds) {}
    ~Stopwatch() {
        milliseconds_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& milliseconds_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Where a thread is in its part of a mesh, and what it has found.
struct Part {
    TriangleSource source;
    Triangles block;
    BlockProgress progress;
    bool done = false;
};

}  // namespace

struct SolidVoxelizer::State {
    explicit State(SolidOptions given);

    bool fits(const BitVolumeView& out, const Region& region) const;
    void prepare_region(const Region& region, Below below, bool by_layer);
    Status snap(const MeshView& mesh, SolidReport& report);
    void pack(std::size_t begin, std::size_t count);
    void pack_all();
    template <class Flush>
    Status cross(const MeshView& mesh, double share, const Flush& flush);
    bool cross_more(Part& at, unsigned part, double share);
    void flush(bool first, BitVolumeView out);
    void finish(bool out_has_events, std::uint64_t* carry, BitVolumeView out);
    Status solid(const MeshBatches* next, BitVolumeView out, std::uint64_t* carry, SolidReport& report);
    Status crossings(CrossingLists& lists, SolidReport& report);

    /// Calls job(report), with what every call begins and ends with.
    template <class Job>
    Status run(SolidReport* report, const Job& job) {
        SolidReport ignored;
        SolidReport& found = report == nullptr ? ignored : *report;
        found = {};
        times = {};
        progress_from = 0;
        progress_to = 1;
        told = 0;
        try {
            return job(found);
        } catch (const std::bad_alloc&) {
            forget();
            return Status::OutOfMemory;
        } catch (...) {  // Of a caller's function.
            forget();
            throw;
        }
    }
    void forget() {
        region.reset();
        points_are_snapped = keys_are_packed = false;
    }
    bool is_stopped() const { return options.stop.stop_requested(); }
    /// How much of the call, or of its slab, is done; less than before is not told.
    void tell(double fraction) {
        told = std::max(told, progress_from + (progress_to - progress_from) * fraction);
        if (options.progress) options.progress(told);
    }
    LayerRange layers_of(unsigned part) const {
        const std::uint64_t nz = region->size.z;
        return {static_cast<std::uint32_t>(nz * part / workers.count()),
                static_cast<std::uint32_t>(nz * (part + 1) / workers.count())};
    }
    void clear_events(SolidReport& report) {
        for (Events& each : events) {
            report.crossings += each.count();
            each.clear();
        }
    }

    SolidOptions options;
    const KernelTable* table;
    Workers workers;
    // One of each for each thread.
    std::vector<Events> events;
    std::vector<Waiting> waiting;
    std::vector<Part> parts;
    std::vector<std::vector<std::uint64_t>> parities;  // A layer.
    std::vector<char> good;

    MeshView mesh;
    bool has_mesh = false;

    Lattice lattice;  // Its tables are the three below.
    bool has_lattice = false;
    std::vector<glm::dvec2> plan;
    std::vector<double> z0, z;
    SnapGrid grid;

    // What has been worked out, and for what.
    std::vector<glm::ivec3> points;  // One more than there are vertices: kPointSlack.
    std::vector<std::uint32_t> keys;
    bool points_are_snapped = false;
    bool keys_are_packed = false;
    std::optional<Region> region;
    RegularPlan regular;
    TablePlan tables;

    SolidTimes times;
    double progress_from = 0;
    double progress_to = 1;
    double told = 0;
};

SolidVoxelizer::State::State(SolidOptions given)
    : options(std::move(given)),
      table(&kernel_table(options.kernel)),
      workers(std::clamp(options.threads, 1u, kMaxSolidThreads)),
      events(workers.count()),
      waiting(workers.count()),
      parities(workers.count()),
      good(workers.count()) {
    parts.reserve(workers.count());
}

bool SolidVoxelizer::State::fits(const BitVolumeView& out, const Region& r) const {
    return has_lattice && is_inside(r, lattice) && out.nx == r.size.x && out.ny == r.size.y && out.nz == r.size.z &&
           out.words.size() == volume_words(r.size.x, r.size.y, r.size.z);
}

/// The plan of a region, and room for its events, unless they are there.
void SolidVoxelizer::State::prepare_region(const Region& wanted, Below below, bool by_layer) {
    const bool same = region && *region == wanted;
    const bool same_columns = region && region->begin.x == wanted.begin.x && region->begin.y == wanted.begin.y &&
                              region->size.x == wanted.size.x && region->size.y == wanted.size.y;
    region.reset();
    if (lattice.is_regular()) {
        regular = {RegularColumns(wanted, grid), static_cast<std::uint32_t>(row_words(wanted.size.x) * 64), below,
                   wanted.size.z < lattice.nz};
        if (!same_columns) keys_are_packed = false;
    } else {
        if (!same_columns) {
            tables.assign_columns(lattice, grid, wanted);
            keys_are_packed = false;
        }
        if (!same) tables.assign_heights(lattice, grid, wanted.begin.z, wanted.size.z);
        tables.set_below(below);
    }
    const std::size_t layer_words = volume_words(wanted.size.x, wanted.size.y, 1);
    const std::size_t bytes = options.event_bytes / workers.count();
    for (unsigned part = 0; part < workers.count(); ++part) {
        events[part].reserve(wanted.size.z, layer_words * 64, bytes, by_layer);
        if (parities[part].size() < layer_words) resize_exactly(parities[part], layer_words);
    }
    region = wanted;
}

/// Snaps and packs the vertices of `from`, whose indices are in range.
Status SolidVoxelizer::State::snap(const MeshView& from, SolidReport& report) {
    const Stopwatch watch(times.snap_ms);
    const std::size_t count = from.positions.size();
    points_are_snapped = keys_are_packed = false;
    resize_exactly(points, count + 1);
    resize_exactly(keys, count);
    workers.run([&](unsigned part) {
        const std::size_t end = count * (part + 1) / workers.count();
        good[part] = 1;
        // Some at a time, so that they are packed while they are in the cache.
        constexpr std::size_t kStep = 1024;
        for (std::size_t begin = count * part / workers.count(); begin < end; begin += kStep) {
            const std::size_t some = std::min(kStep, end - begin);
            if (!table->snap(grid, &from.positions[begin], some, &points[begin])) good[part] = 0;
            pack(begin, some);
        }
    });
    if (std::find(good.begin(), good.end(), 0) != good.end()) {
        if (!snap_vertices(from, grid, std::span(points).first(count), report.bad_vertex)) return Status::OutOfRange;
        pack(0, count);
    }
    points_are_snapped = keys_are_packed = true;
    return Status::Ok;
}

/// The keys of snapped vertices begin … begin + count - 1.
void SolidVoxelizer::State::pack(std::size_t begin, std::size_t count) {
    if (count == 0) return;
    if (lattice.is_regular()) {
        table->pack_regular(regular, &points[begin], count, &keys[begin]);
    } else {
        table->pack_table(tables, &points[begin], count, &keys[begin]);
    }
}

/// The keys of all snapped vertices, for another region.
void SolidVoxelizer::State::pack_all() {
    const Stopwatch watch(times.snap_ms);
    workers.run([&](unsigned part) {
        const std::size_t begin = keys.size() * part / workers.count();
        pack(begin, keys.size() * (part + 1) / workers.count() - begin);
    });
    keys_are_packed = true;
}

/// Pushes events of a thread's part until it is done, or there is no room for more.
bool SolidVoxelizer::State::cross_more(Part& at, unsigned part, double share) {
    const Vertices vertices{points.data(), keys.data()};
    // Lanes of vertex numbers are signed.
    const bool has_lanes = keys.size() <= std::size_t{std::numeric_limits<std::int32_t>::max()};
    const KernelTable& kernel = has_lanes ? *table : kScalarTable;
    while (!is_stopped()) {
        if (at.progress.triangle == at.block.count) {
            at.block = at.source.next();
            at.progress = {};
            if (part == 0) tell(share * at.source.fraction());
        }
        const bool ends = at.block.count == 0;
        bool done = false;
        if (lattice.is_regular()) {
            done = ends ? kernel.cross_waiting_regular(regular, waiting[part], events[part])
                        : kernel.cross_regular(regular, vertices, at.block, at.progress, waiting[part], events[part]);
        } else {
            done = ends ? kernel.cross_waiting_table(tables, waiting[part], events[part])
                        : kernel.cross_table(tables, vertices, at.block, at.progress, waiting[part], events[part]);
        }
        if (ends) return done;
        if (!done) return false;
        at.progress.triangle = at.block.count;
    }
    return false;
}

/// Pushes all events, `share` of what is to be told as progress; calls flush(), which empties them, whenever there is
/// no room for more.
template <class Flush>
Status SolidVoxelizer::State::cross(const MeshView& from, double share, const Flush& flush) {
    const std::span<const std::uint32_t> list = triangle_list(from);
    parts.clear();
    for (unsigned part = 0; part < workers.count(); ++part) {
        parts.push_back({{from, list, std::span(points).first(keys.size()), part, workers.count()}, {}, {}, false});
        for (auto& batch : waiting[part].small.batches) batch.count = 0;
        waiting[part].pairs.count = 0;
    }
    while (true) {
        {
            const Stopwatch watch(times.cross_ms);
            workers.run([&](unsigned part) {
                if (!parts[part].done) parts[part].done = cross_more(parts[part], part, share);
            });
        }
        if (is_stopped()) return Status::Cancelled;
        if (std::all_of(parts.begin(), parts.end(), [](const Part& at) { return at.done; })) return Status::Ok;
        flush();
    }
}

/// Puts the binned events into `out`, where they wait for finish().
void SolidVoxelizer::State::flush(bool first, BitVolumeView out) {
    const Stopwatch watch(times.finish_ms);
    workers.run([&](unsigned part) { add_events(events, layers_of(part), first, out); });
}

/// Makes all events bits of `out`. `carry`, if not null, has the parities below the region, and then those of its
/// highest layer.
void SolidVoxelizer::State::finish(bool out_has_events, std::uint64_t* carry, BitVolumeView out) {
    const Stopwatch watch(times.finish_ms);
    const std::size_t words = volume_words(out.nx, out.ny, 1);
    if (!events[0].columns().empty()) {
        workers.run([&](unsigned part) {
            finish_columns(events, words * part / workers.count(), words * (part + 1) / workers.count(), out);
        });
        return;
    }
    const bool stream = out.size_bytes() > kStreamBytes;
    // Each thread has its own layers, which begin with the parities of all layers below.
    if (workers.count() > 1) {
        workers.run([&](unsigned part) {
            std::fill_n(parities[part].begin(), words, 0);
            apply_events(events, layers_of(part), parities[part].data(), out_has_events ? &out : nullptr);
        });
    } else {
        std::fill_n(parities[0].begin(), words, 0);
    }
    for (std::size_t i = 0; i < words; ++i) {
        std::uint64_t below = carry == nullptr ? 0 : carry[i];
        for (auto& layer : parities) below ^= std::exchange(layer[i], below);
    }
    workers.run([&](unsigned part) {
        const LayerRange layers = layers_of(part);
        constexpr std::uint32_t kStep = 32;
        for (std::uint32_t k = layers.begin; k < layers.end && !is_stopped(); k += kStep) {
            const LayerRange some{k, std::min(k + kStep, layers.end)};
            finish_layers(*table, events, some, parities[part].data(), out_has_events, stream, out);
            if (part == 0)
                tell(kCrossShare + (1.0 - kCrossShare) * (some.end - layers.begin) / (layers.end - layers.begin));
        }
    });
    if (carry != nullptr) std::copy_n(parities.back().begin(), words, carry);
}

/// The bits of the prepared region: of the mesh that was set, or of batches.
Status SolidVoxelizer::State::solid(const MeshBatches* next, BitVolumeView out, std::uint64_t* carry,
                                    SolidReport& report) {
    for (Events& each : events) each.clear();
    bool out_has_events = false;
    const auto make_room = [&] {
        flush(!out_has_events, out);
        out_has_events = true;
        clear_events(report);
    };
    if (next == nullptr) {
        if (!points_are_snapped) {
            if (const Status status = snap(mesh, report); status != Status::Ok) return status;
        }
        if (!keys_are_packed) pack_all();
        if (const Status status = cross(mesh, kCrossShare, make_room); status != Status::Ok) return status;
    } else {
        for (MeshView batch; (*next)(batch); batch = {}) {
            if (const Status status = validate(batch, &report.bad_index); status != Status::Ok) return status;
            Status status = snap(batch, report);
            // How many batches will come is not known: no progress is told.
            if (status == Status::Ok) status = cross(batch, 0.0, make_room);
            points_are_snapped = keys_are_packed = false;
            if (status != Status::Ok) return status;
        }
    }
    finish(out_has_events, carry, out);
    if (is_stopped()) return Status::Cancelled;
    clear_events(report);
    tell(1.0);
    return Status::Ok;
}

Status SolidVoxelizer::State::crossings(CrossingLists& lists, SolidReport& report) {
    for (Events& each : events) each.clear();
    if (!points_are_snapped) {
        if (const Status status = snap(mesh, report); status != Status::Ok) return status;
    }
    if (!keys_are_packed) pack_all();
    LayeredBits kept(region->size.z);
    const auto make_room = [&] {
        const Stopwatch watch(times.finish_ms);
        keep_events(events, kept);
        clear_events(report);
    };
    if (const Status status = cross(mesh, kCrossShare, make_room); status != Status::Ok) return status;
    make_room();
    const Stopwatch watch(times.finish_ms);
    lists.nx = region->size.x;
    lists.ny = region->size.y;
    lists.nz = region->size.z;
    try {
        list_crossings(kept, lists);
    } catch (const std::bad_alloc&) {
        lists = {};
        throw;
    }
    tell(1.0);
    return Status::Ok;
}

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
    std::size_t bytes = vertices * (sizeof(glm::ivec3) + sizeof(std::uint32_t)) + sizeof(glm::ivec3);
    bytes += threads *
             (EventBins::reserved_bytes(lattice.nz, s.options.event_bytes / threads) + layer_bytes + sizeof(Waiting));
    if (!lattice.is_regular()) {
        bytes += TablePlan::bytes(lattice.column_count()) +
                 lattice.column_count() * (sizeof(glm::dvec2) + sizeof(double)) + lattice.nz * sizeof(double);
    }
    return bytes;
}

}  // namespace xorvox
