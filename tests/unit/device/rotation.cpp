#include "driver/device/rotation.h"

#include "tests/unit/device/rotor.h"

using namespace xorvox;
using namespace xorvox::test;
using wire::Fault;
using wire::fault_bit;
using State = RotationTracker::State;

namespace {

constexpr double kPi = 3.14159265358979;
constexpr double kSlice = 1.0 / 360.0;

}  // namespace

TEST_CASE("the phase follows a steady rotor to a hundredth of a slice, whatever it counts by") {
    for (const std::uint32_t pulses : {1u, 2u, 3u, 7u, 60u, 1000u}) {
        INFO(pulses << " pulses a turn");
        Rotor rotor(pulses_at_20(pulses));
        rotor.turn(1.0, 20.0);
        CHECK(rotor.locked());
        rotor.forget();
        rotor.turn(10.0, 20.0);
        CHECK(rotor.worst_error < kSlice / 100);
        CHECK(rotor.locked_seconds == Approx(10.0));
        CHECK(rotor.faults == 0);
        CHECK(rotor.tracker.turn_ns() == Approx(50e6).epsilon(1e-4));
    }
}

TEST_CASE("the mark is where the description says, on every cycle of a turn") {
    for (const std::uint32_t cycles : {1u, 2u, 3u}) {
        RotationConfig config = pulses_at_20(1, cycles);
        config.mark_phase = 0x40000000;
        RotationTracker tracker;
        REQUIRE(tracker.init(config, 0) == Status::Ok);
        for (std::uint64_t t = 1; t <= 20; ++t) {
            tracker.pulse(t * 50'000'000);
            tracker.advance(t * 50'000'000);
        }
        REQUIRE(tracker.state() == State::Locked);
        CHECK(tracker.phase() % (cycles * kCycle) == 0x40000000);
        tracker.advance(20 * 50'000'000 + 25'000'000);
        CHECK(tracker.phase() % (cycles * kCycle) == 0x40000000 + cycles * kCycle / 2);
    }
}

TEST_CASE("spoiled index pulses: the picture stays within a stated part of a turn, and no slice gets too short") {
    struct Case {
        const char* name;
        Sensor sensor;
        double error;  ///< In intervals between pulses.
        bool stays;    ///< It may not blank.
    };
    const Case cases[] = {
        {"5 % jitter", {.jitter = 0.05}, 0.1, true},
        {"10 % missing", {.missing = 0.1}, 0.001, false},
        {"every pulse doubled", {.doubled = 1.0, .doubled_after = 0.1}, 0.001, true},
        {"every tenth doubled, anywhere", {.doubled = 0.1, .doubled_after = 0.0}, 0.25, false},
        {"5 % jitter and 10 % missing", {.jitter = 0.05, .missing = 0.1}, 0.1, false},
    };
    for (const Case& spoiled : cases) {
        for (const std::uint32_t pulses : {1u, 2u, 4u}) {
            for (const std::uint32_t seed : {1u, 2u, 3u}) {
                INFO(spoiled.name << ", " << pulses << " pulses a turn, seed " << seed);
                Sensor sensor = spoiled.sensor;
                sensor.seed = seed;
                Rotor rotor(pulses_at_20(pulses), sensor);
                rotor.turn(20.0, 20.0);
                // Stays, or blanks: whatever was lit was in its place.
                CHECK(rotor.worst_error < spoiled.error / pulses);
                CHECK(rotor.greatest_rate < 20.0 * 9 / 8 * 1.03);  // the filtered turn is off by 3 % at most
                if (rotor.faults == 0) CHECK(rotor.locked_seconds > 19.0);
                if (spoiled.stays) CHECK(rotor.faults == 0);
                CHECK((rotor.faults & ~fault_bit(Fault::LostIndex)) == 0);
            }
        }
    }
}

TEST_CASE("everything wrong at once: it stays or blanks, and the phase never runs away") {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        Rotor rotor(pulses_at_20(1 + seed % 3),
                    {.jitter = 0.05, .missing = 0.1, .doubled = 0.1, .doubled_after = 0.0, .seed = seed});
        rotor.turn(20.0, 20.0);
        CHECK(rotor.worst_error < 0.5);
        CHECK(rotor.greatest_rate < 25.0 * 9 / 8 * 1.01);
    }
}

TEST_CASE("pulses that fall silent: the index is lost within four and a half turns") {
    Rotor rotor(pulses_at_20());
    rotor.turn(2.0, 20.0);
    REQUIRE(rotor.locked());
    const double until = std::ceil(rotor.turns) - 1.0 + 4.5;
    rotor.sensor.missing = 1.0;
    while (rotor.locked() && rotor.turns < until + 1.0) rotor.turn(0.001, 20.0);
    CHECK(rotor.turns < until + 0.05);
    CHECK(rotor.faults == fault_bit(Fault::LostIndex));
    CHECK(rotor.tracker.state() == State::Lost);
    rotor.sensor.missing = 0.0;
    rotor.turn(1.0, 20.0);
    CHECK(rotor.locked());
}

