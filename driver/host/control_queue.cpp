#include "driver/host/control_queue.h"

#include <algorithm>

namespace xorvox::host {

using namespace wire;

namespace {

bool shows(const DeviceStatus& status, const Control& control) {
    switch (control.operation) {
        case ControlOperation::Brightness: return status.brightness == control.value;
        // A fault may keep the display dark that was told to show again.
        case ControlOperation::Blank: return control.value == 0 || status.blank != 0;
        case ControlOperation::SilencePolicy: return static_cast<std::uint32_t>(status.silence_action) == control.value;
        case ControlOperation::Watchdog: return status.watchdog_ms == control.value;
        case ControlOperation::ClearFault: return status.fault == Fault::None;
        case ControlOperation::Status: return true;
    }
    return true;
}

}  // namespace

void ControlQueue::push(const Control& control) {
    waiting_.push_back(control);
}

void ControlQueue::push_clear_fault() {
    const auto clears = [](const Control& control) { return control.operation == ControlOperation::ClearFault; };
    if (std::none_of(waiting_.begin(), waiting_.end(), clears)) push({.operation = ControlOperation::ClearFault});
}

const Control& ControlQueue::send(std::uint64_t now_ns) {
    in_flight_ = true;
    ++attempts_;
    sent_ns_ = now_ns;
    return waiting_.front();
}

Control ControlQueue::take() {
    const Control control = waiting_.front();
    pop();
    return control;
}

void ControlQueue::confirmed_by(const DeviceStatus& status) {
    if (in_flight_ && shows(status, waiting_.front())) pop();
}

bool ControlQueue::refused() {
    if (!in_flight_) return false;
    pop();
    return true;
}

bool ControlQueue::watch(std::uint64_t now_ns, std::uint64_t timeout_ns, std::uint32_t attempts) {
    if (!in_flight_ || now_ns - sent_ns_ < timeout_ns) return false;
    in_flight_ = false;
    if (attempts_ < attempts) return false;
    pop();
    return true;
}

void ControlQueue::pop() {
    waiting_.pop_front();
    in_flight_ = false;
    attempts_ = 0;
}

}  // namespace xorvox::host
