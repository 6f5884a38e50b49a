#include "transport/virtual_lines.h"

#include <algorithm>
#include <deque>
#include <span>
#include <utility>
#include <vector>

namespace xorvox::transport {
namespace {

constexpr std::uint64_t kSecondNs = 1'000'000'000;
constexpr std::uint64_t kNever = VirtualLines::kNoLimit;

/// Sums that stay at the end of time.
constexpr std::uint64_t later(std::uint64_t time_ns, std::uint64_t by_ns) {
    return time_ns > kNever - by_ns ? kNever : time_ns + by_ns;
}

/// What the world sees: levels, and a strobe that runs. Its time never goes back.
class World {
public:
    World(VirtualLinesOptions::Observer observer, LineMask levels, LineMask all, std::uint64_t start_ns)
        : observer_(std::move(observer)), levels_(levels) {
        if (observer_) observer_(start_ns, levels_, all);
    }

    LineMask levels() const { return levels_; }
    LineMask strobe_mask() const { return strobe_; }
    std::uint64_t strobe_end_ns() const { return strobe_end_ns_; }

    /// A strobe that ends until `time_ns` ends.
    void run_until(std::uint64_t time_ns) {
        if (strobe_end_ns_ > time_ns) return;
        const std::uint64_t end_ns = std::exchange(strobe_end_ns_, kNever);
        change(end_ns, after_strobe());
        strobe_ = 0;
    }
    void set(std::uint64_t time_ns, LineMask mask, LineMask levels) {
        run_until(time_ns);
        LineMask next = levels_;
        if ((mask & strobe_) != 0) next = end_strobe();
        change(time_ns, (next & ~mask) | (levels & mask));
    }
    void strobe(std::uint64_t time_ns, LineMask mask, LineMask levels, std::uint64_t end_ns) {
        run_until(time_ns);
        const LineMask before = end_strobe();
        change(time_ns, (before & ~mask) | (levels & mask));
        strobe_ = mask;
        strobe_off_ = ~levels & mask;
        strobe_end_ns_ = end_ns;
    }

private:
    LineMask after_strobe() const { return (levels_ & ~strobe_) | strobe_off_; }
    /// The levels that it leaves behind.
    LineMask end_strobe() {
        const LineMask left = after_strobe();
        strobe_ = strobe_off_ = 0;
        strobe_end_ns_ = kNever;
        return left;
    }
    void change(std::uint64_t time_ns, LineMask levels) {
        const LineMask changed = levels_ ^ levels;
        if (changed == 0) return;
        levels_ = levels;
        if (observer_) observer_(time_ns, levels_, changed);
    }

    VirtualLinesOptions::Observer observer_;
    LineMask levels_ = 0;
    LineMask strobe_ = 0;      ///< Lines of the strobe that runs.
    LineMask strobe_off_ = 0;  ///< Their levels after it.
    std::uint64_t strobe_end_ns_ = kNever;
};

/// Something the program did later than the limit.
struct Operation {
    std::uint64_t time_ns = 0;
    LineMask mask = 0;
    LineMask levels = 0;
    bool strobe = false;
    std::uint64_t strobe_end_ns = 0;
};

}  // namespace

class VirtualLines::Impl {
public:
    explicit Impl(VirtualLinesOptions options)
        : outputs_(options.outputs),
          inputs_(options.inputs & ~options.outputs),
          set_hz_(options.set_hz),
          safe_levels_(options.safe_levels & options.outputs),
          edges_kept_(options.edges_kept),
          time_ns_(options.start_ns),
          world_(std::move(options.observer), safe_levels_, outputs_ | inputs_, options.start_ns) {}

    LinesInfo info() const { return {"virtual", outputs_, inputs_, set_hz_}; }

    Status set(LineMask mask, LineMask levels) {
        if (const Status status = admit(mask); status != Status::Ok) return status;
        if ((mask & strobe_mask_) != 0) strobe_end_ns_ = strobe_mask_ = 0;
        put(time_ns_, mask, levels);
        return Status::Ok;
    }

