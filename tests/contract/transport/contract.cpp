// What transport/link.h promises, run on every backend.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/catch.h"
#include "tests/contract/transport/backends.h"
#include "tests/contract/transport/packets.h"

namespace xorvox::transport {
namespace {

constexpr std::int64_t kLong = 10'000'000'000;  ///< Longer than anything that works takes.

/// Each backend in turn, freshly opened.
Ends open_each() {
    const Backend backend = GENERATE(from_range(backends()));
    Ends ends = backend.open();
    ends.backend = backend.name;
    return ends;
}

/// Whether the link waits at all; where it cannot, WouldBlock answers must come right anyway.
bool can_wait(Link link) {
    return link.wait(kLinkWritable, 0) != Status::Unsupported;
}

std::vector<std::size_t> interesting_sizes(Link link) {
    const std::size_t longest = link.info().max_packet_bytes;
    std::vector<std::size_t> sizes;
    for (const std::size_t size : {1u, 2u, 3u, 5u, 6u, 7u, 255u, 256u, 257u, 1000u, 1023u, 1024u, 4096u, 65535u}) {
        if (size < longest) sizes.push_back(size);
    }
    sizes.push_back(longest - 1);
    sizes.push_back(longest);
    return sizes;
}

TEST_CASE("a link carries packets of every size whole and in order") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    const auto sizes = interesting_sizes(ends.near.get());
    std::vector<std::byte> packet;
    std::uint32_t received = 0;
    const auto receive_next = [&] {
        REQUIRE(receive_packet(ends.far.get(), packet) == Status::Ok);
        REQUIRE(packet == make_packet(received, sizes[received]));
        ++received;
    };
    for (std::uint32_t i = 0; i < sizes.size(); ++i) {
        Status status = Status::WouldBlock;
        while ((status = ends.near->send(make_packet(i, sizes[i]))) == Status::WouldBlock) receive_next();
        REQUIRE(status == Status::Ok);
    }
    ends.deliver(ends);
    while (received < sizes.size()) receive_next();
}

TEST_CASE("the way back carries packets too") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    if (!ends.live) return;
    REQUIRE(ends.near->info().two_way);
    std::vector<std::byte> packet;
    for (std::uint32_t i = 0; i < 50; ++i) {
        REQUIRE(ends.near->send(make_packet(i, 1 + i)) == Status::Ok);
        REQUIRE(ends.far->send(make_packet(1000 + i, 51 - i)) == Status::Ok);
        REQUIRE(receive_packet(ends.near.get(), packet) == Status::Ok);
        REQUIRE(packet == make_packet(1000 + i, 51 - i));
        REQUIRE(receive_packet(ends.far.get(), packet) == Status::Ok);
        REQUIRE(packet == make_packet(i, 1 + i));
    }
}

TEST_CASE("a one-way link never gives a packet back") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    if (ends.near->info().two_way) return;
    std::vector<std::byte> buffer(ends.near->info().max_packet_bytes);
    std::size_t size = 77;
    REQUIRE(ends.near->send(make_packet(0, 10)) == Status::Ok);
    CHECK(ends.near->receive(buffer, size) != Status::Ok);
    CHECK(size == 77);
}

TEST_CASE("a full link answers WouldBlock, takes nothing, and goes on when there is room") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    if (!ends.live) return;
    const Link near = ends.near.get();
    const std::size_t size = std::min<std::size_t>(near.info().max_packet_bytes, 32 * 1024);
    std::vector<std::byte> packet;
    std::uint32_t sent = 0, received = 0;
    for (int round = 0; round < 3; ++round) {
        while (near.send(make_packet(sent, size)) == Status::Ok) REQUIRE(++sent < 10'000);
        REQUIRE(near.send(make_packet(sent, size)) == Status::WouldBlock);
        CHECK(sent > received);
        while (received < sent) {
            REQUIRE(receive_packet(ends.far.get(), packet) == Status::Ok);
            REQUIRE(packet == make_packet(received++, size));
            (void)near.flush();
        }
        if (can_wait(near)) REQUIRE(near.wait(kLinkWritable, kLong) == Status::Ok);
    }
    std::size_t bytes = 0;
    packet.resize(size);
    CHECK(ends.far->receive(packet, bytes) == Status::WouldBlock);
}

TEST_CASE("a buffer that is too small says what is needed and keeps the packet") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    REQUIRE(ends.near->send(make_packet(1, 300)) == Status::Ok);
    REQUIRE(ends.near->send(make_packet(2, 5)) == Status::Ok);
    ends.deliver(ends);
    if (can_wait(ends.far.get())) REQUIRE(ends.far->wait(kLinkReadable, kLong) == Status::Ok);
    std::vector<std::byte> small(299, std::byte{0xAA});
    for (int again = 0; again < 3; ++again) {
        std::size_t size = 0;
        REQUIRE(ends.far->receive(small, size) == Status::OutOfMemory);
        REQUIRE(size == 300);
        if (can_wait(ends.far.get())) REQUIRE(ends.far->wait(kLinkReadable, 0) == Status::Ok);
    }
    CHECK(std::count(small.begin(), small.end(), std::byte{0xAA}) == 299);
    std::vector<std::byte> packet;
    REQUIRE(receive_packet(ends.far.get(), packet) == Status::Ok);
    CHECK(packet == make_packet(1, 300));
    REQUIRE(receive_packet(ends.far.get(), packet) == Status::Ok);
    CHECK(packet == make_packet(2, 5));
}

