// Vcd: a trace of pins as a value change dump (IEEE 1364-2005, clause 18), which GTKWave, PulseView and sigrok-cli
// open.
//
//   sigrok-cli -I vcd -i trace.vcd -P spi:clk=clock:mosi=data     what was shifted into a cube's registers
//
// One scope with a wire for each pin, times in nanoseconds, and nothing else: the same edges give the same bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "transport/lines.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

struct VcdOptions {
    std::string scope = "xorvox";  ///< The display's name; letters, digits and _, any other becomes _.
    /// A trace ends before the change after so many; a change of several pins at once counts for each. Ten million are
    /// about 55 MB.
    std::uint64_t most_changes = 10'000'000;
};

/// Writes while it is fed. One thread.
class VcdWriter {
public:
    /// Takes the next bytes of the file: io::AtomicFile::write, for one.
    using Output = std::function<Expected<void>(std::string_view bytes)>;

    /// `names` by line, as pin_names(); lines without a name are left out.
    VcdWriter(std::vector<std::string> names, const VcdOptions& options, Output output);

    /// A PinSink: all levels from `time_ns` on. The first call gives the levels of the beginning. After an error of the
    /// output, and after the last change that may be, it does nothing.
    void on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed);

    /// The trace lasts until `end_ns`, or until ended_early_ns(), and is written to its end. The output's error, if it
    /// had one. Call once, last; what was never fed is a trace without times.
    Expected<void> finish(std::uint64_t end_ns);

    /// Single pins that changed, without the levels of the beginning.
    std::uint64_t changes() const { return changes_; }
    /// When the first change came that was left out because there were most_changes already.
    std::optional<std::uint64_t> ended_early_ns() const { return ended_early_ns_; }

private:
    void write_header(const std::vector<std::string>& names, const std::string& scope);
    void write_time(std::uint64_t time_ns);
    void write_levels(LineMask levels, LineMask which);
    void flush();

    Output output_;
    Expected<void> status_;
    std::uint64_t most_changes_;
    LineMask traced_ = 0;
    std::string buffer_;
    std::uint64_t changes_ = 0;
    std::optional<std::uint64_t> time_ns_;
    std::optional<std::uint64_t> ended_early_ns_;
};

}  // namespace xorvox::sim