TEST_CASE("from rest it locks only when it is fast and steady enough, without a fault") {
    Rotor rotor(pulses_at_20());
    rotor.turn(5.0, [](double t) { return 1.9 * t; });  // to 9.5 turns a second; a stall is below 10
    CHECK(rotor.tracker.state() == State::Unlocked);
    rotor.turn(10.0, [](double t) { return std::min(20.0, 9.5 + t); });
    CHECK(rotor.locked());
    CHECK(rotor.worst_error < 0.1);
    rotor.turn(2.0, 20.0);
    rotor.forget();
    rotor.turn(1.0, 20.0);
    CHECK(rotor.worst_error < kSlice / 10);
    CHECK(rotor.faults == 0);
}

TEST_CASE("slowing to a stop is a stall, and no longer locked below the slowest speed") {
    Rotor rotor(pulses_at_20());
    rotor.turn(2.0, 20.0);
    double speed = 20.0;
    while (rotor.locked() && speed > 1.0) rotor.turn(0.01, speed -= 0.02);
    CHECK(speed > 8.5);
    CHECK(speed < 10.0);
    CHECK(rotor.faults == fault_bit(Fault::Stall));
    rotor.turn(5.0, 0.0);
    CHECK(rotor.faults == fault_bit(Fault::Stall));
}

TEST_CASE("too fast is an overspeed, slowly or at once, and from the start") {
    Rotor slowly(pulses_at_20());
    slowly.turn(2.0, 20.0);
    double speed = 20.0;
    while (slowly.locked() && speed < 40.0) slowly.turn(0.01, speed += 0.02);
    CHECK(speed < 26.0);
    CHECK(slowly.faults == fault_bit(Fault::Overspeed));

    for (const double factor : {1.5, 2.0, 2.25, 3.0, 10.0}) {
        INFO(factor << " times as fast at once");
        Rotor at_once(pulses_at_20());
        at_once.turn(2.0, 20.0);
        at_once.forget();
        at_once.turn(2.0, 20.0 * factor);
        CHECK_FALSE(at_once.locked());
        CHECK(at_once.locked_seconds < 0.8);
        CHECK((at_once.faults & fault_bit(Fault::Overspeed)) != 0);

        Rotor from_start(pulses_at_20());
        from_start.turn(2.0, 20.0 * factor);
        CHECK(from_start.faults == fault_bit(Fault::Overspeed));
        CHECK(from_start.locked_seconds == 0.0);
    }
}

TEST_CASE("a speed that wanders by 5 % in 5 seconds is followed to 2 % of a turn") {
    Rotor rotor(pulses_at_20());
    rotor.turn(2.0, 20.0);
    rotor.turn(20.0, [](double t) { return 20.0 + std::sin(2 * kPi * t / 5.0); });
    CHECK(rotor.worst_error < 0.02);
    CHECK(rotor.faults == 0);
}

TEST_CASE("pulse times that do not increase lose the index and never turn the phase back") {
    RotationTracker tracker;
    REQUIRE(tracker.init(pulses_at_20(), 0) == Status::Ok);
    std::uint64_t t = 0;
    for (int i = 0; i < 20; ++i) {
        tracker.pulse(t += 50'000'000);
        tracker.advance(t);
    }
    REQUIRE(tracker.state() == State::Locked);
    std::uint32_t faults = 0;
    Phase before = tracker.phase();
    for (std::uint64_t i = 0; i < 20; ++i) {
        tracker.pulse(t - i * 50'000'000);
        tracker.advance(t + i);
        CHECK(device::phase_between(before, tracker.phase()) >= 0);
        before = tracker.phase();
        faults |= tracker.take_faults();
    }
    CHECK(faults == fault_bit(Fault::LostIndex));
}

TEST_CASE("a pulse that is told after the phase was asked for does not turn it back") {
    RotationTracker tracker;
    REQUIRE(tracker.init(pulses_at_20(), 0) == Status::Ok);
    Phase before = 0;
    for (std::uint64_t turn = 1; turn <= 40; ++turn) {
        const std::uint64_t t = turn * 50'000'000 + turn % 2 * 2'000'000;
        tracker.advance(t + 5'000'000);
        CHECK(device::phase_between(before, tracker.phase()) >= 0);
        before = tracker.phase();
        tracker.pulse(t);
        tracker.advance(t + 5'000'000);
        CHECK(device::phase_between(before, tracker.phase()) >= 0);
        if (turn > 10) CHECK(tracker.phase() == before);
        before = tracker.phase();
    }
    CHECK(tracker.state() == State::Locked);
}

