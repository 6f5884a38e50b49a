#include "driver/host/control_queue.h"

#include <algorithm>

namespace xorvox::host {

using namespace wire;

namespace {

bool shows(const DeviceStatus& status, const Control& control) {
    switch (control.operation) {
        case ControlOperation::Brightness: return status.brightness == control.value;
        // A fault keeps the display dark, whatever it was told.
        case ControlOperation::Blank: return status.faults == 0 && status.blank == control.value;
        case ControlOperation::SilencePolicy: return static_cast<std::uint32_t>(status.silence_action) == control.value;
        case ControlOperation::Watchdog: return status.watchdog_ms == control.value;
        case ControlOperation::ClearFault: return (status.faults & fault_bit(static_cast<Fault>(control.value))) == 0;
        case ControlOperation::Status: return true;
    }
    return true;
}

auto is(ControlOperation operation) {
    return [operation](const auto& entry) { return entry.control.operation == operation; };
}

}  // namespace

bool is_valid(const Control& control) {
    switch (control.operation) {
        case ControlOperation::Brightness: return control.value <= 255;
        case ControlOperation::Blank:
        case ControlOperation::SilencePolicy: return control.value <= 1;
        case ControlOperation::Watchdog: return true;
        case ControlOperation::ClearFault: return control.value >= 1 && control.value <= kHighestFault;
        case ControlOperation::Status: return control.value == 0;
    }
    return false;
}

void ControlQueue::heed(std::uint32_t faults) {
    if ((faults & fault_bit(Fault::SilentHost)) == 0) return;
    constexpr auto kSilentHost = static_cast<std::uint32_t>(Fault::SilentHost);
    const auto clears = [](const Waiting& entry) {
        return entry.control.operation == ControlOperation::ClearFault && entry.control.value == kSilentHost;
    };
    if (std::any_of(waiting_.begin(), waiting_.end(), clears)) return;
    push({.operation = ControlOperation::ClearFault, .value = kSilentHost});
}

const Control& ControlQueue::send(std::uint64_t now_ns) {
    in_flight_ = true;
    ++waiting_.front().attempts;
    sent_ns_ = now_ns;
    return waiting_.front().control;
}

Control ControlQueue::take() {
    const Control control = waiting_.front().control;
    pop();
    return control;
}

void ControlQueue::confirmed_by(const DeviceStatus& status) {
    if (!in_flight_) return;
    if (shows(status, waiting_.front().control)) {
        pop();
    } else if (waiting_.front().control.operation == ControlOperation::Blank && status.faults != 0) {
        let_clear_fault_pass();
    }
}

/// Only when the fault is cleared can the Blank in flight be confirmed: it is sent once more after that, unless another
/// Blank replaces it before.
void ControlQueue::let_clear_fault_pass() {
    const auto clear = std::find_if(waiting_.begin(), waiting_.end(), is(ControlOperation::ClearFault));
    if (clear == waiting_.end()) return;
    in_flight_ = false;
    if (std::any_of(waiting_.begin() + 1, clear, is(ControlOperation::Blank))) {
        pop();
    } else {
        std::rotate(waiting_.begin(), waiting_.begin() + 1, clear + 1);
    }
}

bool ControlQueue::refused() {
    if (late_refusals_ > 0) {
        --late_refusals_;
        return false;
    }
    if (!in_flight_) return false;
    late_refusals_ = waiting_.front().attempts - 1;
    pop();
    return true;
}

bool ControlQueue::watch(std::uint64_t now_ns, std::uint64_t timeout_ns, std::uint32_t attempts) {
    if (!in_flight_ || now_ns - sent_ns_ < timeout_ns) return false;
    in_flight_ = false;
    if (waiting_.front().attempts < attempts) return false;
    late_refusals_ += waiting_.front().attempts;
    pop();
    return true;
}

void ControlQueue::begin_again() {
    in_flight_ = false;
    late_refusals_ = 0;
}

void ControlQueue::pop() {
    waiting_.pop_front();
    in_flight_ = false;
}

}  // namespace xorvox::host
