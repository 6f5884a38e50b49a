// The subcommands of the xorvox program: their options as plain structs, and one function each. main.cpp fills the
// structs from the command line; a returned Error is printed as one line, and the exit status is then 2.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "tools/light_options.h"
#include "voxelizer/error.h"
#include "voxelizer/region.h"
#include "voxelizer/simplicial.h"
#include "voxelizer/transfer_function.h"

namespace xorvox::tools {

/// How a mesh file is to be read; shared by info, voxelize and show.
struct MeshOptions {
    std::string path;
    std::string unit;     ///< Of the file's numbers, which then become millimetres; empty: as they are.
    std::string up;       ///< The file's axis that points up; empty: what its format defines.
    bool strict = false;  ///< Refuse open meshes.
};

/// `--grid`, `--origin` and `--pitch` as typed; `--size` instead of the three.
struct GridOptions {
    std::optional<std::uint32_t> size;
    std::optional<glm::dvec3> grid;
    std::optional<glm::dvec3> origin;
    std::optional<glm::dvec3> pitch;
};

/// How a volume file is taken; shared by show, play, info and convert.
struct VolumeOptions {
    std::optional<double> threshold;           ///< Of volumes of values; none: found by Otsu's method.
    std::optional<TransferFunction> transfer;  ///< Of the same; none: from threshold to most value.
    std::optional<std::uint32_t> frame;        ///< Only this one, from 0; none: all.
};

struct InfoOptions {
    MeshOptions mesh;  ///< Its path may be that of a volume.
    VolumeOptions volume;
    bool json = false;
};

struct VoxelizeOptions {
    MeshOptions mesh;
    GridOptions grid;
    std::string output;
    std::string method = "column";  ///< Or "simplicial" or "reference".
    bool gzip = false;              ///< Of .nrrd.
    bool json = false;

    // Of the method "column":
    std::string kernel;                       ///< Empty: the best.
    std::optional<std::uint32_t> threads;     ///< None: one a core.
    std::optional<std::uint32_t> memory_mib;  ///< For volume and voxelizer; none: most of what is free.
    std::optional<Region> region;             ///< None: the whole grid.

    // Of the method "simplicial":
    SimplicialOptions simplicial;
    bool signed_sum = false;  ///< Look for faults of orientation.
};

struct ConvertOptions {
    std::string input;
    std::string output;
    VolumeOptions volume;  ///< Without transfer.
    bool gzip = false;     ///< Of .nrrd.
    bool json = false;
};

/// Pixels of a picture.
struct PictureSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};

/// How a simulated display behaves; of those that are in this program, and of `sim`.
struct SimulationOptions {
    std::vector<std::string> faults;    ///< As sim::parse_fault() takes them.
    std::string file;                   ///< Of sim::Conditions; empty: none.
    std::optional<std::uint32_t> seed;  ///< Of all that is left to chance; none: what `file` and `rotor` say.
    std::string rotor;                  ///< As sim::parse_rotor() takes it; empty: what `file` says.

    // What is seen in time, of displays in this program:
    std::string fidelity;              ///< "strobes", or "edges"; empty: strobes, or edges with `trace`.
    std::optional<double> exposure_s;  ///< None: a cycle.
    std::string trace;                 ///< Files, where anything is written; empty: not.
    std::string histogram;
    std::string compare;

    bool empty() const {
        return faults.empty() && file.empty() && rotor.empty() && !seed && fidelity.empty() && !exposure_s &&
               trace.empty() && histogram.empty() && compare.empty();
    }
};

/// Where light goes, and what is told of it; shared by show, pattern and share.
struct DeliveryOptions {
    std::string to = "loopback";
    std::string png;
    std::string view;   ///< "perspective", the default of --png, or "orthographic".
    std::string frame;  ///< What --png shows: "object", what is lit, or "display", all of it; empty: "object".
    std::string built;  ///< A preset or display file: the simulated display as it is really built; empty: no other.
    std::optional<PictureSize> size;
    SimulationOptions simulation;
    std::string record;  ///< A recording of the link; empty: none.
    bool hold = false;   ///< Stay until a signal.
    bool json = false;
};

/// What is shown, on what, and how; shared by show and play.
struct StageOptions {
    MeshOptions mesh;
    std::vector<std::string> following;  ///< More files of the same kind, shown one after the other.
    double files_per_second = 10.0;
    std::string animation;  ///< Of a file that has some: its name or number; empty: the first.
    VolumeOptions volume;   ///< Where the files are volumes.
    std::string display;
    std::string color;  ///< Empty: the file's own colours where it has any, else "gradient".
    LightOptions light;
    std::string sampling = "native";  ///< Or "cartesian".
    DeliveryOptions delivery;
};

struct ShowOptions {
    StageOptions stage;
    std::optional<double> spin_rpm;  ///< Turn the model, streaming frames at the display's own rate.
    double seconds = 10.0;           ///< Of spinning.
};

