// A server of shared frames and programs that draw, one step at a time: what a test does not do does not happen.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "driver/host/frame_share.h"
#include "driver/host/framebuffer.h"
#include "driver/host/shared_frames.h"
#include "tests/catch.h"
#include "tests/displays.h"
#include "tests/unit/host/checksummed_frame.h"
#include "tests/unit/io/temp_folder.h"

namespace xorvox::test {

/// Frames of 1536 bytes.
inline DisplayDescription shared_display() {
    DisplayDescription display = flat_display("shared", DisplayKind::StackedPlanes, 8);
    display.format = PixelFormat::Rgb888;
    display.panels[0] = {.columns = 8, .rows = 8};
    return display;
}

/// Connects without waiting for anything; −1 on failure.
inline int connect_raw(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return socket;
    ::close(socket);
    return -1;
}

/// A program that draws, in this process, by the C header.
class Drawer {
public:
    explicit Drawer(const std::string& path) {
        frames_.socket = connect_raw(path);
        frames_.latest = XORVOX_FRAMES_NO_PAGE;
    }
    ~Drawer() { xorvox_frames_close(&frames_); }
    Drawer(const Drawer&) = delete;
    Drawer& operator=(const Drawer&) = delete;

    /// Reads the hello that the server has sent, and maps the segment.
    int welcome() {
        int memory = -1;
        int status = xorvox_frames_receive_hello(frames_.socket, &frames_.hello, &memory);
        if (status == XORVOX_FRAMES_OK) status = xorvox_frames_map(&frames_, memory);
        if (memory >= 0) ::close(memory);
        return status;
    }
    xorvox_frames& frames() { return frames_; }
    std::span<std::byte> page(std::uint32_t page) {
        return {reinterpret_cast<std::byte*>(xorvox_frames_page(&frames_, page)), frames_.segment->frame_bytes};
    }

    /// What xorvox_frames_publish() sends.
    xorvox_frames_request request(std::uint32_t page, std::uint64_t tag = 0) const {
        xorvox_frames_request request{};
        std::memcpy(request.magic, XORVOX_FRAMES_MAGIC, 8);
        request.version = XORVOX_FRAMES_VERSION;
        request.what = XORVOX_FRAMES_PUBLISH;
        request.frame_bytes = frames_.hello.frame_bytes;
        request.geometry_digest = frames_.hello.geometry_digest;
        request.page = page;
        request.pixel_format = frames_.hello.pixel_format;
        request.tag = tag;
        return request;
    }
    bool send(const void* bytes, std::size_t size) {
        return ::send(frames_.socket, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(size);
    }
    /// The server's next message; nothing when there is none, or no more.
    std::optional<xorvox_frames_reply> reply() {
        xorvox_frames_reply reply{};
        const ssize_t size = ::recv(frames_.socket, &reply, sizeof reply, MSG_DONTWAIT);
        if (size != static_cast<ssize_t>(sizeof reply)) return std::nullopt;
        return reply;
    }
    /// Whether the server has closed the connection. Drops what it said before.
    bool closed() {
        char byte = 0;
        ssize_t size = 1;
        while (size > 0) size = ::recv(frames_.socket, &byte, 1, MSG_DONTWAIT);
        return size == 0 || errno == ECONNRESET;
    }
    void leave() { xorvox_frames_close(&frames_); }

private:
    xorvox_frames frames_{};
};

struct ShareRig {
    explicit ShareRig(std::uint32_t readers = 1) : frames(frame_bytes(display), readers) {
        auto made = host::FrameShare::listen(display, path, frames);
        REQUIRE(made);
        server = std::move(*made);
    }

    /// A program that has come in.
    std::unique_ptr<Drawer> drawer() {
        auto one = std::make_unique<Drawer>(path);
        server->poll(now_ns);
        REQUIRE(one->welcome() == XORVOX_FRAMES_OK);
        return one;
    }
    /// Publishes page 0 of `one` by message; what the server replies.
    xorvox_frames_reply publish(Drawer& one, std::uint32_t page = 0, std::uint64_t tag = 0) {
        const xorvox_frames_request request = one.request(page, tag);
        return send(one, &request, sizeof request);
    }
    xorvox_frames_reply send(Drawer& one, const void* bytes, std::size_t size) {
        REQUIRE(one.send(bytes, size));
        server->poll(now_ns);
        const auto reply = one.reply();
        REQUIRE(reply);
        return *reply;
    }
    /// Publishes a checksummed frame, whose number the next one has to be.
    void publish_whole(Drawer& one) {
        const auto sequence = static_cast<std::uint32_t>(server->statistics().frames() + 1);
        write_checksummed(one.page(0), sequence);
        const xorvox_frames_reply reply = publish(one, 0, tag_of(sequence));
        CHECK(reply.status == XORVOX_FRAMES_OK);
        CHECK(reply.sequence == sequence);
        CHECK(is_whole(frames.latest()));
    }

    TempFolder folder;
    std::string path = folder / "socket";
    DisplayDescription display = shared_display();
    host::Framebuffer frames;
    std::unique_ptr<host::FrameShare> server;
    std::uint64_t now_ns = 1'000'000'000;
};

inline void fill(std::span<std::byte> bytes, std::uint8_t value) {
    std::fill(bytes.begin(), bytes.end(), std::byte{value});
}
inline bool all_are(const host::Frame& frame, std::uint8_t value) {
    return !frame.bytes.empty() &&
           std::all_of(frame.bytes.begin(), frame.bytes.end(), [&](std::byte b) { return b == std::byte{value}; });
}

}  // namespace xorvox::test
