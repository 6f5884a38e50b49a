// MeshContent: solids whose surface is a mesh: one that stands still, one that its file moves, or several that follow
// each other.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/display/description.h"
#include "driver/host/surface_color.h"
#include "tools/content.h"
#include "tools/placement.h"
#include "voxelizer/io/scene.h"
#include "voxelizer/solid_voxelizer.h"

namespace xorvox::tools {

/// What a file holds, and what messages call it.
struct NamedScene {
    io::Scene scene;
    std::string source;
};

class MeshContent final : public Content {
public:
    /// Fits `scenes`, at least one, into `display`, all by one placement. Each is shown for `seconds_each`; the only
    /// one always, and then it moves as its animation number `animation` does, if it has any. Works with `threads`
    /// threads.
    static Expected<std::unique_ptr<MeshContent>> make(std::vector<NamedScene> scenes, std::size_t animation,
                                                       const DisplayDescription& display, Turning turning,
                                                       double seconds_each, unsigned threads);

    double duration_seconds() const override { return duration_; }
    Expected<void> set_lattice(const Lattice& lattice) override;
    Expected<void> draw(double seconds, const glm::dmat4& pose, BitVolumeView voxels) override;
    bool has_own_color() const override;
    const host::ColorField* own_color() override;

private:
    MeshContent(std::vector<NamedScene> scenes, unsigned threads);
    Expected<void> place(const DisplayDescription& display, Turning turning);
    Expected<void> choose(std::size_t number);
    void move(double seconds, const glm::dmat4& pose);
    Expected<void> fail_as(Status status, const SolidReport& report) const;

    std::vector<NamedScene> scenes_;
    const io::SceneMotion* motion_ = nullptr;  ///< Of the only scene; null: it does not move by itself.
    std::size_t animation_ = 0;
    double duration_ = 0.0;
    double seconds_each_ = 0.0;
    Placement placement_;
    glm::dvec3 lower_{0.0};  ///< The display's box.
    glm::dvec3 upper_{0.0};
    Lattice lattice_;
    SolidVoxelizer voxelizer_;
    std::optional<std::size_t> current_;       ///< Of scenes_: what the voxelizer has.
    std::vector<glm::dvec3> positions_;        ///< Its vertices where they are shown.
    std::optional<host::SurfaceColor> color_;  ///< Its colours, once they were asked for.
};

}  // namespace xorvox::tools
