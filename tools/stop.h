// Stop: SIGINT and SIGTERM as a question that loops ask.
#pragma once

namespace xorvox::tools {

/// From now on SIGINT and SIGTERM do not end the program; asked_to_stop() says that one came. SIGPIPE is ignored: a
/// reader of standard output may leave. A wait that a signal interrupts returns early.
void stop_on_signals();

bool asked_to_stop();

}  // namespace xorvox::tools
