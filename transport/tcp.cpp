#include "transport/tcp.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>

#include "transport/address.h"
#include "transport/hosted.h"
#include "transport/socket.h"

namespace xorvox::transport {
namespace {

using TimePoint = std::chrono::steady_clock::time_point;

std::string address_text(const std::string& host, std::uint16_t port) {
    Address address;
    address.kind = AddressKind::Tcp;
    address.host = host;
    address.port = port;
    return to_string(address);
}

class TcpLink {
public:
    explicit TcpLink(int socket) : socket_(socket) {
        const int on = 1;
        // Packets are small and answered one by one; without this an acknowledgement may wait 40 ms (Nagle, delayed
        // ACK).
        ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    }
    TcpLink(const TcpLink&) = delete;
    TcpLink& operator=(const TcpLink&) = delete;
    ~TcpLink() {
        (void)flush();
        // Closing a socket that has unread bytes resets the connection, and the peer may lose what is still on its way.
        ::shutdown(socket_.get(), SHUT_WR);
        std::byte unread[4096];
        for (int pieces = 0; pieces < 1024 && read(unread) > 0; ++pieces) {
        }
    }

    LinkInfo info() const { return {"tcp", static_cast<std::uint32_t>(kMaxFramedBytes), true}; }

    Status send(std::span<const std::byte> packet) {
        if (packet.empty() || packet.size() > kMaxFramedBytes) return Status::OutOfRange;
        wanted_bytes_ = packet.size() + kFrameHeaderBytes;
        if (flush() == Status::Closed) return Status::Closed;
        if (!has_room()) return Status::WouldBlock;
        if (out_.size() - out_end_ < wanted_bytes_) {
            std::copy(out_.begin() + offset(out_begin_), out_.begin() + offset(out_end_), out_.begin());
            out_end_ -= out_begin_;
            out_begin_ = 0;
        }
        std::size_t size = 0;
        if (encode_frame(packet, std::span(out_).subspan(out_end_), size) != Status::Ok) return Status::OutOfRange;
        out_end_ += size;
        // The packet is taken: should the peer be gone, the next operation says so.
        (void)flush();
        return Status::Ok;
    }

    Status receive(std::span<std::byte> buffer, std::size_t& size) {
        (void)flush();
        return input_.receive([this](std::span<std::byte> bytes) { return read(bytes); }, buffer, size);
    }

    Status flush() {
        while (!gone() && out_begin_ < out_end_) {
            const ssize_t count =
                ::send(socket_.get(), out_.data() + out_begin_, out_end_ - out_begin_, MSG_NOSIGNAL | MSG_DONTWAIT);
            if (count >= 0) {
                out_begin_ += static_cast<std::size_t>(count);
            } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
                return Status::WouldBlock;
            } else if (errno != EINTR) {
                broken_ = true;
            }
        }
        if (gone()) return Status::Closed;
        out_begin_ = out_end_ = 0;
        return Status::Ok;
    }

    Status wait(std::uint32_t events, std::int64_t timeout_ns) {
        const TimePoint deadline = deadline_after(timeout_ns);
        for (;;) {
            // Bytes on their way out are pushed whatever is waited for: the answer may depend on them.
            const Status flushed = flush();
            const Status pulled = input_.pull([this](std::span<std::byte> bytes) { return read(bytes); });
            if (pulled == Status::Closed) return Status::Closed;
            if ((events & kLinkReadable) != 0 && pulled == Status::Ok) return Status::Ok;
            if (flushed == Status::Closed || gone()) return Status::Ok;  // What came before is still to be received.
            if ((events & kLinkWritable) != 0 && has_room()) return Status::Ok;
            const bool unsent = out_begin_ < out_end_;
            // A packet that nobody takes would make the socket readable for ever.
            const bool listens = pulled == Status::WouldBlock;
            const auto wanted = static_cast<short>((listens ? POLLIN : 0) | (unsent ? POLLOUT : 0));
            const short came = poll_until(socket_.get(), wanted, deadline);
            // Nonsense without a pause keeps the socket readable and brings no packet: the time counts, too.
            if (came == 0 || std::chrono::steady_clock::now() >= deadline) return Status::Timeout;
            if (!listens && (came & (POLLHUP | POLLERR)) != 0) return Status::Ok;
        }
    }

private:
    static std::ptrdiff_t offset(std::size_t value) { return static_cast<std::ptrdiff_t>(value); }

    bool gone() const { return broken_ || input_.ended(); }
    bool has_room() const { return out_.size() - (out_end_ - out_begin_) >= wanted_bytes_; }

    std::ptrdiff_t read(std::span<std::byte> bytes) {
        for (;;) {
            const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
            if (count >= 0) return count;
            if (errno == EAGAIN || errno == EWOULDBLOCK) return FramedInput::kNothingYet;
            if (errno != EINTR) return 0;  // Reset by the peer: as final as an orderly end.
        }
    }

