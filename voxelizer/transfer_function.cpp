#include "voxelizer/transfer_function.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace xorvox {
namespace {

constexpr std::size_t kMostStops = 256;

bool parse_number(std::string_view text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

// The part of `text` before the next `mark`, which is cut off with it.
std::string_view take(std::string_view& text, char mark) {
    const std::size_t end = std::min(text.find(mark), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return part;
}

}  // namespace

TransferFunction::TransferFunction(std::vector<Stop> stops) {
    // Colour and opacity are mixed together, so that a clear stop lends nothing of its colour.
    for (const Stop& stop : stops) nodes_.push_back({stop.value, stop.color * stop.opacity});
}

Expected<TransferFunction> TransferFunction::parse(
    std::string_view text, const std::function<Expected<glm::dvec3>(std::string_view)>& parse_color) {
    std::vector<Stop> stops;
    if (text.empty() || text.ends_with(',')) {
        return fail(fmt::format("transfer \"{}\": a stop VALUE:COLOR is missing, as in 0:black,1:white", text));
    }
    for (std::string_view rest = text; !rest.empty();) {
        const std::string_view all = take(rest, ',');
        const auto wrong = [&](std::string_view why) {
            return fail(fmt::format("transfer: stop {}, \"{}\": {}", stops.size() + 1, all, why));
        };
        std::string_view parts = all;
        Stop stop;
        if (!parse_number(take(parts, ':'), stop.value) || parts.empty()) {
            return wrong("it takes VALUE:COLOR or VALUE:COLOR:OPACITY, as in 0.3:#ff8000:0.5");
        }
        const auto color = parse_color(take(parts, ':'));
        if (!color) return wrong(color.error().message);
        stop.color = *color;
        if (!parts.empty() && (!parse_number(parts, stop.opacity) || stop.opacity < 0.0 || stop.opacity > 1.0)) {
            return wrong(fmt::format("the opacity {} is not a number from 0 to 1", parts));
        }
        if (!stops.empty() && stop.value <= stops.back().value) return wrong("values must increase from stop to stop");
        if (stops.size() == kMostStops) return wrong(fmt::format("more than {} stops", kMostStops));
        stops.push_back(stop);
    }
    return TransferFunction(std::move(stops));
}

glm::vec3 TransferFunction::at(double value) const {
    const auto upper = std::ranges::upper_bound(nodes_, value, {}, &Node::value);
    if (upper == nodes_.begin()) return glm::vec3(nodes_.front().light);
    const Node& a = *(upper - 1);
    if (upper == nodes_.end()) return glm::vec3(a.light);
    return glm::vec3(a.light + (upper->light - a.light) * ((value - a.value) / (upper->value - a.value)));
}

}  // namespace xorvox
