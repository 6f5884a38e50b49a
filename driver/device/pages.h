// Pages: which of the caller's pages holds what. A page has one to three uses at a time, or none:
//
//               accept()                     present()                     present() of a later one
//     free ───────────────► pending, base ───────────────► shown, base ───────────────► free, once it is not the base
//      ▲                        │ a later one is presented first                        either
//      └────────────────────────┴────────────────────────────────────────────────────────┘
//
// The delta base is the page accepted last. The page being received is none of these: it is still free, and given up by
// beginning anew.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace xorvox::device {

inline constexpr std::uint32_t kMaxPages = 8;

class Pages {
public:
    static constexpr std::uint32_t kNone = kMaxPages;

    struct Page {
        std::uint32_t frame = 0;
        std::uint32_t crc = 0;
        std::uint64_t due_ns = 0;
        std::uint32_t order = 0;  ///< Counts accepted frames.
        bool pending = false;
        bool of_session = false;  ///< Accepted in the session that is running.
    };

    /// Borrows `memory` of at least count × frame_bytes; count is 2 … kMaxPages. All pages are free.
    void init(std::span<std::byte> memory, std::size_t frame_bytes, std::uint32_t count);

    std::size_t frame_bytes() const { return frame_bytes_; }
    std::uint8_t count() const { return static_cast<std::uint8_t>(count_); }
    std::uint8_t free_count() const;
    /// A free page to receive into, or kNone.
    std::uint32_t find_free() const;
    std::span<std::byte> bytes(std::uint32_t page) const { return memory_.subspan(page * frame_bytes_, frame_bytes_); }
    const Page& page(std::uint32_t page) const { return pages_[page]; }
    std::uint32_t base() const { return base_; }    ///< Page or kNone.
    std::uint32_t shown() const { return shown_; }  ///< Page or kNone.

    /// A free page is whole: it becomes the base, and pending until `due_ns`.
    void accept(std::uint32_t page, std::uint32_t frame, std::uint32_t crc, std::uint64_t due_ns);

    /// Shows, of the pending pages that are due, the one due last (of equals the one accepted last) and frees the
    /// others. False when none is due.
    bool present(std::uint64_t now_ns);

    /// There is no base any more, and of the pending pages only the one accepted last stays, due at once: what was
    /// accepted is shown, and nothing that the next host cannot know of holds a page.
    void end_session();

private:
    bool is_free(std::uint32_t page) const { return page != base_ && page != shown_ && !pages_[page].pending; }
    bool later(std::uint32_t page, std::uint32_t than) const;

    std::span<std::byte> memory_;
    std::size_t frame_bytes_ = 0;
    std::uint32_t count_ = 0;
    std::uint32_t base_ = kNone;
    std::uint32_t shown_ = kNone;
    std::uint32_t accepted_ = 0;
    std::array<Page, kMaxPages> pages_{};
};

}  // namespace xorvox::device
