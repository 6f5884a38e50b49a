#include "transport/faults.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/catch.h"
#include "transport/loopback.h"

namespace xorvox::transport {
namespace {

using Bytes = std::vector<std::byte>;

Bytes numbered(std::uint32_t number) {
    Bytes packet(40);
    for (std::size_t i = 0; i < 4; ++i) packet[i] = static_cast<std::byte>(number >> (8 * i));
    return packet;
}

std::uint32_t number_of(const Bytes& packet) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number |= std::to_integer<std::uint32_t>(packet[i]) << (8 * i);
    return number;
}

std::vector<Bytes> receive_all(Link link) {
    std::vector<Bytes> packets;
    Bytes buffer(65536);
    std::size_t size = 0;
    while (link.receive(buffer, size) == Status::Ok)
        packets.emplace_back(buffer.begin(), buffer.begin() + static_cast<long>(size));
    return packets;
}

/// What arrives of `count` packets that pass the faults while they are sent.
std::vector<Bytes> through(const FaultOptions& options, std::uint32_t count, FaultCounts* counts = nullptr) {
    auto [near, far] = make_loopback();
    near = with_faults(std::move(near), options);
    for (std::uint32_t i = 0; i < count; ++i) REQUIRE(near->send(numbered(i)) == Status::Ok);
    REQUIRE(near->flush() == Status::Ok);
    if (counts != nullptr) *counts = fault_counts(near.get());
    return receive_all(far.get());
}

std::vector<std::uint32_t> numbers(const std::vector<Bytes>& packets) {
    std::vector<std::uint32_t> result;
    for (const Bytes& packet : packets) result.push_back(number_of(packet));
    return result;
}

TEST_CASE("drop loses packets and keeps the order of the others") {
    FaultOptions options;
    options.drop = 0.25;
    FaultCounts counts;
    const auto arrived = numbers(through(options, 1000, &counts));
    CHECK(counts.packets == 1000);
    CHECK(counts.dropped > 180);
    CHECK(counts.dropped < 320);
    CHECK(arrived.size() == 1000 - counts.dropped);
    CHECK(std::is_sorted(arrived.begin(), arrived.end()));
    CHECK(std::adjacent_find(arrived.begin(), arrived.end()) == arrived.end());
}

TEST_CASE("repeat gives packets twice") {
    FaultOptions options;
    options.repeat = 0.25;
    FaultCounts counts;
    auto arrived = numbers(through(options, 1000, &counts));
    CHECK(counts.repeated > 180);
    CHECK(arrived.size() == 1000 + counts.repeated);
    CHECK(std::is_sorted(arrived.begin(), arrived.end()));
}

TEST_CASE("reorder swaps neighbours and loses nothing") {
    FaultOptions options;
    options.reorder = 0.25;
    FaultCounts counts;
    auto arrived = numbers(through(options, 1000, &counts));
    CHECK(counts.reordered > 150);
    CHECK_FALSE(std::is_sorted(arrived.begin(), arrived.end()));
    std::sort(arrived.begin(), arrived.end());
    REQUIRE(arrived.size() == 1000);
    for (std::uint32_t i = 0; i < 1000; ++i) REQUIRE(arrived[i] == i);
}

TEST_CASE("cut shortens packets, never to nothing") {
    FaultOptions options;
    options.cut = 0.25;
    FaultCounts counts;
    const auto arrived = through(options, 1000, &counts);
    CHECK(arrived.size() == 1000);
    const auto is_short = [](const Bytes& packet) { return packet.size() < 40; };
    CHECK(counts.cut > 180);
    CHECK(static_cast<std::uint64_t>(std::count_if(arrived.begin(), arrived.end(), is_short)) == counts.cut);
    CHECK(std::none_of(arrived.begin(), arrived.end(), [](const Bytes& packet) { return packet.empty(); }));
}

TEST_CASE("flip changes one bit") {
    FaultOptions options;
    options.flip = 0.25;
    FaultCounts counts;
    const auto arrived = through(options, 1000, &counts);
    REQUIRE(arrived.size() == 1000);
    std::uint64_t hit = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Bytes sent = numbered(i);
        int bits = 0;
        for (std::size_t b = 0; b < sent.size(); ++b)
            bits += std::popcount(std::to_integer<unsigned>(sent[b] ^ arrived[i][b]));
        REQUIRE(bits <= 1);
        hit += bits == 1;
    }
    CHECK(hit == counts.flipped);
    CHECK(hit > 180);
}

TEST_CASE("equal seeds do the same on every machine, other seeds something else") {
    FaultOptions options;
    options.seed = 42;
    options.drop = options.repeat = options.reorder = options.cut = options.flip = 0.2;
    FaultCounts counts;
    const auto first = through(options, 200, &counts);
    CHECK(first == through(options, 200));
    CHECK(counts.dropped == 40);
    options.seed = 43;
    CHECK(first != through(options, 200));
}

TEST_CASE("faults hit only the direction that was asked for") {
    FaultOptions options;
    options.drop = 1;
    options.directions = GENERATE(kFaultSent, kFaultReceived);
    auto [near, far] = make_loopback();
    near = with_faults(std::move(near), options);
    REQUIRE(near->send(numbered(1)) == Status::Ok);
    REQUIRE(far->send(numbered(2)) == Status::Ok);
    CHECK(receive_all(far.get()).size() == (options.directions == kFaultSent ? 0 : 1));
    CHECK(receive_all(near.get()).size() == (options.directions == kFaultSent ? 1 : 0));
}

TEST_CASE("a packet held back comes out when the peer closes") {
    FaultOptions options;
    options.reorder = 1;
    auto [near, far] = make_loopback();
    far = with_faults(std::move(far), options);
    REQUIRE(near->send(numbered(1)) == Status::Ok);
    CHECK(receive_all(far.get()).empty());
    near.reset();
    CHECK(numbers(receive_all(far.get())) == std::vector<std::uint32_t>{1});
}

TEST_CASE("a full inner link makes the outer one answer WouldBlock and nothing is lost") {
    LoopbackOptions small;
    small.max_packet_bytes = 256;
    small.queue_bytes = 260;
    auto [near, far] = make_loopback(small);
    FaultOptions options;
    options.repeat = 1;
    near = with_faults(std::move(near), options);
    std::vector<std::uint32_t> arrived;
    for (std::uint32_t i = 0; i < 100;) {
        const Status status = near->send(numbered(i));
        if (status == Status::Ok) {
            ++i;
            continue;
        }
        REQUIRE(status == Status::WouldBlock);
        for (const Bytes& packet : receive_all(far.get())) arrived.push_back(number_of(packet));
    }
    while (near->flush() == Status::WouldBlock) {
        for (const Bytes& packet : receive_all(far.get())) arrived.push_back(number_of(packet));
    }
    for (const Bytes& packet : receive_all(far.get())) arrived.push_back(number_of(packet));
    REQUIRE(arrived.size() == 200);
    for (std::uint32_t i = 0; i < 200; ++i) REQUIRE(arrived[i] == i / 2);
}

TEST_CASE("counts of a link without faults are zero") {
    const auto [near, far] = make_loopback();
    CHECK(fault_counts(near.get()).packets == 0);
}

}  // namespace
}  // namespace xorvox::transport
