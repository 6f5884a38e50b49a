#include "tools/stop.h"

#include <atomic>
#include <csignal>

namespace xorvox::tools {
namespace {

std::atomic<bool> asked = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler writes it");

}  // namespace

void stop_on_signals() {
    struct sigaction action = {};
    action.sa_handler = [](int) { asked = true; };
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, nullptr);
}

bool asked_to_stop() {
    return asked;
}

}  // namespace xorvox::tools
