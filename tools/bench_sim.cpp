// bench sim: how much faster than real time light is simulated.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "driver/host/color.h"
#include "driver/host/session.h"
#include "sim/exposure.h"
#include "sim/simulator.h"
#include "tools/bench/race.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/frame_maker.h"
#include "tools/mesh_content.h"
#include "tools/mesh_input.h"
#include "tools/placement.h"
#include "transport/loopback.h"

namespace xorvox::tools {
namespace {

constexpr double kJitter = 0.01;
constexpr double kAim = 10.0;
constexpr std::uint64_t kStep_ns = 1'000'000;  ///< From poll to poll.

struct Row {
    std::string display;
    std::string frame;
    double jitter = 0.0;
    double simulated_ms = 0.0;
    double strobes_ms = 0.0;  ///< Of the processor: device, strobes and their light,
    double read_ms = 0.0;     ///< and the light of every voxel.
    std::size_t strobes = 0;
    std::size_t lit = 0;  ///< Voxels.

    double times_real() const { return simulated_ms / (strobes_ms + read_ms); }
};

/// A display in this program that shows a frame.
class Shown {
public:
    static Expected<std::unique_ptr<Shown>> make(const DisplayDescription& display, std::span<const std::byte> frame,
                                                 double jitter) {
        auto shown = std::make_unique<Shown>();
        std::tie(shown->host_end_, shown->device_end_) = transport::make_loopback();
        sim::SimulatorOptions options;
        options.rotor = sim::RotorConditions{.jitter = jitter};
        auto simulator = sim::Simulator::make(display, shown->device_end_.get(), options);
        if (!simulator) return tl::unexpected(simulator.error());
        shown->simulator_.emplace(std::move(*simulator));
        shown->session_.emplace(shown->host_end_.get(), display, session_options(true, display, frame));
        bool submitted = false;
        while (shown->session_->statistics().frames_presented == 0) {
            shown->poll();
            if (shown->session_->state() == host::SessionState::Failed) {
                return tl::unexpected(shown->session_->error());
            }
            if (!submitted) submitted = shown->session_->submit(frame) == Status::Ok;
        }
        return shown;
    }

    /// Opens the shutter for so long from now on, and measures.
    Row measure(std::uint64_t shutter_ns) {
        Row row;
        const std::uint64_t to_ns = now_ns_ + shutter_ns;
        sim::Exposure exposure(
            simulator_->display(), simulator_->built(),
            [this](std::uint64_t time_ns) { return simulator_->cycles_at(time_ns); }, now_ns_, to_ns);
        simulator_->watch([&](const sim::Strobe& strobe) {
            ++row.strobes;
            exposure.add(strobe);
        });
        const double begin_ms = processor_ms();
        while (now_ns_ < to_ns) poll();
        const double lit_ms = processor_ms();
        row.lit = read(exposure);
        row.read_ms = processor_ms() - lit_ms;
        row.strobes_ms = lit_ms - begin_ms;
        row.simulated_ms = static_cast<double>(shutter_ns) * 1e-6;
        simulator_->watch({});
        return row;
    }

private:
    /// Reads the light of every voxel; how many have some.
    static std::size_t read(const sim::Exposure& exposure) {
        const DisplayDescription& display = exposure.display();
        std::size_t lit = 0;
        std::vector<glm::vec3> light;
        for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
            for (std::uint32_t p = 0; p < display.panel_count; ++p) {
                for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                    light.assign(display.panels[p].columns, glm::vec3(0.0f));
                    if (!exposure.add_row_light(slice, p, row, light)) continue;
                    lit += light.size() - static_cast<std::size_t>(std::ranges::count(light, glm::vec3(0.0f)));
                }
            }
        }
        return lit;
    }

    void poll() {
        (void)session_->poll(now_ns_);
        (void)simulator_->poll(now_ns_);
        now_ns_ += kStep_ns;
    }

    UniqueLink host_end_;
    UniqueLink device_end_;
    std::optional<sim::Simulator> simulator_;
    std::optional<host::Session> session_;
    std::uint64_t now_ns_ = 0;
};

