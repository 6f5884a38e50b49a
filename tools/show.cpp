// show: mesh → voxels on the display's own samples → colours → frame → packets → a display, simulated here or far away.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "driver/display/lattice.h"
#include "driver/display/toml.h"
#include "driver/host/color.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/frame_maker.h"
#include "tools/mesh_input.h"
#include "tools/placement.h"
#include "tools/stream.h"

namespace xorvox::tools {
namespace {

void print_light(const ShowOptions& show, const std::optional<LightSeen>& light) {
    if (!light) return;
    const DeliveryOptions& options = show.delivery;
    const sim::Statistics& seen = light->statistics;
    fmt::print("lit: {} pixels at {} places, {} outside the display\n", thousands(seen.pixels_lit),
               thousands(seen.voxels_lit), thousands(seen.light_outside));
    // In uniform light most samples near an axis are left out, and those that are lit stand for more than their own
    // space.
    if (seen.voxels_lit > 0 && show.light == "bright") {
        fmt::print("brightness: the densest light is {:.3g} times the thinnest\n", seen.brightness_ratio);
    }
    if (show.light == "uniform") {
        fmt::print("brightness: even; of the samples inside, each voxel has one lit for each panel that passes it\n");
    }
    if (!options.png.empty()) {
        fmt::print("picture: {}, {:.0f} % of it is the object\n", options.png, 100.0 * light->picture_covered);
    }
}

std::string light_json(const DeliveryOptions& options, const std::optional<LightSeen>& light) {
    std::string object = light ? sim::to_json(light->statistics) : "null";
    while (object.ends_with('\n')) object.pop_back();
    return fmt::format("\"picture\": {}, \"light\": {}", options.png.empty() ? "null" : json_string(options.png),
                       object);
}

/// What both kinds of report begin with.
std::string head_json(const ShowOptions& options, const DisplayDescription& display, std::size_t samples,
                      std::size_t voxels) {
    return fmt::format("\"mesh\": {}, \"display\": {}, \"to\": {}, \"samples\": {}, \"inside\": {}",
                       json_string(options.mesh.path), json_string(display.name.view()),
                       json_string(options.delivery.to), samples, voxels);
}

Expected<void> show_still(const ShowOptions& options, const transport::Address& address,
                          const DisplayDescription& display, const Mesh& mesh, FrameMaker& maker, io::AtomicFile* png) {
    std::vector<std::byte> frame(frame_bytes(display));
    std::size_t voxels = 0;
    {
        const Progress progress("voxelizing");
        if (const auto drawn = maker.voxelize(mesh.positions); !drawn) return drawn;
        if (const auto painted = maker.paint(frame); !painted) return painted;
        voxels = maker.volume().count();
    }
    if (voxels == 0) {
        warn(options.mesh.path + ": no sample of the display is inside it; it may be thinner than the display's pitch");
    }
    const DeliveryOptions& to = options.delivery;
    const Expected<Delivery> delivery = deliver(to, address, display, frame, voxels, png);
    if (!delivery) return tl::unexpected(delivery.error());
    if (to.json) {
        fmt::print("{{{}, \"bytes_raw\": {}, \"bytes_sent\": {}, \"two_way\": {}, {}}}\n",
                   head_json(options, display, frame_pixels(display), voxels), delivery->session.bytes_raw,
                   delivery->session.bytes_sent, address.kind != transport::AddressKind::File,
                   light_json(to, delivery->light));
        return {};
    }
    fmt::print("{}: {} of {} samples are inside\n", display.name.view(), thousands(voxels),
               thousands(frame_pixels(display)));
    fmt::print("sent to {}: {} bytes as {}\n", to.to, thousands(delivery->session.bytes_raw),
               thousands(delivery->session.bytes_sent));
    print_light(options, delivery->light);
    return {};
}

Expected<void> show_spinning(const ShowOptions& options, const transport::Address& address,
                             const DisplayDescription& display, const Mesh& mesh, FrameMaker& maker,
                             io::AtomicFile* png) {
    const DisplayExtent room = extent(display);
    const glm::dvec2 axis = glm::dvec2(room.lower + room.upper) / 2.0;
    std::vector<glm::dvec3> positions(mesh.positions.size());
    std::optional<Error> broken;
    const FrameSource source = [&](const FrameMoment& moment, std::span<std::byte> frame) {
        const double angle = moment.seconds * *options.spin_rpm / 60.0 * 2.0 * std::numbers::pi;
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const glm::dvec2 from = glm::dvec2(mesh.positions[i]) - axis;
            positions[i] = {axis.x + c * from.x - s * from.y, axis.y + s * from.x + c * from.y, mesh.positions[i].z};
        }
        Expected<void> made = maker.voxelize(positions);
        if (made) made = maker.paint(frame);
        if (!made) broken = made.error();
        return made.has_value();
    };
    const DeliveryOptions& to = options.delivery;
    const Expected<StreamDelivery> delivery = deliver_stream(to, address, display, source, options.seconds, png);
    if (broken) return tl::unexpected(*broken);
    if (!delivery) return tl::unexpected(delivery.error());
    const std::size_t voxels = maker.volume().count();
    if (to.json) {
        fmt::print("{{{}, \"two_way\": {}, {}, {}}}\n", head_json(options, display, frame_pixels(display), voxels),
                   address.kind != transport::AddressKind::File, stream_json(*delivery),
                   light_json(to, delivery->light));
    } else {
        fmt::print("{}: {} of {} samples were inside at the end\n", display.name.view(), thousands(voxels),
                   thousands(frame_pixels(display)));
        print_stream(*delivery);
        print_light(options, delivery->light);
    }
    return delivery->broken ? Expected<void>(tl::unexpected(*delivery->broken)) : Expected<void>();
}

}  // namespace

Expected<void> show(const ShowOptions& options) {
    const DeliveryOptions& to = options.delivery;
    const Expected<transport::Address> address = transport::parse_address(to.to);
    if (!address) return fail("--to: " + address.error().message);
    if (const auto possible = check_delivery(to, *address, options.mesh.path); !possible) return possible;
    const Expected<DisplayFile> display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    const auto color = host::parse_color(options.color);
    if (!color) return fail("--color: " + color.error().message);
    if (const auto fits = check_display_fits(*display); !fits) return fits;
    std::optional<io::AtomicFile> png;
    if (!to.png.empty()) {
        Expected<io::AtomicFile> file = io::AtomicFile::create(to.png);
        if (!file) return tl::unexpected(file.error());
        png = std::move(*file);
    }
    Expected<MeshInput> input = read_solid(options.mesh);
    if (!input) return tl::unexpected(input.error());
    const bool turns = options.spin_rpm.has_value();
    if (const auto fitted = fit_to_display(input->mesh, *display, options.mesh.path, turns); !fitted) return fitted;
    const auto maker = FrameMaker::make(
        *display, input->mesh, options.mesh.path, **color,
        {.light = {.mode = options.light == "uniform" ? host::LightMode::Uniform : host::LightMode::Bright},
         .resampled = options.sampling == "cartesian"});
    if (!maker) return tl::unexpected(maker.error());
    const auto show_it = options.spin_rpm ? show_spinning : show_still;
    return show_it(options, *address, *display, input->mesh, **maker, png ? &*png : nullptr);
}

}  // namespace xorvox::tools
