#include "tools/watch.h"

#include <algorithm>
#include <string_view>

#include "sim/scan_out.h"
#include "tools/stop.h"

namespace xorvox::tools {

Watch::Watch(sim::Simulator& simulator, const std::optional<double>& exposure_s, io::AtomicFile* trace)
    : simulator_(simulator), exposure_s_(exposure_s), file_(trace), begin_ns_(simulator.cycle_begin_ns()) {
    simulator_.watch([this](const sim::Strobe& strobe) { on_strobe(strobe); });
    if (file_ == nullptr) return;
    sim::VcdOptions options;
    options.scope = simulator_.display().name.view();
    trace_.emplace(sim::pin_names(simulator_.display()), options,
                   [this](std::string_view bytes) { return file_->write(bytes); });
    simulator_.watch_pins(
        [this](std::uint64_t time_ns, LineMask levels, LineMask changed) { on_pins(time_ns, levels, changed); });
}

Watch::~Watch() {
    simulator_.watch({});
    simulator_.watch_pins({});
}

void Watch::look() {
    const std::uint64_t begin_ns = simulator_.cycle_begin_ns();
    if (begin_ns == begin_ns_) return;
    begin_ns_ = begin_ns;
    if (is_open_) {
        if (to_ns_ == kNever) to_ns_ = begin_ns;
    } else if (!simulator_.device().shown().page.empty() && ++begun_ == 2) {
        open_at(begin_ns);
    }
}

void Watch::open_at(std::uint64_t from_ns) {
    is_open_ = true;
    from_ns_ = from_ns;
    if (exposure_s_) to_ns_ = from_ns + static_cast<std::uint64_t>(*exposure_s_ * 1e9);
}

void Watch::expose() {
    if (!exposure_) {
        exposure_.emplace(
            simulator_.display(), simulator_.built(),
            [this](std::uint64_t time_ns) { return simulator_.cycles_at(time_ns); }, from_ns_, to_ns_,
            simulator_.faults());
    }
    if (exposure_->to_ns() != to_ns_) exposure_->close(to_ns_);
}

void Watch::on_strobe(const sim::Strobe& strobe) {
    look();
    if (!is_open_) return;
    expose();
    exposure_->add(strobe);
}

void Watch::on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed) {
    look();
    if (!is_open_) {
        levels_ = levels;
        return;
    }
    if (time_ns > to_ns_) return;
    if (!tracing_) trace_->on_pins(from_ns_, levels_, ~LineMask{0});
    tracing_ = true;
    trace_->on_pins(time_ns, levels, changed);
}

bool Watch::is_over(std::uint64_t now_ns) {
    look();
    // Strobes are told when they have ended: of LEDs that keep their light, with the next frame.
    return is_open_ && to_ns_ != kNever && now_ns >= to_ns_ + 2 * cycle_ns(simulator_.display());
}

void Watch::wait(std::uint64_t now_ns, const Meanwhile& meanwhile) {
    constexpr std::uint64_t kPatience = 8;  // Cycles.
    std::uint64_t latest_ns = now_ns + kPatience * cycle_ns(simulator_.display());
    while (!is_over(now_ns) && !asked_to_stop()) {
        if (to_ns_ == kNever && now_ns >= latest_ns) {
            if (is_open_) {
                to_ns_ = now_ns;
            } else {
                open_at(now_ns);
                latest_ns = now_ns + cycle_ns(simulator_.display());
            }
        }
        now_ns = std::max(simulator_.next_boundary_ns(), now_ns + 1);
        now_ns =
            std::min(now_ns, std::max(latest_ns, to_ns_ == kNever ? 0 : to_ns_ + 2 * cycle_ns(simulator_.display())));
        do {
            meanwhile(now_ns);
        } while (simulator_.poll(now_ns) == Status::Ok);
    }
}

Expected<void> Watch::finish(std::optional<double>& trace_ended_ms) {
    expose();
    if (!trace_) return {};
    if (const auto written = trace_->finish(to_ns_); !written) return written;
    if (const auto ended = trace_->ended_early_ns()) trace_ended_ms = static_cast<double>(*ended - from_ns_) * 1e-6;
    return file_->commit();
}

}  // namespace xorvox::tools