TEST_CASE("what was sent before the peer left is given before Closed") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    for (std::uint32_t i = 0; i < 3; ++i) REQUIRE(ends.near->send(make_packet(i, 100 + i)) == Status::Ok);
    ends.deliver(ends);
    ends.near.reset();
    std::vector<std::byte> packet;
    for (std::uint32_t i = 0; i < 3; ++i) {
        REQUIRE(receive_packet(ends.far.get(), packet) == Status::Ok);
        REQUIRE(packet == make_packet(i, 100 + i));
    }
    REQUIRE(receive_packet(ends.far.get(), packet) == Status::Closed);
    REQUIRE(receive_packet(ends.far.get(), packet) == Status::Closed);
    if (can_wait(ends.far.get())) CHECK(ends.far->wait(kLinkReadable, kLong) == Status::Closed);
    if (ends.live) CHECK(ends.far->send(make_packet(9, 9)) == Status::Closed);
}

TEST_CASE("either end may be closed first, with packets on their way") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    for (std::uint32_t i = 0; i < 5; ++i) {
        REQUIRE(ends.near->send(make_packet(i, 100)) == Status::Ok);
        if (ends.live) REQUIRE(ends.far->send(make_packet(i, 100)) == Status::Ok);
    }
    if (GENERATE(false, true)) {
        ends.far.reset();
        ends.near.reset();
    } else {
        ends.near.reset();
        ends.far.reset();
    }
}

TEST_CASE("wait with a timeout of 0 asks and returns") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    if (!can_wait(ends.near.get())) return;
    CHECK(ends.near->wait(kLinkWritable, 0) == Status::Ok);
    CHECK(ends.near->wait(kLinkReadable | kLinkWritable, 0) == Status::Ok);
    CHECK(ends.near->wait(kLinkReadable, 0) == Status::Timeout);
    CHECK(ends.near->wait(kLinkReadable, -5) == Status::Timeout);
    CHECK(ends.near->wait(kLinkReadable, 1'000'000) == Status::Timeout);
    REQUIRE(ends.near->send(make_packet(0, 10)) == Status::Ok);
    ends.deliver(ends);
    REQUIRE(ends.far->wait(kLinkReadable, kLong) == Status::Ok);
    CHECK(ends.far->wait(kLinkReadable, 0) == Status::Ok);
}

TEST_CASE("info stays the same, also when the peer is gone") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    const LinkInfo before = ends.near->info();
    CHECK(before.max_packet_bytes >= 256);
    CHECK(std::string(before.name) != "");
    REQUIRE(ends.near->send(make_packet(0, 10)) == Status::Ok);
    ends.far.reset();
    std::vector<std::byte> packet;
    if (before.two_way) REQUIRE(receive_packet(ends.near.get(), packet) == Status::Closed);
    const LinkInfo after = ends.near->info();
    CHECK(before.name == after.name);
    CHECK(before.max_packet_bytes == after.max_packet_bytes);
    CHECK(before.two_way == after.two_way);
}

TEST_CASE("empty and too long packets are refused and not delivered") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    const std::size_t longest = ends.near->info().max_packet_bytes;
    CHECK(ends.near->send({}) == Status::OutOfRange);
    CHECK(ends.near->send(make_packet(1, longest + 1)) == Status::OutOfRange);
    REQUIRE(ends.near->send(make_packet(2, 20)) == Status::Ok);
    ends.deliver(ends);
    std::vector<std::byte> packet;
    REQUIRE(receive_packet(ends.far.get(), packet) == Status::Ok);
    CHECK(packet == make_packet(2, 20));
}

TEST_CASE("flush comes to an end, and says when the peer is gone") {
    Ends ends = open_each();
    INFO("backend: " << ends.backend);
    REQUIRE(ends.near->send(make_packet(0, 200)) == Status::Ok);
    Status status = ends.near->flush();
    while (status == Status::WouldBlock) {
        REQUIRE(ends.near->wait(kLinkWritable, kLong) == Status::Ok);
        status = ends.near->flush();
    }
    CHECK((status == Status::Ok || status == Status::Unsupported));
    if (!ends.live || status == Status::Unsupported) return;
    ends.far.reset();
    std::vector<std::byte> packet;
    REQUIRE(receive_packet(ends.near.get(), packet) == Status::Closed);
    CHECK(ends.near->flush() == Status::Closed);
}

}  // namespace
}  // namespace xorvox::transport
