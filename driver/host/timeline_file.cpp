// The two ways to write a timeline: a TOML file, and text on a command line.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "driver/display/toml_table.h"
#include "driver/display/toml_tree.h"
#include "driver/host/timeline.h"

namespace xorvox::host {
namespace {

using display::Key;
using display::Mistakes;
using display::Named;
using display::TomlNode;
using display::TomlTable;

constexpr std::size_t kMostBytes = std::size_t{1} << 20;

constexpr Named<Ease> kEaseNames[] = {
    {Ease::Linear, "linear", "Linear"},
    {Ease::Smooth, "smooth", "Smooth"},
    {Ease::Curve, "curve", "Curve"},
    {Ease::Step, "step", "Step"},
};

/// What the two kinds of tracks call their values, in a file and on a command line.
struct Words {
    std::string_view track, place, place_mm, size;
};
constexpr Words words(TrackKind kind) {
    if (kind == TrackKind::Motion) return {"motion", "move", "move_mm", "scale"};
    return {"camera", "center", "center_mm", "zoom"};
}

/// What is wrong with a keyframe that follows `before`, if anything: the value's name, and what was found.
struct Wrong {
    std::string_view name;
    std::string message;
};
std::optional<Wrong> find_wrong(const Keyframe& key, const Keyframe* before, const Words& words) {
    const auto outside = [](double value, double least, double most) { return !(value >= least && value <= most); };
    const auto any_outside = [&outside](const glm::dvec3& v, double most) {
        return outside(v.x, -most, most) || outside(v.y, -most, most) || outside(v.z, -most, most);
    };
    if (outside(key.at_seconds, 0.0, Keyframe::kMostSeconds)) {
        return Wrong{"at", fmt::format("found {}; allowed: 0 to {} seconds", key.at_seconds, Keyframe::kMostSeconds)};
    }
    if (before != nullptr && key.at_seconds <= before->at_seconds) {
        return Wrong{"at", fmt::format("found {} after {}; allowed: keyframes in the order of time, no two at once",
                                       key.at_seconds, before->at_seconds)};
    }
    if (any_outside(key.place_mm, Keyframe::kMostPlace_mm)) {
        return Wrong{words.place, fmt::format("allowed: three numbers within ±{}", Keyframe::kMostPlace_mm)};
    }
    if (any_outside(key.turn_deg, Keyframe::kMostTurn_deg)) {
        return Wrong{"turn", fmt::format("allowed: three angles within ±{}", Keyframe::kMostTurn_deg)};
    }
    if (outside(key.size, Keyframe::kLeastSize, Keyframe::kMostSize)) {
        return Wrong{words.size,
                     fmt::format("found {}; allowed: {} to {}", key.size, Keyframe::kLeastSize, Keyframe::kMostSize)};
    }
    return std::nullopt;
}

void read_vector(TomlTable& table, std::string_view key, glm::dvec3& value) {
    std::vector<double> numbers;
    if (table.find(key) == nullptr) return;
    table.numbers(key, numbers);
    if (numbers.size() == 3) {
        value = {numbers[0], numbers[1], numbers[2]};
    } else if (!numbers.empty()) {
        table.note(key, fmt::format("found {} numbers; allowed: three", numbers.size()));
    }
}

void read_track(TomlTable& top, TrackKind kind, std::vector<Keyframe>& track, Mistakes& mistakes) {
    const Words names = words(kind);
    const TomlNode* list = top.find(names.track);
    if (list == nullptr) return;
    const std::string allowed = fmt::format("one [[{}]] table for each keyframe", names.track);
    if (list->type != TomlNode::Type::List) return top.wrong(*list, names.track, allowed);
    if (list->items.empty() || list->items.size() > Timeline::kMostKeys) {
        return top.note(names.track,
                        fmt::format("found {} keyframes; allowed: 1 to {}", list->items.size(), Timeline::kMostKeys));
    }
    const std::array keys{Key{"at"}, Key{names.place_mm}, Key{"turn_deg"}, Key{names.size}, Key{"ease"}};
    Keyframe key;
    for (std::size_t i = 0; i < list->items.size(); ++i) {
        const TomlNode& node = list->items[i];
        if (node.type != TomlNode::Type::Table) return top.wrong(node, names.track, allowed);
        const std::string place = fmt::format("{} {}: ", names.track, i + 1);
        TomlTable table(node, place, mistakes);
        table.refuse_unknown(keys);
        if (node.find("at") == nullptr) table.note_missing("at");
        table.number("at", key.at_seconds);
        read_vector(table, names.place_mm, key.place_mm);
        read_vector(table, "turn_deg", key.turn_deg);
        table.number(names.size, key.size);
        table.choice("ease", kEaseNames, key.ease);
        const bool sound =
            std::ranges::none_of(keys, [&](const Key& known) { return mistakes.is_spoilt(node, known.name); });
        if (!sound || node.find("at") == nullptr) return;
        if (const auto wrong = find_wrong(key, track.empty() ? nullptr : &track.back(), names)) {
            const std::string_view in_file = wrong->name == names.place ? names.place_mm
                                             : wrong->name == "turn"    ? "turn_deg"
                                                                        : wrong->name;
            return table.note(in_file, wrong->message);
        }
        track.push_back(key);
    }
}

/// All of `text` as a finite number.
bool read_number(std::string_view text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

bool read_three(std::string_view text, glm::dvec3& value) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = axis < 2 ? text.find(',') : text.size();
        if (comma == text.npos || !read_number(text.substr(0, comma), value[axis])) return false;
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return true;
}

/// Takes what stands before the first of `separators` off the front of `text`.
std::string_view cut(std::string_view& text, std::string_view separators) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    const std::string_view front = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return front;
}

/// One `name=value` of a keyframe.
Expected<void> read_setting(std::string_view setting, const Words& names, Keyframe& key) {
    const std::size_t equals = setting.find('=');
    const std::string_view name = setting.substr(0, equals);
    const std::string_view value = equals == setting.npos ? "" : setting.substr(equals + 1);
    const auto refuse = [&setting](std::string_view allowed) {
        return fail(fmt::format("found {}; allowed: {}", display::in_quotes(setting), allowed));
    };
    if (name == "at") return read_number(value, key.at_seconds) ? Expected<void>() : refuse("at=SECONDS");
    if (name == "turn") return read_three(value, key.turn_deg) ? Expected<void>() : refuse("turn=X,Y,Z in degrees");
    if (name == names.place) {
        return read_three(value, key.place_mm) ? Expected<void>()
                                               : refuse(fmt::format("{}=X,Y,Z in millimetres", names.place));
    }
    if (name == names.size)
        return read_number(value, key.size) ? Expected<void>() : refuse(fmt::format("{}=NUMBER", names.size));
    if (name == "ease") {
        for (const Named<Ease>& ease : kEaseNames) {
            if (ease.name != value) continue;
            key.ease = ease.value;
            return {};
        }
        return refuse("ease=linear, ease=smooth, ease=curve or ease=step");
    }
    return refuse(fmt::format("at=, {}=, turn=, {}= and ease=", names.place, names.size));
}

}  // namespace

