// Nothing that happens in the middle of a scan leaves a row lit: looked at on the pins, by chips that know no scanner.
// Each test cuts a scan everywhere: after every step, at every edge, at every call that can fail.
#include <cstdint>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/device/scan_rig.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr std::uint64_t kAvailableNs = 60'000;

/// The times of all edges of a scan, and those in the middle between them.
std::vector<std::uint64_t> interesting_times(const DisplayDescription& display, std::span<const std::byte> bytes) {
    ScanRig rig(display);
    REQUIRE(rig.scan(lit_order(bytes), kAvailableNs) == Status::Ok);
    std::vector<std::uint64_t> times{0};
    for (const Bench::Edge& edge : rig.bench->edges) {
        if (edge.time_ns > times.back() + 1) times.push_back((times.back() + edge.time_ns) / 2);
        if (edge.time_ns > times.back()) times.push_back(edge.time_ns);
    }
    return times;
}

/// Scans until the world is at `time_ns`, and no further.
void scan_until(ScanRig& rig, std::span<const std::byte> bytes, std::uint64_t time_ns) {
    rig.lines().limit(time_ns);
    REQUIRE(rig.begin(lit_order(bytes), kAvailableNs) == Status::Ok);
    while (rig.lines().time_ns() <= time_ns && !rig.finished()) REQUIRE(rig.step() == Status::Ok);
    rig.lines().cut();
    rig.lines().limit(transport::VirtualLines::kNoLimit);
}

LinesOperations without_strobe(Lines lines) {
    LinesOperations operations = *lines.operations;
    operations.strobe = nullptr;
    operations.join = nullptr;
    return operations;
}

bool is_dark_and_cleared(const Chips& chips) {
    return !chips.output_on() && chips.rows_released() && chips.columns_clear();
}

/// Watches a blank: output off first, then rows, then columns, each once it is done for good.
struct BlankOrder {
    explicit BlankOrder(ScanRig& rig) : rig_(&rig) {
        rows_were_ = rig.bench->chips().rows_released();
        columns_were_ = rig.bench->chips().columns_clear();
        rig.bench->after_edge = [this](const Bench::Edge&) { look(); };
    }
    ~BlankOrder() { rig_->bench->after_edge = nullptr; }
    BlankOrder(const BlankOrder&) = delete;
    BlankOrder& operator=(const BlankOrder&) = delete;

    bool kept = true;

private:
    void look() {
        const Chips& chips = rig_->bench->chips();
        if (chips.output_on()) kept = false;  // Dark from the first edge on.
        if (chips.columns_clear() && !columns_were_ && !chips.rows_released()) kept = false;  // Rows before columns.
        if (!chips.rows_released() && rows_were_) kept = false;                               // Released rows stay so.
        rows_were_ = chips.rows_released();
        columns_were_ = chips.columns_clear();
    }
    ScanRig* rig_;
    bool rows_were_ = false;
    bool columns_were_ = false;
};

}  // namespace

TEST_CASE("a blank at any edge of a scan and between them darkens at once, in the order of kBlankSteps") {
    for (const DisplayDescription& display : small_displays()) {
        INFO(display.name.view());
        const auto bytes = random_slice(display, 1);
        std::size_t while_lit = 0;
        for (const std::uint64_t time_ns : interesting_times(display, bytes)) {
            for (const bool by_order : {false, true}) {
                ScanRig rig(display);
                scan_until(rig, bytes, time_ns);
                REQUIRE(rig.lines().time_ns() <= time_ns);
                const bool was_lit = rig.bench->chips().output_on();
                const std::uint64_t now_ns = rig.lines().time_ns();
                while_lit += was_lit ? 1 : 0;
                const std::size_t lights = rig.bench->lights.size();
                {
                    const BlankOrder order(rig);
                    REQUIRE((by_order ? rig.begin({}, 0) : rig.blank()) == Status::Ok);
                    CHECK(order.kept);
                }
                CHECK(rig.finished());
                CHECK(rig.bench->lights.size() == lights);
                if (was_lit) CHECK(rig.bench->lights.back().off_ns == now_ns);
                CHECK(is_dark_and_cleared(rig.bench->chips()));
            }
        }
        CHECK(while_lit > 10);
    }
}

TEST_CASE("a new slice in the middle of another ends its light at once, and is whole itself") {
    for (const DisplayDescription& display : small_displays()) {
        INFO(display.name.view());
        const auto bytes = random_slice(display, 1);
        const auto next = random_slice(display, 2);
        ScanRig alone(display);
        REQUIRE(alone.scan(lit_order(next), kAvailableNs) == Status::Ok);
        for (const std::uint64_t time_ns : interesting_times(display, bytes)) {
            ScanRig rig(display);
            scan_until(rig, bytes, time_ns);
            const std::uint64_t begin_ns = rig.lines().time_ns();
            const bool was_lit = rig.bench->chips().output_on();
            REQUIRE(rig.begin(lit_order(next), kAvailableNs) == Status::Ok);
            CHECK_FALSE(rig.bench->chips().output_on());
            if (was_lit) CHECK(rig.bench->lights.back().off_ns == begin_ns);
            const std::size_t before = rig.bench->lights.size();
            const auto light_before = rig.bench->light_ns;
            while (!rig.finished()) REQUIRE(rig.step() == Status::Ok);
            REQUIRE(rig.bench->lights.size() - before == alone.bench->lights.size());
            CHECK(rig.bench->lights[before].on_ns - begin_ns == alone.bench->lights[0].on_ns);
            bool equal = true;
            for (std::size_t i = 0; i < light_before.size(); ++i) {
                equal = equal && rig.bench->light_ns[i] - light_before[i] == alone.bench->light_ns[i];
            }
            CHECK(equal);
        }
    }
}

