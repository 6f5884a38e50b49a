// PlaneScanner: scans a slice out over lines, bit plane by bit plane, at the times of modulation.h. What kind of panel
// it is, is said by its Wires: Hub75Scan, ShiftRegisterScan and MatrixScan are the scanners that there are.
//
//   static constexpr auto kScan = hub75_config(kDisplay);               // kDisplay: constexpr, `displays NAME --cpp`
//   std::uint64_t buffer[scan_buffer_words(kScan)];
//   Hub75Scan scanner;
//   scanner.init(kScan, lines, buffer);
//
// and then either ScanLoop (scan_loop.h), or, with the orders of ScanControl:
//
//   scanner.begin(order, order.end_ns - now);                           // a new order; dark ones too
//   while (!scanner.finished()) scanner.step();                         // … and look for a new order after each
//
// A slot in the drawing of modulation.h, in the order in which lines are asked:
//
//   hold(fall)  row lines, latch for latch_ns  strobe(on)  write(the next slot's data)  hold(what is left of the slot)
//
// Lines that cannot strobe by themselves (LinesOperations::strobe is null) are lit for a part of the time in each step,
// and data are shifted in after that: the light is right, but a slot takes on + shift instead of the longer of them.
//
// Between two calls nothing is lit but a strobe that ends by itself. So nothing stays lit when no further call comes:
// from a program that hangs, leaves, or destroys the scanner in the middle of a slice.
//
// When an operation of the lines fails, what can still be done of blank() is done, and the status of the operation is
// returned; then the slice is finished, and begin() may be tried again.
//
// No heap, no floating point, no clock. One thread. A scanner is trivial to destroy, and may be a global of firmware.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/device/scan/modulation.h"
#include "driver/device/scan/slice_planes.h"
#include "driver/device/scan_order.h"
#include "transport/lines.h"
#include "voxelizer/status.h"

namespace xorvox::device {

/// What all scanners must know; part of each one's config.
struct ScanConfig {
    Status supported = Status::Ok;  ///< Unsupported: of another driver, or more than the wires can do.
    ModulationConfig modulation;
    SliceConfig slice;
    LineMask used = 0;             ///< Lines that it sets.
    std::uint32_t pins = 0;        ///< So many pins; more than lines where two are on one.
    std::uint32_t write_size = 0;  ///< Elements of the write that shifts a slot's data in.
};

/// The buffer of a scanner, in words of 64 bits: the slice's planes, and what is written for a slot.
template <class Config>
constexpr std::size_t scan_buffer_words(const Config& config) {
    return config.scan.write_size + (config.scan.slice.plane_bytes() + 7) / 8;
}

/// Lines that light what is latched, and their levels while it is lit. All others are dark.
struct Light {
    LineMask mask = 0;
    LineMask levels = 0;
};

/// A pulse on a latch, high for the first half of `latch_ns`; for the rest, what it latched settles.
inline Status pulse_latch(Lines lines, LineMask latch, std::uint64_t latch_ns) {
    Status status = lines.set(latch, latch);
    if (status == Status::Ok) status = lines.hold(latch_ns / 2);
    if (status == Status::Ok) status = lines.set(latch, 0);
    return status == Status::Ok ? lines.hold(latch_ns - latch_ns / 2) : status;
}

/// Wires have
///   Config                               with a member `scan`
///   init(config, lines, levels)          `levels`: write_size words
///   shift(planes, group, plane)          the data of a slot on their way
///   latch(group)                         the data that were shifted, and their row, to the LEDs, which are dark; takes
///                                        latch_ns
///   light(group)                         what lights them
///   output_off() release_rows() clear_columns()    kBlankSteps
template <class Wires>
class PlaneScanner {
public:
    using Config = typename Wires::Config;

    /// What is left of a slot, and light of lines that cannot strobe, are held for no longer at a time. The gap of a
    /// slot, fall and latch_ns, is never cut.
    static constexpr std::uint64_t kLongestHoldNs = 100'000;

