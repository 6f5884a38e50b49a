// The command bench and its parts.
#include "tools/bench/result.h"
#include "tools/command_line.h"

namespace xorvox::tools {
namespace {

CLI::App& bench_voxelize_command(CLI::App& bench, BenchOptions& options) {
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
    return app;
}

CLI::App& bench_displays_command(CLI::App& bench, BenchDisplayOptions& options) {
    CLI::App& app = *bench.add_subcommand(
        "displays",
        "Measure the way of a frame, from a mesh that turned to encoded packets, in the display's own format and one "
        "colour, against the time that the display gives it (headroom); and resampling: its speed and its errors");
    app.add_option("mesh", options.mesh, "The mesh: a .ply, .stl or .obj file")->required()->type_name("MESH");
    app.add_option("--display", options.displays, "Only these presets or display files (default: every preset)")
        ->type_name("NAME|FILE.toml");
    app.add_flag("--quick", options.quick, "Few and short runs, for a first look");
    app.add_flag("--json", options.json, "One JSON array on standard output");
    examples(app, "  xorvox bench displays bunny.ply\n  xorvox bench displays bunny.ply --display vortex --quick");
    return app;
}

CLI::App& bench_color_command(CLI::App& bench, BenchColorOptions& options) {
    CLI::App& app = *bench.add_subcommand("color",
                                          "Measure how fast voxels are painted, and frames taken apart into bit "
                                          "planes, against a copy of the same bytes; "
                                          "and how fast each colour function is at the voxels of the mesh");
    app.add_option("mesh", options.mesh, "The mesh: a .ply, .stl or .obj file")->required()->type_name("MESH");
    app.add_option("--display", options.display, "A preset or a display file")
        ->capture_default_str()
        ->type_name("NAME|FILE.toml");
    app.add_flag("--quick", options.quick, "Few and short runs, for a first look");
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app, "  xorvox bench color examples/duck.ply\n  xorvox bench color bunny.ply --display vx1 --quick");
    return app;
}

CLI::App& bench_sim_command(CLI::App& bench, BenchSimOptions& options) {
    CLI::App& app = *bench.add_subcommand(
        "sim",
        "Measure how much faster than real time the simulator is on one core: device, strobes and the light of every "
        "voxel, of a mesh and of a frame in full white, on rotors that keep their time and that jitter");
    app.add_option("mesh", options.mesh, "The mesh: a .ply, .stl or .obj file")->required()->type_name("MESH");
    app.add_option("displays", options.displays, "Presets or display files")
        ->capture_default_str()
        ->type_name("NAME|FILE.toml");
    app.add_option("--seconds", options.seconds, "Simulated time of each measurement")
        ->capture_default_str()
        ->check(CLI::Range(0.01, 1000.0));
    app.add_flag("--json", options.json, "One JSON array on standard output");
    examples(app, "  xorvox bench sim examples/duck.ply\n  xorvox bench sim bunny.ply vortex --seconds 60");
    return app;
}

}  // namespace

Command bench_command(CLI::App& program, AllOptions& options) {
    CLI::App& bench = *program.add_subcommand("bench", "Measure how fast this machine is");
    bench.require_subcommand(1);
    examples(bench,
             "  xorvox bench voxelize bunny.ply\n  xorvox bench displays bunny.ply\n  xorvox bench color "
             "bunny.ply\n  xorvox bench sim bunny.ply\n\nxorvox bench voxelize --help tells "
             "more.");
    CLI::App& of_voxelizer = bench_voxelize_command(bench, options.bench);
    CLI::App& of_displays = bench_displays_command(bench, options.bench_display);
    CLI::App& of_sim = bench_sim_command(bench, options.bench_sim);
    bench_color_command(bench, options.bench_color);
    return {&bench, [&options, &of_voxelizer, &of_displays, &of_sim] {
                if (of_voxelizer.parsed()) return bench_voxelize(options.bench);
                if (of_displays.parsed()) return bench_displays(options.bench_display);
                if (of_sim.parsed()) return bench_sim(options.bench_sim);
                return bench_color(options.bench_color);
            }};
}

}  // namespace xorvox::tools
