#include "driver/host/frame_share.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace xorvox::host {
namespace {

constexpr std::uint64_t kLongestTick_ns = 50'000'000;
constexpr std::uint64_t kShortestTick_ns = 1'000'000;
/// How long nobody is let in after the system had no descriptor.
constexpr std::uint64_t kPause_ns = 100'000'000;
constexpr int kArrivalsAtOnce = 8;

std::string words(int error) {
    return std::generic_category().message(error);
}

const sockaddr* as_generic(const sockaddr_un& address) {
    return reinterpret_cast<const sockaddr*>(&address);
}

Descriptor make_socket() {
    return Descriptor(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

/// Removes the socket at `path` if nobody listens there any more.
Expected<void> remove_stale(const sockaddr_un& address, const std::string& path) {
    struct stat there {};
    if (::lstat(path.c_str(), &there) == 0 && !S_ISSOCK(there.st_mode)) {
        return fail(path + ": is there already and no socket; choose another path");
    }
    const Descriptor probe = make_socket();
    if (probe.get() < 0) return fail(fmt::format("{}: no socket: {}", path, words(errno)));
    if (::connect(probe.get(), as_generic(address), sizeof address) == 0 || errno != ECONNREFUSED) {
        return fail(path + ": a program listens there already; end it or choose another path");
    }
    if (::unlink(path.c_str()) != 0) {
        return fail(fmt::format("{}: the socket of a program that is gone cannot be removed: {}", path, words(errno)));
    }
    return {};
}

Expected<Descriptor> listen_at(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.empty()) return fail("the path of a socket is empty; give one, as in /tmp/display");
    if (path.find('\0') != path.npos) return fail("the path of a socket has a byte 0 in it; give another one");
    if (path.size() >= sizeof address.sun_path) {
        return fail(fmt::format("{}: {} bytes; the path of a socket has at most {}: choose a shorter one", path,
                                path.size(), sizeof address.sun_path - 1));
    }
    std::memcpy(address.sun_path, path.data(), path.size());
    Descriptor socket = make_socket();
    if (socket.get() < 0) return fail(fmt::format("{}: no socket: {}", path, words(errno)));
    // On Linux the file gets the socket's own mode, before anybody can connect.
    if (::fchmod(socket.get(), 0600) != 0) return fail(fmt::format("{}: fchmod: {}", path, words(errno)));
    int bound = ::bind(socket.get(), as_generic(address), sizeof address);
    if (bound != 0 && errno == EADDRINUSE) {
        if (const auto removed = remove_stale(address, path); !removed) return tl::unexpected(removed.error());
        bound = ::bind(socket.get(), as_generic(address), sizeof address);
    }
    if (bound != 0) {
        return fail(fmt::format("{}: cannot create a socket: {}; name a folder that is there and may be written to",
                                path, words(errno)));
    }
    if (::listen(socket.get(), 16) != 0) {
        const int error = errno;
        ::unlink(path.c_str());
        return fail(fmt::format("{}: cannot listen: {}", path, words(error)));
    }
    return socket;
}

}  // namespace

Expected<std::unique_ptr<FrameShare>> FrameShare::listen(const DisplayDescription& display, const std::string& path,
                                                         Framebuffer& frames) {
    Descriptor wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
    if (wake.get() < 0) return fail(fmt::format("{}: eventfd: {}", path, words(errno)));
    Expected<Descriptor> listener = listen_at(path);
    if (!listener) return tl::unexpected(listener.error());
    return std::unique_ptr<FrameShare>(new FrameShare(display, frames, path, std::move(*listener), std::move(wake)));
}

FrameShare::FrameShare(const DisplayDescription& display, Framebuffer& frames, std::string path, Descriptor listener,
                       Descriptor wake)
    : display_(display),
      terms_(display),
      frames_(frames),
      path_(std::move(path)),
      listener_(std::move(listener)),
      wake_(std::move(wake)) {
    struct stat file {};
    if (::lstat(path_.c_str(), &file) == 0) {
        device_ = file.st_dev;
        inode_ = file.st_ino;
    }
}

FrameShare::~FrameShare() {
    struct stat file {};
    const bool ours = ::lstat(path_.c_str(), &file) == 0 && file.st_dev == device_ && file.st_ino == inode_;
    if (ours) ::unlink(path_.c_str());
}

void FrameShare::poll(std::uint64_t now_ns) {
    std::uint64_t count = 0;
    while (::read(wake_.get(), &count, sizeof count) > 0) continue;
    if (client_) {
        const std::uint64_t before = statistics_.frames();
        const bool alive = client_->poll();
        if (statistics_.frames() != before) published_ns_ = now_ns;
        if (!alive) client_.reset();
    }
    accepts_ = true;
    for (int i = 0; i < kArrivalsAtOnce; ++i) {
        const int arrived = ::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (arrived >= 0) {
            let_in(Descriptor(arrived), now_ns);
        } else if (errno != EINTR && errno != ECONNABORTED) {
            accepts_ = errno == EAGAIN || errno == EWOULDBLOCK;
            return;
        }
    }
}

void FrameShare::let_in(Descriptor socket, std::uint64_t now_ns) {
    const auto turn_away = [&](xorvox_frames_status status) {
        ++statistics_.refused[static_cast<std::size_t>(status)];
        (void)send_hello(socket.get(), terms_, status, nullptr);  // It is closed in any case.
    };
    if (client_ && now_ns - published_ns_ < XORVOX_FRAMES_PATIENCE_NS) return turn_away(XORVOX_FRAMES_BUSY);
    Expected<FrameSegment> segment = FrameSegment::make(display_);
    if (!segment) return turn_away(XORVOX_FRAMES_NO_MEMORY);
    if (!send_hello(socket.get(), terms_, XORVOX_FRAMES_OK, &*segment)) return;
    client_.emplace(std::move(socket), std::move(*segment), terms_, frames_, statistics_);
    published_ns_ = now_ns;
    ++statistics_.clients;
}

void FrameShare::wait(std::int64_t timeout_ns) {
    std::uint64_t longest_ns = timeout_ns < 0 ? UINT64_MAX : static_cast<std::uint64_t>(timeout_ns);
    if (client_) longest_ns = std::min(longest_ns, std::clamp(cycle_ns(display_), kShortestTick_ns, kLongestTick_ns));
    if (!accepts_) longest_ns = std::min(longest_ns, kPause_ns);
    // poll(2) passes over descriptors below zero.
    std::array<pollfd, 3> watched{{{wake_.get(), POLLIN, 0},
                                   {accepts_ ? listener_.get() : -1, POLLIN, 0},
                                   {client_ ? client_->socket() : -1, POLLIN, 0}}};
    timespec timeout{};
    if (longest_ns != UINT64_MAX) {
        timeout.tv_sec = static_cast<time_t>(longest_ns / 1'000'000'000);
        timeout.tv_nsec = static_cast<long>(longest_ns % 1'000'000'000);
    }
    (void)::ppoll(watched.data(), watched.size(), longest_ns == UINT64_MAX ? nullptr : &timeout, nullptr);
}

void FrameShare::wake() {
    const std::uint64_t one = 1;
    (void)!::write(wake_.get(), &one, sizeof one);  // Full only when it is awake anyway.
}

}  // namespace xorvox::host
