#include "sim/level_scan.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "driver/display/timing.h"
#include "sim/light_times.h"

namespace xorvox::sim {
namespace {

/// What an order says, kept.
struct Kept {
    std::vector<std::byte> bytes;  ///< Empty: dark.
    std::uint32_t slice = 0;
    std::uint32_t frame = 0;
    std::uint8_t brightness = 0;
    bool mirrored = false;

    void keep(const device::ScanOrder& order, std::uint32_t of_frame) {
        bytes.assign(order.bytes.begin(), order.bytes.end());
        if (!order.lit() || order.brightness == 0) bytes.clear();
        slice = order.slice;
        frame = of_frame;
        brightness = order.brightness;
        mirrored = order.mirrored;
    }
    bool lit() const { return !bytes.empty(); }
};

class StrobesOfLevels {
public:
    StrobesOfLevels(const DisplayDescription& display, StrobeSink sink)
        : slice_bytes_(slice_bytes(display)), sink_(std::move(sink)) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            panels_.push_back({row_bytes(display.panels[p], display.format), display.panels[p].rows});
        }
    }

    /// Slice `nth` of the bytes of `kept`, lit as slice `slice`.
    void give(const Kept& kept, std::size_t nth, std::uint32_t slice, std::uint32_t row_group, std::uint64_t on_ns,
              std::uint64_t off_ns) const {
        if (on_ns >= off_ns) return;
        assert(kept.bytes.size() >= (nth + 1) * slice_bytes_);
        Strobe strobe{.on_ns = on_ns,
                      .off_ns = off_ns,
                      .row_group = row_group,
                      .plane = Strobe::kLevels,
                      .slice = slice,
                      .frame = kept.frame,
                      .brightness = kept.brightness};
        strobe.mirrored = kept.mirrored;
        const std::byte* at = kept.bytes.data() + nth * slice_bytes_;
        for (std::size_t p = 0; p < panels_.size(); ++p) {
            strobe.panels[p].first = at;
            strobe.panels[p].row_bytes = panels_[p].row_bytes;
            at += panels_[p].row_bytes * panels_[p].rows;
        }
        sink_(strobe);
    }

private:
    struct Rows {
        std::size_t row_bytes;
        std::size_t rows;
    };

    std::size_t slice_bytes_;
    StrobeSink sink_;
    std::vector<Rows> panels_;
};

/// Row groups share the time of the slice.
class GroupScan final : public ScanOut {
public:
    GroupScan(const DisplayDescription& display, StrobeSink sink)
        : strobes_(display, std::move(sink)), groups_(display.scan.row_groups), latch_ns_(display.scan.latch_ns) {}

    void run_until(std::uint64_t now_ns) override {
        for (; order_.lit() && group_ < groups_; ++group_) {
            if (share_ns(group_ + 1) > now_ns) return;
            give(share_ns(group_ + 1));
        }
    }

    void begin(const device::ScanOrder& order, std::uint32_t frame, std::uint64_t now_ns) override {
        run_until(now_ns);
        if (order_.lit() && group_ < groups_) give(now_ns);
        order_.keep(order, frame);
        group_ = 0;
        begin_ns_ = now_ns;
        length_ns_ = order.end_ns > now_ns ? order.end_ns - now_ns : 0;
    }

private:
    std::uint64_t share_ns(std::uint32_t group) const {
        return begin_ns_ + length_ns_ / groups_ * group + length_ns_ % groups_ * group / groups_;
    }
    void give(std::uint64_t off_ns) const {
        const std::uint32_t rows = groups_ == 1 ? Strobe::kAllRows : group_;
        strobes_.give(order_, 0, order_.slice, rows, share_ns(group_) + latch_ns_, off_ns);
    }

    StrobesOfLevels strobes_;
    std::uint32_t groups_;
    std::uint64_t latch_ns_;
    Kept order_;
    std::uint32_t group_ = 0;  ///< That is or will be lit.
    std::uint64_t begin_ns_ = 0;
    std::uint64_t length_ns_ = 0;
};

/// LEDs that keep their colours while the next ones are sent.
class StringScan final : public ScanOut {
public:
    StringScan(const DisplayDescription& display, StrobeSink sink)
        : strobes_(display, std::move(sink)),
          slices_(keeps_light(display) ? display.slices : 1),
          send_ns_(static_cast<std::uint64_t>(scan_time_ns(display, shown_bit_planes(display)) + 0.5)) {}

