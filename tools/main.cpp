// The command line. The only file that includes CLI11, which is slow to compile.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "tools/commands.h"
#include "tools/console.h"

namespace {

using namespace xorvox;
using namespace xorvox::tools;

constexpr int kFailure = 2;

/// "64" into a number of voxels.
std::uint32_t parse_count(const std::string& option, const std::string& text) {
    std::uint32_t number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || stop != text.data() + text.size()) {
        throw CLI::ValidationError(option, fmt::format("'{}' is not a whole number", text));
    }
    return number;
}

/// "1,2.5,3" into a vector; one number stands for three where `one_for_all`.
glm::dvec3 parse_vector(const std::string& option, const std::string& text, bool one_for_all) {
    std::vector<double> numbers;
    std::size_t at = 0;
    while (at <= text.size()) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        double number = 0.0;
        const char* end = text.data() + comma;
        const auto [stop, error] = std::from_chars(text.data() + at, end, number);
        if (error != std::errc() || stop != end) numbers.clear();
        if (error != std::errc() || stop != end) break;
        numbers.push_back(number);
        at = comma + 1;
    }
    if (numbers.size() == 1 && one_for_all) return glm::dvec3(numbers[0]);
    if (numbers.size() != 3) {
        throw CLI::ValidationError(
            option, fmt::format("'{}' is not {}three numbers with commas between them, as in 1,2,3", text,
                                one_for_all ? "one number or " : ""));
    }
    return {numbers[0], numbers[1], numbers[2]};
}

void add_vector(CLI::App& app, const std::string& name, std::optional<glm::dvec3>& value, bool one_for_all,
                const std::string& type, const std::string& help) {
    app.add_option_function<std::string>(
           name,
           [name, &value, one_for_all](const std::string& text) { value = parse_vector(name, text, one_for_all); },
           help)
        ->type_name(type);
}

void add_mesh(CLI::App& app, MeshOptions& mesh) {
    app.add_option("mesh", mesh.path, "The mesh: a .ply, .stl or .obj file")->required()->type_name("MESH");
    app.add_option("--unit", mesh.unit, "The unit of the file's numbers, which then become millimetres")
        ->type_name("mm|cm|m|in|ft");
    app.add_option("--up", mesh.up,
                   "The axis that points up in the file; the mesh is turned so that it is z (default z)")
        ->type_name("x|y|z");
}

void add_strict(CLI::App& app, MeshOptions& mesh) {
    app.add_flag("--strict", mesh.strict, "Refuse a mesh with open edges, instead of a warning");
}

/// What a subcommand is, and what runs when it was given.
struct Command {
    CLI::App* app = nullptr;
    std::function<Expected<void>()> run;
};

void examples(CLI::App& app, const std::string& text) {
    app.footer("Examples:\n" + text);
}

Command info_command(CLI::App& program, InfoOptions& options) {
    CLI::App& app = *program.add_subcommand("info", "Say what a mesh is: size, holes, faults, volume");
    add_mesh(app, options.mesh);
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app, "  xorvox info bunny.ply\n  xorvox info part.stl --unit in --json");
    return {&app, [&options] { return info(options); }};
}

Command voxelize_command(CLI::App& program, VoxelizeOptions& options) {
    CLI::App& app = *program.add_subcommand("voxelize", "Turn a closed mesh into a volume of bits, exactly");
    add_mesh(app, options.mesh);
    add_strict(app, options.mesh);
    app.add_option("-o,--output", options.output, "The volume: .nrrd, .binvox or .bits")->required()->type_name("OUT");
    CLI::Option* size =
        app.add_option_function<std::string>(
               "--size", [&options](const std::string& text) { options.grid.size = parse_count("--size", text); },
               "A cube of N voxels a side around the mesh, 1/64 of room on each side (default 64)")
            ->type_name("N");
    add_vector(app, "--grid", options.grid.grid, false, "NX,NY,NZ",
               "Voxels along x, y and z; needs --origin and --pitch");
    add_vector(app, "--origin", options.grid.origin, false, "X,Y,Z",
               "The outer corner of voxel 0,0,0, in the units of the mesh (mm with --unit)");
    add_vector(app, "--pitch", options.grid.pitch, true, "P[,PY,PZ]", "The size of a voxel");
    size->excludes("--grid")->excludes("--origin")->excludes("--pitch");
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app,
             "  xorvox voxelize bunny.ply --size 256 -o bunny.nrrd\n"
             "  xorvox voxelize part.stl --grid 100,80,40 --origin 0,0,0 --pitch 0.5 -o part.binvox");
    return {&app, [&options] { return voxelize(options); }};
}

