// Peers that vanish or talk nonsense, at either end of tcp.
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

const std::string kDuck = std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply";

/// A bare socket on 127.0.0.1, closed at the end.
class Socket {
public:
    explicit Socket(int fd) : fd_(fd) {}
    Socket() : Socket(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {}
    ~Socket() { close(fd_); }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;

    /// Listens on a free port, which it gives.
    std::uint16_t listen_anywhere() {
        sockaddr_in address = on_loopback(0);
        socklen_t size = sizeof address;
        REQUIRE(bind(fd_, reinterpret_cast<const sockaddr*>(&address), size) == 0);
        REQUIRE(listen(fd_, 4) == 0);
        REQUIRE(getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
        return ntohs(address.sin_port);
    }
    int accept_one() { return accept(fd_, nullptr, nullptr); }
    void connect_to(std::uint16_t port) {
        const sockaddr_in address = on_loopback(port);
        REQUIRE(connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    }
    /// Sends until everything is gone, or false: the peer is.
    bool send_all(const std::string& bytes) {
        std::size_t at = 0;
        while (at < bytes.size()) {
            const ssize_t n = send(fd_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
            if (n <= 0) return false;
            at += static_cast<std::size_t>(n);
        }
        return true;
    }
    /// Reads until the peer closes.
    void drain() {
        char bytes[4096];
        while (read(fd_, bytes, sizeof bytes) > 0) {
        }
    }

private:
    static sockaddr_in on_loopback(std::uint16_t port) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        return address;
    }
    int fd_;
};

std::string garbage(std::size_t size) {
    std::string bytes;
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
    return bytes;
}

Outcome show_to(std::uint16_t port) {
    return run_program({"show", kDuck, "--display", "cube16-ws2812", "--to", "tcp:127.0.0.1:" + std::to_string(port)});
}

void is_one_line(const Outcome& outcome) {
    CAPTURE(outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.starts_with("xorvox: "));
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
}

}  // namespace

TEST_CASE("a display that hangs up at once is one clear line", "[cli]") {
    Socket server;
    const std::uint16_t port = server.listen_anywhere();
    std::thread peer([&] { const Socket client(server.accept_one()); });
    const Outcome outcome = show_to(port);
    peer.join();
    is_one_line(outcome);
    CHECK_THAT(outcome.err, Catch::Contains("closed"));
}

TEST_CASE("a display that answers garbage is given up in bounded time", "[cli]") {
    Socket server;
    const std::uint16_t port = server.listen_anywhere();
    std::thread peer([&] {
        Socket client(server.accept_one());
        client.send_all(garbage(1'000'000));
        client.drain();
    });
    const Outcome outcome = show_to(port);
    peer.join();
    is_one_line(outcome);
}

TEST_CASE("a display that sends garbage without a pause is given up in bounded time", "[cli]") {
    Socket server;
    const std::uint16_t port = server.listen_anywhere();
    std::thread peer([&] {
        Socket client(server.accept_one());
        const std::string nonsense = garbage(100'000);
        while (client.send_all(nonsense)) {
        }
    });
    const Outcome outcome = show_to(port);
    peer.join();
    is_one_line(outcome);
}

TEST_CASE("a simulated display drops a client that says nothing", "[cli]") {
    Background display({"sim", "--display", "cube16-ws2812", "--listen", "tcp:0"});
    const std::string listening = display.line().value_or("");
    Socket client;
    client.connect_to(static_cast<std::uint16_t>(std::stoi(listening.substr(listening.rfind(':') + 1))));
    CHECK(display.line() == "client connected");
    CHECK(display.line() == "client disconnected");
    CHECK(display.terminate() == 0);
}

TEST_CASE("a simulated display outlives clients that send garbage or vanish", "[cli]") {
    Background display({"sim", "--display", "cube16-ws2812", "--listen", "tcp:0"});
    const std::string listening = display.line().value_or("");
    const std::uint16_t port = static_cast<std::uint16_t>(std::stoi(listening.substr(listening.rfind(':') + 1)));
    {
        Socket client;
        client.connect_to(port);
        client.send_all(garbage(300'000));
    }
    {
        Socket client;
        client.connect_to(port);
    }
    const Outcome outcome = show_to(port);
    CAPTURE(outcome.err);
    CHECK(outcome.status == 0);
    CHECK(display.terminate() == 0);
}
