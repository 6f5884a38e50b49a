#include "driver/wire/packet.h"

#include <random>
#include <string_view>
#include <vector>

#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::wire;

namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

std::uint32_t slow_crc32c(std::span<const std::byte> bytes) {
    std::uint32_t crc = 0xffffffffu;
    for (const std::byte byte : bytes) {
        crc ^= std::to_integer<std::uint32_t>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? crc >> 1 ^ 0x82F63B78u : crc >> 1;
    }
    return ~crc;
}

std::vector<std::byte> random_bytes(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<std::byte> bytes(count);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 0xff);
    return bytes;
}

std::vector<std::byte> packet_of(std::span<const std::byte> payload) {
    const Header header{.type = PacketType::Ping, .flags = 0x0102, .session = 0x0304, .sequence = 0x05060708};
    std::vector<std::byte> packet(payload.size() + kPacketOverhead);
    std::size_t size = 0;
    REQUIRE(encode_packet(header, payload, packet, size) == Status::Ok);
    REQUIRE(size == packet.size());
    return packet;
}

}  // namespace

TEST_CASE("crc32c gives the check values of RFC 3720 and of the catalogue") {
    CHECK(crc32c(bytes_of("123456789")) == 0xE3069283u);
    CHECK(crc32c(std::vector<std::byte>(32, std::byte{0})) == 0x8A9136AAu);
    CHECK(crc32c(std::vector<std::byte>(32, std::byte{0xff})) == 0x62A8AB43u);
    CHECK(crc32c({}) == 0);
}

TEST_CASE("crc32c equals the bitwise reference at every length and alignment, whole and continued") {
    const std::vector<std::byte> bytes = random_bytes(64, 1);
    for (std::size_t first = 0; first < 8; ++first) {
        for (std::size_t length = 0; first + length <= bytes.size(); ++length) {
            const auto part = std::span(bytes).subspan(first, length);
            const std::uint32_t expected = slow_crc32c(part);
            const auto begin = part.first(length / 3);
            const auto rest = part.subspan(length / 3);
            REQUIRE(crc32c(part) == expected);
            REQUIRE(crc32c(rest, crc32c(begin)) == expected);
            REQUIRE(crc32c_by_tables(part) == expected);
            REQUIRE(crc32c_by_tables(rest, crc32c_by_tables(begin)) == expected);
        }
    }
}

TEST_CASE("a packet comes back as it was encoded") {
    for (const std::size_t length : {0u, 1u, 5u, 236u, 65516u}) {
        const std::vector<std::byte> payload = random_bytes(length, 2);
        const std::vector<std::byte> packet = packet_of(payload);
        Header header;
        std::span<const std::byte> decoded;
        REQUIRE(decode_packet(packet, header, decoded) == Status::Ok);
        CHECK(header.type == PacketType::Ping);
        CHECK(header.flags == 0x0102);
        CHECK(header.session == 0x0304);
        CHECK(header.sequence == 0x05060708u);
        CHECK(header.length == length);
        CHECK(std::equal(decoded.begin(), decoded.end(), payload.begin(), payload.end()));
    }
}

TEST_CASE("a payload that stands in its place is framed there, and one that overlaps it is moved") {
    const std::vector<std::byte> payload = random_bytes(40, 3);
    const std::vector<std::byte> expected = packet_of(payload);
    for (const std::size_t place : {std::size_t{0}, std::size_t{3}, kHeaderBytes, kHeaderBytes + 4}) {
        std::vector<std::byte> buffer(payload.size() + kPacketOverhead);
        std::copy(payload.begin(), payload.end(), buffer.begin() + static_cast<std::ptrdiff_t>(place));
        const Header header{.type = PacketType::Ping, .flags = 0x0102, .session = 0x0304, .sequence = 0x05060708};
        std::size_t size = 0;
        REQUIRE(encode_packet(header, std::span(buffer).subspan(place, payload.size()), buffer, size) == Status::Ok);
        CHECK(buffer == expected);
    }
}

TEST_CASE("encode_packet refuses a buffer that is one byte too small and leaves it alone") {
    const std::vector<std::byte> payload = random_bytes(10, 4);
    for (std::size_t room = 0; room < payload.size() + kPacketOverhead; ++room) {
        std::vector<std::byte> buffer(room, std::byte{0x55});
        std::size_t size = 99;
        REQUIRE(encode_packet({}, payload, buffer, size) == Status::OutOfMemory);
        CHECK(size == 99);
        CHECK(buffer == std::vector<std::byte>(room, std::byte{0x55}));
    }
}

TEST_CASE("decode_packet rejects every truncation, trailing bytes and every flipped bit") {
    const std::vector<std::byte> packet = packet_of(random_bytes(33, 5));
    Header header{.sequence = 77};
    std::span<const std::byte> payload;
    for (std::size_t length = 0; length < packet.size(); ++length) {
        REQUIRE(decode_packet(std::span(packet).first(length), header, payload) == Status::Corrupt);
    }
    std::vector<std::byte> longer = packet;
    longer.push_back(std::byte{0});
    REQUIRE(decode_packet(longer, header, payload) == Status::Corrupt);
    for (std::size_t bit = 0; bit < packet.size() * 8; ++bit) {
        std::vector<std::byte> flipped = packet;
        flipped[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        REQUIRE(decode_packet(flipped, header, payload) == Status::Corrupt);
    }
    CHECK(header.sequence == 77);
    CHECK(payload.empty());
}

TEST_CASE("a packet of another major version is told apart from a damaged one, and its header is given") {
    std::vector<std::byte> packet = packet_of(random_bytes(8, 6));
    packet[2] = std::byte{kMajor + 1};
    const std::uint32_t crc = slow_crc32c(std::span(packet).first(packet.size() - kCrcBytes));
    for (std::size_t i = 0; i < kCrcBytes; ++i) {
        packet[packet.size() - kCrcBytes + i] = static_cast<std::byte>(crc >> 8 * i & 0xff);
    }
    Header header;
    std::span<const std::byte> payload;
    CHECK(decode_packet(packet, header, payload) == Status::Unsupported);
    CHECK(header.type == PacketType::Ping);
    CHECK(header.session == 0x0304);
    CHECK(payload.empty());
}
