#include "driver/device/scan_control.h"

#include <limits>
#include <set>

#include "driver/device/config.h"
#include "tests/unit/device/rig.h"

using namespace xorvox;
using namespace xorvox::test;
using device::Dark;
using device::ScanControl;
using device::ScanOrder;

namespace {

constexpr std::uint64_t kMs = 1'000'000;
constexpr std::uint64_t kTurnNs = 50 * kMs;

/// The cube of the desk as a rotor: 8 slices of one panel of 8 × 8, 20 turns a second, one pulse a turn.
DisplayDescription rotor8() {
    DisplayDescription display = kCube8;
    display.kind = DisplayKind::RotatingPanel;
    display.cycles_per_second = 20.0;
    display.sync = {.index = IndexSource::Pulses, .index_pulses = 1};
    return display;
}

/// A device on a desk whose panel turns: pulses come, the scanner does what it is told.
struct Bench : Desk {
    ScanControl control;
    DisplayDescription display;
    bool pulses_come = true;
    bool scanner_works = true;
    bool pings = true;
    std::uint64_t turn_ns = kTurnNs;
    std::uint64_t next_pulse_ns = 0;
    std::uint64_t next_ping_ns = 0;
    std::uint64_t scan_delay_ns = 0;  ///< How much later than the end of its slice the scanner is done.
    std::deque<ScanOrder> scanning;   ///< Lit orders that are not reported yet.
    std::vector<ScanOrder> orders;    ///< Every new one since the last run().

    explicit Bench(const DisplayDescription& of = rotor8(), const device::Wiring& wiring = {}) : display(of) {
        REQUIRE(control.init(device::scan_control_config(display, wiring), device, now_ns) == Status::Ok);
        next_pulse_ns = now_ns;
        hello();
        accept(1, frame_of(1));
    }
    explicit Bench(const device::Wiring& wiring) : Bench(rotor8(), wiring) {}

    const ScanOrder& last() const { return orders.back(); }
    bool dark() const { return !orders.empty() && !last().lit(); }

    /// Everything goes on for so long, in steps of 100 µs.
    void run(std::uint64_t duration_ns) {
        const ScanOrder before = orders.empty() ? ScanOrder{} : orders.back();
        orders.clear();
        if (before.number != 0) orders.push_back(before);
        for (const std::uint64_t end_ns = now_ns + duration_ns; now_ns < end_ns; now_ns += 100'000) {
            if (pulses_come && next_pulse_ns <= now_ns) {
                control.index_pulse(next_pulse_ns);
                next_pulse_ns += turn_ns;
            }
            if (pings && next_ping_ns <= now_ns) {
                send(Ping{});
                next_ping_ns = now_ns + 200 * kMs;
            }
            work();
            link.from_device.clear();
            while (scanner_works && !scanning.empty() && now_ns >= scanning.front().end_ns + scan_delay_ns) {
                control.scan_done(scanning.front(), scanning.front().end_ns + scan_delay_ns);
                scanning.pop_front();
            }
            take(control.poll(now_ns));
        }
    }
    void take(const ScanOrder& order) {
        if (order.lit()) {
            REQUIRE(order.begin_ns <= now_ns);
            REQUIRE(now_ns < order.end_ns);
            REQUIRE(order.slice < display.slices);
            REQUIRE(order.bytes.size() == slice_bytes(display));
            const Bytes page = shown();
            REQUIRE(order.bytes[0] == page[order.slice * order.bytes.size()]);
        } else {
            REQUIRE(order.bytes.empty());
            REQUIRE(order.brightness == 0);
        }
        if (!orders.empty() && orders.back().number == order.number) return;
        orders.push_back(order);
        if (order.lit()) scanning.push_back(order);
    }
    /// Turns until the picture is there.
    void light_up() {
        run(1000 * kMs);
        REQUIRE(last().lit());
    }
    std::uint32_t faults() const { return device.faults(); }
    void clear(Fault fault) {
        send(Control{ControlOperation::ClearFault, static_cast<std::uint32_t>(fault)});
        work();
        link.from_device.clear();
    }
};

}  // namespace

TEST_CASE("a rotor lights up once its index is locked, slice after slice, whole turns of one picture") {
    Bench bench;
    bench.run(100 * kMs);
    CHECK(bench.last().dark == Dark::NotLocked);
    bench.light_up();
    bench.run(10 * kTurnNs);
    CHECK(bench.orders.size() == 81);
    for (std::size_t i = 1; i < bench.orders.size(); ++i) {
        CHECK(bench.orders[i].slice == (bench.orders[i - 1].slice + 1) % 8);
        CHECK(bench.orders[i].begin_ns == bench.orders[i - 1].end_ns);
        CHECK(bench.orders[i].brightness == 255);
    }
    CHECK(bench.device.faults() == 0);
    CHECK(bench.device.status(bench.now_ns).shown_frame == 1);
}

