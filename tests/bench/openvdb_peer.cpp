#include <memory>
#include <vector>

#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include "tests/bench/peer.h"

namespace xorvox::bench {
namespace {

using Corners = std::vector<openvdb::Vec3I>;
using Points = std::vector<openvdb::Vec3s>;
using Adapter = openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I>;

/// The mesh in OpenVDB's index space, whose integer points are the lattice's samples.
struct IndexedMesh {
    Points points;
    Corners triangles;
    openvdb::BoolGrid::Ptr inside;
};

}  // namespace

Peer make_openvdb_peer(const MeshView& mesh, const Lattice& lattice) {
    openvdb::initialize();
    const auto data = std::make_shared<IndexedMesh>();
    const glm::dvec3 first = sample_position(lattice, 0, 0, 0);
    for (const glm::dvec3& position : mesh.positions) {
        const glm::dvec3 p = (position - first) / lattice.pitch;
        data->points.emplace_back(p.x, p.y, p.z);
    }
    const auto indices = mesh.used_indices();
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        data->triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    }

    const auto run = [data] {
        const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
        const Adapter adapter(data->points, data->triangles);
        const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
        const auto distances = openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *transform, 1.0f, 1.0f);
        data->inside = openvdb::tools::sdfInteriorMask(*distances);
    };
    const auto voxels = [data, nx = lattice.nx, ny = lattice.ny, nz = lattice.nz] {
        BitVolume volume(nx, ny, nz);
        const auto inside = data->inside->getConstAccessor();
        for (std::uint32_t z = 0; z < nz; ++z) {
            for (std::uint32_t y = 0; y < ny; ++y) {
                for (std::uint32_t x = 0; x < nx; ++x) {
                    const openvdb::Coord at(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
                    if (inside.getValue(at)) volume.view().flip(x, y, z);
                }
            }
        }
        return volume;
    };
    return {"OpenVDB", run, voxels};
}

}  // namespace xorvox::bench