Expected<std::vector<std::byte>> frame_of(const DisplayDescription& display, const Mesh& mesh,
                                          const std::string& source) {
    const auto color = host::parse_color("constant:white");
    if (!color) return tl::unexpected(color.error());
    std::vector<NamedScene> scenes(1);
    scenes.front().scene.mesh = mesh;
    scenes.front().source = source;
    auto content = MeshContent::make(std::move(scenes), 0, display, Turning::Upright, 0.0, 1);
    if (!content) return tl::unexpected(content.error());
    const auto maker = FrameMaker::make(display, **content, color->get(), {});
    if (!maker) return tl::unexpected(maker.error());
    if (const auto drawn = (*maker)->draw(); !drawn) return tl::unexpected(drawn.error());
    std::vector<std::byte> frame(frame_bytes(display));
    if (const auto painted = (*maker)->paint(frame); !painted) return tl::unexpected(painted.error());
    return frame;
}

Expected<void> measure_display(const DisplayDescription& display, const Mesh& mesh, const BenchSimOptions& options,
                               std::vector<Row>& rows) {
    const auto drawn = frame_of(display, mesh, options.mesh);
    if (!drawn) return tl::unexpected(drawn.error());
    const std::vector<std::byte> white(frame_bytes(display), std::byte{0xff});
    const auto shutter_ns = static_cast<std::uint64_t>(options.seconds * 1e9);
    for (const auto& [name, frame] : {std::pair(options.mesh, &*drawn), std::pair(std::string("full white"), &white)}) {
        for (const double jitter : {0.0, kJitter}) {
            const auto shown = Shown::make(display, *frame, jitter);
            if (!shown) return tl::unexpected(shown.error());
            Row row = (*shown)->measure(shutter_ns);
            row.display = display.name.view();
            row.frame = name;
            row.jitter = jitter;
            rows.push_back(std::move(row));
        }
    }
    return {};
}

void print_text(const std::vector<Row>& rows) {
    fmt::print(
        "Simulated time against time of one core: the device and its strobes, added up as light, and then the light\n"
        "of every voxel read out. Aim on displays like vortex: {:.0f} times real time\n\n",
        kAim);
    fmt::print("{:<15}{:<26}{:>7}{:>12}{:>13}{:>13}{:>11}{:>11}{:>15}\n", "display", "frame", "jitter", "simulated",
               "strobes", "voxels lit", "strobes", "read out", "times real");
    for (const Row& row : rows) {
        fmt::print("{:<15}{:<26}{:>6.0f}%{:>9.0f} ms{:>13}{:>13}{:>8.0f} ms{:>8.0f} ms{:>15.1f}\n", row.display,
                   row.frame, 100.0 * row.jitter, row.simulated_ms, thousands(row.strobes), thousands(row.lit),
                   row.strobes_ms, row.read_ms, row.times_real());
    }
}

void print_json(const std::vector<Row>& rows) {
    const char* separator = "";
    fmt::print("[");
    for (const Row& row : rows) {
        fmt::print(
            "{}\n  {{\"display\": {}, \"frame\": {}, \"jitter\": {}, \"simulated_ms\": {:.6g}, \"strobes\": {}, "
            "\"voxels_lit\": {}, \"strobes_ms\": {:.6g}, \"read_ms\": {:.6g}, \"times_real\": {:.6g}}}",
            separator, json_string(row.display), json_string(row.frame), row.jitter, row.simulated_ms, row.strobes,
            row.lit, row.strobes_ms, row.read_ms, row.times_real());
        separator = ",";
    }
    fmt::print("\n]\n");
}

}  // namespace

Expected<void> bench_sim(const BenchSimOptions& options) {
    MeshOptions mesh_options;
    mesh_options.path = options.mesh;
    const Expected<MeshInput> input = read_solid(mesh_options);
    if (!input) return tl::unexpected(input.error());
    std::vector<Row> rows;
    for (const std::string& name : options.displays) {
        const Expected<DisplayFile> display = load_display(name);
        if (!display) return tl::unexpected(display.error());
        if (const auto fits = check_display_fits(*display); !fits) return fits;
        const Progress progress("measuring " + name);
        if (const auto measured = measure_display(*display, input->mesh, options, rows); !measured) return measured;
    }
    (options.json ? print_json : print_text)(rows);
    return {};
}

}  // namespace xorvox::tools
