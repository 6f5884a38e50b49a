// Stream: frames one after the other, at the rate of a display in this program or at the other end of a link.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "driver/display/description.h"
#include "driver/host/session.h"
#include "driver/host/stream.h"
#include "tools/delivery.h"

namespace xorvox::tools {

/// Which frame is asked for.
struct FrameMoment {
    std::uint64_t number = 0;  ///< From 0, without gaps.
    double seconds = 0.0;      ///< When it is expected to be shown, from the first one on.
};

/// Writes a frame into `frame`, frame_bytes(display) long. False: there are no more.
using FrameSource = std::function<bool(const FrameMoment& moment, std::span<std::byte> frame)>;

struct StreamDelivery {
    host::SessionStatistics session;
    host::StreamStatistics stream;
    bool simulated = false;          ///< On loopback: time stood still while frames were made.
    std::optional<LightSeen> light;  ///< Of the last frame, on loopback.
    std::optional<Error> broken;     ///< Why it ended before its time; the figures are those until then.
};

/// Sends frames of `source` for `seconds` (0: until there are no more), one for each cycle of the display as far as
/// they can be made and sent, and waits until the last one is shown. A signal ends it in good order. `png`, on
/// loopback: where a picture of the last frame goes; null for none. `recording`: where the packets go, too; null:
/// nowhere. An Error: nothing was sent.
Expected<StreamDelivery> deliver_stream(const DeliveryOptions& options, const transport::Address& address,
                                        const DisplayDescription& display, const FrameSource& source, double seconds,
                                        io::AtomicFile* png, sim::RecordingWriter* recording = nullptr);

/// "600 volumes shown at 20 a second …": what a person wants to know of it; and the members of a JSON object.
void print_stream(const StreamDelivery& delivery);
std::string stream_json(const StreamDelivery& delivery);

}  // namespace xorvox::tools
