// The command line. The only file that includes CLI11, which is slow to compile.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <limits>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "tools/bench/result.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/stop.h"
#include "voxelizer/lattice.h"
#include "voxelizer/solid_voxelizer.h"

namespace {

using namespace xorvox;
using namespace xorvox::tools;

constexpr int kFailure = 2;
constexpr std::uint32_t kMostMemory = std::numeric_limits<std::uint32_t>::max();  ///< MiB: more than any machine has.

/// "64" into a number of things.
std::uint32_t parse_count(const std::string& option, const std::string& text, std::uint32_t most) {
    std::uint32_t number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (stop != text.data() + text.size() || error == std::errc::invalid_argument) {
        throw CLI::ValidationError(option, fmt::format("'{}' is not a whole number", text));
    }
    if (error != std::errc() || number > most) {
        throw CLI::ValidationError(option,
                                   fmt::format("'{}' is too large; it takes whole numbers up to {}", text, most));
    }
    return number;
}

/// "1,2.5,3" into numbers; none at all when one of them is wrong.
std::vector<double> parse_numbers(const std::string& text) {
    std::vector<double> numbers;
    std::size_t at = 0;
    while (at <= text.size()) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        double number = 0.0;
        const char* end = text.data() + comma;
        const auto [stop, error] = std::from_chars(text.data() + at, end, number);
        if (error != std::errc() || stop != end) return {};
        numbers.push_back(number);
        at = comma + 1;
    }
    return numbers;
}

/// "1,2.5,3" into a vector; one number stands for three where `one_for_all`.
glm::dvec3 parse_vector(const std::string& option, const std::string& text, bool one_for_all) {
    const std::vector<double> numbers = parse_numbers(text);
    if (numbers.size() == 1 && one_for_all) return glm::dvec3(numbers[0]);
    if (numbers.size() != 3) {
        throw CLI::ValidationError(
            option, fmt::format("'{}' is not {}three numbers with commas between them, as in 1,2,3", text,
                                one_for_all ? "one number or " : ""));
    }
    return {numbers[0], numbers[1], numbers[2]};
}

Axis parse_axis(const std::string& option, const std::string& text) {
    if (text == "x") return Axis::X;
    if (text == "y") return Axis::Y;
    if (text == "z") return Axis::Z;
    throw CLI::ValidationError(option, fmt::format("'{}' is no axis; choose x, y or z", text));
}

