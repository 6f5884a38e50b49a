// Session and Device, the two halves, over a loopback that damages packets, on a clock that the test moves.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "driver/device/device.h"
#include "driver/host/session.h"
#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"
#include "transport/faults.h"
#include "transport/loopback.h"

namespace xorvox::host {
namespace {

constexpr std::uint64_t kStepNs = 1'000'000;
constexpr std::uint64_t kStepsPerCycle = 7;

/// Both halves; the display's cycle begins anew every few steps, and what it shows then is written down.
class Pair {
public:
    Pair(const transport::FaultOptions& faults, std::uint32_t pages, const SessionOptions& options)
        : pages_(pages * frame_bytes(display)), packet_(1024) {
        auto [host_end, device_end] = transport::make_loopback();
        host_link_ = transport::with_faults(std::move(host_end), faults);
        device_link_ = std::move(device_end);
        device::DeviceConfig config;
        config.display = &display;
        config.boot_nonce = 1;
        config.link = device_link_.get();
        config.pages = pages_;
        config.page_count = pages;
        config.packet = packet_;
        REQUIRE(device.init(config, now_ns) == Status::Ok);
        session.emplace(host_link_.get(), display, options);
    }

    void step() {
        now_ns += kStepNs;
        const Status status = session->poll(now_ns);
        REQUIRE((status == Status::Ok || status == Status::WouldBlock));
        (void)device.poll(now_ns);
        if (++steps % kStepsPerCycle == 0) {
            device.boundary(now_ns);
            write_down_what_is_shown();
        }
    }

    void submit(std::uint32_t number) {
        Bytes frame = make_frame(display, number);
        while (session->submit(frame) != Status::Ok) step_bounded();
        submitted.push_back(std::move(frame));
    }

    void finish() {
        while (!session->idle()) step_bounded();
        for (std::uint64_t i = 0; i < 2 * kStepsPerCycle; ++i) step();
    }

    void step_bounded() {
        REQUIRE(steps < 2'000'000);
        step();
    }

    transport::FaultCounts counts() const { return transport::fault_counts(host_link_.get()); }

    DisplayDescription display = small_display();
    std::uint64_t now_ns = 1'000'000;
    std::uint64_t steps = 0;
    device::Device device;
    std::optional<Session> session;
    std::vector<Bytes> submitted;
    std::vector<std::size_t> shown;  ///< Indices into `submitted`, one for each change of the picture.

private:
    /// What is shown is one of the submitted frames, byte for byte, and never an older one than before.
    void write_down_what_is_shown() {
        const auto page = device.shown().page;
        if (page.empty()) return;
        const auto found = std::find_if(submitted.begin(), submitted.end(), [&](const Bytes& frame) {
            return std::equal(frame.begin(), frame.end(), page.begin(), page.end());
        });
        REQUIRE(found != submitted.end());
        const auto index = static_cast<std::size_t>(found - submitted.begin());
        if (shown.empty() || shown.back() != index) {
            if (!shown.empty()) REQUIRE(index > shown.back());
            shown.push_back(index);
        }
    }

