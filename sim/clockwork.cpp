#include "sim/clockwork.h"

#include <algorithm>
#include <utility>

namespace xorvox::sim {
namespace {

constexpr std::uint64_t kLongestStep_ns = 1'000'000;  ///< As ScanControl::poll() asks for.

}  // namespace

Clockwork::Clockwork(const DisplayDescription& display, device::Device& device, device::ScanControl& control,
                     const RotorConditions* rotor, TimingWatch* timing)
    : display_(display), device_(device), control_(control), timing_(timing) {
    if (rotor != nullptr) rotor_.emplace(display, *rotor);
}

double Clockwork::cycles_at(std::uint64_t time_ns) const {
    if (rotor_) return rotor_->cycles_at(time_ns);
    const std::uint64_t cycle = cycle_ns(display_);
    return static_cast<double>(time_ns / cycle) + static_cast<double>(time_ns % cycle) / static_cast<double>(cycle);
}

void Clockwork::set_scan(std::unique_ptr<ScanOut> scan) {
    scan_ = std::move(scan);
    if (scan_) scan_->run_until(now_ns_);
}

void Clockwork::run_until(std::uint64_t now_ns) {
    if (is_watched()) {
        for (;;) {
            std::uint64_t next_ns = std::min(order_end_ns_, now_ns_ + kLongestStep_ns);
            if (rotor_) next_ns = std::min(next_ns, rotor_->next_event().time_ns);
            if (next_ns >= now_ns) break;
            step(order_ == 0 ? now_ns_ : std::max(next_ns, now_ns_ + 1));
        }
    }
    step(std::max(now_ns, now_ns_));
    if (scan_) scan_->run_until(now_ns_);
}

void Clockwork::step(std::uint64_t now_ns) {
    now_ns_ = now_ns;
    if (rotor_) {
        for (; rotor_->next_event().time_ns <= now_ns; rotor_->take_event()) {
            const auto [time_ns, steps] = rotor_->next_event();
            steps == 0 ? control_.index_pulse(time_ns) : control_.encoder(time_ns, steps);
        }
    }
    follow();
}

void Clockwork::device_moved() {
    if (is_watched()) follow();
}

void Clockwork::follow() {
    const device::ScanOrder& order = control_.poll(now_ns_);
    order_end_ns_ = order.end_ns;
    const bool is_new = order.number != order_;
    order_ = order.number;
    const std::uint32_t cycle = device::cycle_of(control_.rotation().phase());
    if (scan_ && is_new) scan_->run_until(now_ns_);
    if (cycle != cycle_) cycle_begin_ns_ = now_ns_;
    cycle_ = cycle;
    if (scan_ && is_new) scan_->begin(order, device_.shown().frame, now_ns_);
    if (timing_ == nullptr) return;
    const device::Shown shown = device_.shown();
    timing_->look({.dark = order.dark,
                   .locked = control_.rotation().state() == device::RotationTracker::State::Locked,
                   .cycle = cycle,
                   .has_frame = !shown.page.empty(),
                   .frame = shown.frame,
                   .faults = device_.faults()},
                  now_ns_);
}

std::uint64_t Clockwork::next_ns() const {
    return rotor_ ? std::min(control_.next_boundary_ns(), now_ns_ + kLongestStep_ns) : control_.next_boundary_ns();
}

}  // namespace xorvox::sim
