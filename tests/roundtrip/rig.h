// The rig of the round trip: mesh → voxels → colours → frame → session → link → device → light → voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "driver/display/description.h"
#include "driver/host/color.h"
#include "driver/host/session.h"
#include "sim/rebuild.h"
#include "sim/simulator.h"
#include "transport/faults.h"
#include "transport/link.h"
#include "voxelizer/bit_volume.h"
#include "voxelizer/mesh.h"

namespace xorvox::test {

/// A tetrahedron without any symmetry, within ±1; `turn` picks one of several different ones.
Mesh lopsided(std::uint32_t turn);

/// Two surfaces, one inside the other: of the solid between them few voxels are set, for large displays.
Mesh hollow(std::uint32_t turn);

/// Eight different colours, one an octant of the lattice's box.
class Octants final : public host::ColorField {
public:
    static glm::vec3 color(const glm::vec3& point);
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override;
};

/// One colour, which the host need not ask for point by point.
class Plain final : public host::ColorField {
public:
    static constexpr glm::vec3 kColor{0.9f, 0.5f, 0.2f};
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override;
    std::optional<glm::vec3> constant() const override { return kColor; }
};

/// Voxels of one mesh on one display, and the frame that the host makes of them.
struct Picture {
    BitVolume volume;
    std::vector<std::byte> frame;
    std::vector<sim::SampleCode> codes;  ///< Of the set voxels: the colour's code at each.
};
/// The mesh, which is within ±1, as large as the display. Voxels so near to a border of Octants that rounding decides
/// their colour are left out.
Picture paint(const DisplayDescription& display, const Mesh& mesh, const host::ColorField& field = Octants());

/// A host and a simulated display at the two ends of one link.
class Rig {
public:
    enum class Over { Loopback, Tcp };

    /// `faults` are those of the link, as the host sees it; `broken` is what is wrong with the display.
    Rig(const DisplayDescription& display, Over over, const transport::FaultOptions& faults = {},
        const sim::Faults& broken = {});

    /// Sends the frame and moves both ends until it is presented or the session has failed. After every step what is
    /// shown is dark or one of the frames sent, whole; `whole()` says so. True when it was presented.
    bool show(const std::vector<std::byte>& frame);

    bool whole() const { return whole_; }
    sim::LightField light() const { return simulator_.light(); }
    const host::Session& session() const { return session_; }
    transport::FaultCounts faults() const { return transport::fault_counts(host_end_.get()); }

private:
    Rig(const DisplayDescription& display, std::pair<UniqueLink, UniqueLink> ends, bool in_kernel,
        const transport::FaultOptions& faults, const sim::Faults& broken);
    void look();

    UniqueLink host_end_;
    UniqueLink device_end_;
    bool in_kernel_ = false;
    sim::Simulator simulator_;
    host::Session session_;
    std::vector<std::vector<std::byte>> sent_;
    std::uint64_t now_ns_ = 0;
    std::uint32_t looked_at_ = 0;  ///< Id of the frame that was looked at last.
    bool whole_ = true;
};

}  // namespace xorvox::test