    std::vector<std::byte> pages_;
    std::vector<std::byte> packet_;
    UniqueLink host_link_;
    UniqueLink device_link_;
};

TEST_CASE("every frame is shown once, in order, over a link without faults") {
    const std::uint32_t pages = GENERATE(2u, 3u, 8u);
    Pair pair({}, pages, {});
    for (std::uint32_t i = 0; i < 20; ++i) pair.submit(i);
    pair.finish();
    CHECK(pair.shown.back() == 19);
    CHECK(pair.session->statistics().frames_accepted == 20);
    CHECK(pair.session->statistics().frames_resent == 0);
    CHECK(pair.session->statistics().hellos == 1);
    CHECK(pair.device.status(pair.now_ns).frames_dropped == 0);
}

TEST_CASE("two pages suffice for deltas") {
    Pair pair({}, 2, {});
    for (std::uint32_t i = 0; i < 20; ++i) {
        pair.submit(i);
        pair.finish();
        CHECK(pair.shown.size() == i + 1);
    }
    CHECK(pair.session->statistics().frames_delta == 19);
    CHECK(pair.session->statistics().frames_presented == 20);
    CHECK(pair.device.status(pair.now_ns).frames_dropped == 0);
}

TEST_CASE("an idle session keeps the watchdog quiet") {
    Pair pair({}, 2, {});
    pair.submit(1);
    for (int i = 0; i < 10'000; ++i) pair.step();
    CHECK(pair.device.status(pair.now_ns).fault == wire::Fault::None);
    CHECK_FALSE(pair.device.shown().page.empty());
    CHECK(pair.session->statistics().hellos == 1);
}

TEST_CASE("a host that comes back after the watchdog lights the display again") {
    Pair pair({}, 2, {});
    pair.submit(1);
    pair.finish();
    for (int i = 0; i < 3000; ++i) {
        pair.now_ns += kStepNs;
        (void)pair.device.poll(pair.now_ns);
        pair.device.boundary(pair.now_ns);
    }
    REQUIRE(pair.device.status(pair.now_ns).fault == wire::Fault::SilentHost);
    REQUIRE(pair.device.shown().page.empty());
    for (int i = 0; i < 3000; ++i) pair.step();
    CHECK(pair.device.status(pair.now_ns).fault == wire::Fault::None);
    CHECK_FALSE(pair.device.shown().page.empty());
}

/// Sends frames through faults and checks that the last one is shown in the end. How many had to be sent again.
std::uint64_t run_through(const transport::FaultOptions& faults, std::uint32_t pages) {
    CAPTURE(faults.seed, faults.directions, faults.drop, faults.repeat, faults.reorder, faults.cut, faults.flip, pages);
    SessionOptions options;
    options.answer_timeout_ns = 20'000'000;
    options.attempts = 1000;
    Pair pair(faults, pages, options);
    for (std::uint32_t i = 0; i < 12; ++i) pair.submit(i);
    pair.finish();
    REQUIRE(pair.session->statistics().frames_accepted == 12);
    REQUIRE(pair.shown.back() == 11);
    while (pair.session->last_presented() != pair.session->last_accepted()) pair.step_bounded();
    REQUIRE(pair.counts().packets > 0);
    return pair.session->statistics().frames_resent;
}

TEST_CASE("under every fault the last frame is shown in the end, and nothing but whole frames before") {
    using Probability = double transport::FaultOptions::*;
    const Probability kinds[] = {&transport::FaultOptions::drop, &transport::FaultOptions::repeat,
                                 &transport::FaultOptions::reorder, &transport::FaultOptions::cut,
                                 &transport::FaultOptions::flip};
    for (const Probability kind : kinds) {
        for (const double probability : {0.05, 0.2}) {
            for (const std::uint32_t directions :
                 {std::uint32_t{transport::kFaultSent}, std::uint32_t{transport::kFaultReceived},
                  std::uint32_t{transport::kFaultSent | transport::kFaultReceived}}) {
                std::uint64_t resent = 0;
                for (std::uint64_t seed = 1; seed <= 4; ++seed) {
                    transport::FaultOptions faults;
                    faults.seed = seed;
                    faults.directions = directions;
                    faults.*kind = probability;
                    resent += run_through(faults, seed % 2 == 0 ? 2 : 3);
                }
                // Repeats alone are harmless; everything else in the frames costs some of them.
                const bool harmless = kind == &transport::FaultOptions::repeat;
                if (harmless) REQUIRE(resent == 0);
                if (!harmless && (directions & transport::kFaultSent) != 0) REQUIRE(resent > 0);
            }
        }
    }
}

TEST_CASE("under all faults at once too") {
    std::uint64_t resent = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        transport::FaultOptions faults;
        faults.seed = seed;
        faults.drop = faults.repeat = faults.reorder = faults.cut = faults.flip = 0.05;
        resent += run_through(faults, 2);
    }
    CHECK(resent > 20);
}

}  // namespace
}  // namespace xorvox::host
