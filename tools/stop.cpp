#include "tools/stop.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>

namespace xorvox::tools {
namespace {

std::atomic<int> caught = 0;  // The signal's number.
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler writes it");

}  // namespace

void stop_on_signals() {
    struct sigaction action = {};
    action.sa_handler = [](int signal) { caught = signal; };
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, nullptr);
}

bool asked_to_stop() {
    return caught != 0;
}

StopRequests::StopRequests() {
    stop_on_signals();
    // A signal handler may not request a stop itself: that takes a lock.
    watch_ = std::jthread([source = source_](std::stop_token end) mutable {
        std::mutex mutex;
        std::condition_variable_any wake;
        std::unique_lock lock(mutex);
        while (!asked_to_stop() && !end.stop_requested()) {
            wake.wait_for(lock, end, std::chrono::milliseconds(20), [] { return false; });
        }
        if (asked_to_stop()) source.request_stop();
    });
}

void end_if_asked_to_stop() {
    if (!asked_to_stop()) return;
    std::signal(caught, SIG_DFL);
    std::raise(caught);
}

}  // namespace xorvox::tools