    void run_until(std::uint64_t now_ns) override {
        if (!sending_ || latch_ns_ > now_ns) return;
        for (std::uint32_t nth = 0; shown_.lit() && nth < slices_; ++nth) {
            strobes_.give(shown_, nth, slices_ > 1 ? nth : shown_.slice, Strobe::kAllRows, shown_ns_, latch_ns_);
        }
        std::swap(shown_, sent_);
        shown_ns_ = latch_ns_;
        sending_ = false;
    }

    void begin(const device::ScanOrder& order, std::uint32_t frame, std::uint64_t now_ns) override {
        run_until(now_ns);
        const bool was_going_dark = sending_ && !sent_.lit();
        sent_.keep(order, frame);
        if (was_going_dark && !sent_.lit()) return;
        sending_ = true;
        latch_ns_ = now_ns + send_ns_;
    }

private:
    StrobesOfLevels strobes_;
    std::uint32_t slices_;  ///< Of an order's bytes.
    std::uint64_t send_ns_;
    Kept shown_;
    std::uint64_t shown_ns_ = 0;  ///< Since when.
    Kept sent_;
    bool sending_ = false;
    std::uint64_t latch_ns_ = 0;  ///< When what is sent will be shown.
};

/// A projector that shows planes_per_frame slices by its own clock.
class SubFrameScan final : public ScanOut {
public:
    SubFrameScan(const DisplayDescription& display, StrobeSink sink)
        : strobes_(display, std::move(sink)),
          most_(display.scan.planes_per_frame),
          slice_ns_(slice_time_ns(display)),
          latch_ns_(display.scan.latch_ns) {}

    void run_until(std::uint64_t now_ns) override {
        while (!waiting_.empty() && begin_ns(next_ + 1) <= now_ns) give(begin_ns(next_ + 1));
    }

    void begin(const device::ScanOrder& order, std::uint32_t frame, std::uint64_t now_ns) override {
        run_until(now_ns);
        if (!order.lit()) {
            end(now_ns);
            known_ = 0;
            return;
        }
        if (!follows(order.slice)) {
            end(now_ns);
            trigger_ns_ = now_ns;
            known_ = 0;
            next_ = 0;
        }
        if (known_ == 1) direction_ = std::int64_t{order.slice} - last_slice_;
        last_slice_ = order.slice;
        ++known_;
        waiting_.emplace_back().keep(order, frame);
    }

private:
    std::uint64_t begin_ns(std::uint32_t nth) const {
        return trigger_ns_ + static_cast<std::uint64_t>(nth * slice_ns_ + 0.5);
    }
    bool follows(std::uint32_t slice) const {
        if (known_ == 0 || known_ == most_) return false;
        const std::int64_t step = std::int64_t{slice} - last_slice_;
        return known_ == 1 ? step == 1 || step == -1 : step == direction_;
    }
    void give(std::uint64_t off_ns) {
        const Kept& kept = waiting_.front();
        if (kept.lit()) strobes_.give(kept, 0, kept.slice, Strobe::kAllRows, begin_ns(next_) + latch_ns_, off_ns);
        waiting_.pop_front();
        ++next_;
    }
    void end(std::uint64_t now_ns) {
        if (!waiting_.empty()) give(now_ns);
        waiting_.clear();
    }

    StrobesOfLevels strobes_;
    std::uint32_t most_;
    double slice_ns_;
    std::uint64_t latch_ns_;
    std::uint64_t trigger_ns_ = 0;
    std::uint32_t known_ = 0;  ///< Slices of this frame that were ordered.
    std::uint32_t last_slice_ = 0;
    std::int64_t direction_ = 1;
    std::deque<Kept> waiting_;  ///< Those that were not shown to their end,
    std::uint32_t next_ = 0;    ///< of which the first is this one of the frame.
};

}  // namespace

std::unique_ptr<ScanOut> make_level_scan(const DisplayDescription& display, StrobeSink sink) {
    if (has_strings(display)) return std::make_unique<StringScan>(display, std::move(sink));
    if (display.scan.planes_per_frame > 1) return std::make_unique<SubFrameScan>(display, std::move(sink));
    return std::make_unique<GroupScan>(display, std::move(sink));
}

}  // namespace xorvox::sim
