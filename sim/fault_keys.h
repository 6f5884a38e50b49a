// The keys of each kind of fault, and settings as typed; what text and TOML share. Internal to sim.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "driver/display/rules.h"
#include "sim/faults.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

/// A key, and where its value goes.
struct FaultKey {
    std::string_view name;
    std::uint32_t Fault::*field;  ///< nullptr: `amount`.
    display::Range range;
    bool required = true;  ///< Otherwise 0.

    void set(Fault& fault, double value) const {
        if (field == nullptr) {
            fault.amount = value;
        } else {
            fault.*field = static_cast<std::uint32_t>(value);
        }
    }
};
std::span<const FaultKey> fault_keys(FaultKind kind);

/// The kind of this name; an Error lists them.
Expected<FaultKind> find_fault_kind(std::string_view name);

/// One NAME=VALUE.
struct Setting {
    std::string_view name;
    std::string_view value;
};
/// Those of a list with commas, each name once. Borrows `text`.
Expected<std::vector<Setting>> split_settings(std::string_view text);

/// The value as a number in `range`.
Expected<double> read_number(const Setting& setting, const display::Range& range);

/// That `name` is not known, with the nearest of `known` and all of them.
std::string unknown_name(std::string_view what, std::string_view name, std::span<const std::string_view> known);

}  // namespace xorvox::sim
