// The commands about recordings: record, replay and diff.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/command_line.h"

namespace xorvox::tools {
namespace {

constexpr int kDifferent = 1;  ///< Exit status of diff.

/// "1.5" into a number, 0 or above.
double parse_zero_or_more(const std::string& option, const std::string& text) {
    const std::vector<double> numbers = parse_numbers(text);
    if (numbers.size() != 1 || !(numbers[0] >= 0.0) || !std::isfinite(numbers[0])) {
        throw CLI::ValidationError(option, fmt::format("'{}' is not a number, 0 or above", text));
    }
    return numbers[0];
}

Command record_command(CLI::App& program, PlayOptions& options) {
    CLI::App& app = *program.add_subcommand(
        "record", "Record what a host sends to a display that shows something, and what it answers, in a file");
    add_motion(app, options);
    add_looks(app, options.stage);
    app.add_option_function<std::string>(
           "--frames",
           [&options](const std::string& text) {
               options.frames = parse_count("--frames", text, 1'000'000'000);
               if (options.frames == 0) throw CLI::ValidationError("--frames", "takes 1 or more");
           },
           "How many frames, one for each cycle of the display (default 1)")
        ->type_name("N");
    app.add_option("-o,--output", options.stage.delivery.record, "The recording")
        ->required()
        ->type_name("F.xvr")
        ->check([](const std::string& name) {
            return name.ends_with(".xvr") ? std::string()
                                          : fmt::format("'{}' does not end in .xvr, as a recording's name does", name);
        });
    app.add_flag("--json", options.stage.delivery.json, "What was sent and what lit up, as one JSON object");
    options.frames = 1;
    examples(
        app,
        "  xorvox record bunny.ply --up y --display vortex -o bunny.xvr\n"
        "  xorvox record bunny.ply --up y --display vortex --spin 30 --frames 40 -o turning.xvr\n"
        "The display is simulated, in simulated time: the same input gives the same bytes. What goes to a real one "
        "is\nrecorded by --record of show, play, pattern and share. docs/recordings.md describes the file.");
    return {&app, [&options] { return play(options); }};
}

Command replay_command(CLI::App& program, ReplayOptions& options) {
    CLI::App& app = *program.add_subcommand(
        "replay", "Play a recording to a simulated display, packet by packet, or to another one, frame by frame");
    app.add_option("recording", options.file, "The recording")->required()->type_name("F.xvr");
    app.add_option_function<std::string>(
           "--speed",
           [&options](const std::string& text) {
               options.speed = text == "max" ? 0.0 : parse_zero_or_more("--speed", text);
           },
           "How many times as fast as it was recorded (default 1); max, or 0, is as fast as it goes. The time of a "
           "display in this program is simulated: nobody waits, and max is 1")
        ->type_name("X|max");
    app.add_option_function<std::string>(
           "--seek", [&options](const std::string& text) { options.seek_seconds = parse_zero_or_more("--seek", text); },
           "Begin at this moment of the recording, in seconds (default 0)")
        ->type_name("T");
    app.add_option("--display", options.display,
                   "Instead of the display that was recorded: a preset or display file of the same geometry")
        ->type_name("NAME|FILE.toml");
    app.add_flag("--keep-going", options.keep_going, "Play what is whole of a damaged recording, with warnings");
    add_delivery(app, options.delivery);
    examples(app,
             "  xorvox replay bunny.xvr --png bunny.png\n"
             "  xorvox replay turning.xvr --seek 1.5 --speed 0.5 --to tcp:127.0.0.1:7777\n"
             "  xorvox replay cut.xvr --keep-going");
    return {&app, [&options] { return replay(options); }};
}

Command diff_command(CLI::App& program, DiffOptions& options, int& exit_status) {
    CLI::App& app = *program.add_subcommand(
        "diff", "Whether two recordings show the same; exit status 0: equal, 1: different, 2: an error");
    app.add_option("a", options.a, "A recording")->required()->type_name("A.xvr");
    app.add_option("b", options.b, "Another one")->required()->type_name("B.xvr");
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app,
             "  xorvox diff before.xvr after.xvr\n"
             "Compared are the frames, pixel by pixel. When they were sent, in which packets and how packed does not "
             "matter.");
    return {&app, [&options, &exit_status]() -> Expected<void> {
                const Expected<bool> same = diff(options);
                if (!same) return tl::unexpected(same.error());
                exit_status = *same ? 0 : kDifferent;
                return {};
            }};
}

}  // namespace

std::vector<Command> recording_commands(CLI::App& program, AllOptions& options) {
    return {record_command(program, options.record), replay_command(program, options.replay),
            diff_command(program, options.diff, options.exit_status)};
}

}  // namespace xorvox::tools
