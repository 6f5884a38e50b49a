// What `show --to file:` leaves can be played to a display.
#include <string>
#include <vector>

#include "driver/display/toml.h"
#include "sim/simulator.h"
#include "tests/catch.h"
#include "tests/cli/process.h"
#include "transport/file.h"
#include "transport/loopback.h"

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("two recordings that are played to one display are both shown", "[cli]") {
    const Folder folder;
    const std::string duck = std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply";
    auto [host_end, device_end] = transport::make_loopback();
    auto display = sim::Simulator::make(*load_display("cube16-ws2812"), device_end.get());
    REQUIRE(display.has_value());

    std::uint64_t now_ns = 0;
    for (const std::string color : {"red", "blue"}) {
        const std::string path = folder.path(color);
        REQUIRE(run_program({"show", duck, "--display", "cube16-ws2812", "--color", "constant:" + color, "--to",
                             "file:" + path})
                    .status == 0);
        auto recording = transport::open_file_reader(path);
        REQUIRE(recording.has_value());
        std::vector<std::byte> packet(65536);
        std::size_t size = 0;
        while ((*recording)->receive(packet, size) == Status::Ok) {
            REQUIRE(host_end->send(std::span(packet).first(size)) == Status::Ok);
            (void)display->poll(now_ns);
        }
        now_ns = display->next_boundary_ns();
        (void)display->poll(now_ns);
        const sim::LightField light = display->light();
        REQUIRE(light.flashes.size() > 100);
        CHECK(light.light(light.flashes.front()) == (color == "red" ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1)));
    }
}
