// show: mesh → voxels on the display's own samples → colours → frame → packets → a display, simulated here or far away.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "driver/host/color.h"
#include "driver/host/slices.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/mesh_input.h"
#include "tools/placement.h"
#include "voxelizer/voxelize.h"

namespace xorvox::tools {
namespace {

void print_text(const ShowOptions& options, const DisplayDescription& display, std::size_t voxels, std::size_t samples,
                const Delivery& delivery) {
    fmt::print("{}: {} of {} samples are inside\n", display.name.view(), thousands(voxels), thousands(samples));
    fmt::print("sent to {}: {} bytes as {}\n", options.to, thousands(delivery.session.bytes_raw),
               thousands(delivery.session.bytes_sent));
    if (delivery.light) {
        fmt::print("lit: {} pixels at {} places, {} outside the display\n", thousands(delivery.light->pixels_lit),
                   thousands(delivery.light->voxels_lit), thousands(delivery.light->light_outside));
        if (delivery.light->voxels_lit > 0) {
            fmt::print("brightness: the densest light is {:.3g} times the thinnest\n",
                       delivery.light->brightness_ratio);
        }
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
        "\"bytes_sent\": {}, \"two_way\": {}, \"picture\": {}, \"light\": {}}}\n",
        json_string(options.mesh.path), json_string(display.name.view()), json_string(options.to), samples, voxels,
        delivery.session.bytes_raw, delivery.session.bytes_sent, !options.to.starts_with("file:"),
        options.png.empty() ? "null" : json_string(options.png), light);
}

/// What can be refused before any work.
Expected<void> check_options(const ShowOptions& options, const transport::Address& address) {
    const bool here = address.kind == transport::AddressKind::Loopback;
    if (!options.png.empty()) {
        if (!here) {
            return fail(
                "--png draws the light of a display in this program and needs --to loopback; leave out one of them");
        }
        std::string extension = std::filesystem::path(options.png).extension().string();
        for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (extension != ".png")
            return fail(fmt::format("--png {}: the picture is a PNG; give it a name that ends in .png", options.png));
    }
    if (!options.view.empty() && options.png.empty())
        return fail("--view says what --png draws; give --png OUT.png too");
    if (options.hold && address.kind != transport::AddressKind::Tcp) {
        return fail("--hold keeps a display at the other end of a tcp link lit; use it with --to tcp:HOST:PORT");
    }
    std::error_code missing;
    for (const std::string& out : {options.png, address.path}) {
        if (!out.empty() && std::filesystem::equivalent(out, options.mesh.path, missing)) {
            return fail(out + " is the mesh itself; choose another name for the output");
        }
    }
    return {};
}

}  // namespace

Expected<void> show(const ShowOptions& options) {
    const Expected<transport::Address> address = transport::parse_address(options.to);
    if (!address) return fail("--to: " + address.error().message);
    if (const auto possible = check_options(options, *address); !possible) return possible;
    const Expected<DisplayDescription> display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    const auto color = host::parse_color(options.color);
    if (!color) return fail("--color: " + color.error().message);
    if (const auto fits = check_display_fits(*display); !fits) return fits;
    std::optional<io::AtomicFile> png;
    if (!options.png.empty()) {
        Expected<io::AtomicFile> file = io::AtomicFile::create(options.png);
        if (!file) return tl::unexpected(file.error());
        png = std::move(*file);
    }
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
    const Expected<Delivery> delivery = deliver(options, *address, *display, frame, voxels, png ? &*png : nullptr);
    if (!delivery) return tl::unexpected(delivery.error());
    (options.json ? print_json : print_text)(options, *display, voxels, lattice.sample_count(), *delivery);
    return {};
}

}  // namespace xorvox::tools
