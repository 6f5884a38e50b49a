#include "transport/faults.h"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "transport/hosted.h"
#include "transport/random.h"

namespace xorvox::transport {
namespace {

using Packet = std::vector<std::byte>;

/// One direction: packets go in, what is left of them comes out.
class Mill {
public:
    Mill(const FaultOptions& options, bool active, std::uint64_t seed, FaultCounts& counts)
        : options_(options), active_(active), random_(seed), counts_(&counts) {}

    void put(std::span<const std::byte> bytes) {
        Packet packet(bytes.begin(), bytes.end());
        if (!active_) {
            ready_.push_back(std::move(packet));
            return;
        }
        ++counts_->packets;
        // Every packet takes as many numbers, so that one probability does not change what another one hits.
        const bool drop = random_.chance(options_.drop);
        const bool repeat = random_.chance(options_.repeat);
        const bool reorder = random_.chance(options_.reorder);
        const bool cut = random_.chance(options_.cut) && packet.size() > 1;
        const bool flip = random_.chance(options_.flip);
        const std::size_t cut_to = 1 + random_.below(std::max<std::size_t>(packet.size() - 1, 1));
        const std::size_t bit = random_.below(packet.size() * 8);
        if (drop) {
            ++counts_->dropped;
            return;
        }
        if (flip) {
            ++counts_->flipped;
            packet[bit / 8] ^= std::byte{1} << (bit % 8);
        }
        if (cut) {
            ++counts_->cut;
            packet.resize(cut_to);
        }
        if (repeat) ++counts_->repeated;
        if (reorder && !held_) {
            ++counts_->reordered;
            if (repeat) ready_.push_back(packet);
            held_ = std::move(packet);
            return;
        }
        if (repeat) ready_.push_back(packet);
        ready_.push_back(std::move(packet));
        release();
    }
    /// Lets the packet go that waits for a next one.
    void release() {
        if (held_) ready_.push_back(*std::exchange(held_, std::nullopt));
    }
    bool empty() const { return ready_.empty(); }
    const Packet& front() const { return ready_.front(); }
    void pop() { ready_.pop_front(); }

private:
    FaultOptions options_;
    bool active_;
    Random random_;
    FaultCounts* counts_;
    std::deque<Packet> ready_;
    std::optional<Packet> held_;
};

class FaultyLink {
public:
    FaultyLink(UniqueLink inner, const FaultOptions& options)
        : inner_(std::move(inner)),
          buffer_(inner_->info().max_packet_bytes),
          sent_(options, (options.directions & kFaultSent) != 0, options.seed, counts_),
          received_(options, (options.directions & kFaultReceived) != 0, ~options.seed, counts_) {}
    FaultyLink(const FaultyLink&) = delete;
    FaultyLink& operator=(const FaultyLink&) = delete;
    ~FaultyLink() { (void)flush(); }

    LinkInfo info() const { return inner_->info(); }

    Status send(std::span<const std::byte> packet) {
        if (packet.empty() || packet.size() > info().max_packet_bytes) return Status::OutOfRange;
        if (const Status status = push(); status != Status::Ok) return status;
        // A dropped packet would not notice that the peer is gone.
        if (inner_->flush() == Status::Closed) return Status::Closed;
        sent_.put(packet);
        (void)push();
        return Status::Ok;
    }

    Status receive(std::span<std::byte> buffer, std::size_t& size) {
        (void)push();
        while (received_.empty()) {
            std::size_t bytes = 0;
            const Status status = inner_->receive(buffer_, bytes);
            if (status == Status::Closed) received_.release();
            if (status == Status::Ok) {
                received_.put(std::span(buffer_).first(bytes));
            } else if (received_.empty()) {
                return status;
            }
        }
        const Packet& packet = received_.front();
        size = packet.size();
        if (buffer.size() < packet.size()) return Status::OutOfMemory;
        std::copy(packet.begin(), packet.end(), buffer.begin());
        received_.pop();
        return Status::Ok;
    }

    Status flush() {
        sent_.release();
        const Status status = push();
        return status == Status::Ok ? inner_->flush() : status;
    }

    Status wait(std::uint32_t events, std::int64_t timeout_ns) {
        const Status status = push();
        if ((events & kLinkReadable) != 0 && !received_.empty()) return Status::Ok;
        // Nothing of ours can go before the inner link has room.
        return inner_->wait(status == Status::WouldBlock ? events | kLinkWritable : events, timeout_ns);
    }

    const FaultCounts& counts() const { return counts_; }

private:
    /// Gives the inner link what waits for it. Ok: nothing waits any more.
    Status push() {
        while (!sent_.empty()) {
            const Status status = inner_->send(sent_.front());
            if (status != Status::Ok) return status;
            sent_.pop();
        }
        return Status::Ok;
    }

    UniqueLink inner_;
    FaultCounts counts_;
    std::vector<std::byte> buffer_;
    Mill sent_;
    Mill received_;
};

}  // namespace

UniqueLink with_faults(UniqueLink inner, const FaultOptions& options) {
    return make_unique_link(new FaultyLink(std::move(inner), options));
}

FaultCounts fault_counts(Link link) {
    if (link.operations != &kOperations<FaultyLink>) return {};
    return static_cast<const FaultyLink*>(link.self)->counts();
}

}  // namespace xorvox::transport
