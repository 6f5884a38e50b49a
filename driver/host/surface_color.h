// SurfaceColor: the colours of a mesh's surface, carried inward: each point has that of the nearest place.
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "driver/host/color.h"
#include "voxelizer/mesh.h"
#include "voxelizer/nearest_surface.h"
#include "voxelizer/surface_colors.h"

namespace xorvox::host {

class SurfaceColor final : public ColorField {
public:
    /// `mesh` as for NearestSurface, in the millimetres of the display whose box reaches from `lower_mm` to `upper_mm`
    /// (extent() in driver/display/lattice.h); nothing of it is kept. `colors` belong to it, finite. A mesh without
    /// faces is white. Throws std::bad_alloc.
    SurfaceColor(const MeshView& mesh, SurfaceColors colors, const glm::dvec3& lower_mm, const glm::dvec3& upper_mm);

    /// The mesh has moved: as many positions as before. Must not run while colours are asked for.
    void set_positions(std::span<const glm::dvec3> positions) { surface_.set_positions(positions); }

    /// Fast for points that follow each other in space, as those of a display's rows do.
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override;

private:
    glm::vec3 color_at(const SurfacePoint& place) const;

    NearestSurface surface_;
    SurfaceColors colors_;
    glm::dvec3 lower_mm_;
    glm::dvec3 size_mm_;
};

}  // namespace xorvox::host
