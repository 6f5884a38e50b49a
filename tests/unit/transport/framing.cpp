#include "transport/framing.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/catch.h"

namespace xorvox::transport {
namespace {

using Bytes = std::vector<std::byte>;

Bytes packet_of(std::size_t size, unsigned seed) {
    Bytes packet(size);
    for (std::size_t i = 0; i < size; ++i) packet[i] = static_cast<std::byte>(i * 31 + seed * 101 + i / 256);
    return packet;
}

Bytes frame_of(const Bytes& packet) {
    Bytes frame(packet.size() + kFrameHeaderBytes);
    std::size_t size = 0;
    REQUIRE(encode_frame(packet, frame, size) == Status::Ok);
    REQUIRE(size == frame.size());
    return frame;
}

void append(Bytes& to, const Bytes& bytes) {
    to.insert(to.end(), bytes.begin(), bytes.end());
}

struct Decoded {
    std::vector<Bytes> packets;
    int corrupt = 0;
};

/// Feeds `stream` in pieces of `piece` bytes.
Decoded decode(FrameDecoder& decoder, const Bytes& stream, std::size_t piece) {
    Decoded result;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
        std::span<const std::byte> left = std::span(stream).subspan(at, std::min(piece, stream.size() - at));
        while (!left.empty()) {
            std::size_t consumed = 0;
            const Status status = decoder.feed(left, consumed);
            REQUIRE(consumed > 0);
            REQUIRE(consumed <= left.size());
            if (status == Status::WouldBlock) REQUIRE(consumed == left.size());
            if (status == Status::Ok) result.packets.emplace_back(decoder.packet().begin(), decoder.packet().end());
            if (status == Status::Corrupt) ++result.corrupt;
            left = left.subspan(consumed);
        }
    }
    return result;
}

Decoded decode(const Bytes& stream, std::size_t piece = 1'000'000, std::size_t buffer_bytes = kMaxFramedBytes) {
    Bytes buffer(buffer_bytes);
    FrameDecoder decoder(buffer);
    return decode(decoder, stream, piece);
}

TEST_CASE("the bytes of a frame are these") {
    const Bytes frame = frame_of({std::byte{'1'}, std::byte{'2'}, std::byte{'3'}});
    // CRC-16/CCITT-FALSE of e7 4c 02 00.
    const unsigned char golden[] = {0xE7, 0x4C, 0x02, 0x00, 0xA9, 0x5F, '1', '2', '3'};
    REQUIRE(frame.size() == sizeof golden);
    for (std::size_t i = 0; i < frame.size(); ++i) CHECK(std::to_integer<int>(frame[i]) == golden[i]);
}

TEST_CASE("encode refuses empty and too long packets and too small buffers") {
    std::array<std::byte, kFrameHeaderBytes> header{};
    CHECK(encode_frame_header(0, header) == Status::OutOfRange);
    CHECK(encode_frame_header(kMaxFramedBytes + 1, header) == Status::OutOfRange);
    CHECK(encode_frame_header(kMaxFramedBytes, header) == Status::Ok);
    Bytes out(15);
    std::size_t size = 99;
    CHECK(encode_frame(Bytes(10), out, size) == Status::OutOfMemory);
    CHECK(encode_frame({}, out, size) == Status::OutOfRange);
    CHECK(encode_frame(Bytes(kMaxFramedBytes + 1), out, size) == Status::OutOfRange);
    CHECK(size == 99);
    CHECK(encode_frame(Bytes(9), out, size) == Status::Ok);
}

TEST_CASE("a stream cut in pieces of any size gives the same packets") {
    Bytes stream;
    std::vector<Bytes> packets;
    for (const std::size_t size : {1u, 2u, 5u, 6u, 7u, 40u, 255u, 256u, 257u}) {
        packets.push_back(packet_of(size, static_cast<unsigned>(size)));
        append(stream, frame_of(packets.back()));
    }
    for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
        const Decoded decoded = decode(stream, piece);
        REQUIRE(decoded.packets == packets);
        REQUIRE(decoded.corrupt == 0);
    }
}

