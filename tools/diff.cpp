// diff: whether two recordings show the same, and where they first do not.
#include <string>

#include <fmt/format.h>

#include "sim/recording/difference.h"
#include "sim/recording/reader.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/placement.h"

namespace xorvox::tools {
namespace {

using What = sim::RecordingDifference::What;

std::string to_json(const sim::RecordingDifference& difference, const std::string& words) {
    const char* const what = difference.what == What::Geometry  ? "geometry"
                             : difference.what == What::MoreInA ? "more_in_a"
                             : difference.what == What::MoreInB ? "more_in_b"
                                                                : "frame";
    std::string pixel = "null";
    if (difference.what == What::Frame) {
        const sim::PixelDifference& first = difference.pixels.first;
        pixel = fmt::format(
            "{{\"slice\": {}, \"panel\": {}, \"row\": {}, \"column\": {}, \"code_a\": {}, \"code_b\": {}, "
            "\"pixels_differ\": {}}}",
            first.slice, first.panel, first.row, first.column, first.code_a, first.code_b, difference.pixels.pixels);
    }
    return fmt::format("{{\"equal\": false, \"what\": \"{}\", \"frame\": {}, \"pixel\": {}, \"words\": {}}}", what,
                       difference.frame, pixel, json_string(words));
}

}  // namespace

Expected<bool> diff(const DiffOptions& options) {
    Expected<sim::RecordingReader> a = sim::open_recording(options.a);
    if (!a) return tl::unexpected(a.error());
    Expected<sim::RecordingReader> b = sim::open_recording(options.b);
    if (!b) return tl::unexpected(b.error());
    for (const sim::RecordingReader* recording : {&*a, &*b}) {
        if (const auto fits = check_display_fits(*recording->display()); !fits) {
            return fail(recording->name() + ": " + fits.error().message);
        }
    }
    const auto difference = sim::compare_recordings(*a, *b);
    if (!difference) return tl::unexpected(difference.error());
    if (!*difference) {
        options.json ? fmt::print("{{\"equal\": true, \"frames\": {}}}\n", a->frames().size())
                     : fmt::print("equal: {} frame{}\n", a->frames().size(), a->frames().size() == 1 ? "" : "s");
        return true;
    }
    const std::string words = sim::describe(**difference, *a, *b);
    options.json ? fmt::print("{}\n", to_json(**difference, words)) : fmt::print("different: {}\n", words);
    return false;
}

}  // namespace xorvox::tools