    /// `config`, `lines` and `buffer` (scan_buffer_words(config)) are borrowed for good. Sets nothing; begin with
    /// blank(). Ok; Unsupported: see ScanConfig; InvalidArgument: no lines, lines that strobe and cannot join(), a pin
    /// that is no output of theirs, or two pins on one line; OutOfMemory: the buffer is too small.
    Status init(const Config& config, Lines lines, std::span<std::uint64_t> buffer) {
        finished_ = true;
        ready_ = false;
        const ScanConfig& scan = config.scan;
        if (scan.supported != Status::Ok) return scan.supported;
        if (!lines || (scan.used & ~lines.info().outputs) != 0) return Status::InvalidArgument;
        if (lines.operations->strobe != nullptr && lines.operations->join == nullptr) return Status::InvalidArgument;
        if (static_cast<std::uint32_t>(std::popcount(scan.used)) != scan.pins) return Status::InvalidArgument;
        if (buffer.size() < scan_buffer_words(config)) return Status::OutOfMemory;
        lines_ = lines;
        modulation_config_ = scan.modulation;
        const std::uint64_t set_hz = lines.info().set_hz;
        if (set_hz != 0) {
            shift_ns_ = (scan.write_size * std::uint64_t{1'000'000'000} + set_hz - 1) / set_hz;
            modulation_config_.shift_ns = std::max(modulation_config_.shift_ns, shift_ns_);
        } else {
            shift_ns_ = modulation_config_.shift_ns;
        }
        planes_.init(scan.slice, std::as_writable_bytes(buffer.subspan(scan.write_size)));
        wires_.init(config, lines, buffer.first(scan.write_size));
        ready_ = true;
        return Status::Ok;
    }

    /// A new order: what is lit ends at once. Of one that is lit, its slice is taken apart (that takes as long as
    /// split_bit_planes()) and scanned out within `available_ns`: order.end_ns − now. A dark one is blank(). Ok;
    /// InvalidArgument, and dark: fewer bytes than a slice has, or not initialized; or what lines answer.
    Status begin(const ScanOrder& order, std::uint64_t available_ns) {
        if (!order.lit()) return blank();
        if (!ready_) return Status::InvalidArgument;
        finished_ = false;
        next_ = 0;
        shifted_ = false;
        wait_ns_ = light_ns_ = 0;
        brightness_ = order.brightness;
        Status status = wires_.output_off();
        if (status == Status::Ok) status = planes_.split(order);
        if (status != Status::Ok) return give_up(status);
        modulation_ = modulate(modulation_config_, available_ns);
        slots_ = modulation_.row_groups * modulation_.planes;
        return Status::Ok;
    }

    /// The next slot, or a part of it: no longer than the shift, the gap, and kLongestHoldNs together. Nothing, once
    /// the slice is finished. Ok, or what lines answer.
    Status step() {
        if (finished_) return Status::Ok;
        const Status status = advance();
        return status == Status::Ok ? status : give_up(status);
    }

    /// The slice was scanned out, and its last light is over; or there is none.
    bool finished() const { return finished_; }

    /// kBlankSteps, in their order and at once, also in the middle of a strobe. Each of them is tried whatever becomes
    /// of the others; the output most often. Ok, or what lines answered first.
    Status blank() {
        finished_ = true;
        if (!ready_) return Status::InvalidArgument;
        Status first = wires_.output_off();
        bool off = first == Status::Ok || wires_.output_off() == Status::Ok;
        if (!off) (void)lines_.join();  // A strobe that cannot be cut ends by itself.
        const std::array rest{wires_.release_rows(), wires_.clear_columns()};
        if (!off) (void)wires_.output_off();
        for (const Status status : rest) {
            if (first == Status::Ok) first = status;
        }
        return first;
    }

private:
    std::uint32_t group_of(std::uint32_t slot) const { return slot / modulation_.planes; }
    std::uint32_t plane_of(std::uint32_t slot) const { return slot % modulation_.planes; }

    Status give_up(Status status) {
        (void)blank();
        return status;
    }

    Status shift() {
        shifted_ = true;
        return wires_.shift(planes_, group_of(next_), plane_of(next_));
    }

    Status advance() {
        if (wait_ns_ > 0) {
            const std::uint64_t part = std::min(wait_ns_, kLongestHoldNs);
            wait_ns_ -= part;
            const Status status = lines_.hold(part);
            if (status != Status::Ok || wait_ns_ > 0) return status;
        }
        if (light_ns_ > 0) {
            const std::uint64_t part = std::min(light_ns_, kLongestHoldNs);
            light_ns_ -= part;
            return lines_.strobe(light_.mask, light_.levels, part);
        }
        if (next_ == slots_) {
            finished_ = true;
            return lines_.join();
        }
        if (shifted_) return light_up();
        wait_ns_ = modulation_.shift_ns - shift_ns_;
        return shift();
    }

    Status light_up() {
        const std::uint32_t group = group_of(next_);
        const std::uint64_t full_ns = modulation_.on_ns(plane_of(next_));
        const std::uint64_t on_ns = modulation_.on_ns(plane_of(next_), brightness_);
        Status status = lines_.join();
        if (status == Status::Ok) status = lines_.hold(modulation_.fall_ns);
        if (status == Status::Ok) status = wires_.latch(group);
        if (status != Status::Ok) return status;
        light_ = wires_.light(group);
        shifted_ = false;
        ++next_;
        if (lines_.operations->strobe == nullptr) {
            light_ns_ = on_ns;
            return status;
        }
        if (on_ns > 0) status = lines_.strobe(light_.mask, light_.levels, on_ns);
        if (next_ == slots_) {
            wait_ns_ = on_ns;
        } else if (status == Status::Ok) {
            const std::uint64_t slot_ns = std::max(full_ns, modulation_.shift_ns);
            wait_ns_ = slot_ns - shift_ns_;
            status = shift();
        }
        return status;
    }

    Lines lines_;
    Wires wires_;
    SlicePlanes planes_;
    ModulationConfig modulation_config_;
    Modulation modulation_;
    std::uint64_t shift_ns_ = 0;  ///< As long as the lines take for it.
    std::uint64_t wait_ns_ = 0;   ///< What is left of a slot.
    std::uint64_t light_ns_ = 0;  ///< What is left of its light, where lines cannot strobe.
    Light light_;
    std::uint32_t slots_ = 0;
    std::uint32_t next_ = 0;  ///< Slot to be lit.
    std::uint8_t brightness_ = 0;
    bool shifted_ = false;  ///< Its data are in the registers.
    bool finished_ = true;
    bool ready_ = false;
};

}  // namespace xorvox::device
