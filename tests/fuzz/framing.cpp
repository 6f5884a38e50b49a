// Any bytes, in any pieces: the decoder stays in its buffer, gives what a decoder fed at once gives, and finds a frame
// that follows the garbage.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "transport/framing.h"

namespace {

using namespace xorvox;
using Bytes = std::vector<std::byte>;

constexpr std::size_t kBufferBytes = 300;

void require(bool condition) {
    if (!condition) std::abort();
}

struct Decoded {
    std::vector<Bytes> packets;
    std::size_t corrupt = 0;
    bool partial = false;
    bool operator==(const Decoded&) const = default;
};

/// Feeds pieces of 1 … `longest` bytes.
Decoded decode(std::span<const std::byte> stream, std::size_t longest) {
    Bytes buffer(kBufferBytes);
    transport::FrameDecoder decoder(buffer);
    Decoded result;
    for (std::size_t at = 0; at < stream.size();) {
        const std::size_t piece = std::min(1 + at * 7 % longest, stream.size() - at);
        std::size_t consumed = 0;
        const Status status = decoder.feed(stream.subspan(at, piece), consumed);
        require(consumed > 0 && consumed <= piece);
        if (status == Status::Ok) {
            const auto packet = decoder.packet();
            require(!packet.empty() && packet.size() <= kBufferBytes);
            result.packets.emplace_back(packet.begin(), packet.end());
        } else if (status == Status::Corrupt) {
            ++result.corrupt;
        } else {
            require(status == Status::WouldBlock && consumed == piece);
        }
        at += consumed;
    }
    result.partial = decoder.partial();
    return result;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto input = std::as_bytes(std::span(data, size));
    const Decoded whole = decode(input, SIZE_MAX);
    require(decode(input, 1) == whole);
    require(decode(input, 11) == whole);

    // A frame that stood in the garbage can swallow at most its own length of what follows.
    Bytes stream(input.begin(), input.end());
    const std::array<std::byte, 5> packet{std::byte{'x'}, std::byte{'o'}, std::byte{'r'}, std::byte{'v'},
                                          std::byte{'o'}};
    std::array<std::byte, packet.size() + transport::kFrameHeaderBytes> frame;
    std::size_t frame_bytes = 0;
    require(transport::encode_frame(packet, frame, frame_bytes) == Status::Ok);
    for (std::size_t bytes = 0; bytes <= kBufferBytes + 2 * frame_bytes; bytes += frame_bytes) {
        stream.insert(stream.end(), frame.begin(), frame.end());
    }
    const Decoded after = decode(stream, 11);
    require(!after.packets.empty() && std::ranges::equal(after.packets.back(), packet));
    require(!after.partial);
    return 0;
}
