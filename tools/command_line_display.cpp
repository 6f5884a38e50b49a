// The commands about displays: show, play, share, sim, displays, validate, plan, pattern and control.
#include <fmt/format.h>

#include "tools/color_choice.h"
#include "tools/command_line.h"

namespace xorvox::tools {
namespace {

/// "960x720" into pixels.
PictureSize parse_size(const std::string& option, const std::string& text) {
    const std::size_t cross = text.find('x');
    if (cross == text.npos) throw CLI::ValidationError(option, fmt::format("'{}' is not WxH, as in 960x720", text));
    return {parse_count(option, text.substr(0, cross), 4096), parse_count(option, text.substr(cross + 1), 4096)};
}

}  // namespace

void add_display(CLI::App& app, std::string& display) {
    app.add_option("--display", display, "A preset (see xorvox displays) or a display file")
        ->required()
        ->type_name("NAME|FILE.toml");
}

void add_delivery(CLI::App& app, DeliveryOptions& options) {
    app.add_option("--to", options.to,
                   "Where it goes: loopback (a simulated display in this program, the default), tcp:HOST:PORT, or "
                   "file:PATH")
        ->type_name("ADDRESS");
    app.add_option("--png", options.png, "A picture of the light; needs --to loopback")->type_name("OUT.png");
    app.add_option("--view", options.view,
                   "What --png draws: perspective (the default), or orthographic: front, side and top")
        ->check(CLI::IsMember({"perspective", "orthographic"}).description(""))
        ->type_name("perspective|orthographic");
    app.add_option("--frame", options.frame,
                   "What --png shows: object, what is lit, as large as it fits (the default of show), or display, all "
                   "of it, with +x and the axis marked (of pattern)")
        ->check(CLI::IsMember({"object", "display"}).description(""))
        ->type_name("object|display");
    app.add_option("--built", options.built,
                   "The display as it is really built, where it differs from its file: shows what a mistake in the "
                   "file looks like; needs --to loopback")
        ->type_name("NAME|FILE.toml");
    add_simulation(app, options.simulation);
    add_instruments(app, options.simulation);
    app.add_option_function<std::string>(
           "--size", [&options](const std::string& text) { options.size = parse_size("--size", text); },
           "Pixels of --png (default 960x720); an orthographic one has three square views and only a width counts")
        ->type_name("WxH");
    app.add_option("--record", options.record, "What passes the link, as a recording (docs/recordings.md)")
        ->type_name("F.xvr");
    app.add_flag("--hold", options.hold,
                 "Stay until interrupted. Without it a display goes dark when its watchdog (2 s) misses the host");
    app.add_flag("--json", options.json, "What was sent and what lit up, as one JSON object on standard output");
}

CLI::Option* add_positive(CLI::App& app, const std::string& name, std::function<void(double)> set,
                          const std::string& type, const std::string& help) {
    return app
        .add_option_function<std::string>(
            name, [name, set](const std::string& text) { set(parse_positive(name, text)); }, help)
        ->type_name(type);
}

void add_looks(CLI::App& app, StageOptions& options) {
    add_strict(app, options.mesh);
    add_display(app, options.display);
    app.add_option("--color", options.color,
                   "Which colour each lit voxel has (default: own if there are any, else gradient): " + color_kinds() +
                       ". COLOR is a name as in CSS or #rrggbb, and a wrong one lists them all; own is the model's own "
                       "colours. "
                       "docs/color.md shows each kind")
        ->check(CLI::Validator([](const std::string& text) { return text.empty() ? "is empty" : ""; }, ""))
        ->type_name("KIND:ARGS");
    add_volume(app, options.volume);
    add_transfer(app, options.volume);
    add_light(app, options.light);
    app.add_option(
           "--sampling", options.sampling,
           "native: voxelize at the display's own samples, exactly (the default); cartesian: on a grid of cubes "
           "first, which the samples then take the nearest voxel of")
        ->check(CLI::IsMember({"native", "cartesian"}).description(""))
        ->type_name("native|cartesian");
}

void add_motion(CLI::App& app, PlayOptions& options) {
    app.add_option("files", options.files, "A model, or several that are shown one after the other")
        ->required()
        ->type_name("FILE");
    add_reading(app, options.stage.mesh);
    CLI::Option* const timeline =
        app.add_option("--timeline", options.timeline, "How it moves: keyframes in a file")->type_name("FILE.toml");
    app.add_option("--motion", options.motion,
                   "The same as typed: how the model moves and turns, as in 'at=0; at=4 turn=0,0,360 move=0,0,10'")
        ->excludes(timeline)
        ->type_name("KEYFRAMES");
    app.add_option("--camera", options.camera,
                   "How the display moves through the scene, as in 'at=0; at=5 center=10,0,0 zoom=3 ease=smooth'")
        ->excludes(timeline)
        ->type_name("KEYFRAMES");
    add_positive(
        app, "--spin", [&options](double rpm) { options.spin_rpm = rpm; }, "RPM",
        "Turn the model about its upright axis so many times a minute");
    add_positive(
        app, "--fps", [&options](double fps) { options.stage.files_per_second = fps; }, "N",
        "Files, or frames of a file that has no time of its own, a second (default 10)");
    app.add_option("--animation", options.stage.animation,
                   "Which of the file's animations, by its name or number from 0 (default the first; xorvox info lists "
                   "them)")
        ->type_name("NAME|N");
    app.parse_complete_callback([&options] {
        if (options.files.empty()) return;
        options.stage.mesh.path = options.files.front();
        options.stage.following.assign(options.files.begin() + 1, options.files.end());
    });
}

namespace {

/// What is shown, on what and how; for show and play.
void add_stage(CLI::App& app, StageOptions& options) {
    add_looks(app, options);
    add_delivery(app, options.delivery);
}

Command show_command(CLI::App& program, ShowOptions& options) {
    CLI::App& app = *program.add_subcommand("show", "Show a mesh on a display, or on a simulated one");
    add_mesh(app, options.stage.mesh);
    add_stage(app, options.stage);
    CLI::Option* const spin = add_positive(
        app, "--spin", [&options](double rpm) { options.spin_rpm = rpm; }, "RPM",
        "Turn the model about its upright axis so many times a minute, a new frame each time the display can show one, "
        "and tell how steadily they came");
    add_positive(
        app, "--seconds", [&options](double seconds) { options.seconds = seconds; }, "S",
        "How long to spin (default 10)")
        ->needs(spin);
    examples(app,
             "  xorvox show bunny.ply --up y --display vortex --png bunny.png\n"
             "  xorvox show bunny.ply --up y --display cube16-ws2812 --color constant:orange --to tcp:127.0.0.1:7777\n"
             "  xorvox show bunny.ply --up y --display vortex --spin 6 --seconds 20 --to tcp:127.0.0.1:7777");
    return {&app, [&options] { return show(options); }};
}

Command play_command(CLI::App& program, PlayOptions& options) {
    CLI::App& app = *program.add_subcommand(
        "play", "Show what moves: a model by keyframes, a sequence of files, an animation; see docs/play.md");
    add_motion(app, options);
    add_stage(app, options.stage);
    add_positive(
        app, "--seconds", [&options](double seconds) { options.seconds = seconds; }, "S",
        "How long to play (default: until all has moved once)");
    app.add_flag("--loop", options.loop, "Begin anew at the end, until interrupted or for --seconds");
    examples(app,
             "  xorvox play bunny.ply --up y --display vortex --motion 'at=0; at=4 turn=0,0,360' --png last.png\n"
             "  xorvox play walk*.obj --fps 12 --loop --display cube16-ws2812 --to tcp:127.0.0.1:7777\n"
             "  xorvox play bunny.ply --up y --display vortex --timeline flight.toml --to tcp:127.0.0.1:7777");
    return {&app, [&options] { return play(options); }};
}

Command sim_command(CLI::App& program, SimOptions& options) {
    CLI::App& app =
        *program.add_subcommand("sim", "Be a display: wait for clients and say what lights up, until killed");
    app.add_option("--display", options.display, "A preset (see xorvox displays) or a display file")
        ->capture_default_str()
        ->type_name("NAME|FILE.toml");
    app.add_option("--listen", options.listen, "Where clients connect: tcp:PORT (on 127.0.0.1) or tcp:HOST:PORT")
        ->required()
        ->type_name("ADDRESS");
    add_simulation(app, options.simulation);
    add_instruments(app, options.simulation);
    app.add_option("--record", options.record, "What passes, as a recording (docs/recordings.md), whole once it ends")
        ->type_name("F.xvr");
    app.add_flag("--json", options.json, "One JSON object a line on standard output, for every frame shown");
    examples(app,
             "  xorvox sim --display vortex --listen tcp:7777\n"
             "  xorvox sim --display vortex --listen tcp:7777 --fault lost-packets:part=0.1\n"
             "  xorvox sim --display vortex --listen tcp:7777 --record seen.xvr");
    return {&app, [&options] { return tools::sim(options); }};
}

Command displays_command(CLI::App& program, DisplaysOptions& options) {
    CLI::App& app = *program.add_subcommand("displays", "List the displays that are built in, or describe one");
    app.add_option("display", options.display, "A preset or a display file, to be described in full")
        ->type_name("NAME|FILE.toml");
    CLI::Option* const cpp =
        app.add_flag("--cpp", options.cpp, "The display as a C++ header, for firmware, on standard output");
    app.add_flag("--json", options.json, "JSON on standard output: an array of all, or one object")->excludes(cpp);
    app.parse_complete_callback([&options] {
        if (options.cpp && options.display.empty()) {
            throw CLI::ValidationError("--cpp", "needs the name of a display, as in xorvox displays vortex --cpp");
        }
    });
    examples(app, "  xorvox displays\n  xorvox displays vortex\n  xorvox displays mine.toml --cpp > mine.h");
    return {&app, [&options] { return displays(options); }};
}

Command validate_command(CLI::App& program, ValidateOptions& options) {
    CLI::App& app = *program.add_subcommand(
        "validate", "Check display files: every mistake by line; exit status 2 if there is one");
    app.add_option("files", options.files, "Display files")->required()->type_name("FILE.toml");
    app.add_flag("--json", options.json, "One JSON array on standard output");
    examples(app, "  xorvox validate mine.toml");
    return {&app, [&options] { return validate(options); }};
}

Command plan_command(CLI::App& program, PlanOptions& options) {
    CLI::App& app =
        *program.add_subcommand("plan", "Will it fit? What a display needs of a link, of its driver and of its memory");
    app.add_option("display", options.display, "A preset (see xorvox displays) or a display file")
        ->required()
        ->type_name("NAME|FILE.toml");
    app.add_option("--link", options.link, "usb-hs (the default), usb-fs, hid-hs, hid-fs, tcp or gpio")
        ->type_name("LINK");
    add_positive(
        app, "--gpio-rate", [&options](double hz) { options.gpio_rate_hz = hz; }, "HZ",
        "Of --link gpio: how often a second its 8 lines change, one byte each time (1 to 1e10)");
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app,
             "  xorvox plan vortex\n  xorvox plan cube8-595 --link hid-fs\n  xorvox plan mine.toml --link gpio "
             "--gpio-rate 2000000");
    return {&app, [&options] { return plan(options); }};
}

Command pattern_command(CLI::App& program, PatternOptions& options) {
    CLI::App& app = *program.add_subcommand(
        "pattern", "Show a bring-up pattern on a display: which panel is wrong, is the axis off; see docs/bring-up.md");
    app.add_option("display", options.display, "A preset (see xorvox displays) or a display file")
        ->required()
        ->type_name("NAME|FILE.toml");
    app.add_option("pattern", options.name, "The pattern's name; without one they are listed")->type_name("PATTERN");
    add_positive(
        app, "--seconds", [&options](double seconds) { options.seconds = seconds; }, "S",
        "How long a pattern that moves is shown (default: once through it)");
    add_delivery(app, options.delivery);
    examples(app,
             "  xorvox pattern vortex\n  xorvox pattern vortex panels --png panels.png\n"
             "  xorvox pattern vortex axis --fault off-axis:panel=1,mm=3 --png off-axis.png\n"
             "  xorvox pattern mine.toml walk --to tcp:127.0.0.1:7777");
    return {&app, [&options] { return pattern(options); }};
}

Command share_command(CLI::App& program, ShareOptions& options) {
    CLI::App& app = *program.add_subcommand(
        "share", "Let other programs draw on a display, through shared memory (docs/share.md), until interrupted");
    add_display(app, options.display);
    app.add_option("--socket", options.socket, "Where they connect: a path, at which a Unix socket is made")
        ->required()
        ->type_name("PATH");
    add_positive(
        app, "--seconds", [&options](double seconds) { options.seconds = seconds; }, "S",
        "How long (default: until interrupted)");
    app.add_option_function<std::string>(
           "--frames",
           [&options](const std::string& text) { options.frames = parse_count("--frames", text, 1'000'000'000); },
           "End when so many frames were drawn and the last one was shown (default: any number)")
        ->type_name("N");
    add_delivery(app, options.delivery);
    examples(app,
             "  xorvox share --display vortex --socket /tmp/vortex --to tcp:127.0.0.1:7777\n"
             "  xorvox share --display cube16-ws2812 --socket /tmp/cube --frames 100 --png cube.png");
    return {&app, [&options] { return share(options); }};
}

Command control_command(CLI::App& program, ControlOptions& options) {
    CLI::App& app = *program.add_subcommand(
        "control", "Ask a distant display how it is, and tell it: clear a fault, brightness, dark, watchdog");
    add_display(app, options.display);
    app.add_option("--to", options.to, "Where it is: tcp:HOST:PORT")->required()->type_name("ADDRESS");
    const auto add_count = [&app](const std::string& name, std::optional<std::uint32_t>& value, std::uint32_t most,
                                  const std::string& type, const std::string& help) {
        app.add_option_function<std::string>(
               name, [name, &value, most](const std::string& text) { value = parse_count(name, text, most); }, help)
            ->type_name(type);
    };
    add_count("--clear-fault", options.clear_fault, 7, "N",
              "Clear the fault of this number, once its cause is gone (docs/safety.md)");
    add_count("--brightness", options.brightness, 255, "N", "Of all light: 0 to 255");
    add_count("--watchdog", options.watchdog_ms, 3'600'000, "MS",
              "After how long without a host it goes dark, in milliseconds; 0: never");
    CLI::Option* const blank = app.add_flag_callback(
        "--blank", [&options] { options.blank = true; }, "Go dark");
    app.add_flag_callback(
           "--light", [&options] { options.blank = false; }, "Show the picture again")
        ->excludes(blank);
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app,
             "  xorvox control --display vortex --to tcp:127.0.0.1:7777\n"
             "  xorvox control --display vortex --to tcp:127.0.0.1:7777 --clear-fault 4 --brightness 100");
    return {&app, [&options] { return control(options); }};
}

Command uniformity_command(CLI::App& program, UniformityOptions& options) {
    CLI::App& app = *program.add_subcommand(
        "uniformity", "How even the light of displays is in space, as it comes and corrected; see docs/light.md");
    app.add_option("displays", options.displays, "Presets or display files (default: every preset)")
        ->type_name("NAME|FILE.toml");
    app.add_option_function<std::string>(
           "--frames",
           [&options](const std::string& text) {
               options.frames = parse_count("--frames", text, 1024);
               if (options.frames == 0) throw CLI::ValidationError("--frames", "takes 1 or more");
           },
           "Over how many frames light that is dithered in time is summed: 1 to 1024 (default 8; it repeats after 64)")
        ->type_name("N");
    app.add_flag("--json", options.json, "One JSON array on standard output");
    examples(app, "  xorvox uniformity\n  xorvox uniformity vortex mine.toml --frames 16");
    return {&app, [&options] { return uniformity(options); }};
}

}  // namespace

std::vector<Command> display_commands(CLI::App& program, AllOptions& options) {
    return {show_command(program, options.show),
            play_command(program, options.play),
            share_command(program, options.share),
            sim_command(program, options.sim),
            displays_command(program, options.displays),
            validate_command(program, options.validate),
            plan_command(program, options.plan),
            pattern_command(program, options.pattern),
            uniformity_command(program, options.uniformity),
            control_command(program, options.control)};
}

}  // namespace xorvox::tools
