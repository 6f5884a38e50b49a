#include "driver/wire/messages.h"

#include <vector>

#include "tests/catch.h"
#include "tests/unit/wire/samples.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

std::vector<std::byte> encoded(const auto& message) {
    std::vector<std::byte> payload(kMaxPacketBytes);
    std::size_t size = 0;
    REQUIRE(encode(message, payload, size) == Status::Ok);
    payload.resize(size);
    return payload;
}

Hello hello_but(auto&& change) {
    Hello hello = kHello;
    change(hello);
    return hello;
}

}  // namespace

TEST_CASE("every message comes back as it was encoded") {
    for_each_sample([](const char* name, std::uint32_t, const auto& sample) {
        INFO(name);
        const std::vector<std::byte> payload = encoded(sample);
        std::remove_cvref_t<decltype(sample)> decoded;
        REQUIRE(decode(payload, decoded) == Status::Ok);
        CHECK(encoded(decoded) == payload);
    });
}

TEST_CASE("fields keep their values") {
    Hello hello;
    REQUIRE(decode(encoded(kHello), hello) == Status::Ok);
    CHECK(hello.boot_nonce == 0xA1A2A3A4);
    CHECK(hello.serial.view() == "XV-0042");
    CHECK(hello.display.view() == "cube8");
    CHECK(hello.geometry_digest == 0xa45549ebffcb652e);
    CHECK(hello.fault == Fault::SilentHost);
    CHECK(hello.host_time_ns == 0x1112131415161718);
    Chunk chunk;
    const std::vector<std::byte> payload = encoded(kChunk);
    REQUIRE(decode(payload, chunk) == Status::Ok);
    CHECK(chunk.data.data() == payload.data() + kChunkHeaderBytes);
    CHECK(chunk.data.size() == 5);
}

TEST_CASE("decoders reject every truncation and leave the message alone") {
    for_each_sample([](const char* name, std::uint32_t, const auto& sample) {
        INFO(name);
        const std::vector<std::byte> payload = encoded(sample);
        std::remove_cvref_t<decltype(sample)> untouched;
        const std::vector<std::byte> before = encoded(untouched);
        for (std::size_t length = 0; length < payload.size(); ++length) {
            REQUIRE(decode(std::span(payload).first(length), untouched) == Status::Corrupt);
        }
        CHECK(encoded(untouched) == before);
    });
}

TEST_CASE("decoders skip what a later minor version appends") {
    for_each_sample([](const char* name, std::uint32_t, const auto& sample) {
        INFO(name);
        using Message = std::remove_cvref_t<decltype(sample)>;
        if constexpr (!std::is_same_v<Message, Chunk>) {
            const std::vector<std::byte> payload = encoded(sample);
            std::vector<std::byte> longer = payload;
            longer.insert(longer.end(), 7, std::byte{0xEE});
            Message decoded;
            REQUIRE(decode(longer, decoded) == Status::Ok);
            CHECK(encoded(decoded) == payload);
        }
    });
}

TEST_CASE("encoders refuse a buffer that is too small and leave it alone") {
    for_each_sample([](const char* name, std::uint32_t, const auto& sample) {
        INFO(name);
        const std::size_t whole = encoded(sample).size();
        for (std::size_t room = 0; room < whole; ++room) {
            std::vector<std::byte> out(room, std::byte{0x55});
            std::size_t size = 99;
            REQUIRE(encode(sample, out, size) == Status::OutOfMemory);
            CHECK(size == 99);
            CHECK(out == std::vector<std::byte>(room, std::byte{0x55}));
        }
    });
}

TEST_CASE("chunk data that stands in its place is encoded without a copy") {
    std::vector<std::byte> out(kChunkHeaderBytes + 3, std::byte{0x77});
    Chunk chunk = kChunk;
    chunk.decoded_length = 3;
    chunk.data = std::span(out).subspan(kChunkHeaderBytes);
    std::size_t size = 0;
    REQUIRE(encode(chunk, out, size) == Status::Ok);
    Chunk decoded;
    REQUIRE(decode(out, decoded) == Status::Ok);
    CHECK(std::vector(decoded.data.begin(), decoded.data.end()) == std::vector<std::byte>(3, std::byte{0x77}));
}

TEST_CASE("decode of a chunk rejects lengths that cannot be") {
    Chunk chunk = kChunk;
    Chunk decoded;
    chunk.decoded_length = 0;
    CHECK(decode(encoded(chunk), decoded) == Status::Corrupt);
    chunk.decoded_length = 6;
    CHECK(decode(encoded(chunk), decoded) == Status::Corrupt);
    chunk.codec = Codec::Lz4;
    CHECK(decode(encoded(chunk), decoded) == Status::Ok);
}

TEST_CASE("decode of a hello rejects what no device can be") {
    Hello decoded;
    CHECK(decode(encoded(hello_but([](Hello& h) { h.pages = 1; })), decoded) == Status::Corrupt);
    CHECK(decode(encoded(hello_but([](Hello& h) { h.free_pages = 4; })), decoded) == Status::Corrupt);
    CHECK(decode(encoded(hello_but([](Hello& h) { h.max_packet_bytes = 255; })), decoded) == Status::Corrupt);
    CHECK(decode(encoded(hello_but([](Hello& h) { h.max_packet_bytes = 65537; })), decoded) == Status::Corrupt);
    CHECK(decode(encoded(hello_but([](Hello& h) { h.codecs = 2; })), decoded) == Status::Corrupt);
    CHECK(decode(encoded(hello_but([](Hello& h) { h.frame_bytes = 0; })), decoded) == Status::Corrupt);
    CHECK(decode(encoded(hello_but([](Hello& h) { h.planes = 0; })), decoded) == Status::Corrupt);
    CHECK(decode(encoded(hello_but([](Hello& h) { h.serial.text.fill('x'); })), decoded) == Status::Corrupt);
    CHECK(decode(encoded(hello_but([](Hello& h) { h.display.text[20] = 'x'; })), decoded) == Status::Corrupt);
    CHECK(decode(encoded(hello_but([](Hello& h) { h.codecs = 0xffffffff; })), decoded) == Status::Ok);
}

TEST_CASE("numbers of enumerations that are not known yet are let through") {
    Control control;
    REQUIRE(decode(encoded(Control{.operation = static_cast<ControlOperation>(200), .value = 1}), control) ==
            Status::Ok);
    CHECK(static_cast<int>(control.operation) == 200);
    Nack nack;
    REQUIRE(decode(encoded(Nack{.reason = static_cast<NackReason>(99)}), nack) == Status::Ok);
    CHECK(static_cast<int>(nack.reason) == 99);
}
