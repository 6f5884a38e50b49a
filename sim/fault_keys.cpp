#include "sim/fault_keys.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/display/toml_table.h"
#include "driver/display/toml_tree.h"

namespace xorvox::sim {
namespace {

using display::Range;

/// A number of something; check_faults() knows how many the display has.
constexpr Range kCount{0, 1e6, true};
constexpr FaultKey kPanel{"panel", &Fault::panel, kCount, false};
constexpr FaultKey kOther{"other", &Fault::other, kCount};
constexpr FaultKey kMm{"mm", nullptr, display::kPlaceMm};

constexpr FaultKey kOffAxis[] = {kPanel, kMm};
constexpr FaultKey kShiftedPlane[] = {{"plane", &Fault::slice, kCount}, kMm};
constexpr FaultKey kTilted[] = {kPanel, {"deg", nullptr, {-180, 180}}};
constexpr FaultKey kMirrored[] = {kPanel};
constexpr FaultKey kSwappedPanels[] = {{"panel", &Fault::panel, kCount}, kOther};
constexpr FaultKey kSwappedSlices[] = {{"slice", &Fault::slice, kCount}, kOther};
constexpr FaultKey kDeadRow[] = {kPanel, {"row", &Fault::row, kCount}};
constexpr FaultKey kStuckBit[] = {kPanel, {"bit", &Fault::bit, kCount}, {"value", nullptr, {0, 1, true}}};
constexpr FaultKey kRowOrder[] = {kPanel, {"line", &Fault::line, kCount}, kOther};
constexpr FaultKey kPhase[] = {{"slices", nullptr, {-double{kMaxSlices}, double{kMaxSlices}}}};
constexpr FaultKey kLostPackets[] = {{"part", nullptr, {0, 1}}};

}  // namespace

std::span<const FaultKey> fault_keys(FaultKind kind) {
    switch (kind) {
        case FaultKind::OffAxis:
        case FaultKind::Shifted: return kOffAxis;
        case FaultKind::ShiftedPlane: return kShiftedPlane;
        case FaultKind::Tilted: return kTilted;
        case FaultKind::Mirrored: return kMirrored;
        case FaultKind::SwappedPanels: return kSwappedPanels;
        case FaultKind::SwappedSlices: return kSwappedSlices;
        case FaultKind::DeadRow: return kDeadRow;
        case FaultKind::StuckBit: return kStuckBit;
        case FaultKind::RowOrder: return kRowOrder;
        case FaultKind::Phase: return kPhase;
        case FaultKind::LostPackets: return kLostPackets;
    }
    return {};
}

Expected<FaultKind> find_fault_kind(std::string_view name) {
    std::vector<std::string_view> known;
    for (const FaultKindInfo& info : fault_kinds()) {
        if (info.name == name) return info.kind;
        known.push_back(info.name);
    }
    return fail(unknown_name("fault", name, known));
}

Expected<std::vector<Setting>> split_settings(std::string_view text) {
    std::vector<Setting> settings;
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        const std::string_view setting = text.substr(0, comma);
        text.remove_prefix(std::min(comma + 1, text.size()));
        const std::size_t equals = setting.find('=');
        if (equals == std::string_view::npos || equals == 0) {
            return fail(
                fmt::format("found {}; allowed: KEY=VALUE, with commas between them", display::in_quotes(setting)));
        }
        const std::string_view name = setting.substr(0, equals);
        if (std::ranges::find(settings, name, &Setting::name) != settings.end()) {
            return fail(fmt::format("{} stands in it twice", display::in_quotes(name)));
        }
        settings.push_back({name, setting.substr(equals + 1)});
    }
    return settings;
}

Expected<double> read_number(const Setting& setting, const Range& range) {
    double value = 0.0;
    const char* const end = setting.value.data() + setting.value.size();
    const auto [rest, error] = std::from_chars(setting.value.data(), end, value);
    if (error != std::errc() || rest != end || (range.whole && value != std::floor(value))) {
        return fail(fmt::format("{}: found {}; allowed: a {} from {} to {}", setting.name,
                                display::in_quotes(setting.value), range.whole ? "whole number" : "number",
                                range.lowest, range.highest));
    }
    if (const auto wrong = display::check(value, range)) return fail(fmt::format("{}: {}", setting.name, *wrong));
    return value;
}

std::string unknown_name(std::string_view what, std::string_view name, std::span<const std::string_view> known) {
    return fmt::format("unknown {} {}; the nearest one is \"{}\" of {}", what, display::in_quotes(name),
                       display::nearest_name(name, known), fmt::join(known, ", "));
}

}  // namespace xorvox::sim
