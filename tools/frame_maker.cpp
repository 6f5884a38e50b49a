#include "tools/frame_maker.h"

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace xorvox::tools {

FrameMaker::FrameMaker(const DisplayDescription& display, Content& content, const host::ColorField* color,
                       const FrameMakerOptions& options)
    : content_(content),
      color_(color),
      slices_(display.slices),
      painter_(display, options.light),
      budget_(display),
      brightness_(options.light.brightness),
      volume_(painter_.lattice().view()),
      threads_(options.threads) {
    if (!options.resampled) return;
    map_.emplace(display, painter_.lattice());
    cartesian_ = BitVolume(map_->grid());
}

Expected<std::unique_ptr<FrameMaker>> FrameMaker::make(const DisplayDescription& display, Content& content,
                                                       const host::ColorField* color,
                                                       const FrameMakerOptions& options) {
    std::unique_ptr<FrameMaker> maker(new FrameMaker(display, content, color, options));
    const Lattice lattice = maker->map_ ? maker->map_->grid() : maker->painter_.lattice().view();
    if (const auto set = content.set_lattice(lattice); !set) return tl::unexpected(set.error());
    return maker;
}

Expected<void> FrameMaker::draw(double seconds, const glm::dmat4& pose) {
    if (const auto drawn = content_.draw(seconds, pose, map_ ? cartesian_.view() : volume_.view()); !drawn)
        return drawn;
    if (map_ && map_->sample(cartesian_.view(), volume_.view()) != Status::Ok) return fail("resampling failed");
    return {};
}

Expected<void> FrameMaker::paint(std::span<std::byte> frame, std::uint32_t number) {
    do {
        dimmed_to_ = budget_.factor();
        painter_.set_brightness(brightness_ * dimmed_to_);
        if (const auto painted = paint_once(frame, number); !painted) return painted;
    } while (!budget_.allows(frame));
    return {};
}

Expected<void> FrameMaker::paint_once(std::span<std::byte> frame, std::uint32_t number) {
    const host::ColorField* const color = color_ != nullptr ? color_ : content_.own_color();
    std::atomic<bool> painted = true;
    const auto paint_part = [&](unsigned part) {
        const auto begin = static_cast<std::uint32_t>(std::uint64_t{slices_} * part / threads_);
        const auto end = static_cast<std::uint32_t>(std::uint64_t{slices_} * (part + 1) / threads_);
        const Status status = painter_.paint_slices(volume_.view(), *color, frame, begin, end - begin, number);
        if (status != Status::Ok) painted = false;
    };
    {
        std::vector<std::jthread> others;
        for (unsigned part = 1; part < threads_; ++part) others.emplace_back(paint_part, part);
        paint_part(0);
    }
    if (painted) return {};
    return fail("the frame could not be painted");
}

}  // namespace xorvox::tools
