// The command line, as CLI11 reads it: the files tools/command_line*.cpp and main.cpp alone include CLI11, which is
// slow to compile.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <glm/vec3.hpp>

#include "tools/commands.h"
#include "voxelizer/error.h"

namespace xorvox::tools {

/// Where the options of all commands are kept while they are read and run.
struct AllOptions {
    InfoOptions info;
    VoxelizeOptions voxelize;
    ConvertOptions convert;
    ShowOptions show;
    PlayOptions play;
    SimOptions sim;
    ShareOptions share;
    BenchOptions bench;
    BenchDisplayOptions bench_display;
    BenchColorOptions bench_color;
    BenchSimOptions bench_sim;
    DisplaysOptions displays;
    ValidateOptions validate;
    PlanOptions plan;
    PatternOptions pattern;
    ControlOptions control;
    UniformityOptions uniformity;
    PlayOptions record;
    ReplayOptions replay;
    DiffOptions diff;
    int exit_status = 0;  ///< Of the program, where the command did what it should.
};

/// What a subcommand is, and what runs when it was given.
struct Command {
    CLI::App* app = nullptr;
    std::function<Expected<void>()> run;
};

/// Puts the commands into `program`; `options` is borrowed by them.
std::vector<Command> mesh_commands(CLI::App& program, AllOptions& options);
Command convert_command(CLI::App& program, ConvertOptions& options);
std::vector<Command> display_commands(CLI::App& program, AllOptions& options);
std::vector<Command> recording_commands(CLI::App& program, AllOptions& options);
Command bench_command(CLI::App& program, AllOptions& options);

/// The lines below an `Examples:` at the end of a command's help.
void examples(CLI::App& app, const std::string& text);

/// The mesh, add_reading() how it is read, and add_strict() the refusal of open ones.
void add_mesh(CLI::App& app, MeshOptions& mesh);
void add_reading(CLI::App& app, MeshOptions& mesh);
void add_strict(CLI::App& app, MeshOptions& mesh);

/// A display of the caller's choice.
void add_display(CLI::App& app, std::string& display);
/// --to, --png and what belongs to it.
void add_delivery(CLI::App& app, DeliveryOptions& options);
/// What is shown, on what and how, but for add_delivery().
void add_looks(CLI::App& app, StageOptions& options);
/// Files that are shown, and how they move.
void add_motion(CLI::App& app, PlayOptions& options);
/// A number above zero.
CLI::Option* add_positive(CLI::App& app, const std::string& name, std::function<void(double)> set,
                          const std::string& type, const std::string& help);

/// How colours become light; for the commands that show models.
void add_light(CLI::App& app, LightOptions& light);
/// --threshold and --volume; add_transfer() the colours of values.
void add_volume(CLI::App& app, VolumeOptions& volume);
void add_transfer(CLI::App& app, VolumeOptions& volume);

/// How a simulated display behaves: --fault and --sim.
void add_simulation(CLI::App& app, SimulationOptions& options);

/// "64" into a number of things, at most `most`. A CLI::ValidationError says what is wrong; so below.
std::uint32_t parse_count(const std::string& option, const std::string& text, std::uint32_t most);
/// "1.5" into a number above zero.
double parse_positive(const std::string& option, const std::string& text);
/// "1,2.5,3" into numbers; none at all when one of them is wrong.
std::vector<double> parse_numbers(const std::string& text);
/// "1,2.5,3" into a vector; one number stands for three where `one_for_all`.
glm::dvec3 parse_vector(const std::string& option, const std::string& text, bool one_for_all);

}  // namespace xorvox::tools
