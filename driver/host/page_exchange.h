// PageExchange: whole frames from one writer to several readers, by pages. Nobody waits for anybody: each operation is
// a bounded number of atomic steps, whatever the others do, and also when one of them has stopped for good.
//
//            begin()                  publish()            publish() of the next
//     free ───────────► being written ─────────► latest ──────────────────────────► replaced
//      ▲                                     take() any time                           │
//      └───────────────────────────────────────────────────────────────────────────────┘ no reader has it (any more)
//
// A reader takes the latest page only, and lets go of the one before first. So each reader has at most one page, which
// is the latest or a replaced one; and of readers + 2 pages one is always free for the writer.
//
// Only page numbers are here: where the pages lie, what is in them, and how the two sides reach these words (one
// address space, or memory that processes share) is the user's. Freestanding; 32-bit words, and of their operations
// only those that C11 and a Cortex-M3 have: any code may use it, an interrupt handler too.
//
// How it is known who has what. `latest` holds the number of the latest page, and how often it was taken since it is
// the latest: a reader learns the number and is counted in one step. publish() exchanges the whole word, so the
// writer gets the final count of the page that it replaces. `released` counts how often each page was let go. A
// replaced page is free when both counts agree. Counts wrap around; that there are never more readers than a count can
// tell apart is enough.
//
// The order of memory, as C++ and C11 have it:
//
//  1. publish() releases `latest`, take() acquires it: what the writer wrote into the page, and beside it, is there for
//     the reader. The takings of other readers between them are read-modify-writes, so the release reaches beyond them.
//  2. release() releases `released`, begin() acquires it: what a reader read, it read before the writer writes there
//     again. Again this holds for all readers of the page, as each of their steps is a read-modify-write.
//  3. take() also releases `latest`, and publish() also acquires it: the writer, when it counts a reader in at its new
//     page, sees that the reader has let go of the old one. Without this it could see one reader at two replaced pages,
//     and none would be free.
//
// (1) and (2) keep frames whole; (3) keeps the writer from finding no page.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace xorvox::host {

inline constexpr std::uint32_t kMaxExchangePages = 8;
/// In `latest`: the lower bits are the page, the others count.
inline constexpr std::uint32_t kPageBits = 4;
inline constexpr std::uint32_t kNoPage = (1u << kPageBits) - 1;

/// The words that both sides share. As constructed there is no latest page, and all are free. Begin anew only when
/// neither side is at work. `Word` is another type only for tests that take the operations apart.
template <typename Word = std::atomic<std::uint32_t>>
struct PageExchange {
    Word latest{kNoPage};
    std::array<Word, kMaxExchangePages> released{};
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "nobody must wait");

/// The writer's end; there is one. One thread at a time.
template <typename Word = std::atomic<std::uint32_t>>
class PageWriter {
public:
    /// Borrows `exchange`, as constructed. `pages` is readers + 2 or more, at most kMaxExchangePages.
    PageWriter(PageExchange<Word>& exchange, std::uint32_t pages) : exchange_(&exchange), pages_(pages) {}

    /// A page to write into: it stays free until it is published. kNoPage only when there are more readers than pages
    /// − 2, or readers that do not keep to the rules.
    std::uint32_t begin() const {
        for (std::uint32_t page = 0; page < pages_; ++page) {
            if (page == latest_) continue;
            const std::uint32_t released = exchange_->released[page].load(std::memory_order_acquire);  // 2
            if ((taken_[page] - released) << kPageBits == 0) return page;
        }
        return kNoPage;
    }

    /// `page`, of begin(), is whole and from now on the latest; the writer may not touch it any more.
    void publish(std::uint32_t page) {
        const std::uint32_t replaced = exchange_->latest.exchange(page, std::memory_order_acq_rel);  // 1, 3
        if (latest_ != kNoPage) taken_[latest_] += replaced >> kPageBits;
        latest_ = page;
    }

private:
    PageExchange<Word>* exchange_;
    std::uint32_t pages_;
    std::uint32_t latest_ = kNoPage;
    std::array<std::uint32_t, kMaxExchangePages> taken_{};  ///< While they were the latest; the upper bits are noise.
};

/// A reader's end. One thread at a time.
template <typename Word = std::atomic<std::uint32_t>>
class PageReader {
public:
    /// Borrows `exchange`; `pages` as the writer's. Whatever number the words hold, take() answers no page beyond them.
    PageReader(PageExchange<Word>& exchange, std::uint32_t pages) : exchange_(&exchange), pages_(pages) {}

    /// The latest page, which stays as it is until the next take() or release() of this reader. The same again while
    /// there is no later one; kNoPage while there is none at all.
    std::uint32_t take() {
        // A page that this reader has is not published again: the same number is the same frame. No order is needed,
        // since nothing is read for it that was not there already.
        const std::uint32_t latest = exchange_->latest.load(std::memory_order_relaxed) & kNoPage;
        if (latest == page_ || latest >= pages_) return page_;
        release();
        // It may be a later one by now.
        const std::uint32_t taken =
            exchange_->latest.fetch_add(1u << kPageBits, std::memory_order_acq_rel) & kNoPage;  // 1, 3
        if (taken < pages_) page_ = taken;
        return page_;
    }

    /// Lets go of the page, if there is one.
    void release() {
        if (page_ == kNoPage) return;
        exchange_->released[page_].fetch_add(1, std::memory_order_release);  // 2
        page_ = kNoPage;
    }

private:
    PageExchange<Word>* exchange_;
    std::uint32_t pages_;
    std::uint32_t page_ = kNoPage;
};

}  // namespace xorvox::host
