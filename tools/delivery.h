// Delivery: one frame to a display, in this program or at the other end of a link.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "driver/display/description.h"
#include "driver/display/toml.h"
#include "driver/host/session.h"
#include "sim/recording/writer.h"
#include "sim/simulator.h"
#include "sim/statistics.h"
#include "tools/commands.h"
#include "tools/shutter.h"
#include "transport/address.h"
#include "voxelizer/io/atomic_file.h"

namespace xorvox::tools {

/// What a display in this program showed.
struct LightSeen {
    sim::Statistics statistics;
    double picture_covered = 0.0;       ///< The part of the picture that is the object; 0 without one.
    std::optional<SeenInTime> in_time;  ///< Where it was watched in time: then statistics and picture are of that.
};

/// What became of the frame.
struct Delivery {
    host::SessionStatistics session;
    std::optional<LightSeen> light;  ///< On loopback.
};

/// The end of a file's name, from its last dot on, in lower case.
std::string extension_of(const std::string& path);

/// How far the clock of a display in this program goes when nothing moves: shorter than anybody's patience.
inline constexpr std::uint64_t kSimulatedStep_ns = 100'000'000;

/// A distant display remembers the session before, so each gets another id; that of a file, and of a display that is
/// switched on for it, follows from its first frame, so that equal frames give equal packets.
/// `recorded`: a keyframe now and then, so that the recording can be played from any moment.
host::SessionOptions session_options(bool distant, const DisplayDescription& display, std::span<const std::byte> frame,
                                     bool recorded = false);

/// Begins the file of --record. Nothing without the option.
Expected<std::optional<sim::RecordingWriter>> make_recording(const DeliveryOptions& options,
                                                             const DisplayFile& display);

/// `link`, whose packets go into `recording` if there is one.
UniqueLink recorded(UniqueLink link, sim::RecordingWriter* recording, std::function<std::uint64_t()> now_ns);

/// "recorded: 3 frames in duck.xvr"; commits `recording` if there is one.
Expected<void> finish_recording(const DeliveryOptions& options, sim::RecordingWriter* recording);

/// Where an error ended the delivery: keeps the recording of what was sent whole until then, if there is any.
void keep_recording(const DeliveryOptions& options, sim::RecordingWriter* recording);

/// A display in this program.
struct LocalDisplay {
    DisplayFile built;  ///< Of --built: the simulator borrows its points.
    sim::Simulator simulator;
    std::optional<Shutter> shutter;  ///< Where it is to be watched in time.
};
/// Switches it on with `link` at its plug.
Expected<LocalDisplay> make_local_display(const DeliveryOptions& options, const DisplayDescription& display, Link link);

/// Measures what `local` shows, at most `pixels` of them, and draws it into `png` if there is one. Where it has a
/// shutter, time goes on, and its host does `meanwhile`. Without enough memory: nothing, with a warning, unless a
/// picture, JSON or an instrument was asked for.
Expected<std::optional<LightSeen>> look_at(LocalDisplay& local, std::uint64_t now_ns, std::size_t pixels,
                                           const DeliveryOptions& options, io::AtomicFile* png,
                                           const Meanwhile& meanwhile);

/// What of `options` can be refused before any work: --png, --built, --fault and --sim without loopback, faults that
/// are none, the picture's name,
/// --view, --frame and --size without it, --hold without tcp, an output that would overwrite the file `input` (empty:
/// none).
Expected<void> check_delivery(const DeliveryOptions& options, const transport::Address& address,
                              const std::string& input);

/// Sends `frame`, in which `pixels` are lit, and waits until the display shows it, or a link without a way back
/// has taken it. `png`, on loopback: where a picture of the light goes; null for none. `recording`: where the packets
/// go, too; null: nowhere.
Expected<Delivery> deliver(const DeliveryOptions& options, const transport::Address& address,
                           const DisplayDescription& display, std::span<const std::byte> frame, std::size_t pixels,
                           io::AtomicFile* png, sim::RecordingWriter* recording = nullptr);

/// What a display in this program showed, as a JSON object; "null" of another one.
std::string light_json(const DeliveryOptions& options, const std::optional<LightSeen>& light);

/// Members of a JSON object: the picture and the light.
std::string picture_json(const DeliveryOptions& options, const std::optional<LightSeen>& light);

}  // namespace xorvox::tools
