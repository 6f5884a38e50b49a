#include "driver/device/pages.h"

namespace xorvox::device {

void Pages::init(std::span<std::byte> memory, std::size_t frame_bytes, std::uint32_t count) {
    *this = Pages{};
    memory_ = memory;
    frame_bytes_ = frame_bytes;
    count_ = count;
}

std::uint8_t Pages::free_count() const {
    std::uint8_t count = 0;
    for (std::uint32_t page = 0; page < count_; ++page) {
        if (is_free(page)) ++count;
    }
    return count;
}

std::uint32_t Pages::find_free() const {
    for (std::uint32_t page = 0; page < count_; ++page) {
        if (is_free(page)) return page;
    }
    return kNone;
}

void Pages::accept(std::uint32_t page, std::uint32_t frame, std::uint32_t crc, std::uint64_t due_ns) {
    pages_[page] = {frame, crc, due_ns, accepted_++, true, true};
    base_ = page;
}

bool Pages::later(std::uint32_t page, std::uint32_t than) const {
    const Page& a = pages_[page];
    const Page& b = pages_[than];
    if (a.due_ns != b.due_ns) return a.due_ns > b.due_ns;
    return static_cast<std::int32_t>(a.order - b.order) > 0;
}

bool Pages::present(std::uint64_t now_ns) {
    std::uint32_t latest = kNone;
    for (std::uint32_t page = 0; page < count_; ++page) {
        if (!pages_[page].pending || pages_[page].due_ns > now_ns) continue;
        pages_[page].pending = false;
        if (latest == kNone || later(page, latest)) latest = page;
    }
    if (latest == kNone) return false;
    shown_ = latest;
    return true;
}

void Pages::end_session() {
    base_ = kNone;
    std::uint32_t last = kNone;
    for (std::uint32_t page = 0; page < count_; ++page) {
        pages_[page].of_session = false;
        if (!pages_[page].pending) continue;
        pages_[page].pending = false;
        pages_[page].due_ns = 0;
        if (last == kNone || later(page, last)) last = page;
    }
    if (last != kNone) pages_[last].pending = true;
}

}  // namespace xorvox::device
