#include "sim/lossy_link.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include "transport/faults.h"
#include "transport/hosted.h"

namespace xorvox::sim {

/// An owned link that stands for one that is not.
class LossyLink::Borrowed {
public:
    explicit Borrowed(Link link) : link_(link), info_(link.info()) {}

    LinkInfo info() const { return info_; }
    Status send(std::span<const std::byte> packet) { return link_ ? link_.send(packet) : Status::Closed; }
    Status receive(std::span<std::byte> buffer, std::size_t& size) {
        return link_ ? link_.receive(buffer, size) : Status::Closed;
    }
    Status flush() { return link_ ? link_.flush() : Status::Closed; }
    Status wait(std::uint32_t events, std::int64_t timeout_ns) {
        return link_ ? link_.wait(events, timeout_ns) : Status::Closed;
    }

    /// From now on the link may be gone.
    void give_back() { link_ = Link{}; }

private:
    Link link_;
    LinkInfo info_;
};

LossyLink::~LossyLink() {
    if (borrowed_ != nullptr) borrowed_->give_back();
}

Link LossyLink::over(Link link, const Faults& faults) {
    // What wraps it flushes it when it closes.
    if (borrowed_ != nullptr) borrowed_->give_back();
    borrowed_ = nullptr;
    lossy_.reset();
    const double part = faults.lost_packets();
    if (!link || part == 0.0) return link;
    transport::FaultOptions options;
    options.seed = faults.seed;
    options.directions = transport::kFaultReceived;
    options.drop = part;
    borrowed_ = new Borrowed(link);
    lossy_ = transport::with_faults(transport::make_unique_link(borrowed_), options);
    return lossy_.get();
}

}  // namespace xorvox::sim
