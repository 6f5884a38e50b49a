#include "voxelizer/solid_state.h"

#include <chrono>
#include <limits>
#include <utility>

#include "voxelizer/faces.h"
#include "voxelizer/resize_exactly.h"

namespace xorvox {

using namespace kernels;

namespace {

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

}  // namespace

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

/// Snaps and packs the vertices of the mesh that was set, as far as that has not been done.
Status SolidVoxelizer::State::prepare_vertices(SolidReport& report) {
    if (!points_are_snapped) return snap(mesh, report);
    if (keys_are_packed) return Status::Ok;
    const Stopwatch watch(times.snap_ms);
    workers.run([&](unsigned part) {
        const std::size_t begin = keys.size() * part / workers.count();
        pack(begin, keys.size() * (part + 1) / workers.count() - begin);
    });
    keys_are_packed = true;
    return Status::Ok;
}

/// Pushes events of a thread's part until it is done, or there is no room for more.
bool SolidVoxelizer::State::cross_more(SolidPart& at, unsigned part, double share) {
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
        if (std::all_of(parts.begin(), parts.end(), [](const SolidPart& at) { return at.done; })) return Status::Ok;
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
        if (const Status status = prepare_vertices(report); status != Status::Ok) return status;
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
    if (const Status status = prepare_vertices(report); status != Status::Ok) return status;
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

}  // namespace xorvox
