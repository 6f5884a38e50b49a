#include "tools/frame_maker.h"

#include <atomic>
#include <cstdint>
#include <thread>
#include <utility>
#include <vector>

#include "voxelizer/voxelize.h"

namespace xorvox::tools {
namespace {

SolidOptions solid_options(unsigned threads) {
    SolidOptions options;
    options.threads = threads;
    return options;
}

}  // namespace

FrameMaker::FrameMaker(const DisplayDescription& display, const Mesh& mesh, std::string source,
                       const host::ColorField& color, const FrameMakerOptions& options)
    : source_(std::move(source)),
      mesh_(mesh),
      slices_(display.slices),
      color_(color),
      painter_(display, options.light),
      budget_(display),
      brightness_(options.light.brightness),
      volume_(painter_.lattice().view()),
      threads_(options.threads),
      voxelizer_(solid_options(options.threads)) {
    if (!options.resampled) return;
    map_.emplace(display, painter_.lattice());
    cartesian_ = BitVolume(map_->grid());
}

Expected<std::unique_ptr<FrameMaker>> FrameMaker::make(const DisplayDescription& display, const Mesh& mesh,
                                                       std::string source, const host::ColorField& color,
                                                       const FrameMakerOptions& options) {
    std::unique_ptr<FrameMaker> maker(new FrameMaker(display, mesh, std::move(source), color, options));
    if (const auto begun = maker->begin(); !begun) return tl::unexpected(begun.error());
    return maker;
}

Expected<void> FrameMaker::begin() {
    SolidReport report;
    Status status = voxelizer_.set_mesh(mesh_.view(), &report);
    if (status == Status::Ok) status = voxelizer_.set_lattice(drawn_on());
    if (status == Status::Ok) return {};
    return fail(source_ + ": " + describe_failure(status, mesh_.view(), drawn_on(), report).message);
}

Expected<void> FrameMaker::voxelize(std::span<const glm::dvec3> positions) {
    SolidReport report;
    Status status = voxelizer_.set_positions(positions);
    if (status == Status::Ok) status = voxelizer_.solid(map_ ? cartesian_.view() : volume_.view(), &report);
    if (status != Status::Ok) {
        MeshView moved = mesh_.view();
        moved.positions = positions;
        return fail(source_ + ": " + describe_failure(status, moved, drawn_on(), report).message);
    }
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

Expected<void> FrameMaker::paint_once(std::span<std::byte> frame, std::uint32_t number) const {
    std::atomic<bool> painted = true;
    const auto paint_part = [&](unsigned part) {
        const auto begin = static_cast<std::uint32_t>(std::uint64_t{slices_} * part / threads_);
        const auto end = static_cast<std::uint32_t>(std::uint64_t{slices_} * (part + 1) / threads_);
        const Status status = painter_.paint_slices(volume_.view(), color_, frame, begin, end - begin, number);
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
