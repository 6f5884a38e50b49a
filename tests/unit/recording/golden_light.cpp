// A golden recording, played to a simulated display, gives the light that the mesh's voxels ask for.
#include <bit>
#include <filesystem>

#include "driver/display/lattice.h"
#include "driver/host/pixel_encoder.h"
#include "sim/rebuild.h"
#include "sim/recording/playback.h"
#include "sim/simulator.h"
#include "tests/catch.h"
#include "tests/unit/recording/rig.h"
#include "tools/placement.h"
#include "transport/loopback.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/voxelize.h"

namespace xorvox::test {
namespace {

/// What is shown at the end.
sim::LightField play(sim::RecordingReader& reader, const DisplayFile& display) {
    auto [host_end, device_end] = transport::make_loopback();
    auto simulator = sim::Simulator::make(display, device_end.get());
    REQUIRE(simulator);
    std::uint64_t now_ns = 0;
    std::vector<std::byte> answer(65536);
    std::size_t size = 0;
    const auto settle = [&] {
        while (simulator->poll(now_ns) == Status::Ok) {
        }
        while (host_end->receive(answer, size) == Status::Ok) {
        }
    };
    sim::Playback playback(reader);
    while (playback.next() == Status::Ok) {
        while (simulator->next_boundary_ns() < playback.due_ns()) {
            now_ns = simulator->next_boundary_ns();
            settle();
        }
        now_ns = std::max(now_ns, playback.due_ns());
        while (host_end->send(playback.packet()) == Status::WouldBlock) settle();
        settle();
    }
    for (int cycle = 0; cycle < 2; ++cycle) {
        now_ns = simulator->next_boundary_ns();
        settle();
    }
    return simulator->light();
}

}  // namespace

TEST_CASE("the golden rotor, played to a simulated display, is lit where the duck's voxels are, in its colour") {
    sim::RecordingReader reader = open_golden("rotor.xvr");
    const DisplayFile display = *reader.display();
    auto mesh = io::read_mesh(XORVOX_SOURCE_DIR "/examples/duck.ply");
    REQUIRE(mesh);
    const auto placement =
        tools::fit_to_display([&mesh](const auto& visit) { visit(mesh->positions); }, display, "duck");
    REQUIRE(placement);
    for (glm::dvec3& position : mesh->positions) position = placement->place(position);
    const DisplayLattice lattice(display);
    const auto volume = voxelize(mesh->view(), lattice.view());
    REQUIRE(volume);

    // Orange, sRGB 255, 165, 0.
    const std::uint32_t code = host::PixelEncoder(display).nearest(glm::vec3(1.0f, 0.3763f, 0.0f));
    std::vector<sim::SampleCode> codes;
    const Lattice shape = lattice.view();
    for (std::uint32_t k = 0; k < shape.nz; ++k) {
        for (std::uint32_t y = 0; y < shape.ny; ++y) {
            for (std::uint32_t x = 0; x < shape.nx; ++x) {
                if (volume->test(x, y, k)) codes.push_back({(std::uint64_t{k} * shape.ny + y) * shape.nx + x, code});
            }
        }
    }
    REQUIRE(codes.size() > 1000);
    const sim::DisplaySamples samples(display);
    const sim::Rebuilt seen = samples.rebuild(play(reader, display));
    CHECK(seen.outside == 0);
    CHECK(seen == samples.faithful(codes));
}

TEST_CASE("every golden recording is whole, and small") {
    std::uintmax_t bytes = 0;
    for (const char* name : {"rotor.xvr", "cube.xvr", "sweep.xvr"}) {
        sim::RecordingReader reader = open_golden(name);
        REQUIRE(reader.display() != nullptr);
        const Read read = read_frames(reader, *reader.display());
        CHECK(read.damage.empty());
        CHECK(read.frames.size() == reader.frames().size());
        CHECK(read.frames.size() >= 2);
        bytes += std::filesystem::file_size(reader.name());
    }
    CHECK(bytes < 50'000);
}

}  // namespace xorvox::test
