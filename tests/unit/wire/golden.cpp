#include "tests/golden/golden.h"

#include "tests/catch.h"
#include "tests/unit/wire/samples.h"

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("every message encodes to its golden packet, and the packet decodes") {
    const std::vector<GoldenEntry> golden = read_golden("tests/golden/messages.hex");
    REQUIRE(golden.size() == 11);
    std::size_t index = 0;
    for_each_sample([&](const char* name, std::uint32_t sequence, const auto& sample) {
        const GoldenEntry& entry = golden[index++];
        INFO(name);
        REQUIRE(entry.word == name);
        std::vector<std::byte> packet(kMaxPacketBytes);
        std::size_t size = 0;
        REQUIRE(encode_packet(0x1234, sequence, sample, packet, size) == Status::Ok);
        packet.resize(size);
        CHECK(packet == entry.bytes);

        Header header;
        std::span<const std::byte> payload;
        REQUIRE(decode_packet(entry.bytes, header, payload) == Status::Ok);
        CHECK(header.type == sample.kType);
        CHECK(header.session == 0x1234);
        CHECK(header.sequence == sequence);
        std::remove_cvref_t<decltype(sample)> decoded;
        CHECK(decode(payload, decoded) == Status::Ok);
    });
}

TEST_CASE("PROTOCOL.md shows the golden bytes") {
    const std::string document = read_text("driver/PROTOCOL.md");
    for (const char* file : {"messages.hex", "conversation.hex"}) {
        INFO(file);
        const std::string golden = read_text(std::string("tests/golden/") + file);
        REQUIRE(!golden.empty());
        CHECK(document.find("\n```\n" + golden + "```\n") != std::string::npos);
    }
}
