#include "sim/sim_host.h"

#include <algorithm>
#include <cassert>

namespace xorvox::sim {
namespace {

constexpr std::uint16_t kSession = 1;
constexpr std::uint64_t kQuiet_ns = 100'000'000;

}  // namespace

SimHost::SimHost(Link link, std::uint64_t now_ns)
    : link_(link), buffer_(link.info().max_packet_bytes), said_ns_(now_ns) {
    queue(wire::HelloRequest{.host_time_ns = now_ns});
}

template <class Message>
void SimHost::queue(const Message& message) {
    std::size_t size = 0;
    [[maybe_unused]] const Status status = wire::encode_packet(kSession, sequence_++, message, buffer_, size);
    assert(status == Status::Ok);
    packets_.emplace_back(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(size));
}

std::uint32_t SimHost::send_frame(std::span<const std::byte> page, std::uint64_t present_at_ns) {
    ++frame_;
    queue(wire::FrameBegin{
        .frame = frame_, .frame_bytes = static_cast<std::uint32_t>(page.size()), .present_at_ns = present_at_ns});
    const std::size_t most = buffer_.size() - wire::kPacketOverhead - wire::kChunkHeaderBytes;
    for (std::size_t at = 0; at < page.size(); at += most) {
        const std::span<const std::byte> part = page.subspan(at, std::min(most, page.size() - at));
        queue(wire::Chunk{.frame = frame_,
                          .offset = static_cast<std::uint32_t>(at),
                          .decoded_length = static_cast<std::uint32_t>(part.size()),
                          .codec = wire::Codec::Raw,
                          .data = part});
    }
    queue(wire::FrameEnd{.frame = frame_, .page_crc = wire::crc32c(page)});
    return frame_;
}

void SimHost::poll(std::uint64_t now_ns) {
    if (packets_.empty() && now_ns - said_ns_ >= kQuiet_ns) queue(wire::Ping{.host_time_ns = now_ns});
    while (!packets_.empty() && link_.send(packets_.front()) == Status::Ok) {
        packets_.pop_front();
        said_ns_ = now_ns;
    }
    for (std::size_t size = 0; link_.receive(buffer_, size) == Status::Ok;) {
    }
}

}  // namespace xorvox::sim
