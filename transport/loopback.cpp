#include "transport/loopback.h"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "transport/hosted.h"

namespace xorvox::transport {
namespace {

/// A ring of packets, each behind its length in 4 bytes.
class PacketRing {
public:
    explicit PacketRing(std::size_t bytes) : ring_(bytes) {}

    bool empty() const { return used_ == 0; }
    bool has_room(std::size_t packet_bytes) const { return ring_.size() - used_ >= packet_bytes + kLengthBytes; }

    void push(std::span<const std::byte> packet) {
        const auto length = static_cast<std::uint32_t>(packet.size());
        put(std::as_bytes(std::span(&length, 1)));
        put(packet);
    }
    std::size_t front_bytes() const {
        std::uint32_t length = 0;
        get(0, std::as_writable_bytes(std::span(&length, 1)));
        return length;
    }
    void pop(std::span<std::byte> packet) {
        get(kLengthBytes, packet);
        begin_ = (begin_ + kLengthBytes + packet.size()) % ring_.size();
        used_ -= kLengthBytes + packet.size();
    }

    static constexpr std::size_t kLengthBytes = sizeof(std::uint32_t);

private:
    void put(std::span<const std::byte> bytes) {
        const std::size_t at = (begin_ + used_) % ring_.size();
        const std::size_t first = std::min(bytes.size(), ring_.size() - at);
        std::copy_n(bytes.begin(), first, ring_.begin() + static_cast<std::ptrdiff_t>(at));
        std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(first), bytes.end(), ring_.begin());
        used_ += bytes.size();
    }
    void get(std::size_t offset, std::span<std::byte> bytes) const {
        const std::size_t at = (begin_ + offset) % ring_.size();
        const std::size_t first = std::min(bytes.size(), ring_.size() - at);
        std::copy_n(ring_.begin() + static_cast<std::ptrdiff_t>(at), first, bytes.begin());
        std::copy_n(ring_.begin(), bytes.size() - first, bytes.begin() + static_cast<std::ptrdiff_t>(first));
    }

    std::vector<std::byte> ring_;
    std::size_t begin_ = 0;
    std::size_t used_ = 0;
};

/// Both directions: side s sends into ring[s] and receives from ring[1 − s].
struct Shared {
    explicit Shared(std::size_t queue_bytes) : ring{PacketRing(queue_bytes), PacketRing(queue_bytes)} {}

    std::mutex mutex;
    std::condition_variable changed;
    std::array<PacketRing, 2> ring;
    std::array<bool, 2> closed{};
};

class LoopbackEnd {
public:
    LoopbackEnd(std::shared_ptr<Shared> shared, std::size_t side, std::uint32_t max_packet_bytes)
        : shared_(std::move(shared)), side_(side), max_packet_bytes_(max_packet_bytes) {}
    LoopbackEnd(const LoopbackEnd&) = delete;
    LoopbackEnd& operator=(const LoopbackEnd&) = delete;
    ~LoopbackEnd() {
        const std::lock_guard lock(shared_->mutex);
        shared_->closed[side_] = true;
        shared_->changed.notify_all();
    }

    LinkInfo info() const { return {"loopback", max_packet_bytes_, true}; }

    Status send(std::span<const std::byte> packet) {
        if (packet.empty() || packet.size() > max_packet_bytes_) return Status::OutOfRange;
        const std::lock_guard lock(shared_->mutex);
        if (peer_closed()) return Status::Closed;
        wanted_bytes_ = packet.size();
        if (!outgoing().has_room(packet.size())) return Status::WouldBlock;
        outgoing().push(packet);
        shared_->changed.notify_all();
        return Status::Ok;
    }

    Status receive(std::span<std::byte> buffer, std::size_t& size) {
        const std::lock_guard lock(shared_->mutex);
        if (incoming().empty()) return peer_closed() ? Status::Closed : Status::WouldBlock;
        const std::size_t bytes = incoming().front_bytes();
        size = bytes;
        if (buffer.size() < bytes) return Status::OutOfMemory;
        incoming().pop(buffer.first(bytes));
        shared_->changed.notify_all();
        return Status::Ok;
    }

    Status flush() {
        const std::lock_guard lock(shared_->mutex);
        return peer_closed() ? Status::Closed : Status::Ok;
    }

    Status wait(std::uint32_t events, std::int64_t timeout_ns) {
        const auto deadline = deadline_after(timeout_ns);
        std::unique_lock lock(shared_->mutex);
        const bool woken = shared_->changed.wait_until(lock, deadline, [&] {
            return peer_closed() || ((events & kLinkReadable) != 0 && !incoming().empty()) ||
                   ((events & kLinkWritable) != 0 && outgoing().has_room(wanted_bytes_));
        });
        if (peer_closed() && incoming().empty()) return Status::Closed;
        return woken ? Status::Ok : Status::Timeout;
    }

private:
    PacketRing& outgoing() { return shared_->ring[side_]; }
    PacketRing& incoming() { return shared_->ring[1 - side_]; }
    bool peer_closed() const { return shared_->closed[1 - side_]; }

    std::shared_ptr<Shared> shared_;
    std::size_t side_;
    std::uint32_t max_packet_bytes_;
    std::size_t wanted_bytes_ = 1;  ///< Of the last packet to be sent: what "writable" means.
};

}  // namespace

std::pair<UniqueLink, UniqueLink> make_loopback(const LoopbackOptions& options) {
    const std::size_t queue_bytes = std::max(options.queue_bytes, options.max_packet_bytes + PacketRing::kLengthBytes);
    const auto shared = std::make_shared<Shared>(queue_bytes);
    return {make_unique_link(new LoopbackEnd(shared, 0, options.max_packet_bytes)),
            make_unique_link(new LoopbackEnd(shared, 1, options.max_packet_bytes))};
}

}  // namespace xorvox::transport
