#include "transport/tcp.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/catch.h"

namespace xorvox::transport {
namespace {

constexpr std::int64_t kLong = 10'000'000'000;

/// A peer that speaks no framing.
class RawClient {
public:
    explicit RawClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    }
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;
    ~RawClient() { ::close(socket_); }
    void write(std::string_view text) {
        REQUIRE(::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size()));
    }

private:
    int socket_;
};

UniqueLink accept_from(TcpListener& listener) {
    UniqueLink link;
    REQUIRE(listener.wait(kLong) == Status::Ok);
    REQUIRE(listener.accept(link) == Status::Ok);
    return link;
}

bool contains(const Error& error, std::string_view words) {
    return error.message.find(words) != std::string::npos;
}

TEST_CASE("a port in use is named with what to do") {
    auto first = TcpListener::listen(0);
    REQUIRE(first);
    const auto second = TcpListener::listen(first->port());
    REQUIRE_FALSE(second);
    CHECK(contains(second.error(), "tcp:127.0.0.1:" + std::to_string(first->port())));
    CHECK(contains(second.error(), "is in use"));
    CHECK(contains(second.error(), "choose another port"));
}

TEST_CASE("a port can be listened on again at once after its clients left") {
    auto listener = TcpListener::listen(0);
    REQUIRE(listener);
    const std::uint16_t port = listener->port();
    {
        auto client = connect_tcp("127.0.0.1", port);
        REQUIRE(client);
        UniqueLink served = accept_from(*listener);
        served.reset();
    }
    { const TcpListener ended = std::move(*listener); }
    CHECK(TcpListener::listen(port));
}

TEST_CASE("connecting says why it failed") {
    std::uint16_t free_port = 0;
    {
        const auto listener = TcpListener::listen(0);
        REQUIRE(listener);
        free_port = listener->port();
    }
    const auto refused = connect_tcp("127.0.0.1", free_port);
    REQUIRE_FALSE(refused);
    CHECK(contains(refused.error(), "nobody listens"));
    CHECK(contains(refused.error(), std::to_string(free_port)));

    const auto unknown = connect_tcp("no host has spaces", 5000);
    REQUIRE_FALSE(unknown);
    CHECK(contains(unknown.error(), "is not known"));

    const auto zero = connect_tcp("127.0.0.1", 0);
    REQUIRE_FALSE(zero);
    CHECK(contains(zero.error(), "port 0"));

    CHECK_FALSE(TcpListener::listen(0, "no host has spaces"));
}

TEST_CASE("a listener without clients answers WouldBlock") {
    auto listener = TcpListener::listen(0);
    REQUIRE(listener);
    UniqueLink link;
    CHECK(listener->accept(link) == Status::WouldBlock);
    CHECK_FALSE(link);
    CHECK(listener->wait(0) == Status::Timeout);
}

TEST_CASE("a listener serves one client after another") {
    auto listener = TcpListener::listen(0);
    REQUIRE(listener);
    for (int round = 0; round < 3; ++round) {
        auto client = connect_tcp("localhost", listener->port());
        REQUIRE(client);
        const UniqueLink served = accept_from(*listener);
        const std::byte hello[] = {std::byte{1}, std::byte{2}};
        REQUIRE((*client)->send(hello) == Status::Ok);
        std::byte buffer[16];
        std::size_t size = 0;
        REQUIRE(served->wait(kLinkReadable, kLong) == Status::Ok);
        REQUIRE(served->receive(buffer, size) == Status::Ok);
        CHECK(size == 2);
    }
}

TEST_CASE("a peer that sends garbage is one Corrupt, then Closed") {
    auto listener = TcpListener::listen(0);
    REQUIRE(listener);
    UniqueLink served;
    {
        RawClient client(listener->port());
        served = accept_from(*listener);
        client.write("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    }
    std::vector<std::byte> buffer(100);
    std::size_t size = 0;
    int corrupt = 0;
    Status status = Status::WouldBlock;
    while (status != Status::Closed) {
        (void)served->wait(kLinkReadable, kLong);
        status = served->receive(buffer, size);
        REQUIRE(status != Status::Ok);
        if (status == Status::Corrupt) ++corrupt;
    }
    CHECK(corrupt == 1);
}

TEST_CASE("half a packet is not readable, and its loss is said") {
    auto listener = TcpListener::listen(0);
    REQUIRE(listener);
    UniqueLink served;
    std::vector<std::byte> buffer(100);
    std::size_t size = 0;
    {
        RawClient client(listener->port());
        served = accept_from(*listener);
        client.write(
            std::string_view("\xE7\x4C\x02\x00\xA9\x5F"
                             "12",
                             8));
        CHECK(served->wait(kLinkReadable, 20'000'000) == Status::Timeout);
        CHECK(served->receive(buffer, size) == Status::WouldBlock);
        client.write("3");
        CHECK(served->wait(kLinkReadable, kLong) == Status::Ok);
        CHECK(served->receive(buffer, size) == Status::Ok);
        CHECK(size == 3);
        client.write(
            std::string_view("\xE7\x4C\x02\x00\xA9\x5F"
                             "12",
                             8));
    }
    CHECK(served->wait(kLinkReadable, kLong) == Status::Ok);
    CHECK(served->receive(buffer, size) == Status::Corrupt);
    CHECK(served->receive(buffer, size) == Status::Closed);
}

}  // namespace
}  // namespace xorvox::transport