TEST_CASE("the picture changes only where a turn begins") {
    Bench bench;
    bench.light_up();
    for (std::uint8_t frame = 2; frame < 20; ++frame) {
        bench.pings = false;
        bench.run(frame * 7u % 40u * kMs);
        bench.send_frame(frame, frame_of(frame));
        bench.run(2 * kTurnNs);
        CHECK(bench.device.shown().frame == frame);
    }
    const std::byte* page = nullptr;
    for (const ScanOrder& order : bench.orders) {
        const std::byte* of = order.bytes.data() - order.slice * order.bytes.size();
        if (page != nullptr && of != page) CHECK(order.slice == 0);
        page = of;
    }
}

TEST_CASE("with the host gone every fault blanks the display, and it stays dark until a command") {
    struct Case {
        Fault fault;
        void (*cause)(Bench&);
        void (*mend)(Bench&);
    };
    const Case cases[] = {
        {Fault::SilentHost, [](Bench& b) { b.device.set_link({}); }, [](Bench&) {}},
        {Fault::LateScan, [](Bench& b) { b.scanner_works = false; }, [](Bench& b) { b.scanner_works = true; }},
        {Fault::LostIndex, [](Bench& b) { b.pulses_come = false; },
         [](Bench& b) {
             b.pulses_come = true;
             b.next_pulse_ns = b.now_ns;
         }},
        {Fault::Overspeed, [](Bench& b) { b.turn_ns = kTurnNs * 2 / 3; }, [](Bench& b) { b.turn_ns = kTurnNs; }},
        {Fault::Stall,
         [](Bench& b) {
             for (; b.turn_ns < 110 * kMs; b.turn_ns += kMs) b.run(b.turn_ns);
         },
         [](Bench& b) { b.turn_ns = kTurnNs; }},
        {Fault::Interlock, [](Bench& b) { b.control.interlock(false); }, [](Bench& b) { b.control.interlock(true); }},
    };
    for (const Case& test : cases) {
        INFO("fault " << static_cast<int>(test.fault));
        Bench bench(device::Wiring{.reports_scans = true, .has_interlock = true});
        bench.control.interlock(true);
        bench.light_up();
        REQUIRE(bench.faults() == 0);
        // The host's link is gone; under the hold policy its silence is none.
        bench.pings = false;
        if (test.fault != Fault::SilentHost) {
            bench.send(Control{ControlOperation::SilencePolicy, 0});
            bench.work();
            bench.device.set_link({});
        }
        test.cause(bench);
        bench.run(3000 * kMs);
        CHECK((bench.faults() & fault_bit(test.fault)) != 0);
        CHECK(bench.last().dark == Dark::Fault);

        test.mend(bench);
        bench.run(5000 * kMs);
        CHECK(bench.orders.size() == 1);
        CHECK(bench.dark());

        // A host comes, learns of it, and clears it.
        bench.link.to_device.clear();
        bench.device.set_link(bench.link.link());
        ++bench.session;
        CHECK((bench.hello().fault >= test.fault));
        bench.run(200 * kMs);
        CHECK(bench.dark());
        for (std::uint8_t fault = 1; fault <= kHighestFault; ++fault) bench.clear(static_cast<Fault>(fault));
        bench.pings = true;
        bench.run(1000 * kMs);
        CHECK(bench.faults() == 0);
        CHECK(bench.last().lit());
    }
}

