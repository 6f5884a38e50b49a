#include "driver/host/framebuffer.h"

#include <algorithm>

namespace xorvox::host {

Framebuffer::Framebuffer(std::size_t frame_bytes, std::uint32_t readers)
    : pages_(std::clamp(readers, 1u, kMaxReaders) + 2),
      frame_bytes_(frame_bytes),
      page_lines_(frame_bytes / kLine + (frame_bytes % kLine != 0)),
      memory_(pages_ * page_lines_),
      readers_(pages_ - 2, Reader{PageReader<>(exchange_, pages_)}),
      writer_(exchange_, pages_) {}

std::span<std::byte> Framebuffer::begin_frame() {
    if (drawing_ == kNoPage) drawing_ = writer_.begin();
    if (drawing_ == kNoPage) return {};
    return {page_bytes(drawing_), frame_bytes_};
}

Status Framebuffer::end_frame(std::uint64_t tag) {
    if (drawing_ == kNoPage) return Status::InvalidArgument;
    const std::uint32_t sequence = published_.load(std::memory_order_relaxed) + 1;  // Only this thread changes it.
    notes_[drawing_] = {tag, sequence};
    writer_.publish(drawing_);
    drawing_ = kNoPage;
    // After publish(), and released: who sees the number finds the page.
    published_.store(sequence, std::memory_order_release);
    return Status::Ok;
}

Frame Framebuffer::latest(std::uint32_t reader) {
    if (reader >= readers()) return {};
    const std::uint32_t page = readers_[reader].side.take();
    if (page == kNoPage) return {};
    return {{page_bytes(page), frame_bytes_}, notes_[page].sequence, notes_[page].tag};
}

void Framebuffer::release(std::uint32_t reader) {
    if (reader < readers()) readers_[reader].side.release();
}

bool Framebuffer::changed_since(std::uint32_t sequence) const {
    // A reader can have a frame before its number is stored here: then the difference is negative, which is no change.
    return static_cast<std::int32_t>(published_.load(std::memory_order_acquire) - sequence) > 0;
}

}  // namespace xorvox::host