Command show_command(CLI::App& program, ShowOptions& options) {
    CLI::App& app = *program.add_subcommand("show", "Show a mesh on a display, or on a simulated one");
    add_mesh(app, options.mesh);
    add_strict(app, options.mesh);
    app.add_option("--display", options.display, "A preset (see xorvox displays) or a display file")
        ->required()
        ->type_name("NAME|FILE.toml");
    app.add_option("--to", options.to,
                   "Where it goes: loopback (a simulated display in this program, the default), tcp:HOST:PORT, or "
                   "file:PATH")
        ->type_name("ADDRESS");
    app.add_option(
           "--color", options.color,
           "constant:NAME, constant:#rrggbb, gradient (the default), gradient:NAME,NAME from bottom to top, noise "
           "or noise:SCALE; NAME is a colour as in CSS, and a wrong one lists them all")
        ->type_name("KIND:ARGS");
    app.add_option("--png", options.png, "A picture of the light; needs --to loopback")->type_name("OUT.png");
    app.add_option("--view", options.view,
                   "What --png draws: perspective (the default), or orthographic: front, side and top")
        ->check(CLI::IsMember({"perspective", "orthographic"}))
        ->type_name("VIEW");
    app.add_flag("--hold", options.hold,
                 "Stay until interrupted. Without it a display goes dark when its watchdog (2 s) misses the host");
    app.add_flag("--json", options.json, "What was sent and what lit up, as one JSON object on standard output");
    examples(app,
             "  xorvox show bunny.ply --up y --display vortex --png bunny.png\n"
             "  xorvox show bunny.ply --up y --display cube16-ws2812 --color constant:orange --to tcp:127.0.0.1:7777");
    return {&app, [&options] { return show(options); }};
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
    app.add_flag("--json", options.json, "One JSON object a line on standard output, for every frame shown");
    examples(app, "  xorvox sim --display vortex --listen tcp:7777");
    return {&app, [&options] { return sim(options); }};
}

Command displays_command(CLI::App& program, DisplaysOptions& options) {
    CLI::App& app = *program.add_subcommand("displays", "List the displays that are built in, one a line, name first");
    app.add_flag("--json", options.json, "One JSON array on standard output");
    examples(app, "  xorvox displays");
    return {&app, [&options] { return displays(options); }};
}

std::vector<std::string> command_names(const std::vector<Command>& commands) {
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.app->get_name());
    return names;
}

/// CLI11's messages may run over several lines; ours never do.
std::string one_line(std::string text) {
    for (char& c : text) {
        if (c == '\n') c = ' ';
    }
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

int main_program(int argc, char** argv) {
    CLI::App program{"xorvox drives volumetric displays: meshes into voxels, voxels into light", "xorvox"};
    program.require_subcommand(1);
    program.set_version_flag("--version", "xorvox " XORVOX_VERSION);
    program.get_formatter()->column_width(32);
    examples(program,
             "  xorvox show bunny.ply --up y --display vortex --png bunny.png\n\nxorvox COMMAND --help tells more.");

    InfoOptions info_options;
    VoxelizeOptions voxelize_options;
    ShowOptions show_options;
    SimOptions sim_options;
    DisplaysOptions displays_options;
    const std::vector<Command> commands{info_command(program, info_options),
                                        voxelize_command(program, voxelize_options),
                                        show_command(program, show_options), sim_command(program, sim_options),
                                        displays_command(program, displays_options)};

    const std::vector<std::string> names = command_names(commands);
    const std::string first = argc > 1 ? argv[1] : "";
    if (!first.empty() && first != "--version" && first != "--help" && first != "-h" &&
        std::find(names.begin(), names.end(), first) == names.end()) {
        complain(fmt::format("there is no {} '{}'; there are {}; see xorvox --help",
                             first.starts_with('-') ? "option" : "command", first, fmt::join(names, ", ")));
        return kFailure;
    }
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return program.exit(error);
        std::string help = "xorvox --help";
        std::string what = one_line(error.what());
        for (const Command& command : commands) {
            if (!command.app->parsed()) continue;
            help = fmt::format("xorvox {} --help", command.app->get_name());
            // CLI11 lists these from the last to the first.
            if (const auto extra = command.app->remaining(); !extra.empty()) {
                what = fmt::format("'{}' is not known to xorvox {}", extra.front(), command.app->get_name());
            }
        }
        complain(fmt::format("{}; see {}", what, help));
        return kFailure;
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) continue;
        if (const Expected<void> done = command.run(); !done) {
            complain(one_line(done.error().message));
            return kFailure;
        }
    }
    if (std::fflush(stdout) != 0) {
        complain("standard output could not be written; files that were asked for are whole");
        return kFailure;
    }
    return 0;
}

/// Standard streams that the caller closed become ones that fail, so that no file or socket gets their numbers.
void occupy_standard_streams() {
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(fd, F_GETFD) != -1) continue;
        // The lowest free number is this one. If /dev/null is not there either, nothing is lost.
        (void)open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
}

}  // namespace

int main(int argc, char** argv) {
    occupy_standard_streams();
    setenv("EGL_LOG_LEVEL", "fatal", 0);  // Mesa explains itself on standard error; our one line says it
    try {
        return main_program(argc, argv);
    } catch (const std::bad_alloc&) {
        complain("not enough memory for this; try a smaller mesh, grid or display");
    } catch (const std::system_error& error) {
        complain(one_line(error.what()));  // fmt, when standard output cannot be written
    } catch (const std::exception& error) {
        complain(fmt::format("internal error: {}", one_line(error.what())));
    }
    return kFailure;
}
