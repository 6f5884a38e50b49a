// Scene: what a model file holds, more than its mesh: colours, and how its parts move.
//
// read_mesh (voxelizer/io/mesh_file.h) is for those who want only the shape.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "voxelizer/error.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/mesh.h"
#include "voxelizer/surface_colors.h"

namespace xorvox::io {

/// A movement that a file brings.
struct SceneAnimation {
    std::string name;             ///< As in the file; may be empty.
    double duration_seconds = 0;  ///< From its first moment, 0, to its last.
};

/// The parts of a scene that move, and how. Copies are independent; any number of threads may ask one.
class SceneMotion {
public:
    virtual ~SceneMotion() = default;
    virtual std::span<const SceneAnimation> animations() const = 0;
    /// Where the vertices of Scene::mesh are `seconds` into animation number `animation`; before its beginning and
    /// after its end as at those. `positions` has one entry a vertex. Allocates nothing but a little for nodes.
    virtual void positions_at(std::size_t animation, double seconds, std::span<glm::dvec3> positions) const = 0;
};

struct Scene {
    Mesh mesh;  ///< At rest: what the file shows when nothing moves. Scaled and turned by the options.
    SurfaceColors colors;
    /// Why `colors` are empty although the file has some: an image or a material file that is missing, damaged or too
    /// large. Who shows the colours should refuse with it; the shape is whole. Empty: no fault.
    std::string colors_fault;
    /// Null: the file has no animation that is read. Positions are scaled and turned too.
    std::shared_ptr<const SceneMotion> motion;
    /// What the file has and this does not show, each a line for a person: "2 skins: the mesh stays in its rest pose".
    std::vector<std::string> notes;
};

/// Reads the model file at `path`: what read_mesh() does, with colours and animations. Vertices at the same place are
/// welded, but for those that may part when the scene moves. Errors are those of read_mesh().
Expected<Scene> read_scene(const std::string& path, const MeshReadOptions& options = {});

}  // namespace xorvox::io