    Descriptor socket_;
    FramedInput input_;
    std::vector<std::byte> out_ = std::vector<std::byte>(2 * (kMaxFramedBytes + kFrameHeaderBytes));
    std::size_t out_begin_ = 0;
    std::size_t out_end_ = 0;
    std::size_t wanted_bytes_ = 1;  ///< Of the last packet to be sent: what "writable" means.
    bool broken_ = false;
};

/// Connects one address. 0, or the error number.
int connect_one(int socket, const addrinfo& address, TimePoint deadline) {
    if (::connect(socket, address.ai_addr, address.ai_addrlen) != 0) {
        if (errno != EINPROGRESS) return errno;
        if (poll_until(socket, POLLOUT, deadline) == 0) return ETIMEDOUT;
        int error = 0;
        socklen_t bytes = sizeof error;
        if (::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &bytes) != 0) return errno;
        if (error != 0) return error;
    }
    // With nobody listening on an ephemeral port of this machine, TCP may connect a socket to itself.
    sockaddr_storage here{}, there{};
    socklen_t here_bytes = sizeof here, there_bytes = sizeof there;
    if (::getsockname(socket, reinterpret_cast<sockaddr*>(&here), &here_bytes) != 0) return errno;
    if (::getpeername(socket, reinterpret_cast<sockaddr*>(&there), &there_bytes) != 0) return errno;
    if (here_bytes == there_bytes && std::memcmp(&here, &there, here_bytes) == 0) return ECONNREFUSED;
    return 0;
}

std::uint16_t bound_port(int socket) {
    sockaddr_storage bound{};
    socklen_t bytes = sizeof bound;
    if (::getsockname(socket, reinterpret_cast<sockaddr*>(&bound), &bytes) != 0) return 0;
    if (bound.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6*>(&bound)->sin6_port);
    return ntohs(reinterpret_cast<const sockaddr_in*>(&bound)->sin_port);
}

}  // namespace

Expected<UniqueLink> connect_tcp(const std::string& host, std::uint16_t port, std::int64_t timeout_ns) {
    const std::string what = address_text(host, port);
    if (port == 0) return fail(what + ": port 0 cannot be connected to; give the port that the display listens on");
    const TimePoint deadline = deadline_after(timeout_ns);
    const auto addresses = look_up(what, host, port, 0);
    if (!addresses) return tl::unexpected(addresses.error());
    int error = 0;
    for (const addrinfo* address = addresses->get(); address != nullptr; address = address->ai_next) {
        Descriptor socket(::socket(address->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
        error = socket.get() < 0 ? errno : connect_one(socket.get(), *address, deadline);
        if (error == 0) return make_unique_link(new TcpLink(socket.release()));
    }
    if (error == ECONNREFUSED) {
        return fail(
            fmt::format("{}: nobody listens there; start the display or the simulator first "
                        "(xorvox sim --listen tcp:{})",
                        what, port));
    }
    if (error == ETIMEDOUT) return fail(what + ": no answer in time; check the address, the cable and the firewall");
    return fail(fmt::format("{}: cannot connect: {}; check the address and the network", what, describe(error)));
}

Expected<TcpListener> TcpListener::listen(std::uint16_t port, const std::string& host) {
    const std::string what = address_text(host, port);
    const auto addresses = look_up(what, host, port, AI_PASSIVE);
    if (!addresses) return tl::unexpected(addresses.error());
    const addrinfo& address = **addresses;
    Descriptor socket(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (socket.get() < 0) return fail(fmt::format("{}: no socket: {}", what, describe(errno)));
    const int on = 1;
    // Connections that ended a moment ago do not keep the port from a new listener; a live listener still does.
    ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (::bind(socket.get(), address.ai_addr, address.ai_addrlen) != 0 || ::listen(socket.get(), 16) != 0) {
        const int error = errno;
        if (error == EADDRINUSE) {
            return fail(
                fmt::format("{}: port {} is in use; stop the program that has it "
                            "(ss -ltnp names it) or choose another port",
                            what, port));
        }
        if (error == EACCES) return fail(what + ": ports below 1024 need root; choose one from 1024 to 65535");
        if (error == EADDRNOTAVAIL) {
            return fail(fmt::format("{}: this machine has no address {}; use 127.0.0.1", what, host));
        }
        return fail(fmt::format("{}: cannot listen: {}", what, describe(error)));
    }
    const std::uint16_t bound = bound_port(socket.get());
    return TcpListener(socket.release(), bound);
}

TcpListener::TcpListener(TcpListener&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), port_(other.port_) {}

TcpListener& TcpListener::operator=(TcpListener&& other) noexcept {
    std::swap(socket_, other.socket_);
    std::swap(port_, other.port_);
    return *this;
}

TcpListener::~TcpListener() {
    if (socket_ >= 0) ::close(socket_);
}

Status TcpListener::accept(UniqueLink& link) {
    for (;;) {
        const int client = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (client >= 0) {
            link = make_unique_link(new TcpLink(client));
            return Status::Ok;
        }
        // A client that went away before it was accepted is no reason to stop.
        if (errno == EAGAIN || errno == EWOULDBLOCK) return Status::WouldBlock;
        if (errno != EINTR && errno != ECONNABORTED) return Status::Closed;
    }
}

Status TcpListener::wait(std::int64_t timeout_ns) {
    return poll_until(socket_, POLLIN, deadline_after(timeout_ns)) == 0 ? Status::Timeout : Status::Ok;
}

}  // namespace xorvox::transport
