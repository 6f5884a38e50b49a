// show: mesh → voxels on the display's own samples → colours → frame → packets → a display, simulated here or far away.
#include <chrono>
#include <random>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "driver/host/color.h"
#include "driver/host/session.h"
#include "driver/host/slices.h"
#include "sim/picture.h"
#include "sim/simulator.h"
#include "sim/statistics.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/mesh_input.h"
#include "tools/placement.h"
#include "transport/address.h"
#include "transport/file.h"
#include "transport/loopback.h"
#include "transport/tcp.h"
#include "voxelizer/io/atomic_file.h"
#include "voxelizer/voxelize.h"

namespace xorvox::tools {
namespace {

/// What became of the frame, for the summary.
struct Delivery {
    host::SessionStatistics session;
    std::optional<sim::Statistics> light;  ///< Of the simulated display, on loopback.
    double picture_covered = 0.0;
};

std::uint64_t clock_ns() {
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                                      std::chrono::nanoseconds(1));
}

/// A display may remember the last session, so each gets another id; a file is the same every time.
host::SessionOptions session_options(bool two_way) {
    host::SessionOptions options;
    if (!two_way) return options;
    options.session = static_cast<std::uint16_t>(std::random_device()() % 0xffff + 1);
    return options;
}

Expected<void> write_png(const std::string& path, const sim::Image& image) {
    const std::vector<std::byte> png = sim::encode_png(image);
    return io::write_file_atomically(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

/// A display in this program, in simulated time: both ends move in turn, and the clock jumps when neither can.
Expected<Delivery> show_in_process(const ShowOptions& options, const DisplayDescription& display,
                                   std::span<const std::byte> frame) {
    auto [host_end, device_end] = transport::make_loopback();
    Expected<sim::Simulator> simulator = sim::Simulator::make(display, device_end.get());
    if (!simulator) return tl::unexpected(simulator.error());
    host::Session session(host_end.get(), display);

    std::uint64_t now_ns = 0;
    bool submitted = false;
    while (session.statistics().frames_presented == 0) {
        const Status host_moved = session.poll(now_ns);
        const Status device_moved = simulator->poll(now_ns);
        if (session.state() == host::SessionState::Failed) return tl::unexpected(session.error());
        if (!submitted) submitted = session.submit(frame) == Status::Ok;
        if (host_moved == Status::WouldBlock && device_moved == Status::WouldBlock)
            now_ns = simulator->next_boundary_ns();
    }

    Delivery delivery{session.statistics(), std::nullopt, 0.0};
    const sim::LightField light = simulator->light();
    {
        const Progress progress("measuring the light");
        delivery.light = sim::measure(display, light, simulator->device().status(now_ns));
    }
    if (!options.png.empty()) {
        const Progress progress("drawing the picture");
        sim::Picture picture;
        if (options.view == "orthographic") {
            picture = sim::render_orthographic(display, light);
        } else {
            Expected<sim::Picture> drawn = sim::render_perspective(display, light);
            if (!drawn) return fail(drawn.error().message + "; --view orthographic needs no OpenGL");
            picture = std::move(*drawn);
        }
        if (const auto written = write_png(options.png, picture.image); !written) {
            return tl::unexpected(written.error());
        }
        delivery.picture_covered = picture.covered;
    }
    return delivery;
}

/// Sends the frame and waits until it is presented, or, where there is no way back, until the link has all of it.
Expected<Delivery> send_over(Link link, const ShowOptions& options, const DisplayDescription& display,
                             std::span<const std::byte> frame) {
    const bool two_way = link.info().two_way;
    if (!two_way && !options.json) {
        fmt::print("{} has no way back: keyframes only, and the display is taken to be as {} says\n", options.to,
                   display.name.view());
    }
    const Progress progress("sending to " + options.to);
    // Nobody answers a recording: its time is 0, so that equal frames give equal files.
    const auto now_ns = [two_way] { return two_way ? clock_ns() : 0; };
    host::Session session(link, display, session_options(two_way));
    bool submitted = false;
    const auto done = [&] {
        return submitted && session.idle() && (!two_way || session.statistics().frames_presented > 0);
    };
    while (!done()) {
        const Status moved = session.poll(now_ns());
        if (session.state() == host::SessionState::Failed) return tl::unexpected(session.error());
        if (!submitted) submitted = session.submit(frame) == Status::Ok;
        if (moved != Status::WouldBlock) continue;
        // Whatever it says, the session's own time-outs are looked at next.
        (void)link.wait(session.events(), 20'000'000);
    }
    return Delivery{session.statistics(), std::nullopt, 0.0};
}

Expected<Delivery> deliver(const ShowOptions& options, const transport::Address& address,
                           const DisplayDescription& display, std::span<const std::byte> frame) {
    switch (address.kind) {
        case transport::AddressKind::Loopback: return show_in_process(options, display, frame);
        case transport::AddressKind::Tcp: {
            Expected<UniqueLink> link = transport::connect_tcp(address.host, address.port);
            if (!link) return tl::unexpected(link.error());
            return send_over(link->get(), options, display, frame);
        }
        case transport::AddressKind::File: {
            Expected<UniqueLink> link = transport::open_file_writer(address.path);
            if (!link) return tl::unexpected(link.error());
            Expected<Delivery> delivery = send_over(link->get(), options, display, frame);
            if (!delivery) return delivery;
            if (const auto kept = transport::commit_file(link->get()); !kept) return tl::unexpected(kept.error());
            return delivery;
        }
    }
    return fail("unknown kind of address");
}

void print_text(const ShowOptions& options, const DisplayDescription& display, std::size_t voxels, std::size_t samples,
                const Delivery& delivery) {
    fmt::print("{}: {} of {} samples are inside\n", display.name.view(), thousands(voxels), thousands(samples));
    fmt::print("sent to {}: {} bytes as {}\n", options.to, thousands(delivery.session.bytes_raw),
               thousands(delivery.session.bytes_sent));
    if (delivery.light) {
        fmt::print("lit: {} pixels at {} places, {} outside the display, brightness varies {:.3g} to 1\n",
                   thousands(delivery.light->pixels_lit), thousands(delivery.light->voxels_lit),
                   thousands(delivery.light->light_outside), delivery.light->brightness_ratio);
    }
    if (!options.png.empty()) {
        fmt::print("picture: {}, {:.0f} % of it is the object\n", options.png, 100.0 * delivery.picture_covered);
    }
}

void print_json(const ShowOptions& options, const DisplayDescription& display, std::size_t voxels, std::size_t samples,
                const Delivery& delivery) {
    std::string light = delivery.light ? sim::to_json(*delivery.light) : "null";
    while (light.ends_with('\n')) light.pop_back();
    fmt::print(
        "{{\"mesh\": {}, \"display\": {}, \"to\": {}, \"samples\": {}, \"inside\": {}, \"bytes_raw\": {}, "
        "\"bytes_sent\": {}, \"picture\": {}, \"light\": {}}}\n",
        json_string(options.mesh.path), json_string(display.name.view()), json_string(options.to), samples, voxels,
        delivery.session.bytes_raw, delivery.session.bytes_sent,
        options.png.empty() ? "null" : json_string(options.png), light);
}

}  // namespace

Expected<void> show(const ShowOptions& options) {
    const Expected<transport::Address> address = transport::parse_address(options.to);
    if (!address) return fail("--to: " + address.error().message);
    if (!options.png.empty() && address->kind != transport::AddressKind::Loopback) {
        return fail(
            "--png draws the light of a display in this program and needs --to loopback; leave out one of them");
    }
    const Expected<DisplayDescription> display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    const auto color = host::parse_color(options.color);
    if (!color) return fail("--color: " + color.error().message);
    Expected<MeshInput> input = read_solid(options.mesh);
    if (!input) return tl::unexpected(input.error());
    if (const auto fitted = fit_to_display(input->mesh, *display, options.mesh.path); !fitted) return fitted;

    host::FramePainter painter(*display);
    const Lattice lattice = painter.lattice().view();
    std::vector<std::byte> frame(frame_bytes(*display));
    std::size_t voxels = 0;
    {
        const Progress progress("voxelizing");
        const Expected<BitVolume> volume = xorvox::voxelize(input->mesh.view(), lattice);
        if (!volume) return fail(options.mesh.path + ": " + volume.error().message);
        voxels = volume->count();
        if (painter.paint(volume->view(), **color, frame) != Status::Ok) return fail("the frame could not be painted");
    }
    if (voxels == 0) {
        warn(options.mesh.path + ": no sample of the display is inside it; it may be thinner than the display's pitch");
    }
    const Expected<Delivery> delivery = deliver(options, *address, *display, frame);
    if (!delivery) return tl::unexpected(delivery.error());
    (options.json ? print_json : print_text)(options, *display, voxels, lattice.sample_count(), *delivery);
    return {};
}

}  // namespace xorvox::tools
