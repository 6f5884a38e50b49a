// Stop: SIGINT and SIGTERM as a question that loops ask, or as a stop request.
#pragma once

#include <stop_token>
#include <thread>

namespace xorvox::tools {

/// From now on SIGINT and SIGTERM do not end the program; asked_to_stop() says that one came. SIGPIPE is ignored: a
/// reader of standard output may leave. A wait that a signal interrupts returns early.
void stop_on_signals();

bool asked_to_stop();

/// stop_on_signals(), and while it lives a signal becomes a stop request, within a moment.
class StopRequests {
public:
    StopRequests();
    std::stop_token token() const { return source_.get_token(); }

private:
    std::stop_source source_;
    std::jthread watch_;
};

/// After a signal: ends the program as if it had not been caught, so that a shell sees the interruption and leaves its
/// loop. Without one: nothing.
void end_if_asked_to_stop();

}  // namespace xorvox::tools
