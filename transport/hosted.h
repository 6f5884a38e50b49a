// What the hosted backends share: an operations table made from a class, the input side of a byte stream, deadlines,
// the system's words for its errors.
//
// Internal to transport and sim; not installed. A backend for firmware writes its table by hand, as link_template.cpp
// does.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "transport/framing.h"
#include "transport/link.h"

namespace xorvox::transport {

/// The table of a class with the member functions info, send, receive, flush and wait. close() deletes the object.
template <class Backend>
inline constexpr LinkOperations kOperations = {
    .info = [](const void* self) { return static_cast<const Backend*>(self)->info(); },
    .send = [](void* self, std::span<const std::byte> packet) { return static_cast<Backend*>(self)->send(packet); },
    .receive = [](void* self, std::span<std::byte> buffer,
                  std::size_t& size) { return static_cast<Backend*>(self)->receive(buffer, size); },
    .flush = [](void* self) { return static_cast<Backend*>(self)->flush(); },
    .wait = [](void* self, std::uint32_t events,
               std::int64_t timeout_ns) { return static_cast<Backend*>(self)->wait(events, timeout_ns); },
    .close = [](void* self) { delete static_cast<Backend*>(self); },
};

/// Takes over `backend`, made by new.
template <class Backend>
UniqueLink make_unique_link(Backend* backend) {
    return UniqueLink(Link{&kOperations<Backend>, backend});
}

/// The end of a wait that begins now. Negative timeouts count as 0; very long ones as a year, so that nothing
/// overflows.
inline std::chrono::steady_clock::time_point deadline_after(std::int64_t timeout_ns) {
    constexpr std::int64_t kYearNs = 365LL * 24 * 3600 * 1'000'000'000;
    return std::chrono::steady_clock::now() +
           std::chrono::nanoseconds(std::clamp<std::int64_t>(timeout_ns, 0, kYearNs));
}

/// What the system says of `error`, a value of errno. Thread-safe, unlike std::strerror.
inline std::string describe(int error) {
    return std::generic_category().message(error);
}

/// The receiving side of a link over a byte stream. `read` puts bytes into the span that it gets and answers how many;
/// 0 at the stream's end and kNothingYet when it would have to wait.
class FramedInput {
public:
    static constexpr std::ptrdiff_t kNothingYet = -1;

    FramedInput() = default;
    FramedInput(const FramedInput&) = delete;  // decoder_ points into packet_.
    FramedInput& operator=(const FramedInput&) = delete;

    /// Reads on until receive() has something to say. Ok: it has. WouldBlock: not yet, or not in the bounded number of
    /// bytes that one call looks at, so that a peer who sends nonsense without a pause holds up nobody. Closed: the
    /// end, and everything was given.
    template <class Read>
    Status pull(Read&& read) {
        int reads_left = 16;
        while (!has_packet_ && !corrupt_) {
            if (begin_ < end_) {
                std::size_t consumed = 0;
                const Status status = decoder_.feed(std::span(bytes_).subspan(begin_, end_ - begin_), consumed);
                begin_ += consumed;
                has_packet_ = status == Status::Ok;
                corrupt_ = status == Status::Corrupt;
                continue;
            }
            if (ended_) return Status::Closed;
            if (reads_left-- == 0) return Status::WouldBlock;
            const std::ptrdiff_t count = read(std::span(bytes_));
            if (count == kNothingYet) return Status::WouldBlock;
            begin_ = 0;
            end_ = static_cast<std::size_t>(count);
            if (count == 0) {
                ended_ = true;
                corrupt_ = decoder_.partial();
            }
        }
        return Status::Ok;
    }

    /// What LinkOperations::receive says.
    template <class Read>
    Status receive(Read&& read, std::span<std::byte> buffer, std::size_t& size) {
        const Status status = pull(read);
        if (status != Status::Ok) return status;
        if (corrupt_) {
            corrupt_ = false;
            return Status::Corrupt;
        }
        const std::span<const std::byte> packet = decoder_.packet();
        size = packet.size();
        if (buffer.size() < packet.size()) return Status::OutOfMemory;
        std::memcpy(buffer.data(), packet.data(), packet.size());
        has_packet_ = false;
        return Status::Ok;
    }

    bool ended() const { return ended_; }

private:
    std::vector<std::byte> bytes_ = std::vector<std::byte>(64 * 1024);
    std::vector<std::byte> packet_ = std::vector<std::byte>(kMaxFramedBytes);
    FrameDecoder decoder_{packet_};
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
    bool has_packet_ = false;
    bool corrupt_ = false;
    bool ended_ = false;
};

}  // namespace xorvox::transport
