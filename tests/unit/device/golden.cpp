#include "tests/golden/golden.h"

#include "tests/unit/device/rig.h"

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("the device plays its part of the golden conversation to the letter") {
    Desk desk(2);
    std::size_t packets = 0;
    for (const GoldenEntry& entry : read_golden("tests/golden/conversation.hex")) {
        INFO("after " << packets << " packets");
        desk.work();
        if (entry.word == "at") {
            REQUIRE(desk.link.from_device.empty());
            desk.now_ns = entry.number;
        } else if (entry.word == "boundary") {
            desk.device.boundary(desk.now_ns);
        } else if (entry.word == ">") {
            REQUIRE(desk.link.from_device.empty());
            desk.put(entry.bytes);
            ++packets;
        } else {
            REQUIRE(entry.word == "<");
            REQUIRE_FALSE(desk.link.from_device.empty());
            CHECK(desk.link.from_device.front() == entry.bytes);
            desk.link.from_device.pop_front();
            ++packets;
        }
    }
    CHECK(desk.silent());
    CHECK(packets == 22);
    CHECK_FALSE(desk.shown().empty());
}
