// A program that draws, by arbitrary steps: messages, words of the exchange and bytes of its segment. Whatever it does,
// the server takes whole pages as they are, refuses the rest with a status, and counts both.
//
// A step is a byte, and what it needs of those that follow: 0 a message of arbitrary bytes, 1 a message that is right
// but for one byte, 2 a word of the exchange, 3 bytes anywhere in the segment, else the server's turn.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <utility>

#include <sys/socket.h>
#include <unistd.h>

#include "driver/host/frame_client.h"
#include "driver/host/framebuffer.h"

namespace {

using namespace xorvox;

void require(bool holds) {
    if (!holds) std::abort();
}

class Input {
public:
    explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    bool empty() const { return bytes_.empty(); }
    std::uint8_t byte() {
        if (bytes_.empty()) return 0;
        const std::uint8_t value = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return value;
    }
    std::uint32_t word() {
        std::uint32_t value = 0;
        for (int shift = 0; shift < 32; shift += 8) value |= std::uint32_t{byte()} << shift;
        return value;
    }
    std::span<const std::uint8_t> take(std::size_t count) {
        const auto taken = bytes_.first(std::min(count, bytes_.size()));
        bytes_ = bytes_.subspan(taken.size());
        return taken;
    }

private:
    std::span<const std::uint8_t> bytes_;
};

DisplayDescription small_display() {
    DisplayDescription display;
    display.name = std::string_view("fuzz");
    display.slices = 2;
    display.cycles_per_second = 10;
    display.panels[0] = {.columns = 8, .rows = 4};
    return display;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const DisplayDescription display = small_display();
    const host::FrameTerms terms(display);
    host::Framebuffer frames(frame_bytes(display));
    host::ShareStatistics statistics;
    auto segment = host::FrameSegment::make(display);
    int ends[2];
    if (!segment || ::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) return 0;
    host::FrameClient client(host::Descriptor(ends[0]), std::move(*segment), terms, frames, statistics);
    const host::Descriptor drawer(ends[1]);
    xorvox_frames_segment* const shared = client.segment().header();
    auto* const bytes = reinterpret_cast<std::uint8_t*>(shared);

    Input input({data, size});
    bool alive = true;
    while (alive && !input.empty()) {
        switch (input.byte()) {
            case 0: {
                const auto message = input.take(input.byte());
                (void)::send(drawer.get(), message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
                break;
            }
            case 1: {
                xorvox_frames_request request{};
                std::memcpy(request.magic, XORVOX_FRAMES_MAGIC, 8);
                request.version = XORVOX_FRAMES_VERSION;
                request.what = XORVOX_FRAMES_PUBLISH;
                request.frame_bytes = terms.frame_bytes;
                request.geometry_digest = terms.geometry_digest;
                request.page = input.byte() % 4;
                request.pixel_format = terms.pixel_format;
                const std::size_t at = input.byte() % sizeof request;
                reinterpret_cast<std::uint8_t*>(&request)[at] ^= input.byte();
                (void)::send(drawer.get(), &request, sizeof request, MSG_NOSIGNAL | MSG_DONTWAIT);
                break;
            }
            case 2: {
                const std::uint8_t which = input.byte() % 9;
                (which == 0 ? shared->latest : shared->released[which - 1]) = input.word();
                break;
            }
            case 3: {
                const std::size_t at = input.word() % client.segment().bytes();
                const auto written = input.take(std::min<std::size_t>(input.byte(), client.segment().bytes() - at));
                std::copy(written.begin(), written.end(), bytes + at);
                break;
            }
            default: {
                const std::uint64_t before = statistics.frames();
                const std::uint32_t last = frames.latest().sequence;
                alive = client.poll();
                const host::Frame latest = frames.latest();
                require(latest.sequence == static_cast<std::uint32_t>(statistics.frames()));
                require(latest.sequence >= last && statistics.frames() >= before);
                // Nobody writes while the server copies: the last frame is one of the pages.
                bool found = statistics.frames() == before;
                for (std::uint32_t page = 0; page < host::FrameSegment::kPages && !found; ++page) {
                    const auto drawn = client.segment().page(page);
                    found = std::equal(drawn.begin(), drawn.end(), latest.bytes.begin(), latest.bytes.end());
                }
                require(found);
                xorvox_frames_reply reply;
                ssize_t count = 0;
                while ((count = ::recv(drawer.get(), &reply, sizeof reply, MSG_DONTWAIT)) > 0) {
                    require(count == sizeof reply && reply.status < XORVOX_FRAMES_CLOSED);
                    require((reply.status == XORVOX_FRAMES_OK) == (reply.sequence != 0));
                }
            }
        }
    }
    return 0;
}
