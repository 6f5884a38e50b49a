// A test without hardware: a host shows a solid on a display that does not turn evenly, and looks at every strobe.
// docs/testing.md walks through it. Any test framework will do; this is a program, which says what it found.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "driver/host/color.h"
#include "driver/host/session.h"
#include "driver/host/slices.h"
#include "sim/make_sim.h"
#include "voxelizer/mesh.h"
#include "voxelizer/voxelize.h"

using namespace xorvox;

namespace {

constexpr std::uint64_t kSecond = 1'000'000'000;

int failed(const char* what) {
    std::fprintf(stderr, "simulated_display: %s\n", what);
    return 1;
}

}  // namespace

int main() {
    // Two panels back to back, 72 slices a turn. Turns are up to 1 % longer or shorter, and the sensor misses every
    // twentieth pulse.
    Expected<sim::SimRig> made = sim::make_sim()
                                     .rotating(72)
                                     .panel(32, 16)
                                     .panel(32, 16)
                                     .format(PixelFormat::Rgb332)
                                     .jitter(0.01)
                                     .missed(0.05)
                                     .seed(7)
                                     .build();
    if (!made) return failed(made.error().message.c_str());
    sim::SimRig& rig = *made;

    // What the host shows: a tetrahedron of 20 mm, in orange.
    Mesh mesh;
    mesh.positions = {{-20, -20, -10}, {20, -20, -10}, {0, 20, -10}, {0, 0, 10}};
    mesh.indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    const host::FramePainter painter(rig.display());
    const Expected<BitVolume> volume = voxelize(mesh.view(), painter.lattice().view());
    if (!volume) return failed(volume.error().message.c_str());
    const auto orange = host::parse_color("constant:#ff8000");
    if (!orange) return failed(orange.error().message.c_str());
    std::vector<std::byte> frame(frame_bytes(rig.display()));
    if (painter.paint(volume->view(), **orange, frame) != Status::Ok) return failed("the frame cannot be painted");

    // The rig's time goes on only when it is told to, and it polls the host as it goes.
    host::Session session(rig.host_end(), rig.display());
    rig.set_host([&](std::uint64_t now_ns) { (void)session.poll(now_ns); });
    if (session.submit(frame) != Status::Ok) return failed("the session does not take a frame");
    if (!rig.run_until([&] { return session.last_presented() != 0; }, 2 * kSecond)) return failed("it is never shown");
    rig.run_for(2 * kSecond);

    // Every strobe tells where the display really was.
    double worst = 0.0;
    for (const sim::SeenStrobe& strobe : rig.strobes()) worst = std::max(worst, std::abs(strobe.slices_off));
    const sim::TimingWatch& timing = rig.simulator().timing();
    std::printf("%zu strobes, none more than %.1f slices off its own\n%s\n", rig.strobes().size(), worst,
                sim::to_json(timing.timing()).c_str());
    if (rig.simulator().device().faults() != 0) return failed("the display has a fault");
    if (worst > 7.2) return failed("light is a tenth of a turn off");
    return 0;
}
