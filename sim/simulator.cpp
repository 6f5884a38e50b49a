#include "sim/simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

#include "driver/display/toml.h"

namespace xorvox::sim {
namespace {

/// After a long pause only the last cycles are gone through: more than this many pages cannot be waiting.
constexpr std::uint64_t kMostCyclesPerPoll = device::kMaxPages;

}  // namespace

struct Simulator::Impl {
    DisplayDescription display;
    Misbuild misbuild;
    std::uint64_t cycle_length_ns = 0;
    std::uint64_t cycle = 0;  ///< Number of the cycle that the display is in; cycle 0 begins at time 0.
    std::vector<std::byte> pages;
    std::vector<std::byte> packet;
    device::Device device;
};

Simulator::Simulator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;
Simulator::~Simulator() = default;

Expected<Simulator> Simulator::make(const DisplayDescription& display, Link link, const SimulatorOptions& options) {
    if (const Expected<void> valid = validate_display(display); !valid) return tl::unexpected(valid.error());
    auto impl = std::make_unique<Impl>();
    impl->display = display;
    impl->misbuild = options.misbuild;
    impl->cycle_length_ns = std::max<std::uint64_t>(1, cycle_ns(display));
    impl->pages.resize(std::size_t{options.pages} * frame_bytes(display));
    impl->packet.resize(options.max_packet_bytes);

    device::DeviceConfig config;
    config.display = &impl->display;
    config.serial = DisplayName("simulator");
    config.boot_nonce = options.boot_nonce;
    config.link = link;
    config.pages = impl->pages;
    config.page_count = options.pages;
    config.packet = impl->packet;
    if (const Status status = impl->device.init(config, 0); status != Status::Ok) {
        return fail(fmt::format(
            "cannot simulate display {}: {} ({} pages, allowed 2 to {}; packets of {} bytes, allowed {} to {})",
            display.name.view(), to_string(status), options.pages, device::kMaxPages, options.max_packet_bytes,
            wire::kMinPacketBytes, wire::kMaxPacketBytes));
    }
    return Simulator(std::move(impl));
}

Status Simulator::poll(std::uint64_t now_ns) {
    Impl& self = *impl_;
    const std::uint64_t current = now_ns / self.cycle_length_ns;
    if (current > self.cycle + kMostCyclesPerPoll) self.cycle = current - kMostCyclesPerPoll;
    while (self.cycle < current) self.device.boundary(++self.cycle * self.cycle_length_ns);
    return self.device.poll(now_ns);
}

void Simulator::set_link(Link link) {
    impl_->device.set_link(link);
}

std::uint64_t Simulator::next_boundary_ns() const {
    return (impl_->cycle + 1) * impl_->cycle_length_ns;
}

LightField Simulator::light() const {
    const device::Shown shown = impl_->device.shown();
    return expose(impl_->display, shown.page, shown.brightness, impl_->misbuild);
}

const device::Device& Simulator::device() const {
    return impl_->device;
}

const DisplayDescription& Simulator::display() const {
    return impl_->display;
}

}  // namespace xorvox::sim
