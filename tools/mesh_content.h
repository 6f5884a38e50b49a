// MeshContent: meshes that are filled, one after the other or one for all time.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "driver/display/description.h"
#include "tools/content.h"
#include "tools/placement.h"
#include "voxelizer/mesh.h"
#include "voxelizer/solid_voxelizer.h"

namespace xorvox::tools {

/// A mesh, and what messages call it.
struct NamedMesh {
    Mesh mesh;
    std::string source;
};

class MeshContent final : public Content {
public:
    /// Fits `meshes`, at least one, into `display`, all by one placement. Each is shown for `seconds_each`; the only
    /// one always. Works with `threads` threads.
    static Expected<MeshContent> make(std::vector<NamedMesh> meshes, const DisplayDescription& display, Turning turning,
                                      double seconds_each, unsigned threads);

    double duration_seconds() const override;
    Expected<void> set_lattice(const Lattice& lattice) override;
    Expected<void> draw(double seconds, const glm::dmat4& pose, BitVolumeView voxels) override;

private:
    MeshContent(std::vector<NamedMesh> meshes, const Placement& placement, double seconds_each, unsigned threads);
    Expected<void> fail_as(Status status, const SolidReport& report) const;

    std::vector<NamedMesh> meshes_;  ///< Placed.
    double seconds_each_;
    std::size_t current_ = 0;            ///< Of meshes_: what the voxelizer has.
    std::vector<glm::dvec3> positions_;  ///< Its vertices, moved.
    Lattice lattice_;
    SolidVoxelizer voxelizer_;
};

}  // namespace xorvox::tools