/// "0,0,8,64,64,4" into a region.
Region parse_region(const std::string& option, const std::string& text) {
    const std::vector<double> numbers = parse_numbers(text);
    const auto is_index = [](double n) { return n >= 0.0 && n <= kMaxLatticeSide && n == std::floor(n); };
    if (numbers.size() != 6 || !std::all_of(numbers.begin(), numbers.end(), is_index)) {
        throw CLI::ValidationError(
            option, fmt::format("'{}' is not the first voxel and the size of a box, as in 0,0,8,64,64,4", text));
    }
    return {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
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

/// How `voxelize` computes. Every method gives the same bits of a closed mesh.
void add_method(CLI::App& app, VoxelizeOptions& options) {
    app.add_option("--method", options.method,
                   "column: parity along columns, fast (the default); simplicial: tetrahedra between an apex and the "
                   "faces; reference: column, slow and simple. The bits of a closed mesh are the same")
        ->check(CLI::IsMember({"column", "simplicial", "reference"}).description(""))
        ->type_name("column|simplicial|reference");
    const std::vector<CLI::Option*> of_column{
        app.add_option("--kernel", options.kernel,
                       "The instructions used: scalar, sse4, avx2, avx512 or neon (default: the best here)")
            ->type_name("NAME"),
        app.add_option_function<std::string>(
               "--threads",
               [&options](const std::string& text) {
                   if (text != "auto") options.threads = parse_count("--threads", text, kMaxSolidThreads);
               },
               "Threads to work with; auto is one for each core (the default)")
            ->type_name("N|auto"),
        app.add_option_function<std::string>(
               "--memory",
               [&options](const std::string& text) { options.memory_mib = parse_count("--memory", text, kMostMemory); },
               "Memory for the volume and the work; a larger volume is written slab by slab (default: most of what is "
               "free)")
            ->type_name("MIB"),
        app.add_option_function<std::string>(
               "--region", [&options](const std::string& text) { options.region = parse_region("--region", text); },
               "Only this box of the grid: its first voxel and its size")
            ->type_name("X,Y,Z,NX,NY,NZ")};
    const std::vector<CLI::Option*> of_simplicial{
        app.add_option_function<std::string>(
               "--apex",
               [&options](const std::string& text) {
                   if (text != "centroid") options.simplicial.apex = parse_vector("--apex", text, false);
               },
               "The point that all tetrahedra share, in the units of the mesh (default centroid)")
            ->type_name("centroid|X,Y,Z"),
        app.add_option_function<std::string>(
               "--sweep",
               [&options](const std::string& text) { options.simplicial.sweep = parse_axis("--sweep", text); },
               "The axis along which slices follow each other (default y)")
            ->type_name("x|y|z"),
        app.add_flag("--signed", options.signed_sum,
                     "Look for faces of wrong orientation by the signed sum of the tetrahedra; the volume stays the "
                     "same")};
    for (CLI::Option* option : of_column) option->group("Options of --method column");
    for (CLI::Option* option : of_simplicial) option->group("Options of --method simplicial");
    app.parse_complete_callback([&options, of_column, of_simplicial] {
        const auto only_with = [&options](const std::string& method, const std::vector<CLI::Option*>& its_own) {
            if (options.method == method) return;
            for (const CLI::Option* option : its_own) {
                if (option->count() == 0) continue;
                throw CLI::ValidationError(option->get_name(),
                                           fmt::format("is only for --method {}, not for {}", method, options.method));
            }
        };
        only_with("column", of_column);
        only_with("simplicial", of_simplicial);
    });
}

Command voxelize_command(CLI::App& program, VoxelizeOptions& options) {
    CLI::App& app = *program.add_subcommand("voxelize", "Turn a closed mesh into a volume of bits, exactly");
    add_mesh(app, options.mesh);
    add_strict(app, options.mesh);
    app.add_option("-o,--output", options.output, "The volume: .nrrd, .binvox or .bits")->required()->type_name("OUT");
    CLI::Option* size = app.add_option_function<std::string>(
                               "--size",
                               [&options](const std::string& text) {
                                   options.grid.size = parse_count("--size", text, kMaxLatticeSide);
                               },
                               "A cube of N voxels a side around the mesh, 1/64 of room on each side (default 64)")
                            ->type_name("N");
    add_vector(app, "--grid", options.grid.grid, false, "NX,NY,NZ",
               "Voxels along x, y and z; needs --origin and --pitch");
    add_vector(app, "--origin", options.grid.origin, false, "X,Y,Z",
               "The outer corner of voxel 0,0,0, in the units of the mesh (mm with --unit)");
    add_vector(app, "--pitch", options.grid.pitch, true, "P[,PY,PZ]", "The size of a voxel");
    size->excludes("--grid")->excludes("--origin")->excludes("--pitch");
    add_method(app, options);
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app,
             "  xorvox voxelize bunny.ply --size 256 -o bunny.nrrd\n"
             "  xorvox voxelize part.stl --grid 100,80,40 --origin 0,0,0 --pitch 0.5 -o part.binvox\n"
             "  xorvox voxelize bunny.ply --method simplicial --signed -o bunny.nrrd\n"
             "  xorvox voxelize huge.ply --size 4096 --memory 2048 -o huge.bits");
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
        ->check(CLI::IsMember({"perspective", "orthographic"}).description(""))
        ->type_name("perspective|orthographic");
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
    return {&app, [&options] { return tools::sim(options); }};
}

Command bench_command(CLI::App& program, BenchOptions& options) {
    CLI::App& bench = *program.add_subcommand("bench", "Measure how fast this machine is");
    bench.require_subcommand(1);
    examples(bench, "  xorvox bench voxelize bunny.ply\n\nxorvox bench voxelize --help tells more.");
    CLI::App& app = *bench.add_subcommand(
        "voxelize",
        "Measure the solid voxelizers: medians of the whole way from mesh to bits, and of what the machine cannot do "
        "without (the floor: the volume cleared, its layers combined, the mesh's corners read), all in turns");
    app.add_option("meshes", options.meshes, "The meshes: .ply, .stl or .obj files")->required()->type_name("MESH");
    app.add_option("--sizes", options.sizes, "Samples a side of the cube around the mesh")
        ->capture_default_str()
        ->type_name("N,N");
    app.add_option("--methods", options.methods, "Of column, simplicial and reference")
        ->capture_default_str()
        ->type_name("NAME,NAME");
    app.add_option("--threads", options.threads, "Threads of the method column")
        ->capture_default_str()
        ->type_name("N,N");
    app.add_option("--kernel", options.kernel,
                   "Of the method column: scalar, sse4, avx2, avx512 or neon (default: the best here)")
        ->type_name("NAME");
    app.add_flag("--quick", options.quick, "Few and short runs, for a first look");
    app.add_option("--plot", options.plot, "A chart of the results, with logarithmic axes")->type_name("OUT.png");
    CLI::Option* json = app.add_flag("--json", options.json, "One JSON array on standard output");
    app.add_flag("--tables", options.tables,
                 "Also the tables of Rueda et al. beside the times of gem24, gem1944, spot5856, fandisk13k and "
                 "dragon100k, those of them that are given")
        ->excludes(json);
    examples(app,
             "  xorvox bench voxelize bunny.ply dragon.ply --plot chart.png\n"
             "  xorvox bench voxelize bunny.ply --sizes 256 --methods column --threads 1,2,4 --json\n\n" +
                 bench_json_fields());
    return {&bench, [&options] { return bench_voxelize(options); }};
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

/// The option of `app` that was given more often than it takes, or null.
const CLI::Option* repeated_option(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_expected_max() == 1 && option->count() > 1) return option;
    }
    return nullptr;
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
    BenchOptions bench_options;
    DisplaysOptions displays_options;
    const std::vector<Command> commands{
        info_command(program, info_options),   voxelize_command(program, voxelize_options),
        show_command(program, show_options),   sim_command(program, sim_options),
        bench_command(program, bench_options), displays_command(program, displays_options)};

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
            std::string name = "xorvox " + command.app->get_name();
            const CLI::App* innermost = command.app;
            for (const CLI::App* part : command.app->get_subcommands()) {
                name += ' ' + part->get_name();
                innermost = part;
            }
            help = name + " --help";
            const CLI::Option* const repeated = repeated_option(*innermost);
            if (repeated != nullptr && dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
                what = fmt::format("{} is given {} times; give it once", repeated->get_name(), repeated->count());
            }
            // CLI11 lists these from the last to the first.
            if (const auto extra = command.app->remaining(true); !extra.empty()) {
                what = fmt::format("'{}' is not known to {}", extra.front(), name);
            }
        }
        complain(fmt::format("{}; see {}", what, help));
        return kFailure;
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) continue;
        if (const Expected<void> done = command.run(); !done) {
            complain(one_line(done.error().message));
            end_if_asked_to_stop();
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
