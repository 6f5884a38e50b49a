// Framebuffer: whole frames from the thread that draws to those that show, send or look at them. The writer never waits
// for a reader, a reader never for the writer, and no reader sees half a frame or a mixture of two; who is slow misses
// frames. For a queue that loses none, see driver/host/stream.h.
//
//     Framebuffer frames(frame_bytes(display));
//
//     // the one that draws                        // the one that shows
//     painter.paint(…, frames.begin_frame());      const Frame frame = frames.latest();
//     frames.end_frame(time_ns);                   if (!frame.bytes.empty()) session.submit(frame.bytes, frame.tag);
//
// It is memory and page numbers (driver/host/page_exchange.h): no thread, no clock, no lock, and nothing is allocated
// after construction.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/host/page_exchange.h"
#include "voxelizer/status.h"

namespace xorvox::host {

/// A frame as a reader has it. `bytes` is the Framebuffer's memory, of frame_bytes(); empty: there is no frame yet.
struct Frame {
    std::span<const std::byte> bytes;
    /// The how-manieth that was published, from 1, modulo 2³²; 0 when there is none.
    std::uint32_t sequence = 0;
    std::uint64_t tag = 0;  ///< What the writer gave to end_frame().
};

/// Threads: begin_frame() and end_frame() are the writer's, one thread at a time; latest(r) and release(r) are reader
/// r's, one thread at a time; everything else anybody's. None of them waits, allocates or makes a system call.
class Framebuffer {
public:
    static constexpr std::uint32_t kMaxReaders = kMaxExchangePages - 2;

    /// Takes readers + 2 pages of `frame_bytes`, all bytes 0. `readers` is 1 … kMaxReaders; a number beyond them counts
    /// as the nearest. Throws as std::vector does when there is not so much memory.
    explicit Framebuffer(std::size_t frame_bytes, std::uint32_t readers = 1);
    Framebuffer(const Framebuffer&) = delete;
    Framebuffer& operator=(const Framebuffer&) = delete;

    std::size_t frame_bytes() const { return frame_bytes_; }
    std::uint32_t readers() const { return pages_ - 2; }
    std::uint32_t pages() const { return pages_; }

    /// A page of frame_bytes() to draw into, at a multiple of 64 bytes; the writer's until end_frame(). It holds an
    /// older frame or zeros: write all of it. Called again before end_frame() it is the same page, as it was left: a
    /// frame is given up by beginning anew. Empty only when readers' threads break the rule above.
    std::span<std::byte> begin_frame();

    /// The page of begin_frame() is the latest frame from now on. `tag` goes with it: whatever the reader is to know,
    /// such as when it is to be shown, in ns. Ok; InvalidArgument when no frame was begun.
    Status end_frame(std::uint64_t tag = 0);

    /// The latest frame; it is reader `reader`'s and does not change until its next latest() or release(). While there
    /// is no later one, the same again. No frame, as when none was published yet, for a reader that is not there.
    Frame latest(std::uint32_t reader = 0);

    /// Reader `reader` is done with its frame, whose bytes may change from now on. Never needed: a page is there for it
    /// in any case.
    void release(std::uint32_t reader = 0);

    /// Whether a frame later than number `sequence` is there: latest() called then gives a later one. 0 asks whether
    /// there is any. Right as long as fewer than 2³¹ frames came since.
    bool changed_since(std::uint32_t sequence) const;

private:
    static constexpr std::size_t kLine = 64;  ///< Bytes that processors pass to each other in one piece.

    struct alignas(kLine) Line {
        std::array<std::byte, kLine> bytes{};
    };
    struct alignas(kLine) Reader {
        PageReader<> side;
    };
    /// What lies beside a page, written and read under the same order.
    struct PageNote {
        std::uint64_t tag = 0;
        std::uint32_t sequence = 0;
    };

    std::byte* page_bytes(std::uint32_t page) { return memory_.data()->bytes.data() + page * page_lines_ * kLine; }

    std::uint32_t pages_;
    std::size_t frame_bytes_;
    std::size_t page_lines_;
    std::vector<Line> memory_;
    std::array<PageNote, kMaxExchangePages> notes_{};
    std::vector<Reader> readers_;

    alignas(kLine) PageExchange<> exchange_;
    std::atomic<std::uint32_t> published_{0};

    alignas(kLine) PageWriter<> writer_;
    std::uint32_t drawing_ = kNoPage;
};

}  // namespace xorvox::host
