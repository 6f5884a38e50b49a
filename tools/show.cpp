// show: mesh → voxels on the display's own samples → colours → frame → packets → a display, simulated here or far away.
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "tools/commands.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/stage.h"
#include "voxelizer/io/file_name.h"

namespace xorvox::tools {
namespace {

Expected<void> show_still(const StageOptions& options) {
    if (const auto possible = check_still(options.light); !possible) return possible;
    const auto set = set_stage(options, Turning::Not);
    if (!set) return tl::unexpected(set.error());
    Stage& stage = **set;
    std::vector<std::byte> frame(frame_bytes(stage.display));
    std::size_t voxels = 0;
    {
        const Progress progress("voxelizing");
        if (const auto drawn = stage.maker->draw(); !drawn) return drawn;
        if (const auto painted = stage.maker->paint(frame); !painted) return painted;
        voxels = stage.maker->volume().count();
    }
    if (voxels == 0) {
        warn(io::printable_name(options.mesh.path) +
             ": no sample of the display is inside it; it may be thinner than the display's pitch");
    }
    const DeliveryOptions& to = options.delivery;
    const Expected<Delivery> delivery =
        deliver(to, stage.address, stage.display, frame, voxels, stage.picture(), stage.recorder());
    if (!delivery) {
        keep_recording(to, stage.recorder());
        return tl::unexpected(delivery.error());
    }
    if (to.json) {
        fmt::print("{{{}, \"bytes_raw\": {}, \"bytes_sent\": {}, \"two_way\": {}, {}}}\n",
                   stage_json(options, stage, voxels), delivery->session.bytes_raw, delivery->session.bytes_sent,
                   stage.address.kind != transport::AddressKind::File, picture_json(to, delivery->light));
        return finish_recording(to, stage.recorder());
    }
    fmt::print("{}: {} of {} samples are inside\n", stage.display.name.view(), thousands(voxels),
               thousands(frame_pixels(stage.display)));
    fmt::print("sent to {}: {} bytes as {}\n", to.to, thousands(delivery->session.bytes_raw),
               thousands(delivery->session.bytes_sent));
    print_light(options, stage, delivery->light);
    if (voxels > 0 && delivery->light && delivery->light->statistics.pixels_lit == 0) {
        warn("all " + thousands(voxels) + " samples inside are dark: --color or --brightness makes them black");
    }
    return finish_recording(to, stage.recorder());
}

}  // namespace

Expected<void> show(const ShowOptions& options) {
    if (!options.spin_rpm) return show_still(options.stage);
    PlayOptions spinning;
    spinning.stage = options.stage;
    spinning.spin_rpm = options.spin_rpm;
    spinning.seconds = options.seconds;
    return play(spinning);
}

}  // namespace xorvox::tools
