// FrameSegment: the memory that one program draws into, as driver/host/shared_frames.h lays it out. Linux.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/display/description.h"
#include "driver/host/descriptor.h"
#include "driver/host/page_exchange.h"
#include "driver/host/shared_frames.h"
#include "voxelizer/error.h"

namespace xorvox::host {

/// Anonymous memory, sealed: nobody can make it shorter, so that reading it never faults. Whoever has its descriptor
/// may write any of it at any time. What of a display is needed to read it is kept here, and never read from there.
class FrameSegment {
public:
    /// One reader's pages: one that it has, the latest, and one to draw into.
    static constexpr std::uint32_t kPages = 3;

    /// Pages of zeros, under a header for `display`, which must be valid. An Error: there is no memory or descriptor.
    static Expected<FrameSegment> make(const DisplayDescription& display);
    FrameSegment(FrameSegment&& other) noexcept;
    FrameSegment& operator=(FrameSegment&&) = delete;
    ~FrameSegment();

    /// For SCM_RIGHTS. The segment's.
    int descriptor() const { return memory_.get(); }
    std::size_t bytes() const { return bytes_; }

    /// `page` is below kPages.
    std::span<const std::byte> page(std::uint32_t page) const;
    std::uint64_t tag(std::uint32_t page) const;
    PageExchange<>& exchange() { return *exchange_; }

    /// The whole of it, as a writer in this process sees it.
    xorvox_frames_segment* header() { return static_cast<xorvox_frames_segment*>(mapped_); }

private:
    FrameSegment(Descriptor memory, void* mapped, std::size_t bytes, const DisplayDescription& display);

    Descriptor memory_;
    void* mapped_;
    std::size_t bytes_;
    std::size_t frame_bytes_;
    PageExchange<>* exchange_;  ///< In the mapped memory.
};

}  // namespace xorvox::host