TEST_CASE("the longest packet passes") {
    const Bytes packet = packet_of(kMaxFramedBytes, 3);
    CHECK(decode(frame_of(packet), 1000).packets == std::vector<Bytes>{packet});
}

TEST_CASE("garbage before, between and after frames costs one Corrupt each and no packet") {
    const Bytes a = packet_of(20, 1), b = packet_of(30, 2);
    for (std::size_t length = 1; length < 40; ++length) {
        Bytes garbage(length);
        // Half headers and repeated magic are the hard cases.
        for (std::size_t i = 0; i < length; ++i) garbage[i] = i % 3 == 2 ? kFrameMagic1 : kFrameMagic0;
        Bytes stream = garbage;
        append(stream, frame_of(a));
        append(stream, garbage);
        append(stream, frame_of(b));
        for (const std::size_t piece : {1u, 2u, 7u, 1000u}) {
            const Decoded decoded = decode(stream, piece);
            REQUIRE(decoded.packets == std::vector<Bytes>{a, b});
            REQUIRE(decoded.corrupt == 2);
        }
    }
}

TEST_CASE("a flipped bit anywhere in a header costs that packet only") {
    const Bytes first = packet_of(50, 1), hit = packet_of(60, 2), last = packet_of(70, 3);
    const std::size_t at = frame_of(first).size();
    for (std::size_t bit = 0; bit < kFrameHeaderBytes * 8; ++bit) {
        Bytes stream = frame_of(first);
        append(stream, frame_of(hit));
        append(stream, frame_of(last));
        stream[at + bit / 8] ^= std::byte{1} << (bit % 8);
        const Decoded decoded = decode(stream, 13);
        REQUIRE(decoded.packets == std::vector<Bytes>{first, last});
        REQUIRE(decoded.corrupt == 1);
    }
}

TEST_CASE("bytes lost anywhere cost at most the packet they hit and the next one") {
    std::vector<Bytes> packets;
    Bytes stream;
    for (unsigned i = 0; i < 4; ++i) {
        packets.push_back(packet_of(40 + i, i));
        append(stream, frame_of(packets.back()));
    }
    for (std::size_t at = 0; at < frame_of(packets[0]).size(); ++at) {
        Bytes shorter = stream;
        shorter.erase(shorter.begin() + static_cast<long>(at));
        const Decoded decoded = decode(shorter, 9);
        REQUIRE(decoded.packets.size() >= 2);
        REQUIRE(decoded.packets.back() == packets[3]);
        REQUIRE(decoded.packets[decoded.packets.size() - 2] == packets[2]);
    }
}

TEST_CASE("a frame longer than the buffer is garbage, and the buffer is not overrun") {
    Bytes memory(32 + 8, std::byte{0x5A});
    FrameDecoder decoder{std::span<std::byte>(memory).first(32)};
    Bytes stream = frame_of(packet_of(33, 1));
    append(stream, frame_of(packet_of(32, 2)));
    const Decoded decoded = decode(decoder, stream, 5);
    CHECK(decoded.packets == std::vector<Bytes>{packet_of(32, 2)});
    CHECK(decoded.corrupt == 1);
    CHECK(std::count(memory.begin() + 32, memory.end(), std::byte{0x5A}) == 8);
}

TEST_CASE("partial tells a cut-off stream from a finished one") {
    const Bytes frame = frame_of(packet_of(10, 1));
    Bytes buffer(64);
    for (std::size_t length = 0; length <= frame.size(); ++length) {
        FrameDecoder decoder(buffer);
        (void)decode(decoder, Bytes(frame.begin(), frame.begin() + static_cast<long>(length)), 1000);
        CHECK(decoder.partial() == (length > 0 && length < frame.size()));
        decoder.reset();
        CHECK_FALSE(decoder.partial());
        CHECK(decode(decoder, frame, 3).packets.size() == 1);
    }
}

}  // namespace
}  // namespace xorvox::transport
