#include "sim/faults.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "driver/display/names.h"
#include "driver/display/rules.h"
#include "sim/fault_keys.h"
#include "sim/pixel_light.h"

namespace xorvox::sim {
namespace {

constexpr FaultKindInfo kKinds[] = {
    {FaultKind::OffAxis, "off-axis", "a panel of a rotor stands further out", "off-axis:panel=1,mm=3"},
    {FaultKind::Shifted, "shifted", "a panel of a rotor, or a projector's image, stands further along its columns",
     "shifted:panel=0,mm=4"},
    {FaultKind::ShiftedPlane, "shifted-plane", "a plane of a stack stands further along its columns",
     "shifted-plane:plane=5,mm=10"},
    {FaultKind::Tilted, "tilted", "a panel of a rotor leans", "tilted:panel=1,deg=5"},
    {FaultKind::Mirrored, "mirrored", "a panel's columns are wired from the other end", "mirrored:panel=0"},
    {FaultKind::SwappedPanels, "swapped-panels", "two panels are plugged the other way round",
     "swapped-panels:panel=0,other=1"},
    {FaultKind::SwappedSlices, "swapped-slices", "two slices, layers, or points of a string are",
     "swapped-slices:slice=2,other=5"},
    {FaultKind::DeadRow, "dead-row", "a row of a panel stays dark", "dead-row:panel=0,row=20"},
    {FaultKind::StuckBit, "stuck-bit", "a bit of a panel's codes, 0 the lowest, is always 0 or 1",
     "stuck-bit:panel=0,bit=7,value=0"},
    {FaultKind::RowOrder, "row-order", "two row lines of a panel are swapped: of HUB75 address lines, A is 0",
     "row-order:panel=0,line=1,other=4"},
    {FaultKind::Phase, "phase", "the index mark, or the count of planes or points, is late by slices",
     "phase:slices=15"},
    {FaultKind::LostPackets, "lost-packets", "this part of the packets to the display vanishes",
     "lost-packets:part=0.1"},
};

/// Looks at one fault on one display.
class Checker {
public:
    Checker(const DisplayDescription& display, const Fault& fault) : display_(display), fault_(fault) {}

    Expected<void> check() const {
        if (const auto kind = of_this_kind(); !kind) return kind;
        if (const auto panel = count("panel", fault_.panel, display_.panel_count); !panel) return panel;
        const Panel& panel = display_.panels[fault_.panel];
        switch (fault_.kind) {
            case FaultKind::Tilted: return tilted(panel.tilt_deg + fault_.amount);
            case FaultKind::ShiftedPlane: return count("plane", fault_.slice, display_.slices);
            case FaultKind::OffAxis:
            case FaultKind::Shifted:
            case FaultKind::Mirrored:
            case FaultKind::LostPackets: return {};
            case FaultKind::SwappedPanels: return swapped_panels();
            case FaultKind::SwappedSlices: return swapped_slices();
            case FaultKind::DeadRow: return count("row", fault_.row, panel.rows);
            case FaultKind::StuckBit: return stuck_bit(fault_.bit);
            case FaultKind::RowOrder: return row_order();
            case FaultKind::Phase: return phase(fault_.amount);
        }
        return {};
    }

private:
    bool is(DisplayKind kind) const { return display_.kind == kind; }

    tl::unexpected<Error> refuse(std::string_view why) const {
        return fail(fmt::format("fault {} cannot be on {}, kind \"{}\": {}", to_string(fault_.kind),
                                display_.name.view(), display::kind_name(display_.kind), why));
    }
    Expected<void> needs(bool met, std::string_view otherwise) const {
        if (met) return {};
        return refuse(otherwise);
    }
    /// Whether displays of its kind can have the fault at all.
    Expected<void> of_this_kind() const {
        switch (fault_.kind) {
            case FaultKind::OffAxis: return needs(is(DisplayKind::RotatingPanel), "only panels that turn have an axis");
            case FaultKind::Tilted: return needs(is(DisplayKind::RotatingPanel), "only panels that turn can lean");
            case FaultKind::Shifted:
                return needs(is(DisplayKind::RotatingPanel) || is(DisplayKind::SweptPlane) || is(DisplayKind::Helix),
                             "only panels that turn and images of a projector are shifted as a whole; of a stack try "
                             "shifted-plane");
            case FaultKind::ShiftedPlane:
                return needs(is(DisplayKind::StackedPlanes), "only stacks have planes that stand by themselves");
            default: return {};
        }
    }
    /// `index` of `all` that there are.
    Expected<void> count(std::string_view key, std::uint32_t index, std::uint64_t all) const {
        if (index < all) return {};
        if (all == 1) return refuse(fmt::format("{}: found {}; it has one, 0", key, index));
        return refuse(fmt::format("{}: found {}; allowed: 0 to {}", key, index, all - 1));
    }
    Expected<void> two(std::uint32_t one, std::uint32_t other) const {
        return needs(one != other, fmt::format("other: found {}, which is the same; allowed: another one", other));
    }

