#include "driver/host/frame_segment.h"

#include <cerrno>
#include <cstring>
#include <new>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>

namespace xorvox::host {
namespace {

constexpr std::size_t kAlign = 4096;

constexpr std::size_t round_up(std::size_t bytes) {
    return (bytes + kAlign - 1) / kAlign * kAlign;
}

// The words of the C header are a PageExchange.
static_assert(std::is_standard_layout_v<PageExchange<>>);
static_assert(sizeof(PageExchange<>) == sizeof(std::uint32_t) * (1 + kMaxExchangePages));
static_assert(offsetof(PageExchange<>, released) ==
              offsetof(xorvox_frames_segment, released) - offsetof(xorvox_frames_segment, latest));
static_assert(kMaxExchangePages == XORVOX_FRAMES_MAX_PAGES && kPageBits == XORVOX_FRAMES_PAGE_BITS &&
              kNoPage == XORVOX_FRAMES_NO_PAGE);
static_assert(kMaxPanels == XORVOX_FRAMES_MAX_PANELS);
static_assert(sizeof(DisplayName::text) == sizeof(xorvox_frames_segment::display_name));

void describe(const DisplayDescription& display, std::size_t segment_bytes, xorvox_frames_segment& header) {
    std::memcpy(header.magic, XORVOX_FRAMES_MAGIC, sizeof header.magic);
    header.version = XORVOX_FRAMES_VERSION;
    header.header_bytes = kAlign;
    header.segment_bytes = segment_bytes;
    header.frame_bytes = frame_bytes(display);
    header.page_stride_bytes = round_up(frame_bytes(display));
    header.geometry_digest = geometry_digest(display);
    header.pages = FrameSegment::kPages;
    header.pixel_format = static_cast<std::uint32_t>(display.format);
    header.bits_per_pixel = bits_per_pixel(display.format);
    header.display_kind = static_cast<std::uint32_t>(display.kind);
    header.slices = display.slices;
    header.panel_count = display.panel_count;
    header.slice_bytes = slice_bytes(display);
    header.cycle_ns = cycle_ns(display);
    std::memcpy(header.display_name, display.name.text.data(), sizeof header.display_name);
    std::size_t offset = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const std::size_t row = row_bytes(panel, display.format);
        header.panel[p] = {.columns = panel.columns,
                           .rows = panel.rows,
                           .row_bytes = static_cast<std::uint32_t>(row),
                           .offset_bytes = static_cast<std::uint32_t>(offset)};
        offset += row * panel.rows;
    }
}

}  // namespace

Expected<FrameSegment> FrameSegment::make(const DisplayDescription& display) {
    const std::size_t bytes = kAlign + kPages * round_up(frame_bytes(display));
    const auto failed = [](const char* what) {
        return fail(std::string("memory to share frames: ") + what + ": " + std::generic_category().message(errno) +
                    "; end other programs");
    };
    Descriptor memory(::memfd_create("xorvox-frames", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (memory.get() < 0) return failed("memfd_create");
    if (::ftruncate(memory.get(), static_cast<off_t>(bytes)) != 0) return failed("ftruncate");
    if (::fcntl(memory.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
        return failed("F_ADD_SEALS");
    void* const mapped = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory.get(), 0);
    if (mapped == MAP_FAILED) return failed("mmap");
    describe(display, bytes, *static_cast<xorvox_frames_segment*>(mapped));
    return FrameSegment(std::move(memory), mapped, bytes, display);
}

FrameSegment::FrameSegment(Descriptor memory, void* mapped, std::size_t bytes, const DisplayDescription& display)
    : memory_(std::move(memory)),
      mapped_(mapped),
      bytes_(bytes),
      frame_bytes_(frame_bytes(display)),
      exchange_(::new (static_cast<std::byte*>(mapped) + offsetof(xorvox_frames_segment, latest)) PageExchange<>) {}

FrameSegment::FrameSegment(FrameSegment&& other) noexcept
    : memory_(std::move(other.memory_)),
      mapped_(std::exchange(other.mapped_, nullptr)),
      bytes_(other.bytes_),
      frame_bytes_(other.frame_bytes_),
      exchange_(other.exchange_) {}

FrameSegment::~FrameSegment() {
    if (mapped_ != nullptr) ::munmap(mapped_, bytes_);
}

std::span<const std::byte> FrameSegment::page(std::uint32_t page) const {
    return {static_cast<const std::byte*>(mapped_) + kAlign + page * round_up(frame_bytes_), frame_bytes_};
}

std::uint64_t FrameSegment::tag(std::uint32_t page) const {
    return static_cast<const xorvox_frames_segment*>(mapped_)->tag[page];
}

}  // namespace xorvox::host
