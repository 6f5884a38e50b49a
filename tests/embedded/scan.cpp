#include "tests/embedded/scan.h"

#include <array>
#include <cstring>
#include <span>

#include "driver/device/config.h"
#include "driver/device/scan/scan_loop.h"
#include "driver/device/scan/shift_register_scan.h"

using namespace xorvox;

namespace {

constexpr DisplayDescription kCube = [] {
    DisplayDescription display;
    display.name = DisplayName("cube8");
    display.slices = 8;
    display.cycles_per_second = 60.0;
    display.panels[0] = {.columns = 8, .rows = 8};
    display.scan.driver = DriverChip::ShiftRegister595;
    display.scan.pixel_clock_hz = 8'000'000;
    display.scan.latch_ns = 1000;
    display.scan.min_on_ns = 10'000;
    return display;
}();
constexpr device::ShiftRegisterConfig kScan = device::shift_register_config(kCube);
constexpr device::ScanControlConfig kControl = device::scan_control_config(kCube, {.reports_scans = true});
constexpr std::uint64_t kSliceNs = kControl.rotation.cycle_ns / 8;

/// Nine 74HC595 on pins 0 … 3, a timer for the output enable, and what the cube then shows.
struct Board {
    std::uint64_t now_ns = 0;
    unsigned pins = 0b100;  // Clock, latch, output enable (low: lit), data.
    std::uint64_t strobe_end_ns = 0;
    std::uint64_t stages = 0;  ///< 0 … 63; 0 … 7 are the layers.
    std::uint64_t far_stages = 0;
    std::uint64_t layers = 0xff;  ///< Outputs; at power-on anything.
    std::uint64_t columns = ~std::uint64_t{0};

    std::span<const std::byte> page;
    std::uint64_t begin_ns = 0;
    unsigned lights = 0;
    const char* wrong = nullptr;

    void set(unsigned mask, unsigned levels) {
        const unsigned before = pins;
        pins = (pins & ~mask) | (levels & mask);
        const unsigned rose = pins & ~before;
        if ((rose & 0b001) != 0) {
            far_stages = far_stages << 1 | stages >> 63;
            stages = stages << 1 | (pins >> 3 & 1u);
        }
        if ((rose & 0b010) != 0) {
            if ((pins & 0b100) == 0) wrong = "data were latched while it was lit\n";
            layers = stages & 0xff;
            columns = stages >> 8 | far_stages << 56;
        }
    }
    bool dark() const { return (pins & 0b100) != 0 && now_ns >= strobe_end_ns; }
    void light(std::uint64_t ns) {
        const std::uint64_t layer = (now_ns - begin_ns) / kSliceNs % 8;
        std::uint64_t expected = 0;
        std::memcpy(&expected, page.data() + 8 * layer, 8);
        if (layers != std::uint64_t{1} << layer) wrong = "another layer is lit\n";
        if (columns != expected) wrong = "a layer's columns differ from the page\n";
        // The host asked for half the light.
        if (ns < kSliceNs * 4 / 10 || ns > kSliceNs * 6 / 10) wrong = "a layer is lit for another time\n";
        strobe_end_ns = now_ns + ns;
        ++lights;
    }
};

constexpr LinesOperations kBoardLines{
    .info =
        [](const void*) {
            return LinesInfo{"board", 0b1111, 0, 16'000'000};
        },
    .set =
        [](void* self, LineMask mask, LineMask levels) {
            auto& board = *static_cast<Board*>(self);
            if ((mask & 0b100) != 0) board.strobe_end_ns = board.now_ns;
            board.set(static_cast<unsigned>(mask), static_cast<unsigned>(levels));
            return Status::Ok;
        },
    .write =
        [](void* self, LineMask mask, std::span<const LineMask> levels) {
            auto& board = *static_cast<Board*>(self);
            for (const LineMask level : levels) board.set(static_cast<unsigned>(mask), static_cast<unsigned>(level));
            board.now_ns += levels.size() * 125 / 2;
            return Status::Ok;
        },
    .hold =
        [](void* self, std::uint64_t ns) {
            static_cast<Board*>(self)->now_ns += ns;
            return Status::Ok;
        },
    .strobe =
        [](void* self, LineMask mask, LineMask levels, std::uint64_t ns) {
            auto& board = *static_cast<Board*>(self);
            if (mask != 0b100 || levels != 0) return Status::InvalidArgument;
            board.light(ns);
            return Status::Ok;
        },
    .join =
        [](void* self) {
            auto& board = *static_cast<Board*>(self);
            if (board.now_ns < board.strobe_end_ns) board.now_ns = board.strobe_end_ns;
            return Status::Ok;
        },
    .get = [](void*, LineMask&) { return Status::Unsupported; },
    .edges = nullptr,
    .wait = nullptr,
    .close = [](void*) {},
};

std::array<std::uint64_t, scan_buffer_words(kScan)> buffer;
Board board;
device::ShiftRegisterScan scanner;

}  // namespace

const char* scan_out(device::Device& device, device::ScanControl& control, std::uint64_t& now_ns) {
    board.now_ns = board.begin_ns = now_ns;
    board.page = device.shown().page;
    if (control.init(kControl, device, now_ns) != Status::Ok) return "the cube cannot be controlled\n";
    if (scanner.init(kScan, {&kBoardLines, &board}, buffer) != Status::Ok) return "the cube cannot be scanned\n";
    device::ScanLoop loop(control, scanner);
    if (loop.stop() != Status::Ok || board.layers != 0 || board.columns != 0) return "the board is not cleared\n";
    while (board.now_ns < board.begin_ns + 16 * kSliceNs) {
        const std::uint64_t before_ns = board.now_ns;
        if (loop.poll(board.now_ns) != Status::Ok) return "the scan fails\n";
        if (board.wrong != nullptr) return board.wrong;
        if (board.now_ns == before_ns) board.now_ns += 2000;
    }
    if (board.lights < 15) return "too few layers were lit\n";
    if (loop.stop() != Status::Ok || !board.dark() || board.layers != 0 || board.columns != 0) {
        return "it is not dark at the end\n";
    }
    if (device.fault() != wire::Fault::None) return "the scan raised a fault\n";
    now_ns = board.now_ns;
    return nullptr;
}
