#include "transport/tap.h"

#include <utility>

#include "transport/hosted.h"

namespace xorvox::transport {
namespace {

class TappedLink {
public:
    TappedLink(UniqueLink inner, Listener listener) : inner_(std::move(inner)), listener_(std::move(listener)) {}

    LinkInfo info() const { return inner_->info(); }

    Status send(std::span<const std::byte> packet) {
        const Status status = inner_->send(packet);
        if (status == Status::Ok) listener_(Passing::Sent, packet);
        return status;
    }

    Status receive(std::span<std::byte> buffer, std::size_t& size) {
        const Status status = inner_->receive(buffer, size);
        if (status == Status::Ok) listener_(Passing::Received, buffer.first(size));
        return status;
    }

    Status flush() { return inner_->flush(); }
    Status wait(std::uint32_t events, std::int64_t timeout_ns) { return inner_->wait(events, timeout_ns); }

private:
    UniqueLink inner_;
    Listener listener_;
};

}  // namespace

UniqueLink with_tap(UniqueLink inner, Listener listener) {
    return make_unique_link(new TappedLink(std::move(inner), std::move(listener)));
}

}  // namespace xorvox::transport