struct PlayOptions {
    StageOptions stage;
    std::vector<std::string> files;
    std::string timeline;  ///< A file; empty: none. Without one:
    std::string motion;    ///< Keyframes as host::parse_track() takes them; empty: none.
    std::string camera;
    std::optional<double> spin_rpm;
    std::optional<double> seconds;  ///< None: as long as what moves needs.
    std::uint64_t frames = 0;       ///< 0: for `seconds`; else so many frames, whether or not anything moves.
    bool loop = false;
};

struct PatternOptions {
    std::string display;
    std::string name;      ///< Empty with `list`.
    double seconds = 0.0;  ///< Of a pattern that moves; 0: once through it.
    DeliveryOptions delivery;
};

struct ShareOptions {
    std::string display;
    std::string socket;        ///< Where other programs connect; a path.
    double seconds = 0.0;      ///< 0: until a signal.
    std::uint32_t frames = 0;  ///< Ends when so many were published and the last is shown; 0: any number.
    DeliveryOptions delivery;
};

struct ReplayOptions {
    std::string file;
    std::string display;          ///< Instead of the one that was recorded; empty: that one.
    std::optional<double> speed;  ///< 0: as fast as it goes; none: as recorded.
    double seek_seconds = 0.0;
    bool keep_going = false;  ///< What is whole of a damaged recording.
    DeliveryOptions delivery;
};

struct DiffOptions {
    std::string a;
    std::string b;
    bool json = false;
};

struct ControlOptions {
    std::string display;
    std::string to;
    std::optional<std::uint32_t> clear_fault;  ///< Number of the fault.
    std::optional<std::uint32_t> brightness;   ///< 0 … 255.
    std::optional<std::uint32_t> watchdog_ms;
    std::optional<bool> blank;
    bool json = false;
};

struct PlanOptions {
    std::string display;
    std::string link = "usb-hs";
    std::optional<double> gpio_rate_hz;  ///< Of --link gpio: bytes a second on its 8 lines.
    bool json = false;
};

struct ValidateOptions {
    std::vector<std::string> files;
    bool json = false;
};

struct SimOptions {
    std::string display = "cube16-ws2812";
    std::string listen;
    SimulationOptions simulation;
    std::string record;  ///< A recording of all clients; empty: none.
    bool json = false;
};

struct BenchOptions {
    std::vector<std::string> meshes;
    std::string sizes = "64,128,256,512,1024";
    std::string methods = "column,simplicial";
    std::string threads = "1,2";
    std::string kernel;   ///< Of "column"; empty: the best.
    bool quick = false;   ///< Few and short runs.
    bool tables = false;  ///< Also the tables of Rueda et al.
    std::string plot;     ///< Where a chart goes; empty: nowhere.
    bool json = false;
};

struct DisplaysOptions {
    std::string display;  ///< Empty: a list of all presets.
    bool cpp = false;     ///< As a C++ header, for firmware.
    bool json = false;
};

struct BenchDisplayOptions {
    std::string mesh;
    std::vector<std::string> displays;  ///< Empty: every preset.
    bool quick = false;
    bool json = false;
};

struct BenchColorOptions {
    std::string mesh;
    std::string display = "vortex";
    bool quick = false;
    bool json = false;
};

struct BenchSimOptions {
    std::string mesh;
    std::vector<std::string> displays{"vortex", "rotovox"};
    double seconds = 10.0;  ///< For which the shutter is open.
    bool json = false;
};

struct UniformityOptions {
    std::vector<std::string> displays;  ///< Empty: every preset.
    std::uint32_t frames = 8;           ///< Of dithering in time; at least 1.
    bool json = false;
};

Expected<void> info(const InfoOptions& options);
Expected<void> voxelize(const VoxelizeOptions& options);
Expected<void> convert(const ConvertOptions& options);
Expected<void> show(const ShowOptions& options);
Expected<void> play(const PlayOptions& options);
Expected<void> replay(const ReplayOptions& options);
/// Whether the two show the same.
Expected<bool> diff(const DiffOptions& options);
Expected<void> sim(const SimOptions& options);
Expected<void> share(const ShareOptions& options);
Expected<void> bench_voxelize(const BenchOptions& options);
Expected<void> bench_displays(const BenchDisplayOptions& options);
Expected<void> bench_color(const BenchColorOptions& options);
Expected<void> bench_sim(const BenchSimOptions& options);
Expected<void> displays(const DisplaysOptions& options);
Expected<void> validate(const ValidateOptions& options);
Expected<void> control(const ControlOptions& options);
Expected<void> plan(const PlanOptions& options);
Expected<void> pattern(const PatternOptions& options);
Expected<void> uniformity(const UniformityOptions& options);

}  // namespace xorvox::tools
