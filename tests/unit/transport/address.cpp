#include "transport/address.h"

#include <string>

#include "tests/catch.h"

namespace xorvox::transport {
namespace {

TEST_CASE("addresses are read and written back") {
    CHECK(parse_address("loopback")->kind == AddressKind::Loopback);

    const auto port = parse_address("tcp:5000");
    REQUIRE(port);
    CHECK(port->kind == AddressKind::Tcp);
    CHECK(port->host == "127.0.0.1");
    CHECK(port->port == 5000);

    const auto host = parse_address("tcp:cube.local:65535");
    REQUIRE(host);
    CHECK(host->host == "cube.local");
    CHECK(host->port == 65535);

    const auto six = parse_address("tcp:[::1]:5000");
    REQUIRE(six);
    CHECK(six->host == "::1");
    CHECK(six->port == 5000);

    const auto file = parse_address("file:a:b/c.xvr");
    REQUIRE(file);
    CHECK(file->kind == AddressKind::File);
    CHECK(file->path == "a:b/c.xvr");

    for (const char* text : {"loopback", "tcp:cube.local:1", "tcp:[::1]:5000", "tcp:127.0.0.1:0", "file:x"}) {
        CHECK(to_string(*parse_address(text)) == text);
    }
}

TEST_CASE("wrong addresses are refused with what to write instead") {
    for (const char* text : {"", "tcp", "tcp:", "udp:1", "TCP:1", "loopback:", "5000", "file"}) {
        INFO(text);
        CHECK_FALSE(parse_address(text));
    }
    for (const char* text :
         {"tcp:x", "tcp:-1", "tcp:65536", "tcp:99999999999", "tcp:1x", "tcp:a:", "tcp:a: 1", "tcp:1.5"}) {
        INFO(text);
        const auto address = parse_address(text);
        REQUIRE_FALSE(address);
        CHECK(address.error().message.find("0 to 65535") != std::string::npos);
    }
    CHECK(parse_address("tcp::1").error().message.find("the host is empty") != std::string::npos);
    CHECK(parse_address("tcp:::1:5000").error().message.find("tcp:[::1]:5000") != std::string::npos);
    CHECK(parse_address("file:").error().message.find("file:PATH") != std::string::npos);
    CHECK(parse_address("serial:/dev/x").error().message.find("tcp:HOST:PORT") != std::string::npos);
}

}  // namespace
}  // namespace xorvox::transport
