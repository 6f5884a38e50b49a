// SolidVoxelizer::State: what a SolidVoxelizer holds, and the way from a mesh to bits or lists on one region. The calls
// are in solid_voxelizer.cpp. Hosted; internal to the voxelizer.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <vector>

#include "voxelizer/kernels/kernel_table.h"
#include "voxelizer/kernels/layers.h"
#include "voxelizer/kernels/triangle_source.h"
#include "voxelizer/solid_voxelizer.h"
#include "voxelizer/workers.h"

namespace xorvox {

/// Where a thread is in its part of a mesh, and what it has found.
struct SolidPart {
    kernels::TriangleSource source;
    kernels::Triangles block;
    kernels::BlockProgress progress;
    bool done = false;
};

struct SolidVoxelizer::State {
    explicit State(SolidOptions given);

    bool fits(const BitVolumeView& out, const Region& region) const;
    void prepare_region(const Region& region, kernels::Below below, bool by_layer);
    Status snap(const MeshView& mesh, SolidReport& report);
    void pack(std::size_t begin, std::size_t count);
    Status prepare_vertices(SolidReport& report);
    template <class Flush>
    Status cross(const MeshView& mesh, double share, const Flush& flush);
    bool cross_more(SolidPart& at, unsigned part, double share);
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
    kernels::LayerRange layers_of(unsigned part) const {
        const std::uint64_t nz = region->size.z;
        return {static_cast<std::uint32_t>(nz * part / workers.count()),
                static_cast<std::uint32_t>(nz * (part + 1) / workers.count())};
    }
    void clear_events(SolidReport& report) {
        for (kernels::Events& each : events) {
            report.crossings += each.count();
            each.clear();
        }
    }

    SolidOptions options;
    const kernels::KernelTable* table;
    Workers workers;
    // One of each for each thread.
    std::vector<kernels::Events> events;
    std::vector<kernels::Waiting> waiting;
    std::vector<SolidPart> parts;
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
    kernels::RegularPlan regular;
    kernels::TablePlan tables;

    SolidTimes times;
    double progress_from = 0;
    double progress_to = 1;
    double told = 0;
};

}  // namespace xorvox
