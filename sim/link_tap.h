// LinkTap: a device's end of a link, with the packets that pass shown to the account of time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sim/timing.h"
#include "transport/link.h"

namespace xorvox::sim {

class LinkTap {
public:
    /// `timing` is borrowed.
    explicit LinkTap(TimingWatch& timing) : timing_(timing) {}
    LinkTap(const LinkTap&) = delete;
    LinkTap& operator=(const LinkTap&) = delete;

    /// `inner`, which is borrowed, until the next call; empty stays empty.
    Link over(Link inner) {
        static constexpr LinkOperations kOperations{
            .info = [](const void* self) { return static_cast<const LinkTap*>(self)->inner_.info(); },
            .send =
                [](void* self, std::span<const std::byte> packet) {
                    const Status status = at(self).inner_.send(packet);
                    if (status == Status::Ok) at(self).timing_.sent(packet, at(self).now_ns_);
                    return status;
                },
            .receive =
                [](void* self, std::span<std::byte> buffer, std::size_t& size) {
                    const Status status = at(self).inner_.receive(buffer, size);
                    if (status == Status::Ok) at(self).timing_.received(buffer.first(size), at(self).now_ns_);
                    return status;
                },
            .flush = [](void* self) { return at(self).inner_.flush(); },
            .wait = [](void* self, std::uint32_t events,
                       std::int64_t timeout_ns) { return at(self).inner_.wait(events, timeout_ns); },
            .close = [](void*) {},
        };
        inner_ = inner;
        return inner ? Link{&kOperations, this} : Link{};
    }
    /// From here on it is `now_ns`.
    void set_time(std::uint64_t now_ns) { now_ns_ = now_ns; }

private:
    static LinkTap& at(void* self) { return *static_cast<LinkTap*>(self); }

    TimingWatch& timing_;
    Link inner_;
    std::uint64_t now_ns_ = 0;
};

}  // namespace xorvox::sim
