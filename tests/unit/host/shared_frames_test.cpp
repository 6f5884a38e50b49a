// Shared frames as programs that keep to the rules see them; those that do not: shared_frames_hostile_test.cpp.
#include "driver/host/shared_frames.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <functional>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "driver/host/frame_share.h"
#include "tests/golden/golden.h"
#include "tests/unit/host/shared_frames_c.h"
#include "tests/unit/host/shared_frames_rig.h"

namespace xorvox::test {
namespace {

#define FIELD(type, member) offsetof(xorvox_frames##type, member), sizeof(((xorvox_frames##type*)nullptr)->member)

TEST_CASE("shared frames: C and C++ lay out alike what both ends share") {
    const std::size_t layout[] = {
        sizeof(xorvox_frames),
        FIELD(, segment),
        FIELD(, socket),
        FIELD(, taken),
        FIELD(_segment, page_stride_bytes),
        FIELD(_segment, display_name),
        FIELD(_segment, panel),
        FIELD(_segment, tag),
        FIELD(_segment, latest),
        FIELD(_segment, released),
        sizeof(xorvox_frames_segment),
        FIELD(_hello, pixel_format),
        FIELD(_request, tag),
        FIELD(_reply, sequence),
        0,
    };
    for (std::size_t i = 0; i < std::size(layout); ++i) {
        INFO(i);
        CHECK(xorvox_test_c_layout[i] == layout[i]);
    }
}

TEST_CASE("shared frames: messages and the head of a segment have the bytes of the golden file") {
    ShareRig rig;
    Drawer drawer(rig.path);
    rig.server->poll(rig.now_ns);
    // Before the hello is taken off the socket: its own bytes.
    std::vector<std::byte> hello(sizeof(xorvox_frames_hello));
    REQUIRE(::recv(drawer.frames().socket, hello.data(), hello.size(), MSG_PEEK) == 48);
    REQUIRE(drawer.welcome() == XORVOX_FRAMES_OK);
    const xorvox_frames_request request = drawer.request(2, 0x1122334455667788);
    const xorvox_frames_reply reply = rig.publish(drawer, 2, 7);
    for (const GoldenEntry& entry : read_golden("tests/golden/shared_frames.hex")) {
        INFO(entry.word);
        const void* const ours = entry.word == "hello"     ? hello.data()
                                 : entry.word == "request" ? static_cast<const void*>(&request)
                                 : entry.word == "reply"   ? static_cast<const void*>(&reply)
                                                           : drawer.frames().segment;
        std::vector<std::byte> bytes(entry.bytes.size());
        std::memcpy(bytes.data(), ours, bytes.size());
        CHECK(bytes == entry.bytes);
    }
}

TEST_CASE("shared frames: a page published by message is the latest frame, and the writer's again on reply") {
    ShareRig rig;
    const auto drawer = rig.drawer();
    CHECK(rig.frames.latest().bytes.empty());
    for (std::uint8_t i = 1; i <= 10; ++i) {
        const std::uint32_t page = i % host::FrameSegment::kPages;
        fill(drawer->page(page), i);
        const xorvox_frames_reply reply = rig.publish(*drawer, page, 1000u + i);
        CHECK(reply.status == XORVOX_FRAMES_OK);
        CHECK(reply.sequence == i);
        CHECK(reply.page == page);
        fill(drawer->page(page), 99);
        CHECK(all_are(rig.frames.latest(), i));
        CHECK(rig.frames.latest().tag == 1000u + i);
    }
    CHECK(rig.server->statistics().by_message == 10);
}

TEST_CASE("shared frames: a page published by atomics is the latest frame, and another one is there to draw into") {
    ShareRig rig;
    const auto drawer = rig.drawer();
    xorvox_frames& frames = drawer->frames();
    std::uint32_t read = XORVOX_FRAMES_NO_PAGE;  // By the server.
    for (std::uint8_t i = 1; i <= 50; ++i) {
        const std::uint32_t page = xorvox_frames_begin(&frames);
        REQUIRE(page < host::FrameSegment::kPages);
        REQUIRE(page != read);
        CHECK(xorvox_frames_begin(&frames) == page);
        fill(drawer->page(page), i);
        xorvox_frames_end(&frames, page, i);
        if (i % 3 != 0) continue;  // The server was slow.
        read = page;
        rig.server->poll(rig.now_ns);
        rig.server->poll(rig.now_ns);
        CHECK(all_are(rig.frames.latest(), i));
        CHECK(rig.frames.latest().tag == i);
        CHECK(rig.frames.latest().sequence == i / 3);
    }
}

TEST_CASE("shared frames: what was published by atomics last is taken, though its program has ended") {
    ShareRig rig;
    auto drawer = rig.drawer();
    fill(drawer->page(xorvox_frames_begin(&drawer->frames())), 5);
    xorvox_frames_end(&drawer->frames(), xorvox_frames_begin(&drawer->frames()), 0);
    drawer.reset();
    rig.server->poll(rig.now_ns);
    CHECK(all_are(rig.frames.latest(), 5));
}

TEST_CASE("shared frames: what was published by messages last is taken, though its program ended with replies unread") {
    ShareRig rig;
    const auto drawer = rig.drawer();
    const auto publish = [&](std::uint32_t page) {
        fill(drawer->page(page), static_cast<std::uint8_t>(1 + page));
        const xorvox_frames_request request = drawer->request(page);
        REQUIRE(drawer->send(&request, sizeof request));
    };
    publish(0);
    rig.server->poll(rig.now_ns);
    publish(1);
    publish(2);
    drawer->leave();
    rig.server->poll(rig.now_ns);
    CHECK(all_are(rig.frames.latest(), 3));
    CHECK(rig.server->statistics().by_message == 3);
    CHECK(rig.drawer() != nullptr);
}

TEST_CASE("shared frames: a segment tells what a display is and where its rows are") {
    ShareRig rig;
    rig.server.reset();
    for (const DisplayDescription& display : odd_displays()) {
        INFO(std::string(display.name.view()));
        host::Framebuffer frames(frame_bytes(display));
        auto server = host::FrameShare::listen(display, rig.path, frames);
        REQUIRE(server);
        Drawer drawer(rig.path);
        (*server)->poll(0);
        REQUIRE(drawer.welcome() == XORVOX_FRAMES_OK);
        const xorvox_frames_segment& told = *drawer.frames().segment;
        CHECK(told.frame_bytes == frame_bytes(display));
        CHECK(told.geometry_digest == geometry_digest(display));
        CHECK(told.slices == display.slices);
        CHECK(told.bits_per_pixel == bits_per_pixel(display.format));
        REQUIRE(told.panel_count == display.panel_count);
        CHECK(told.segment_bytes == 4096 + told.pages * told.page_stride_bytes);
        CHECK(told.page_stride_bytes % 4096 == 0);
        std::uint64_t bytes = 0;
        for (std::uint32_t p = 0; p < told.panel_count; ++p) {
            CHECK(told.panel[p].offset_bytes == bytes);
            CHECK(told.panel[p].columns == display.panels[p].columns);
            CHECK(told.panel[p].rows == display.panels[p].rows);
            bytes += std::uint64_t{told.panel[p].row_bytes} * told.panel[p].rows;
        }
        CHECK(bytes == told.slice_bytes);
        // The last pixel of the frame, all bits of it.
        const std::uint32_t panel = told.panel_count - 1;
        const std::uint32_t all = (1u << told.bits_per_pixel) - 1;
        xorvox_frames_put(&drawer.frames(), 1, told.slices - 1, panel, told.panel[panel].rows - 1,
                          told.panel[panel].columns - 1, all);
        std::uint32_t bits = 0;
        for (const std::byte byte : drawer.page(1).last(told.panel[panel].row_bytes)) {
            bits += static_cast<std::uint32_t>(std::popcount(std::to_integer<std::uint8_t>(byte)));
        }
        CHECK(bits == told.bits_per_pixel);
        xorvox_frames_put(&drawer.frames(), 1, told.slices - 1, panel, told.panel[panel].rows - 1,
                          told.panel[panel].columns - 1, 0);
        for (const std::byte byte : drawer.page(1)) REQUIRE(byte == std::byte{0});
    }
}

TEST_CASE("shared frames: the C header's codes are those of the driver for full and for no colour") {
    for (const PixelFormat format : kPixelFormats) {
        const auto number = static_cast<std::uint32_t>(format);
        INFO(to_string(format));
        CHECK(xorvox_frames_code(number, 255, 255, 255) == (1u << bits_per_pixel(format)) - 1);
        CHECK(xorvox_frames_code(number, 0, 0, 0) == 0);
    }
    CHECK(xorvox_frames_code(static_cast<std::uint32_t>(PixelFormat::Rgb565), 255, 0, 0) == 0xf800);
    CHECK(xorvox_frames_code(static_cast<std::uint32_t>(PixelFormat::Rgb332), 0, 0, 255) == 0x03);
    CHECK(xorvox_frames_code(static_cast<std::uint32_t>(PixelFormat::Rgb888), 1, 2, 3) == 0x030201);
    CHECK(xorvox_frames_code(99, 255, 255, 255) == 0);
}

TEST_CASE("shared frames: one program draws at a time; the next is let in when the first has gone") {
    ShareRig rig;
    auto first = rig.drawer();
    Drawer second(rig.path);
    rig.server->poll(rig.now_ns);
    CHECK(second.welcome() == XORVOX_FRAMES_BUSY);
    CHECK(second.closed());
    rig.publish_whole(*first);
    first.reset();
    const auto third = rig.drawer();
    CHECK(is_whole(rig.frames.latest()));
    rig.publish_whole(*third);
    CHECK(rig.server->statistics().clients == 2);
    CHECK(rig.server->statistics().refused[XORVOX_FRAMES_BUSY] == 1);
}

TEST_CASE("shared frames: a program that has published nothing for long makes room for the next one") {
    ShareRig rig;
    const auto stalled = rig.drawer();
    rig.now_ns += XORVOX_FRAMES_PATIENCE_NS - 1;
    rig.publish_whole(*stalled);
    rig.now_ns += XORVOX_FRAMES_PATIENCE_NS - 1;
    Drawer early(rig.path);
    rig.server->poll(rig.now_ns);
    CHECK(early.welcome() == XORVOX_FRAMES_BUSY);
    rig.now_ns += 1;
    CHECK_FALSE(stalled->closed());
    const auto next = rig.drawer();
    CHECK(stalled->closed());
    CHECK(is_whole(rig.frames.latest()));
    // What it still writes, it writes into memory that nobody reads.
    fill(stalled->page(0), 1);
    rig.publish_whole(*next);
    CHECK(xorvox_frames_publish(&stalled->frames(), 0, 0) == XORVOX_FRAMES_CLOSED);
}

TEST_CASE("shared frames: a socket is for its user alone, and is removed at the end") {
    ShareRig rig;
    struct stat file {};
    REQUIRE(::stat(rig.path.c_str(), &file) == 0);
    CHECK(S_ISSOCK(file.st_mode));
    CHECK((file.st_mode & 07777) == 0600);
    rig.server.reset();
    CHECK(rig.folder.names().empty());
}

TEST_CASE("shared frames: the socket of a dead server is replaced, that of a live one is not") {
    ShareRig rig;
    const auto second = host::FrameShare::listen(rig.display, rig.path, rig.frames);
    REQUIRE_FALSE(second);
    CHECK_THAT(second.error().message, Catch::Contains("listens there already"));
    CHECK(rig.folder.names().size() == 1);
    rig.server.reset();

    const int dead = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, rig.path.data(), rig.path.size());
    REQUIRE(::bind(dead, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    ::close(dead);
    REQUIRE(rig.folder.names().size() == 1);
    const auto third = host::FrameShare::listen(rig.display, rig.path, rig.frames);
    REQUIRE(third);
    CHECK(Drawer(rig.path).frames().socket >= 0);
}

TEST_CASE("shared frames: a server removes no socket that is not its own") {
    ShareRig rig;
    ::unlink(rig.path.c_str());
    const auto second = host::FrameShare::listen(rig.display, rig.path, rig.frames);
    REQUIRE(second);
    rig.server.reset();
    CHECK(rig.folder.names().size() == 1);
}

TEST_CASE("shared frames: paths where no socket can be are refused with the reason") {
    ShareRig rig;
    const auto message = [&](const std::string& path) {
        const auto server = host::FrameShare::listen(rig.display, path, rig.frames);
        return server ? std::string() : server.error().message;
    };
    put(rig.folder / "file", "text");
    CHECK_THAT(message(rig.folder / "file"), Catch::Contains("no socket; choose another path"));
    CHECK(contents(rig.folder / "file") == "text");
    CHECK_THAT(message(rig.folder / "missing/socket"), Catch::Contains("name a folder that is there"));
    CHECK_THAT(message(rig.folder / std::string(120, 'x')), Catch::Contains("has at most 107"));
    CHECK_THAT(message(""), Catch::Contains("empty"));
    CHECK_THAT(message(std::string("a\0b", 3)), Catch::Contains("byte 0"));
}

TEST_CASE("shared frames: the C header maps no segment whose pages do not fit into it") {
    ShareRig rig;
    const auto drawer = rig.drawer();
    const auto map = [&](const std::function<void(xorvox_frames_segment&)>& spoil) {
        xorvox_frames frames{};
        frames.socket = -1;
        frames.hello = drawer->frames().hello;
        const int memory = ::memfd_create("segment", MFD_CLOEXEC);
        REQUIRE(::ftruncate(memory, static_cast<off_t>(frames.hello.segment_bytes)) == 0);
        alignas(xorvox_frames_segment) std::array<std::byte, sizeof(xorvox_frames_segment)> head{};
        std::memcpy(head.data(), drawer->frames().segment, head.size());
        spoil(*reinterpret_cast<xorvox_frames_segment*>(head.data()));
        REQUIRE(::pwrite(memory, head.data(), head.size(), 0) == static_cast<ssize_t>(head.size()));
        const int status = xorvox_frames_map(&frames, memory);
        ::close(memory);
        xorvox_frames_close(&frames);
        return status;
    };
    using Segment = xorvox_frames_segment;
    CHECK(map([](Segment&) {}) == XORVOX_FRAMES_OK);
    CHECK(map([](Segment& s) { s.header_bytes = 8; }) == XORVOX_FRAMES_NO_SERVER);
    CHECK(map([](Segment& s) { s.header_bytes += 1; }) == XORVOX_FRAMES_NO_SERVER);
    CHECK(map([](Segment& s) { s.header_bytes = 0xffff'ffff; }) == XORVOX_FRAMES_NO_SERVER);
    CHECK(map([](Segment& s) { s.page_stride_bytes = s.frame_bytes - 1; }) == XORVOX_FRAMES_NO_SERVER);
    CHECK(map([](Segment& s) { s.page_stride_bytes += 1; }) == XORVOX_FRAMES_NO_SERVER);
    CHECK(map([](Segment& s) { s.page_stride_bytes = std::uint64_t{1} << 63; }) == XORVOX_FRAMES_NO_SERVER);
}

TEST_CASE("shared frames: the C header says why it cannot connect") {
    ShareRig rig;
    xorvox_frames frames;
    CHECK(xorvox_frames_connect(&frames, (rig.folder / "nobody").c_str()) == -ENOENT);
    CHECK(xorvox_frames_connect(&frames, std::string(120, 'x').c_str()) == -ENAMETOOLONG);
    for (int status = 0; status < XORVOX_FRAMES_STATUSES; ++status) {
        CHECK(std::string(xorvox_frames_text(status)) != "unknown status");
    }
    CHECK(std::string(xorvox_frames_text(XORVOX_FRAMES_STATUSES)) == "unknown status");
    CHECK(std::string(xorvox_frames_text(-ENOENT)) == std::strerror(ENOENT));
}

}  // namespace
}  // namespace xorvox::test