    Status write(LineMask mask, std::span<const LineMask> levels) {
        if (const Status status = admit(mask); status != Status::Ok) return status;
        if (!levels.empty() && (mask & strobe_mask_) != 0) strobe_end_ns_ = strobe_mask_ = 0;
        const std::uint64_t step_ns = set_hz_ == 0 ? 0 : kSecondNs / set_hz_;
        const std::uint64_t step_part = set_hz_ == 0 ? 0 : kSecondNs % set_hz_;
        std::uint64_t at_ns = time_ns_;
        std::uint64_t part = 0;  // Of 1 / set_hz nanoseconds.
        for (const LineMask level : levels) {
            put(at_ns, mask, level);
            at_ns += step_ns;
            part += step_part;
            if (part >= set_hz_ && part != 0) {
                part -= set_hz_;
                ++at_ns;
            }
        }
        move_to(at_ns + (part != 0 ? 1 : 0));
        return Status::Ok;
    }

    Status hold(std::uint64_t ns) {
        if (closed_) return Status::Closed;
        move_to(later(time_ns_, ns));
        return Status::Ok;
    }

    Status strobe(LineMask mask, LineMask levels, std::uint64_t ns) {
        if (const Status status = admit(mask); status != Status::Ok) return status;
        strobe_mask_ = mask;
        strobe_end_ns_ = later(time_ns_, ns);
        if (time_ns_ <= limit_ns_) {
            world_.strobe(time_ns_, mask, levels, strobe_end_ns_);
        } else {
            kept_back_.push_back({time_ns_, mask, levels, true, strobe_end_ns_});
        }
        return Status::Ok;
    }

    Status join() {
        if (closed_) return Status::Closed;
        move_to(std::max(time_ns_, strobe_end_ns_));
        return Status::Ok;
    }

    Status get(LineMask& levels) {
        if (closed_) return Status::Closed;
        world_.run_until(std::min(time_ns_, limit_ns_));
        levels = world_.levels();
        return Status::Ok;
    }

    Status edges(std::span<LineEdge> edges, std::size_t& count) {
        count = std::min(edges.size(), edges_.size());
        if (count == 0 && closed_) return Status::Closed;
        if (count == 0) return Status::Ok;
        const auto end = edges_.begin() + static_cast<std::ptrdiff_t>(count);
        std::copy(edges_.begin(), end, edges.begin());
        edges_.erase(edges_.begin(), end);
        return std::exchange(lost_edges_, false) ? Status::Corrupt : Status::Ok;
    }

    Status wait(std::int64_t timeout_ns) {
        if (!edges_.empty()) return Status::Ok;
        if (closed_) return Status::Closed;
        move_to(later(time_ns_, static_cast<std::uint64_t>(std::max<std::int64_t>(timeout_ns, 0))));
        return Status::Timeout;
    }

    void close() {
        if (closed_) return;
        put(time_ns_, outputs_, safe_levels_);
        closed_ = true;
    }

    void advance_to(std::uint64_t time_ns) { move_to(std::max(time_ns, time_ns_)); }
    std::uint64_t time_ns() const { return time_ns_; }
    LineMask levels() const { return world_.levels(); }
    std::uint64_t sets() const { return sets_; }

    void limit(std::uint64_t time_ns) {
        limit_ns_ = time_ns;
        while (!kept_back_.empty() && kept_back_.front().time_ns <= limit_ns_) {
            const Operation& next = kept_back_.front();
            if (next.strobe) {
                world_.strobe(next.time_ns, next.mask, next.levels, next.strobe_end_ns);
            } else {
                world_.set(next.time_ns, next.mask, next.levels);
            }
            kept_back_.pop_front();
        }
        world_.run_until(std::min(time_ns_, limit_ns_));
    }

    void cut() {
        kept_back_.clear();
        time_ns_ = std::min(time_ns_, limit_ns_);
        strobe_mask_ = world_.strobe_mask();
        strobe_end_ns_ = strobe_mask_ == 0 ? 0 : world_.strobe_end_ns();
    }

    void drive(std::uint32_t line, bool level) {
        if (line >= kMaxLines || (inputs_ >> line & 1u) == 0) return;
        const LineMask bit = LineMask{1} << line;
        const std::uint64_t now_ns = std::min(time_ns_, limit_ns_);
        if (((world_.levels() & bit) != 0) == level) return;
        world_.set(now_ns, bit, level ? bit : 0);
        if (edges_kept_ == 0) return;
        if (edges_.size() == edges_kept_) {
            edges_.pop_front();
            lost_edges_ = true;
        }
        edges_.push_back({now_ns, line, level});
    }

