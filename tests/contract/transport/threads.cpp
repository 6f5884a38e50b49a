// The two ends of a link in two threads, both sending and receiving.

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "tests/catch.h"
#include "tests/contract/transport/backends.h"
#include "tests/contract/transport/packets.h"

namespace xorvox::transport {
namespace {

constexpr std::uint32_t kPackets = 2000;

std::size_t size_of(std::uint32_t number) {
    return 1 + number * 7919 % 3000;
}

/// Sends packets `first` … and expects the peer's from `expected` on. The number of those that came right.
std::uint32_t talk(Link link, std::uint32_t first, std::uint32_t expected) {
    std::uint32_t sent = 0, received = 0;
    std::vector<std::byte> packet(link.info().max_packet_bytes);
    while (sent < kPackets || received < kPackets) {
        if (sent < kPackets && link.send(make_packet(first + sent, size_of(sent))) == Status::Ok) ++sent;
        std::size_t size = 0;
        const Status status = link.receive(packet, size);
        if (status == Status::Ok) {
            const auto wanted = make_packet(expected + received, size_of(received));
            if (!std::equal(wanted.begin(), wanted.end(), packet.begin(), packet.begin() + static_cast<long>(size))) {
                return received;
            }
            ++received;
        } else if (status != Status::WouldBlock) {
            return received;
        } else if (link.wait(kLinkReadable | (sent < kPackets ? kLinkWritable : 0u), 10'000'000'000) != Status::Ok) {
            return received;
        }
    }
    while (link.flush() == Status::WouldBlock) (void)link.wait(kLinkWritable, 1'000'000'000);
    return received;
}

TEST_CASE("two threads talk over the two ends of a link") {
    for (const Backend& backend : backends()) {
        if (!backend.threads) continue;
        INFO("backend: " << backend.name);
        Ends ends = backend.open();
        std::uint32_t far_received = 0;
        std::thread other([&] { far_received = talk(ends.far.get(), 500'000, 0); });
        const std::uint32_t near_received = talk(ends.near.get(), 0, 500'000);
        other.join();
        CHECK(near_received == kPackets);
        CHECK(far_received == kPackets);
    }
}

TEST_CASE("closing an end wakes the thread that waits at the other") {
    for (const Backend& backend : backends()) {
        if (!backend.threads) continue;
        INFO("backend: " << backend.name);
        Ends ends = backend.open();
        Status status = Status::Ok;
        std::thread waiting([&] { status = ends.far->wait(kLinkReadable, 60'000'000'000); });
        ends.near.reset();
        waiting.join();
        CHECK(status == Status::Closed);
    }
}

}  // namespace
}  // namespace xorvox::transport
