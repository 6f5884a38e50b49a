#include "driver/device/lz4_block.h"

#include <initializer_list>
#include <random>

#include "tests/catch.h"
#include "tests/unit/device/lz4_reference.h"

using namespace xorvox;
using namespace xorvox::test;
using Bytes = std::vector<std::byte>;

namespace {

Bytes bytes(std::initializer_list<int> values) {
    Bytes result;
    for (const int value : values) result.push_back(static_cast<std::byte>(value));
    return result;
}

Bytes compress(const Bytes& data) {
    Bytes block(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(data.size()))));
    const int size =
        LZ4_compress_default(reinterpret_cast<const char*>(data.data()), reinterpret_cast<char*>(block.data()),
                             static_cast<int>(data.size()), static_cast<int>(block.size()));
    REQUIRE(size > 0);
    block.resize(static_cast<std::size_t>(size));
    return block;
}

// Runs, repeats at a distance and noise, mixed.
Bytes structured(std::size_t size, std::mt19937& random) {
    Bytes data;
    while (data.size() < size) {
        const std::size_t count = 1 + random() % 600;
        const std::size_t back = 1 + random() % 70000;
        const auto value = static_cast<std::byte>(random() & 0xff);
        const auto kind = random() % 3;
        for (std::size_t i = 0; i < count && data.size() < size; ++i) {
            if (kind == 0) data.push_back(value);
            if (kind == 1) data.push_back(static_cast<std::byte>(random() & 0xff));
            if (kind == 2) data.push_back(back <= data.size() ? data[data.size() - back] : value);
        }
    }
    return data;
}

Status decode(const Bytes& block, std::size_t length, Bytes& out) {
    out.assign(length, std::byte{0xEE});
    return device::decode_lz4_block(block, out);
}

}  // namespace

TEST_CASE("lz4: what liblz4 compresses decodes to the same bytes") {
    std::mt19937 random(1);
    for (std::size_t size = 1; size < 200'000; size += 1 + size / 3) {
        const Bytes data = structured(size, random);
        Bytes out;
        REQUIRE(decode(compress(data), size, out) == Status::Ok);
        REQUIRE(out == data);
    }
}

TEST_CASE("lz4: overlapping matches repeat what they copy") {
    Bytes out;
    // 1 literal, then 19 bytes from 1 back; 3 literals, then 7 from 3 back; nothing.
    REQUIRE(decode(bytes({0x1F, 'a', 1, 0, 0, 0x33, 'x', 'y', 'z', 3, 0, 0x00}), 30, out) == Status::Ok);
    CHECK(std::string(reinterpret_cast<const char*>(out.data()), out.size()) == "aaaaaaaaaaaaaaaaaaaaxyzxyzxyzx");
}

TEST_CASE("lz4: a block must have exactly the announced length") {
    const Bytes data(1000, std::byte{7});
    const Bytes block = compress(data);
    Bytes out;
    CHECK(decode(block, 999, out) == Status::Corrupt);
    CHECK(decode(block, 1001, out) == Status::Corrupt);
    for (std::size_t cut = 0; cut < block.size(); ++cut) {
        CHECK(decode(Bytes(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(cut)), 1000, out) ==
              Status::Corrupt);
    }
    Bytes longer = block;
    longer.push_back(std::byte{0});
    CHECK(decode(longer, 1000, out) == Status::Corrupt);
}

TEST_CASE("lz4: offsets of zero or before the start, endless lengths and empty blocks are corrupt") {
    Bytes out;
    CHECK(decode({}, 4, out) == Status::Corrupt);
    CHECK(decode({}, 0, out) == Status::Corrupt);
    CHECK(decode(bytes({0x10, 'a', 0, 0, 0x00}), 5, out) == Status::Corrupt);
    CHECK(decode(bytes({0x10, 'a', 2, 0, 0x00}), 5, out) == Status::Corrupt);
    CHECK(decode(bytes({0x00, 1, 0, 0x00}), 4, out) == Status::Corrupt);
    CHECK(decode(Bytes(5000, std::byte{0xff}), 100, out) == Status::Corrupt);
    CHECK(decode(bytes({0x50, 1, 2, 3, 4}), 5, out) == Status::Corrupt);
    CHECK(out == Bytes(5, std::byte{0xEE}));
}

TEST_CASE("lz4: what liblz4 takes of damaged blocks we take alike, and nothing is written outside") {
    std::mt19937 random(2);
    for (int round = 0; round < 20'000; ++round) {
        const std::size_t size = 1 + random() % 300;
        Bytes block = compress(structured(size, random));
        for (auto change = random() % 4; change > 0; --change) {
            block[random() % block.size()] = static_cast<std::byte>(random() & 0xff);
        }
        if (random() % 4 == 0) block.resize(random() % block.size());
        REQUIRE(agrees_with_liblz4(block, size + random() % 3));
    }
}

TEST_CASE("lz4: random bytes agree with liblz4") {
    std::mt19937 random(3);
    for (int round = 0; round < 50'000; ++round) {
        Bytes block(random() % 24);
        for (std::byte& byte : block) byte = static_cast<std::byte>(random() % 4 == 0 ? random() & 0xff : random() & 7);
        REQUIRE(agrees_with_liblz4(block, random() % 64));
    }
}
