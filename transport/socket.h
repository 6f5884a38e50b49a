// What the socket backends share: an owned descriptor, waiting, and name lookup. Internal to transport; not installed.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "voxelizer/error.h"

namespace xorvox::transport {

/// Owns a file descriptor.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    int get() const { return number_; }
    int release() {
        const int number = number_;
        number_ = -1;
        return number;
    }

private:
    int number_;
};

/// Waits for `events` (POLLIN, POLLOUT) on `descriptor` until `deadline`. The events that came; 0 at the deadline.
inline short poll_until(int descriptor, short events, std::chrono::steady_clock::time_point deadline) {
    for (;;) {
        const auto left = std::max(deadline - std::chrono::steady_clock::now(), std::chrono::steady_clock::duration{0});
        const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
        const timespec timeout{static_cast<time_t>(seconds.count()), static_cast<long>((left - seconds).count())};
        pollfd entry{descriptor, events, 0};
        const int count = ::ppoll(&entry, 1, &timeout, nullptr);
        if (count > 0) return entry.revents;
        if (count == 0) return 0;
        // Interrupted by a signal: the time left is computed anew.
    }
}

struct FreeAddresses {
    void operator()(addrinfo* list) const { ::freeaddrinfo(list); }
};
using AddressList = std::unique_ptr<addrinfo, FreeAddresses>;

/// The stream addresses of `host`; `flags` are those of getaddrinfo. The message begins with `what`.
inline Expected<AddressList> look_up(const std::string& what, const std::string& host, std::uint16_t port, int flags) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = flags | AI_NUMERICSERV;
    addrinfo* list = nullptr;
    const int error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list);
    if (error != 0) {
        return fail(what + ": the host \"" + host + "\" is not known (" + ::gai_strerror(error) +
                    "); check its spelling or give its address");
    }
    return AddressList(list);
}

}  // namespace xorvox::transport