    Expected<void> tilted(double deg) const {
        const auto wrong = display::check(deg, display::kTiltDeg);
        return needs(!wrong, "deg: it would lean by " + fmt::format("{}", deg) + " degrees; allowed: less than 90");
    }

    Expected<void> swapped_panels() const {
        if (display_.panel_count < 2) return refuse("it has one panel");
        if (const auto known = count("other", fault_.other, display_.panel_count); !known) return known;
        const Panel& a = display_.panels[fault_.panel];
        const Panel& b = display_.panels[fault_.other];
        if (a.columns != b.columns || a.rows != b.rows) return refuse("the two panels differ in columns or rows");
        return two(fault_.panel, fault_.other);
    }

    Expected<void> swapped_slices() const {
        const bool points = is(DisplayKind::FreePoints);
        const std::uint64_t all = points ? display_.points.size() : display_.slices;
        if (all < 2) return refuse("it has one slice");
        if (const auto known = count("slice", fault_.slice, all); !known) return known;
        if (const auto known = count("other", fault_.other, all); !known) return known;
        return two(fault_.slice, fault_.other);
    }

    Expected<void> stuck_bit(std::uint32_t bit) const {
        if (const auto known = count("bit", bit, bits_per_pixel(display_.format)); !known) return known;
        return needs((PixelLight(display_).shown_bits() >> bit & 1u) != 0,
                     fmt::format("bit: found {} of {}, which is not shown: bit_planes is {}", bit,
                                 to_string(display_.format), shown_bit_planes(display_)));
    }

    Expected<void> row_order() const {
        const Scan& scan = display_.scan;
        const bool addressed = scan.driver == DriverChip::Hub75;
        if (scan.row_groups < 2 || (!addressed && scan.driver != DriverChip::Direct)) {
            return refuse("its rows do not take turns (scan.row_groups); of layers and strings try swapped-slices");
        }
        const std::uint32_t lines = addressed ? static_cast<std::uint32_t>(std::bit_width(scan.row_groups - 1u))
                                              : std::uint32_t{scan.row_groups};
        if (lines < 2) return refuse("it has one address line");
        if (const auto known = count("line", fault_.line, lines); !known) return known;
        if (const auto known = count("other", fault_.other, lines); !known) return known;
        return two(fault_.line, fault_.other);
    }

    Expected<void> phase(double slices) const {
        const bool counts = is(DisplayKind::StackedPlanes) || is(DisplayKind::FreePoints);
        return needs(!counts || slices == std::floor(slices),
                     "slices: planes and points are counted; allowed: whole numbers");
    }

    const DisplayDescription& display_;
    const Fault& fault_;
};

}  // namespace

bool Faults::has(FaultKind kind) const {
    return std::ranges::find(list, kind, &Fault::kind) != list.end();
}

double Faults::lost_packets() const {
    double arrives = 1.0;
    for (const Fault& fault : list) {
        if (fault.kind == FaultKind::LostPackets) arrives *= 1.0 - fault.amount;
    }
    return 1.0 - arrives;
}

double Faults::late_slices() const {
    double late = 0.0;
    for (const Fault& fault : list) {
        if (fault.kind == FaultKind::Phase) late += fault.amount;
    }
    return late;
}

std::span<const FaultKindInfo> fault_kinds() {
    return kKinds;
}

std::string_view to_string(FaultKind kind) {
    const auto info = std::ranges::find(kKinds, kind, &FaultKindInfo::kind);
    return info == std::end(kKinds) ? "unknown" : info->name;
}

Expected<Fault> parse_fault(std::string_view text) {
    const std::size_t colon = std::min(text.find(':'), text.size());
    const Expected<FaultKind> kind = find_fault_kind(text.substr(0, colon));
    if (!kind) return tl::unexpected(kind.error());
    const std::string_view name = to_string(*kind);
    const auto refuse = [name](const std::string& message) { return fail(fmt::format("{}: {}", name, message)); };
    const auto settings = split_settings(text.substr(std::min(colon + 1, text.size())));
    if (!settings) return refuse(settings.error().message);

    const std::span<const FaultKey> keys = fault_keys(*kind);
    Fault fault;
    fault.kind = *kind;
    for (const Setting& setting : *settings) {
        const auto key = std::ranges::find(keys, setting.name, &FaultKey::name);
        if (key == keys.end()) {
            std::vector<std::string_view> known;
            for (const FaultKey& one : keys) known.push_back(one.name);
            return refuse(unknown_name("key", setting.name, known));
        }
        const Expected<double> value = read_number(setting, key->range);
        if (!value) return refuse(value.error().message);
        key->set(fault, *value);
    }
    for (const FaultKey& key : keys) {
        if (!key.required || std::ranges::find(*settings, key.name, &Setting::name) != settings->end()) continue;
        const auto info = std::ranges::find(kKinds, *kind, &FaultKindInfo::kind);
        return refuse(fmt::format("the key {} is missing; as in {}", key.name, info->example));
    }
    return fault;
}

Expected<void> check_faults(const DisplayDescription& display, const Faults& faults) {
    for (const Fault& fault : faults.list) {
        if (const auto possible = Checker(display, fault).check(); !possible) return possible;
    }
    return {};
}

}  // namespace xorvox::sim
