// TomlTable: typed values out of one table of a display file. Every mistake is noted with its line, and reading goes
// on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "driver/display/names.h"
#include "driver/display/rules.h"
#include "driver/display/toml_tree.h"

namespace xorvox::display {

/// A set of kinds of displays.
class Kinds {
public:
    constexpr Kinds(std::initializer_list<DisplayKind> kinds) {
        for (const DisplayKind kind : kinds) bits_ |= 1u << static_cast<unsigned>(kind);
    }
    constexpr bool has(DisplayKind kind) const { return (bits_ >> static_cast<unsigned>(kind) & 1u) != 0; }

private:
    std::uint32_t bits_ = 0;
};
inline constexpr Kinds kAllKinds{DisplayKind::StackedPlanes, DisplayKind::RotatingPanel, DisplayKind::SweptPlane,
                                 DisplayKind::Helix, DisplayKind::FreePoints};

/// A key that a table may have.
struct Key {
    std::string_view name;
    Kinds required_by{};         ///< Kinds that need it,
    Kinds known_to = kAllKinds;  ///< and kinds that may have it.
};

/// The one of `names`, which are some, with the fewest letters that are another, missing or too many.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> names);

/// What is wrong with a file so far.
class Mistakes {
public:
    /// `key` of `table` has no value that can be relied on. `key` is borrowed.
    void spoil(const TomlNode& table, std::string_view key) { spoilt_.emplace_back(&table, key); }
    bool is_spoilt(const TomlNode& table, std::string_view key) const {
        return std::ranges::find(spoilt_, std::pair(&table, key)) != spoilt_.end();
    }

    std::vector<DisplayMistake> list;

private:
    std::vector<std::pair<const TomlNode*, std::string_view>> spoilt_;
};

/// A table in hand. A key that is absent, or whose value is wrong, leaves the value as it was.
class TomlTable {
public:
    /// `place` leads to the table in messages: "", "panel 1: ", "motion.". All are borrowed.
    TomlTable(const TomlNode& table, std::string_view place, Mistakes& mistakes)
        : table_(table), place_(place), mistakes_(mistakes) {}

    const TomlNode* find(std::string_view key) const { return table_.find(key); }

    /// Notes keys that are not among `keys`, with the nearest one that is.
    void refuse_unknown(std::span<const Key> keys);
    /// Notes keys that do not apply to `kind`, and those that it needs and that are missing.
    void check_keys(std::span<const Key> keys, DisplayKind kind);
    /// Notes that `key` is missing, unless an unknown key was said to be near it.
    void note_missing(std::string_view key);

    void text(std::string_view key, std::string& value);
    void truth(std::string_view key, bool& value);
    /// Infinities, and numbers out of range, are left to the rules.
    void number(std::string_view key, double& value);
    /// A list of such numbers.
    void numbers(std::string_view key, std::vector<double>& values);
    /// A list of lists of three numbers.
    void points(std::string_view key, std::vector<PointMm>& values);
    /// A list of texts.
    void texts(std::string_view key, std::vector<std::string>& values);

    /// Of an integer type, which the range is narrower than.
    template <class Integer>
    void whole(std::string_view key, const Range& range, Integer& value) {
        if (const auto number = whole_in(key, range)) value = static_cast<Integer>(*number);
    }

    /// One of `names`.
    template <class Enum, std::size_t N>
    void choice(std::string_view key, const Named<Enum> (&names)[N], Enum& value) {
        std::vector<std::string_view> known;
        for (const Named<Enum>& named : names) known.push_back(named.name);
        if (const auto at = one_of(key, known)) value = names[*at].value;
    }

    /// Notes a mistake in the value of `key`, or in the whole table if it has no such key. The key counts as spoilt
    /// then, as it does after every mistake that has one.
    void note(std::string_view key, std::string_view message);
    void wrong(const TomlNode& node, std::string_view key, std::string_view allowed);

private:
    std::optional<std::int64_t> whole_in(std::string_view key, const Range& range);
    std::optional<std::size_t> one_of(std::string_view key, std::span<const std::string_view> names);
    const TomlNode* list(std::string_view key, std::string_view of_what);
    void add(std::string_view key, DisplayMistake mistake);
    std::string path(std::string_view key) const;
    std::string_view before() const;

    const TomlNode& table_;
    std::string_view place_;
    Mistakes& mistakes_;
    std::vector<std::string_view> misspelt_;  ///< Keys that unknown ones are near to.
};

}  // namespace xorvox::display
