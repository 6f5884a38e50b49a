// Traces as sigrok-cli reads them: another program's decoders see the bits that were sent.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "driver/display/toml.h"
#include "sim/scan_out.h"
#include "sim/vcd.h"
#include "tests/catch.h"
#include "tests/unit/io/temp_folder.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/orders.h"
#include "tests/unit/sim/vcd_reader.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

/// What sigrok-cli says of a trace; empty where it is not installed.
std::string sigrok(const std::string& trace, const std::string& arguments) {
    const std::string command = "sigrok-cli -I vcd -i '" + trace + "' " + arguments + " 2>&1";
    std::string out;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    char buffer[4096];
    while (const std::size_t read = std::fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, read);
    REQUIRE(::pclose(pipe) == 0);
    return out;
}

bool has_sigrok() {
    return std::system("sigrok-cli --version >/dev/null 2>&1") == 0;
}

/// The trace of slices of a random page, each for its time.
std::string traced(const DisplayDescription& display, const std::vector<std::byte>& page, std::uint32_t slices,
                   std::uint64_t slice_ns) {
    std::string text;
    sim::VcdWriter trace(sim::pin_names(display), {.scope = std::string(display.name.view())},
                         [&](std::string_view bytes) -> Expected<void> {
                             text += bytes;
                             return {};
                         });
    auto scan = sim::make_edge_scan(display, {}, [&](std::uint64_t time_ns, LineMask levels, LineMask changed) {
        trace.on_pins(time_ns, levels, changed);
    });
    REQUIRE(scan);
    for (std::uint32_t slice = 0; slice < slices; ++slice) {
        const std::uint64_t begin_ns = slice * slice_ns;
        (*scan)->begin(lit_order(display, page, slice, begin_ns, begin_ns + slice_ns), 1, begin_ns);
    }
    (*scan)->run_until(slices * slice_ns);
    REQUIRE(trace.finish(slices * slice_ns));
    return text;
}

/// The levels of a wire from when on they are others than before: what a sampler of one nanosecond sees.
std::map<std::string, std::vector<std::pair<std::uint64_t, bool>>> sampled(const Vcd& vcd) {
    std::map<std::string, std::vector<std::pair<std::uint64_t, bool>>> wires;
    for (const auto& [wire, level] : vcd.initial) wires[wire] = {{0, level}};
    for (const Vcd::Change& change : vcd.changes) {
        auto& levels = wires.at(change.wire);
        const std::uint64_t time = change.time - vcd.begin;
        if (levels.back().first == time) levels.pop_back();
        if (levels.empty() || levels.back().second != change.level) levels.emplace_back(time, change.level);
    }
    return wires;
}

}  // namespace

TEST_CASE("sigrok's SPI decoder finds a cube's rows and layers in a trace", "[sim][vcd][sigrok]") {
    if (!has_sigrok()) XORVOX_SKIP("sigrok-cli is not installed");
    const auto cube = load_display("cube8-595");
    REQUIRE(cube);
    const std::vector<std::byte> page = random_page(*cube, 5);
    const std::uint32_t slices = 8;
    const TempFolder folder;
    put(folder / "cube.vcd", traced(*cube, page, slices, 200'000));

    // Most significant bit first, pixels first: rows 7 … 0, then the layer's byte. After each slice's data nothing more
    // is shifted.
    std::string expected;
    for (std::uint32_t slice = 0; slice < slices; ++slice) {
        char text[32];
        for (std::size_t row = 8; row-- > 0;) {
            std::snprintf(text, sizeof text, "spi-1: %02X\n", std::to_integer<unsigned>(page[slice * 8 + row]));
            expected += text;
        }
        std::snprintf(text, sizeof text, "spi-1: %02X\n", 1u << slice);
        expected += text;
    }
    CHECK(sigrok(folder / "cube.vcd", "-P spi:clk=clock:mosi=data:wordsize=8 -A spi=mosi-data") == expected);
}

TEST_CASE("sigrok reads every level of a hub75 trace as it was", "[sim][vcd][sigrok]") {
    if (!has_sigrok()) XORVOX_SKIP("sigrok-cli is not installed");
    DisplayDescription display = rotor_of(9, 8, 4, PixelFormat::Rgb332, 2);
    display.panels[1].connector = 1;
    display.scan.driver = DriverChip::Hub75;
    display.scan.row_groups = 4;
    display.scan.pixel_clock_hz = 20'000'000;
    display.scan.latch_ns = 100;
    const TempFolder folder;
    const std::string ours = traced(display, random_page(display, 6), 4, 20'000);
    put(folder / "hub75.vcd", ours);

    std::string theirs = sigrok(folder / "hub75.vcd", "-O vcd");
    theirs = theirs.substr(theirs.find("$date"));
    const auto read = sampled(read_vcd(theirs));
    const auto written = sampled(read_vcd(ours));
    REQUIRE(read.size() == 3 + 2 + 12);
    const auto rises = [&](const std::string& wire) {
        return std::ranges::count_if(read.at(wire), [](const auto& level) { return level.second; });
    };
    CHECK(rises("clock") == 4 * 4 * 3 * 9);  // Slices, row groups, planes, columns.
    CHECK(rises("latch") == 4 * 4 * 3);
    for (const auto& [wire, levels] : written) {
        INFO(wire);
        REQUIRE(read.contains(wire));
        CHECK(std::ranges::equal(read.at(wire), levels));
    }
    CHECK(read_vcd(theirs).end == 80'000);
}