    void fail_sets(std::uint64_t after, std::uint64_t count) {
        fail_after_ = after;
        failures_ = count;
    }

private:
    /// Whether lines may be set at all.
    Status admit(LineMask mask) {
        if (closed_) return Status::Closed;
        if ((mask & ~outputs_) != 0) return Status::InvalidArgument;
        if (failures_ > 0) {
            if (fail_after_ == 0) {
                --failures_;
                return Status::Closed;
            }
            --fail_after_;
        }
        ++sets_;
        return Status::Ok;
    }

    void put(std::uint64_t time_ns, LineMask mask, LineMask levels) {
        if (time_ns <= limit_ns_) {
            world_.set(time_ns, mask, levels);
        } else {
            kept_back_.push_back({time_ns, mask, levels, false, 0});
        }
    }

    void move_to(std::uint64_t time_ns) {
        time_ns_ = time_ns;
        if (strobe_end_ns_ <= time_ns_) strobe_end_ns_ = strobe_mask_ = 0;
        world_.run_until(std::min(time_ns_, limit_ns_));
    }

    const LineMask outputs_;
    const LineMask inputs_;
    const std::uint32_t set_hz_;
    const LineMask safe_levels_;
    const std::size_t edges_kept_;

    // The program's: of the strobe that it knows to run.
    std::uint64_t time_ns_ = 0;
    std::uint64_t strobe_end_ns_ = 0;
    LineMask strobe_mask_ = 0;

    std::uint64_t limit_ns_ = kNoLimit;
    std::deque<Operation> kept_back_;
    World world_;

    std::deque<LineEdge> edges_;
    bool lost_edges_ = false;

    bool closed_ = false;
    std::uint64_t sets_ = 0;
    std::uint64_t fail_after_ = 0;
    std::uint64_t failures_ = 0;
};

VirtualLines::VirtualLines(VirtualLinesOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}

VirtualLines::~VirtualLines() {
    impl_->limit(kNoLimit);
    impl_->close();
}

Lines VirtualLines::lines() {
    static constexpr LinesOperations kOperations{
        .info = [](const void* self) { return static_cast<const Impl*>(self)->info(); },
        .set = [](void* self, LineMask mask, LineMask levels) { return static_cast<Impl*>(self)->set(mask, levels); },
        .write = [](void* self, LineMask mask,
                    std::span<const LineMask> levels) { return static_cast<Impl*>(self)->write(mask, levels); },
        .hold = [](void* self, std::uint64_t ns) { return static_cast<Impl*>(self)->hold(ns); },
        .strobe = [](void* self, LineMask mask, LineMask levels,
                     std::uint64_t ns) { return static_cast<Impl*>(self)->strobe(mask, levels, ns); },
        .join = [](void* self) { return static_cast<Impl*>(self)->join(); },
        .get = [](void* self, LineMask& levels) { return static_cast<Impl*>(self)->get(levels); },
        .edges = [](void* self, std::span<LineEdge> edges,
                    std::size_t& count) { return static_cast<Impl*>(self)->edges(edges, count); },
        .wait = [](void* self, std::int64_t timeout_ns) { return static_cast<Impl*>(self)->wait(timeout_ns); },
        .close = [](void* self) { static_cast<Impl*>(self)->close(); },
    };
    return {&kOperations, impl_.get()};
}

std::uint64_t VirtualLines::time_ns() const {
    return impl_->time_ns();
}

void VirtualLines::advance_to(std::uint64_t time_ns) {
    impl_->advance_to(time_ns);
}

LineMask VirtualLines::levels() const {
    return impl_->levels();
}

void VirtualLines::limit(std::uint64_t time_ns) {
    impl_->limit(time_ns);
}

void VirtualLines::cut() {
    impl_->cut();
}

void VirtualLines::drive(std::uint32_t line, bool level) {
    impl_->drive(line, level);
}

void VirtualLines::fail_sets(std::uint64_t after, std::uint64_t count) {
    impl_->fail_sets(after, count);
}

std::uint64_t VirtualLines::sets() const {
    return impl_->sets();
}

}  // namespace xorvox::transport