TEST_CASE("lines that fail once, at any call of a scan or a blank, leave it dark and cleared, and it says so") {
    for (const DisplayDescription& display : small_displays()) {
        INFO(display.name.view());
        const auto bytes = random_slice(display, 1);
        std::uint64_t calls = 0;
        {
            ScanRig rig(display);
            REQUIRE(rig.scan(lit_order(bytes), kAvailableNs) == Status::Ok);
            calls = rig.lines().sets();
            REQUIRE(rig.blank() == Status::Ok);
            CHECK(rig.lines().sets() > calls);
        }
        for (std::uint64_t k = 0; k < calls; ++k) {
            ScanRig rig(display);
            rig.lines().fail_sets(k);
            CHECK(rig.scan(lit_order(bytes), kAvailableNs) == Status::Closed);
            CHECK(rig.finished());
            CHECK(is_dark_and_cleared(rig.bench->chips()));
            const std::size_t lights = rig.bench->lights.size();
            CHECK(rig.step() == Status::Ok);
            rig.lines().advance_to(1'000'000'000);
            CHECK(rig.bench->lights.size() == lights);
            CHECK(rig.scan(lit_order(bytes), kAvailableNs) == Status::Ok);
        }
        // A blank in which one call fails, in the middle of a strobe.
        const std::uint64_t lit_ns = [&] {
            ScanRig rig(display);
            REQUIRE(rig.scan(lit_order(bytes), kAvailableNs) == Status::Ok);
            return rig.bench->lights[1].on_ns + 10;
        }();
        for (std::uint64_t k = 0; k < 10; ++k) {
            ScanRig rig(display);
            scan_until(rig, bytes, lit_ns);
            REQUIRE(rig.bench->chips().output_on());
            const std::uint64_t before = rig.lines().sets();
            rig.lines().fail_sets(k);
            const Status status = rig.blank();
            if (rig.lines().sets() - before < k) {
                CHECK(status == Status::Ok);
                break;
            }
            CHECK_FALSE(rig.bench->chips().output_on());
            CHECK(rig.bench->lights.back().off_ns == lit_ns);
            if (status != Status::Ok) CHECK(k < 7);
        }
    }
}

TEST_CASE("an output that cannot be switched off twice ends with its strobe, and no row is changed before") {
    for (const DisplayDescription& display : small_displays()) {
        INFO(display.name.view());
        const auto bytes = random_slice(display, 1);
        ScanRig plain(display);
        REQUIRE(plain.scan(lit_order(bytes), kAvailableNs) == Status::Ok);
        for (const Lit& light : plain.bench->lights) {
            ScanRig rig(display);
            scan_until(rig, bytes, light.on_ns + 5);
            rig.lines().fail_sets(0, 2);
            CHECK(rig.blank() == Status::Closed);
            CHECK((rig.bench->lights.back() == light));
            CHECK(is_dark_and_cleared(rig.bench->chips()));
        }
    }
}

TEST_CASE("three calls that fail, wherever, leave lines dark that cannot strobe by themselves") {
    for (const DisplayDescription& display : small_displays()) {
        INFO(display.name.view());
        const auto bytes = random_slice(display, 1);
        std::size_t failed = 0;
        for (std::uint64_t k = 0;; ++k) {
            ScanRig rig(display);
            const LinesOperations plain = without_strobe(rig.lines().lines());
            rig.replace_lines({&plain, rig.lines().lines().self});
            rig.lines().fail_sets(k, 3);
            const Status status = rig.scan(lit_order(bytes), kAvailableNs);
            if (status == Status::Ok) break;
            ++failed;
            if (rig.bench->chips().output_on()) FAIL_CHECK("lit after " << k << " calls");
        }
        CHECK(failed > 10);
    }
}

TEST_CASE("nothing is shifted while a latch is open, also after a pulse of it that was cut") {
    for (const DisplayDescription& display : {small_hub75(), small_cube()}) {
        INFO(display.name.view());
        const LineMask clock = device::line_bit(device::Hub75Pins{}.clock);
        const LineMask latch = device::line_bit(device::Hub75Pins{}.latch);
        REQUIRE(device::ShiftRegisterPins{}.clock == device::Hub75Pins{}.clock);
        REQUIRE(device::ShiftRegisterPins{}.latch == device::Hub75Pins{}.latch);
        const auto bytes = random_slice(display, 1);
        std::size_t open = 0;
        for (const std::uint64_t time_ns : interesting_times(display, bytes)) {
            for (const bool by_blank : {false, true}) {
                ScanRig rig(display);
                scan_until(rig, bytes, time_ns);
                if ((rig.lines().levels() & latch) == 0) continue;
                ++open;
                bool closed = true;
                rig.bench->after_edge = [&](const Bench::Edge& edge) {
                    if ((edge.changed & clock) != 0 && (edge.levels & latch) != 0) closed = false;
                };
                REQUIRE((by_blank ? rig.blank() : rig.scan(lit_order(bytes), kAvailableNs)) == Status::Ok);
                rig.bench->after_edge = nullptr;
                CHECK(closed);
            }
        }
        CHECK(open > 2);
    }
}

TEST_CASE("lines that strobe and cannot join are refused") {
    for (const DisplayDescription& display : small_displays()) {
        ScanRig rig(display);
        LinesOperations operations = *rig.lines().lines().operations;
        operations.join = nullptr;
        CHECK(rig.init({&operations, rig.lines().lines().self}) == Status::InvalidArgument);
        CHECK(rig.init({}) == Status::InvalidArgument);
        operations.strobe = nullptr;
        CHECK(rig.init({&operations, rig.lines().lines().self}) == Status::Ok);
    }
}

TEST_CASE("lines that fail for good, at any call, are lit no longer than the strobe that runs") {
    for (const DisplayDescription& display : small_displays()) {
        INFO(display.name.view());
        const auto bytes = random_slice(display, 1);
        ScanRig plain(display);
        REQUIRE(plain.scan(lit_order(bytes), kAvailableNs) == Status::Ok);
        const std::uint64_t calls = plain.lines().sets();
        for (std::uint64_t k = 0; k < calls; ++k) {
            ScanRig rig(display);
            rig.lines().fail_sets(k, ~std::uint64_t{0});
            CHECK(rig.scan(lit_order(bytes), kAvailableNs) == Status::Closed);
            rig.lines().advance_to(1'000'000'000);
            CHECK_FALSE(rig.bench->chips().output_on());
            bool planned = rig.bench->lights.size() <= plain.bench->lights.size();
            for (std::size_t i = 0; planned && i < rig.bench->lights.size(); ++i) {
                planned = rig.bench->lights[i] == plain.bench->lights[i];
            }
            CHECK(planned);
        }
    }
}

TEST_CASE("a program that hangs or destroys its scanner after any step leaves nothing lit") {
    for (const DisplayDescription& display : small_displays()) {
        INFO(display.name.view());
        const auto bytes = random_slice(display, 1);
        ScanRig plain(display);
        REQUIRE(plain.scan(lit_order(bytes), kAvailableNs) == Status::Ok);
        for (std::size_t steps = 0;; ++steps) {
            ScanRig rig(display);
            REQUIRE(rig.begin(lit_order(bytes), kAvailableNs) == Status::Ok);
            for (std::size_t i = 0; i < steps && !rig.finished(); ++i) REQUIRE(rig.step() == Status::Ok);
            const bool all = rig.finished();
            rig.destroy();
            rig.lines().advance_to(1'000'000'000);
            CHECK_FALSE(rig.bench->chips().output_on());
            bool planned = true;
            for (std::size_t i = 0; i < rig.bench->lights.size(); ++i) {
                planned = planned && rig.bench->lights[i] == plain.bench->lights[i];
            }
            CHECK(planned);
            if (all) break;
        }
    }
}

TEST_CASE("a program that ends at any edge of a scan leaves the safe levels behind") {
    for (const DisplayDescription& display : small_displays()) {
        INFO(display.name.view());
        const auto bytes = random_slice(display, 1);
        for (const std::uint64_t time_ns : interesting_times(display, bytes)) {
            ScanRig rig(display);
            scan_until(rig, bytes, time_ns);
            { const UniqueLines owner(rig.lines().lines()); }
            CHECK_FALSE(rig.bench->chips().output_on());
            if (!rig.finished()) CHECK(rig.step() == Status::Closed);
            CHECK(rig.blank() == Status::Closed);
            CHECK_FALSE(rig.bench->chips().output_on());
        }
    }
}

TEST_CASE("two rows are never lit together, and the row and its data stand before the light and until it ends") {
    for (const DisplayDescription& display : small_displays()) {
        INFO(display.name.view());
        const auto bytes = random_slice(display, 1);
        ScanRig rig(display);
        bool still = true;
        bool was_on = false;
        int row = 0;
        std::vector<bool> lit;
        rig.bench->after_edge = [&](const Bench::Edge&) {
            const Chips& chips = rig.bench->chips();
            std::vector<bool> now;
            if (chips.output_on()) {
                for (const Led& led : Bench::all_leds(display)) now.push_back(chips.lit(led));
                if (was_on) still = still && chips.selected() == row && now == lit;
                row = chips.selected();
            }
            was_on = chips.output_on();
            lit = now;
        };
        REQUIRE(rig.blank() == Status::Ok);
        REQUIRE(rig.scan(lit_order(bytes), kAvailableNs) == Status::Ok);
        CHECK(still);
        CHECK_FALSE(rig.bench->several);
        CHECK(rig.bench->lights.size() > 1);
    }
}
