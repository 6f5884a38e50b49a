#include "driver/host/capabilities.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace xorvox::host {
namespace {

/// Small enough for every device that is likely to play a recording; the headers are below one percent of it.
constexpr std::uint32_t kOneWayPacketBytes = 4096;

/// A name from the wire, fit for a terminal.
std::string printable(const DisplayName& name) {
    std::string text(name.view());
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

/// What a device tells of its geometry, where it differs from that of `display`.
std::string difference(const wire::Hello& hello, const DisplayDescription& display) {
    std::string text;
    if (hello.format != display.format) {
        text = fmt::format("its pixels are {}, these {}, ", to_string(hello.format), to_string(display.format));
    }
    if (hello.frame_bytes != frame_bytes(display)) {
        text += fmt::format("its frames have {} bytes, these {}, ", hello.frame_bytes, frame_bytes(display));
    }
    if (text.empty()) text = "its frames are as large as these, so a place, a size or a direction differs, ";
    return text + fmt::format("digests {:016x} and {:016x}", hello.geometry_digest, geometry_digest(display));
}

}  // namespace

Expected<void> check_capabilities(const wire::Hello& hello, const DisplayDescription& display) {
    const std::string device =
        fmt::format("the device \"{}\" (serial \"{}\")", printable(hello.display), printable(hello.serial));
    if (hello.major != wire::kMajor) {
        return fail(fmt::format("{} speaks version {}.{} of the protocol, this program {}.{}; update the older one",
                                device, hello.major, hello.minor, wire::kMajor, wire::kMinor));
    }
    if (hello.geometry_digest != geometry_digest(display)) {
        return fail(
            fmt::format("{} has another geometry than the display \"{}\", which the frames are made for: {}; give "
                        "both ends the same display file (of show: --display)",
                        device, printable(display.name), difference(hello, display)));
    }
    // With equal digests these differ only in a device that is broken or lies.
    const std::size_t bytes = frame_bytes(display);
    if (hello.format != display.format || hello.planes != bits_per_pixel(display.format) ||
        hello.frame_bytes != bytes) {
        return fail(
            fmt::format("{} wants frames of {} bytes with {} bits a pixel in format {}, but \"{}\" has {} bytes, {} "
                        "bits and {}; its firmware does not match its geometry",
                        device, hello.frame_bytes, hello.planes, to_string(hello.format), printable(display.name),
                        bytes, bits_per_pixel(display.format), to_string(display.format)));
    }
    return {};
}

wire::Hello assumed_capabilities(const DisplayDescription& display, const LinkInfo& link) {
    return {
        .serial = DisplayName("unknown"),
        .display = display.name,
        .geometry_digest = geometry_digest(display),
        .format = display.format,
        .planes = static_cast<std::uint8_t>(bits_per_pixel(display.format)),
        .frame_bytes = static_cast<std::uint32_t>(frame_bytes(display)),
        .pages = 2,
        .max_packet_bytes = std::min(kOneWayPacketBytes, link.max_packet_bytes),
        .codecs = 1u << static_cast<unsigned>(wire::Codec::Raw) | 1u << static_cast<unsigned>(wire::Codec::Lz4),
        .free_pages = 2,
    };
}

}  // namespace xorvox::host
