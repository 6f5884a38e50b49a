// record_link: a tap that records what passes a link.
#pragma once

#include <cstdint>
#include <functional>

#include "sim/recording/writer.h"
#include "transport/link.h"

namespace xorvox::sim {

/// Which end of the link is wrapped: who sends into it.
enum class LinkEnd : std::uint8_t { Host, Device };

/// Takes over `inner`, which must be open, and has its info() and thread rules. Every packet that the link took or gave
/// goes to `writer`, which is borrowed, at the time that `now_ns` says. A recording that cannot be written does not
/// disturb the link: writer.commit() says so.
UniqueLink record_link(UniqueLink inner, LinkEnd end, RecordingWriter& writer, std::function<std::uint64_t()> now_ns);

}  // namespace xorvox::sim