TEST_CASE("an encoder that runs backwards blanks the display with the host gone") {
    DisplayDescription display = rotor8();
    display.sync = {.index = IndexSource::Encoder, .index_pulses = 100};
    Bench bench(display);
    bench.pings = bench.pulses_come = false;
    const auto steps = [&](int count, std::int32_t each) {
        for (int i = 0; i < count; ++i) {
            bench.control.encoder(bench.now_ns, each);
            if (each > 0 && i % 100 == 99) bench.control.index_pulse(bench.now_ns);
            bench.run(500'000);
        }
    };
    steps(400, 1);
    REQUIRE(bench.last().lit());
    bench.device.set_link({});
    steps(20, -1);
    CHECK(bench.faults() == fault_bit(Fault::Reversed));
    steps(300, 1);
    CHECK(bench.last().dark == Dark::Fault);
}

TEST_CASE("an interlock is open until it is told to be closed, and opens for a moment only once") {
    Bench bench(device::Wiring{.has_interlock = true});
    bench.run(kMs);
    CHECK(bench.faults() == fault_bit(Fault::Interlock));
    bench.clear(Fault::Interlock);
    bench.run(kMs);
    CHECK(bench.faults() == fault_bit(Fault::Interlock));
    bench.control.interlock(true);
    bench.clear(Fault::Interlock);
    bench.light_up();
    CHECK(bench.faults() == 0);

    bench.control.interlock(false);
    bench.control.interlock(true);
    bench.run(kMs);
    CHECK(bench.faults() == fault_bit(Fault::Interlock));
    CHECK(bench.dark());
    bench.clear(Fault::Interlock);
    bench.run(kMs);
    CHECK(bench.faults() == 0);
    CHECK(bench.last().lit());
}

TEST_CASE("a display without an interlock can be given one while it runs") {
    Bench bench;
    bench.light_up();
    bench.control.interlock(false);
    bench.run(kMs);
    CHECK(bench.dark());
}

TEST_CASE("a scan-out that is late by less than a slice is let pass, by more is a fault") {
    Bench bench(device::Wiring{.reports_scans = true});
    bench.light_up();
    const std::uint64_t slice_ns = kTurnNs / 8;
    bench.scan_delay_ns = slice_ns * 8 / 10;
    bench.run(10 * kTurnNs);
    CHECK(bench.faults() == 0);
    bench.scan_delay_ns = slice_ns * 12 / 10;
    bench.run(10 * kTurnNs);
    CHECK(bench.faults() == fault_bit(Fault::LateScan));
    CHECK(bench.dark());
}

TEST_CASE("a late report is a fault even when nobody looked until it came") {
    Bench bench(device::Wiring{.reports_scans = true});
    bench.light_up();
    const ScanOrder order = bench.control.poll(bench.now_ns);
    bench.control.scan_done(order, order.end_ns + kTurnNs / 8 - 1000);
    (void)bench.control.poll(bench.now_ns);
    CHECK(bench.faults() == 0);
    bench.control.scan_done(order, order.end_ns + kTurnNs / 8 + 1000);
    (void)bench.control.poll(bench.now_ns);
    CHECK(bench.faults() == fault_bit(Fault::LateScan));
}

TEST_CASE("a scanner that hangs is noticed within two slices") {
    Bench bench(device::Wiring{.reports_scans = true});
    bench.light_up();
    bench.scanner_works = false;
    const std::uint64_t hangs_ns = bench.last().end_ns;
    while (bench.faults() == 0 && bench.now_ns < hangs_ns + kTurnNs) bench.run(100'000);
    CHECK(bench.faults() == fault_bit(Fault::LateScan));
    CHECK(bench.now_ns <= hangs_ns + kTurnNs / 8 + 300'000);
}

TEST_CASE("a display that does not turn is shown by the device's own clock") {
    Bench bench(kCube8);
    bench.pulses_come = false;
    bench.run(100 * kMs);
    const std::uint64_t cycle = cycle_ns(kCube8);
    CHECK(bench.last().lit());
    CHECK(bench.control.next_boundary_ns() == 1'000'000 + ((bench.now_ns - 1'100'000) / cycle + 1) * cycle);
    bench.run(1000 * kMs);
    CHECK(bench.orders.size() >= 60 * 8);
    CHECK(bench.faults() == 0);
}

TEST_CASE("after a long pause the last cycles alone are gone through, each at its own time") {
    Desk desk(8);
    ScanControl control;
    REQUIRE(control.init(device::scan_control_config(kCube8), desk.device, desk.now_ns) == Status::Ok);
    desk.hello();
    const std::uint64_t cycle = cycle_ns(kCube8);
    const std::uint64_t start = desk.now_ns;
    for (const std::uint64_t jump : {1ull, 3ull, 100ull, 1'000'000ull}) {
        INFO(jump << " cycles");
        // Two frames for two of the last boundaries: the later one is what is shown, from its own boundary on.
        const std::uint64_t cycles = (desk.now_ns - start) / cycle + jump;
        desk.accept(static_cast<std::uint32_t>(2 * jump), frame_of(1));
        desk.now_ns = start + cycles * cycle + 5;
        CHECK(control.poll(desk.now_ns).lit());
        const Acknowledge presented = desk.answer<Acknowledge>();
        CHECK(presented.stage == AckStage::Presented);
        CHECK(presented.device_time_ns == start + (cycles - std::min<std::uint64_t>(jump, 8) + 1) * cycle);
    }
}

TEST_CASE("time that goes back is the same time, and a pulse of the future waits") {
    Bench bench;
    bench.light_up();
    const ScanOrder order = bench.control.poll(bench.now_ns);
    CHECK(bench.control.poll(0).number == order.number);
    CHECK(bench.control.poll(bench.now_ns - kMs).slice == order.slice);
    // Read between the caller's clock and poll().
    bench.pulses_come = false;
    const device::Phase before = bench.control.rotation().phase();
    bench.control.index_pulse(bench.next_pulse_ns);
    bench.control.index_pulse(std::numeric_limits<std::uint64_t>::max());
    (void)bench.control.poll(bench.now_ns);
    CHECK(bench.control.rotation().phase() == before);
    bench.next_pulse_ns += kTurnNs;
    bench.run(kTurnNs);
    bench.pulses_come = true;
    bench.run(500 * kMs);
    CHECK(bench.faults() == 0);
    CHECK(bench.last().lit());
}

TEST_CASE("more pulses than the ring holds are lost, like pulses that were missed") {
    Bench bench;
    bench.light_up();
    for (int i = 0; i < 1000; ++i) bench.control.index_pulse(bench.now_ns);
    bench.run(1000 * kMs);
    CHECK((bench.faults() & ~fault_bit(Fault::LostIndex)) == 0);
}

TEST_CASE("the current limit dims a slice that would draw too much, and no other") {
    DisplayDescription display = rotor8();
    display.power = {.led_ma = 10.0, .limit_ma = 320.0};
    Bench bench(display);
    Bytes frame(64);
    std::fill(frame.begin() + 16, frame.begin() + 24, std::byte{0xff});  // slice 2: 64 LEDs, 640 mA
    std::fill(frame.begin() + 32, frame.begin() + 36, std::byte{0xff});  // slice 4: 32 LEDs, 320 mA
    bench.send_frame(2, frame);
    bench.light_up();
    bench.run(2 * kTurnNs);
    for (const ScanOrder& order : bench.orders) CHECK(order.brightness == (order.slice == 2 ? 127 : 255));

    bench.send(Control{ControlOperation::Brightness, 60});
    bench.run(2 * kTurnNs);
    CHECK(bench.last().brightness == 60);
}

TEST_CASE("the host's blank is dark without a fault") {
    Bench bench;
    bench.light_up();
    bench.send(Control{ControlOperation::Blank, 1});
    bench.run(5 * kMs);
    CHECK(bench.last().dark == Dark::NoPicture);
    bench.send(Control{ControlOperation::Blank, 0});
    bench.run(5 * kMs);
    CHECK(bench.last().lit());
}

TEST_CASE("a swept plane is dark at its ends, and shows every slice twice a cycle") {
    DisplayDescription display = kCube8;
    display.kind = DisplayKind::SweptPlane;
    display.cycles_per_second = 20.0;
    display.motion = {.stroke_mm = 80.0, .both_ways = true, .dead_zone = 0.1};
    display.sync = {.index = IndexSource::Pulses, .index_pulses = 1};
    Bench bench(display);
    bench.run(1000 * kMs);
    bench.run(kTurnNs);
    std::multiset<std::uint32_t> slices;
    int dark_zones = 0;
    for (std::size_t i = 1; i < bench.orders.size(); ++i) {
        if (bench.orders[i].lit()) slices.insert(bench.orders[i].slice);
        if (bench.orders[i].dark == Dark::DeadZone) ++dark_zones;
    }
    CHECK(slices.size() == 16);
    for (std::uint32_t s = 0; s < 8; ++s) CHECK(slices.count(s) == 2);
    CHECK(dark_zones >= 2);
}

TEST_CASE("a blank takes the output away before the rows") {
    using device::BlankStep;
    REQUIRE(device::kBlankSteps.size() == 3);
    CHECK(device::kBlankSteps[0] == BlankStep::OutputOff);
    CHECK(device::kBlankSteps[1] == BlankStep::ReleaseRows);
}

TEST_CASE("configurations that cannot be are refused") {
    Desk desk;
    ScanControl control;
    const auto refused = [&](auto&& change) {
        device::ScanControlConfig config = device::scan_control_config(rotor8());
        change(config);
        return control.init(config, desk.device, 0) == Status::InvalidArgument;
    };
    using Config = device::ScanControlConfig;
    CHECK_FALSE(refused([](Config&) {}));
    CHECK(refused([](Config& c) { c.rotation.pulses_per_turn = 0; }));
    CHECK(refused([](Config& c) { c.schedule.slices = 0; }));
    CHECK(refused([](Config& c) { c.schedule.slices = kMaxSlices + 1; }));
    CHECK(refused([](Config& c) { c.schedule.stroke_count = 3; }));
    CHECK(refused([](Config& c) { c.schedule.stroke_count = 2; }));
    CHECK(refused([](Config& c) { c.schedule.strokes[0].length = 3; }));
    CHECK(refused([](Config& c) { c.schedule.strokes[0].begin = 1; }));
    CHECK(refused([](Config& c) { c.current.row_groups = 0; }));
    CHECK(refused([](Config& c) { c.current.bit_planes = 9; }));
    CHECK(refused([](Config& c) { c.slice_bytes = 0; }));
}
