// VolumeContent: volumes of other programs, one after the other or one for all time.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/display/description.h"
#include "driver/host/volume_color.h"
#include "tools/content.h"
#include "tools/placement.h"
#include "tools/volume_input.h"

namespace xorvox::tools {

class VolumeContent final : public Content {
public:
    /// Fits the frames of `input` into `display`, all by one placement; messages call them `source`. Each of them is
    /// shown for `seconds_each`; the only one always. Works with `threads` threads.
    static Expected<std::unique_ptr<VolumeContent>> make(VolumeInput input, const std::string& source,
                                                         const DisplayDescription& display, Turning turning,
                                                         double seconds_each, unsigned threads);

    double duration_seconds() const override;
    Expected<void> set_lattice(const Lattice& lattice) override;
    Expected<void> draw(double seconds, const glm::dmat4& pose, BitVolumeView voxels) override;
    bool has_own_color() const override;
    const host::ColorField* own_color() override;

private:
    VolumeContent() = default;

    std::vector<std::shared_ptr<const SampledVolume>> frames_;
    double threshold_ = 0.0;
    std::optional<TransferFunction> transfer_;
    glm::dmat4 placement_{1.0};
    glm::dvec3 lower_{0.0};  ///< The display's box.
    glm::dvec3 upper_{0.0};
    double seconds_each_ = 0.0;
    unsigned threads_ = 1;
    Lattice lattice_;
    std::size_t current_ = 0;                 ///< Of frames_: what was drawn last.
    glm::dmat4 to_volume_{1.0};               ///< Where it was.
    std::optional<host::VolumeColor> color_;  ///< Of frames_[current_], once it was asked for.
};

}  // namespace xorvox::tools