TEST_CASE("an encoder gives the phase at once after its mark, and follows changes of speed") {
    for (const std::uint32_t steps : {8u, 100u, 1000u, 4096u}) {
        INFO(steps << " steps");
        Rotor rotor(encoder_at_20(steps));
        rotor.turn(1.0, 20.0);
        CHECK(rotor.locked());
        rotor.turn(4.0, [](double t) { return 20.0 + std::sin(2 * kPi * t / 5.0); });
        CHECK(rotor.worst_error < 0.005 + 1.0 / steps);
        CHECK(rotor.faults == 0);
    }
}

TEST_CASE("an encoder that stands is a stall within a turn, one without marks has lost its index") {
    Rotor stands(encoder_at_20(1000));
    stands.turn(1.0, 20.0);
    stands.forget();
    stands.turn(0.05, 0.0);
    CHECK(stands.faults == fault_bit(Fault::Stall));

    Rotor no_mark(encoder_at_20(1000));
    no_mark.turn(1.0, 20.0);
    no_mark.sensor.missing = 1.0;
    no_mark.forget();
    no_mark.turn(1.0, 20.0);
    CHECK(no_mark.faults == fault_bit(Fault::LostIndex));
    CHECK(no_mark.locked_seconds < 5.0 / 20.0);
    CHECK_FALSE(no_mark.locked());
}

TEST_CASE("an encoder that runs backwards is reversed within an eighth of a turn; by hand, within a whole one") {
    Rotor rotor(encoder_at_20(1000));
    rotor.turn(1.0, 20.0);
    const double at = rotor.turns;
    while (rotor.locked() && rotor.turns > at - 1.0) rotor.turn(0.001, -10.0);
    CHECK(rotor.turns > at - 0.15);
    CHECK(rotor.faults == fault_bit(Fault::Reversed));

    Rotor by_hand(encoder_at_20(1000));
    by_hand.turn(1.0, -0.9);
    CHECK(by_hand.faults == 0);
    by_hand.turn(1.0, -0.9);
    CHECK(by_hand.faults == fault_bit(Fault::Reversed));
}

TEST_CASE("an encoder that trembles on the spot is neither turning nor reversed") {
    Rotor rotor(encoder_at_20(100));
    for (int i = 0; i < 200; ++i) rotor.turn(0.01, i % 2 == 0 ? 3.0 : -3.0);
    CHECK(rotor.tracker.state() == State::Unlocked);
    CHECK(rotor.faults == 0);
}

TEST_CASE("without index the device's clock is the master, without drift, for days") {
    RotationTracker tracker;
    const RotationConfig config{.cycle_ns = 16'666'667};
    REQUIRE(tracker.init(config, 123) == Status::Ok);
    CHECK(tracker.state() == State::Locked);
    for (const std::uint64_t cycles : {0ull, 1ull, 2ull, 1000ull, 1001ull, 50'000'000ull}) {
        tracker.advance(123 + cycles * config.cycle_ns);
        CHECK(tracker.phase() == cycles * kCycle);
        CHECK(tracker.time_of(tracker.phase() + kCycle) == 123 + (cycles + 1) * config.cycle_ns);
        if (cycles >= 8) CHECK(tracker.time_of(tracker.phase() - 8 * kCycle) == 123 + (cycles - 8) * config.cycle_ns);
        tracker.pulse(123 + cycles * config.cycle_ns);
        tracker.encoder(123 + cycles * config.cycle_ns, -1000);
    }
    tracker.advance(5);
    CHECK(tracker.phase() == 50'000'000 * kCycle);
    CHECK(tracker.take_faults() == 0);
}

TEST_CASE("configurations out of range are refused") {
    RotationTracker tracker;
    CHECK(tracker.init({}, 0) == Status::InvalidArgument);
    const auto refused = [&](auto&& change) {
        RotationConfig config = pulses_at_20();
        change(config);
        return tracker.init(config, 0) == Status::InvalidArgument;
    };
    CHECK(refused([](RotationConfig& c) { c.pulses_per_turn = 0; }));
    CHECK(refused([](RotationConfig& c) { c.pulses_per_turn = 65537; }));
    CHECK(refused([](RotationConfig& c) { c.cycles_per_turn = 0; }));
    CHECK(refused([](RotationConfig& c) { c.cycles_per_turn = 9; }));
    CHECK(refused([](RotationConfig& c) { c.shortest_turn_ns = 15; }));
    CHECK(refused([](RotationConfig& c) { c.longest_turn_ns = c.shortest_turn_ns; }));
    CHECK(refused([](RotationConfig& c) { c.longest_turn_ns = std::uint64_t{1} << 42; }));
    CHECK_FALSE(refused([](RotationConfig&) {}));
}
