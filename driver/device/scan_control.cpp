#include "driver/device/scan_control.h"

#include <algorithm>
#include <limits>

namespace xorvox::device {

namespace {

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kDarkPollNs = 1'000'000;
constexpr std::uint64_t kMostAheadNs = 1'000'000'000;

bool can_be(const ScanControlConfig& config) {
    const SliceSchedule& schedule = config.schedule;
    if (schedule.slices < 1 || schedule.slices > kMaxSlices || schedule.stroke_count < 1 || schedule.stroke_count > 2) {
        return false;
    }
    std::uint64_t from = 0;
    for (std::uint32_t i = 0; i < schedule.stroke_count; ++i) {
        const SliceSchedule::Stroke& stroke = schedule.strokes[i];
        if (stroke.begin < from || stroke.begin >= kCycle || stroke.length < schedule.slices ||
            stroke.length > kCycle - stroke.begin) {
            return false;
        }
        from = stroke.begin + stroke.length;
    }
    const CurrentConfig& current = config.current;
    return current.bit_planes >= 1 && current.bit_planes <= 8 && current.row_groups >= 1 &&
           current.led_ua <= 1u << 24 && current.limit_ua <= std::uint64_t{1} << 48 &&
           current.panel_count <= kMaxPanels && config.slice_bytes >= 1;
}

}  // namespace

Status ScanControl::init(const ScanControlConfig& config, Device& device, std::uint64_t now_ns) {
    if (!can_be(config)) return Status::InvalidArgument;
    if (const Status status = rotation_.init(config.rotation, now_ns); status != Status::Ok) return status;
    config_ = config;
    device_ = &device;
    events_.clear();
    guard_.init(config.late_ns, config.has_interlock);
    now_ns_ = now_ns;
    turning_ = rotation_.state() == RotationTracker::State::Locked;
    cycle_ = 0;
    order_ = {};
    order_begin_ = 0;
    return Status::Ok;
}

void ScanControl::index_pulse(std::uint64_t now_ns) {
    (void)events_.push({now_ns, 0});
}

void ScanControl::encoder(std::uint64_t now_ns, std::int32_t steps) {
    if (steps != 0) (void)events_.push({now_ns, steps});
}

void ScanControl::interlock(bool closed) {
    guard_.interlock(closed);
}

void ScanControl::scan_done(const ScanOrder& order, std::uint64_t now_ns) {
    guard_.scan_done(order, now_ns);
}

const ScanOrder& ScanControl::poll(std::uint64_t now_ns) {
    const std::uint64_t before_ns = now_ns_;
    now_ns_ = std::max(now_ns_, now_ns);
    hear_events();
    rotation_.advance(now_ns_);
    raise(rotation_.take_faults() | guard_.faults(now_ns_));
    announce_cycles(before_ns);

    Phase begin = 0;
    ScanOrder next = find_order(begin);
    const bool same = next.dark == order_.dark && next.slice == order_.slice &&
                      next.bytes.data() == order_.bytes.data() && begin == order_begin_;
    next.number = same && order_.number != 0 ? order_.number : order_.number + 1;
    if (next.lit()) {
        // While a slice is lit its brightness stays.
        next.brightness = next.number == order_.number
                              ? order_.brightness
                              : std::min(next.brightness, safe_brightness(config_.current, next.bytes));
    }
    const bool is_new = next.number != order_.number;
    order_ = next;
    order_begin_ = begin;
    if (is_new) guard_.ordered(order_);
    return order_;
}

void ScanControl::hear_events() {
    for (const RotationEvent* event = events_.front(); event != nullptr; event = events_.front()) {
        // An interrupt may have come since the caller read the clock.
        if (event->time_ns > now_ns_ && event->time_ns - now_ns_ <= kMostAheadNs) return;
        if (event->time_ns <= now_ns_) {
            if (event->steps == 0) {
                rotation_.pulse(event->time_ns);
            } else {
                rotation_.encoder(event->time_ns, event->steps);
            }
        }
        events_.pop();
    }
}

void ScanControl::raise(std::uint32_t faults) {
    for (std::uint8_t number = 1; number <= wire::kHighestFault; ++number) {
        const auto fault = static_cast<wire::Fault>(number);
        if ((faults & wire::fault_bit(fault)) != 0) device_->raise_fault(fault);
    }
}

void ScanControl::announce_cycles(std::uint64_t before_ns) {
    const bool turned = turning_;
    turning_ = rotation_.state() == RotationTracker::State::Locked;
    if (!turning_) return;
    const std::uint32_t cycle = cycle_of(rotation_.phase());
    if (turned) {
        for (std::uint32_t left = std::min(cycle - cycle_, kMaxPages); left > 0; --left) {
            const std::uint64_t begun_ns = rotation_.time_of(Phase{cycle - left + 1} << 32);
            device_->boundary(std::clamp(begun_ns, before_ns, now_ns_));
        }
    }
    cycle_ = cycle;
}

ScanOrder ScanControl::find_order(Phase& begin) {
    if (device_->faults() != 0) return dark(Dark::Fault, now_ns_ + kDarkPollNs);
    if (!turning_) return dark(Dark::NotLocked, now_ns_ + kDarkPollNs);
    const Shown shown = device_->shown();
    if (shown.page.empty()) return dark(Dark::NoPicture, std::min(now_ns_ + kDarkPollNs, next_boundary_ns()));
    const SliceSchedule::Place place = config_.schedule.at(rotation_.phase());
    const std::uint64_t end_ns = std::max(rotation_.time_of(place.end), now_ns_ + 1);
    if (!place.lit) return dark(Dark::DeadZone, end_ns);
    const std::size_t first = std::size_t{place.slice} * config_.slice_bytes;
    if (first + config_.slice_bytes > shown.page.size()) return dark(Dark::NoPicture, end_ns);
    begin = place.begin;
    return {.dark = Dark::No,
            .slice = place.slice,
            .mirrored = place.mirrored,
            .brightness = shown.brightness,
            .bytes = shown.page.subspan(first, config_.slice_bytes),
            .begin_ns = std::min(rotation_.time_of(place.begin), now_ns_),
            .end_ns = end_ns};
}

ScanOrder ScanControl::dark(Dark why, std::uint64_t end_ns) const {
    return {.dark = why, .begin_ns = order_.dark == why ? order_.begin_ns : now_ns_, .end_ns = end_ns};
}

std::uint64_t ScanControl::next_boundary_ns() const {
    if (!turning_) return kNever;
    return std::max(rotation_.time_of(Phase{cycle_ + 1} << 32), now_ns_ + 1);
}

}  // namespace xorvox::device
