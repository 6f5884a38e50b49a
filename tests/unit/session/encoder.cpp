#include "driver/host/encoder.h"

#include <lz4.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"

namespace xorvox::host {

Bytes decode_frame(const std::vector<Received>& packets, const Bytes& base) {
    const auto begin = packets.front().as<wire::FrameBegin>();
    const auto end = packets.back().as<wire::FrameEnd>();
    Bytes page(begin.frame_bytes);
    std::size_t covered = 0;
    for (std::size_t i = 1; i + 1 < packets.size(); ++i) {
        const auto chunk = packets[i].as<wire::Chunk>();
        REQUIRE(chunk.frame == begin.frame);
        REQUIRE(chunk.offset == covered);
        REQUIRE(chunk.decoded_length <= page.size() - covered);
        const auto place = std::span(page).subspan(covered, chunk.decoded_length);
        if (chunk.codec == wire::Codec::Raw) {
            REQUIRE(chunk.data.size() == place.size());
            std::copy(chunk.data.begin(), chunk.data.end(), place.begin());
        } else {
            const int bytes = LZ4_decompress_safe(reinterpret_cast<const char*>(chunk.data.data()),
                                                  reinterpret_cast<char*>(place.data()),
                                                  static_cast<int>(chunk.data.size()), static_cast<int>(place.size()));
            REQUIRE(bytes == static_cast<int>(place.size()));
        }
        covered += place.size();
    }
    REQUIRE(covered == page.size());
    if ((begin.flags & wire::kFrameDelta) != 0) {
        REQUIRE(base.size() == page.size());
        for (std::size_t i = 0; i < page.size(); ++i) page[i] ^= base[i];
    }
    REQUIRE(end.frame == begin.frame);
    REQUIRE(end.page_crc == wire::crc32c(page));
    return page;
}

namespace {

std::vector<Received> payloads(const FrameEncoder& encoder) {
    std::vector<Received> result;
    for (std::size_t i = 0; i < encoder.payload_count(); ++i) {
        const Payload payload = encoder.payload(i);
        Received received;
        received.header.type = payload.type;
        received.payload.assign(payload.bytes.begin(), payload.bytes.end());
        result.push_back(std::move(received));
    }
    return result;
}

std::size_t longest_packet(const FrameEncoder& encoder) {
    std::size_t longest = 0;
    for (std::size_t i = 0; i < encoder.payload_count(); ++i) {
        longest = std::max(longest, encoder.payload(i).bytes.size() + wire::kPacketOverhead);
    }
    return longest;
}

Bytes noise(std::size_t size, std::uint32_t seed) {
    Bytes bytes(size);
    std::uint32_t state = seed * 2654435761u + 1;
    for (std::byte& byte : bytes) {
        state = state * 1664525u + 1013904223u;
        byte = static_cast<std::byte>(state >> 24);
    }
    return bytes;
}

/// From empty space to noise: runs and noise alternate, more noise with every step of `disorder`, 0 … 8.
Bytes mixed(std::size_t size, std::uint32_t disorder) {
    Bytes bytes = noise(size, disorder);
    for (std::size_t i = 0; i < size; ++i) {
        if (i / 64 % 8 >= disorder) bytes[i] = static_cast<std::byte>(i / 512);
    }
    return bytes;
}

TEST_CASE("frames of every kind decode to what they were, in packets no longer than allowed") {
    for (const std::uint32_t max_packet : {256u, 1000u, 4096u, 65536u}) {
        for (const bool lz4 : {false, true}) {
            FrameEncoder encoder({max_packet, lz4});
            for (const std::size_t size : {1u, 12u, 13u, 222u, 223u, 224u, 5000u, 70'000u, 200'001u}) {
                for (std::uint32_t disorder = 0; disorder <= 8; ++disorder) {
                    const Bytes frame = mixed(size, disorder);
                    encoder.encode({.id = 9, .content = frame});
                    REQUIRE(decode_frame(payloads(encoder)) == frame);
                    REQUIRE(longest_packet(encoder) <= max_packet);
                    REQUIRE_FALSE(encoder.is_delta());
                }
            }
        }
    }
}

TEST_CASE("an empty frame of a megabyte goes in few packets, noise in hardly more than its bytes") {
    FrameEncoder encoder({1024, true});
    encoder.encode({.id = 1, .content = Bytes(1 << 20)});
    CHECK(encoder.payload_count() < 30);
    encoder.encode({.id = 2, .content = noise(1 << 20, 1)});
    CHECK(encoder.payload_count() == 2 + ((1 << 20) + 990) / 991);
}

TEST_CASE("packets are filled") {
    FrameEncoder encoder({1024, true});
    encoder.encode({.id = 1, .content = mixed(1 << 18, 4)});
    std::size_t full = 0;
    for (const Received& payload : payloads(encoder)) full += payload.payload.size() + wire::kPacketOverhead > 1000;
    CHECK(full + 3 >= encoder.payload_count());
}

TEST_CASE("a delta is used where it is shorter, and names its base") {
    FrameEncoder encoder({1024, true});
    const Bytes base = noise(20'000, 1);
    Bytes frame = base;
    frame[12'345] ^= std::byte{1};
    encoder.encode({.id = 6, .content = frame, .present_at_ns = 123, .base_id = 5, .base = base});
    REQUIRE(encoder.is_delta());
    CHECK(encoder.payload_count() == 3);
    const auto begin = payloads(encoder).front().as<wire::FrameBegin>();
    CHECK(begin.frame == 6);
    CHECK(begin.base == 5);
    CHECK(begin.flags == wire::kFrameDelta);
    CHECK(begin.present_at_ns == 123);
    CHECK(decode_frame(payloads(encoder), base) == frame);

    const Bytes empty(20'000);
    encoder.encode({.id = 7, .content = empty, .base_id = 6, .base = frame});
    CHECK_FALSE(encoder.is_delta());
    CHECK(payloads(encoder).front().as<wire::FrameBegin>().flags == 0);
    CHECK(decode_frame(payloads(encoder)) == empty);
}

TEST_CASE("without compression there are no deltas") {
    FrameEncoder encoder({1024, false});
    const Bytes frame(5000);
    encoder.encode({.id = 2, .content = frame, .base_id = 1, .base = frame});
    CHECK_FALSE(encoder.is_delta());
}

}  // namespace
}  // namespace xorvox::host
