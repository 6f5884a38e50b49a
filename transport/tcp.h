// TCP: a link over a socket, with framing (transport/framing.h). For a simulator or a display with a network plug.
//
// There is no encryption and no password: listen on 127.0.0.1, the default, unless the network is yours.
#pragma once

#include <cstdint>
#include <string>

#include "transport/link.h"
#include "voxelizer/error.h"

namespace xorvox::transport {

/// Connects to a listener; waits up to `timeout_ns` for its answer. `host` is a name or an address; `port` is not 0.
/// The message says whether the host is unknown, nobody listens, or nobody answers. Afterwards nothing blocks.
Expected<UniqueLink> connect_tcp(const std::string& host, std::uint16_t port, std::int64_t timeout_ns = 5'000'000'000);

/// Takes connections. Movable; closes its socket, not the links that it gave. One thread.
class TcpListener {
public:
    /// Listens on `port`, 0: any free one. `host` is the address of an interface. The message for a port in use says
    /// so.
    static Expected<TcpListener> listen(std::uint16_t port, const std::string& host = "127.0.0.1");

    TcpListener(TcpListener&& other) noexcept;
    TcpListener& operator=(TcpListener&& other) noexcept;
    ~TcpListener();

    /// The next client, who may have been waiting. Never blocks. Ok; WouldBlock when there is none; Closed when the
    /// system gives no more connections (too many open files).
    Status accept(UniqueLink& link);

    /// Blocks until accept() is likely to succeed or `timeout_ns` has passed. Ok or Timeout.
    Status wait(std::int64_t timeout_ns);

    /// The port that clients connect to; never 0.
    std::uint16_t port() const { return port_; }

private:
    TcpListener(int socket, std::uint16_t port) : socket_(socket), port_(port) {}

    int socket_ = -1;
    std::uint16_t port_ = 0;
};

}  // namespace xorvox::transport
