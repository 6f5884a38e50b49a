// The commands that end in a file or in text: info and voxelize.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tools/command_line.h"
#include "voxelizer/lattice.h"
#include "voxelizer/solid_voxelizer.h"

namespace xorvox::tools {
namespace {

constexpr std::uint32_t kMostMemory = std::numeric_limits<std::uint32_t>::max();  ///< MiB: more than any machine has.

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

Command info_command(CLI::App& program, InfoOptions& options) {
    CLI::App& app =
        *program.add_subcommand("info", "Say what a mesh is: size, holes, faults, volume; or what a volume is");
    add_mesh(app, options.mesh);
    app.get_option("mesh")->description("The mesh, a .ply, .stl or .obj file; or a volume (see xorvox convert --help)");
    add_volume(app, options.volume);
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app, "  xorvox info bunny.ply\n  xorvox info part.stl --unit in --json\n  xorvox info scan.nii.gz");
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
    app.add_option("-o,--output", options.output,
                   "The volume: .nrrd, .binvox, .nii, .nii.gz, .vox, .bits, or a stack of .png")
        ->required()
        ->type_name("OUT");
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
    app.add_flag("--gzip", options.gzip, "Pack a .nrrd file");
    add_method(app, options);
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app,
             "  xorvox voxelize bunny.ply --size 256 -o bunny.nrrd\n"
             "  xorvox voxelize part.stl --grid 100,80,40 --origin 0,0,0 --pitch 0.5 -o part.binvox\n"
             "  xorvox voxelize bunny.ply --method simplicial --signed -o bunny.nrrd\n"
             "  xorvox voxelize huge.ply --size 4096 --memory 2048 -o huge.bits");
    return {&app, [&options] { return voxelize(options); }};
}

}  // namespace

std::vector<Command> mesh_commands(CLI::App& program, AllOptions& options) {
    return {info_command(program, options.info), voxelize_command(program, options.voxelize),
            convert_command(program, options.convert)};
}

}  // namespace xorvox::tools