Expected<Timeline> parse_timeline(std::string_view toml, std::string_view source) {
    if (toml.size() > kMostBytes) return fail(fmt::format("{}: larger than 1 MiB, which no timeline is", source));
    const auto root = display::parse_toml(toml);
    if (!root) return fail(fmt::format("{}: line {}: {}", source, root.error().line, root.error().message));
    Timeline timeline;
    Mistakes mistakes;
    TomlTable top(*root, "", mistakes);
    constexpr Key kKeys[] = {{"seconds"}, {"loop"}, {"motion"}, {"camera"}};
    top.refuse_unknown(kKeys);
    top.number("seconds", timeline.seconds);
    if (top.find("seconds") != nullptr && !mistakes.is_spoilt(*root, "seconds") &&
        !(timeline.seconds > 0.0 && timeline.seconds <= Keyframe::kMostSeconds)) {
        top.note("seconds",
                 fmt::format("found {}; allowed: above 0, at most {}", timeline.seconds, Keyframe::kMostSeconds));
    }
    top.truth("loop", timeline.loop);
    read_track(top, TrackKind::Motion, timeline.motion, mistakes);
    read_track(top, TrackKind::Camera, timeline.camera, mistakes);
    if (mistakes.list.empty() && timeline.motion.empty() && timeline.camera.empty()) {
        return fail(fmt::format("{}: nothing moves: it has neither [[motion]] nor [[camera]] keyframes", source));
    }
    if (mistakes.list.empty()) return timeline;
    const auto first = std::ranges::min_element(mistakes.list, {}, &DisplayMistake::line);
    return fail(fmt::format("{}: line {}: {}", source, first->line, first->message));
}

Expected<std::vector<Keyframe>> parse_track(std::string_view text, TrackKind kind) {
    const Words names = words(kind);
    std::vector<Keyframe> track;
    Keyframe key;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const auto refuse = [number](const std::string& message) {
            return fail(fmt::format("keyframe {}: {}", number, message));
        };
        std::string_view rest = cut(text, ";");
        std::vector<std::string_view> named;
        while (!rest.empty()) {
            const std::string_view setting = cut(rest, " \t");
            if (setting.empty()) continue;
            const std::string_view name = setting.substr(0, setting.find('='));
            if (std::ranges::find(named, name) != named.end()) {
                return refuse(
                    fmt::format("{} stands in it twice; is a semicolon missing between two keyframes?", name));
            }
            named.push_back(name);
            if (const auto read = read_setting(setting, names, key); !read) return refuse(read.error().message);
        }
        if (std::ranges::find(named, "at") == named.end())
            return refuse("it has no time; allowed: at=SECONDS in each, as in \"at=0; at=4 turn=0,0,360\"");
        if (const auto wrong = find_wrong(key, track.empty() ? nullptr : &track.back(), names)) {
            return refuse(fmt::format("{}: {}", wrong->name, wrong->message));
        }
        if (track.size() == Timeline::kMostKeys)
            return fail(fmt::format("more than {} keyframes", Timeline::kMostKeys));
        track.push_back(key);
    }
    if (track.empty()) return fail("no keyframe; allowed: as in \"at=0; at=4 turn=0,0,360\"");
    return track;
}

}  // namespace xorvox::host
