#include "sim/simulator.h"

#include <fmt/format.h>

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

#include "driver/device/config.h"
#include "driver/device/scan_control.h"
#include "driver/display/toml.h"

namespace xorvox::sim {
struct Simulator::Impl {
    DisplayDescription display;
    Misbuild misbuild;
    std::vector<std::byte> pages;
    std::vector<std::byte> packet;
    device::Device device;
    device::ScanControl control;
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
    // The motor keeps to the device's clock: cycle 0 begins at time 0, and the others where they should.
    device::ScanControlConfig scan = device::scan_control_config(impl->display);
    scan.rotation.source = IndexSource::None;
    if (const Status status = impl->control.init(scan, impl->device, 0); status != Status::Ok) {
        return fail(fmt::format("cannot simulate display {}: its scan-out cannot be computed in integers ({})",
                                display.name.view(), to_string(status)));
    }
    return Simulator(std::move(impl));
}

Status Simulator::poll(std::uint64_t now_ns) {
    (void)impl_->control.poll(now_ns);  // What it orders, the light of a whole cycle shows.
    return impl_->device.poll(now_ns);
}

void Simulator::set_link(Link link) {
    impl_->device.set_link(link);
}

std::uint64_t Simulator::next_boundary_ns() const {
    return impl_->control.next_boundary_ns();
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
