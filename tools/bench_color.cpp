// bench color: how fast colours are painted and computed, each against a copy of the same bytes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/device/bit_planes.h"
#include "driver/display/lattice.h"
#include "driver/display/toml.h"
#include "driver/host/color.h"
#include "driver/host/label_color.h"
#include "driver/host/slices.h"
#include "driver/host/spherical_image_color.h"
#include "driver/host/surface_color.h"
#include "driver/host/texture_color.h"
#include "driver/host/volume_placement.h"
#include "tools/bench/race.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/mesh_input.h"
#include "tools/placement.h"
#include "voxelizer/solid_voxelizer.h"

namespace xorvox::tools {
namespace {

constexpr const char* kExpression = "expr: hsv(0.5+0.5*noise(8*p), 1, z)";
/// As many points at a time as FramePainter asks for, about.
constexpr std::size_t kBatch = 256;
constexpr std::uint32_t kVolumeSide = 64;
/// Colours that are computed in a run, at most: from the middle of the frame on.
constexpr std::size_t kMostEvaluated = 200'000;

/// Something that is measured.
struct Row {
    std::string name;
    std::size_t items = 0;     ///< Voxels or colours of a run.
    double ms = 0.0;           ///< Of the processor.
    double copy_ms = 0.0;      ///< Of a copy of the bytes that it writes.
    double aim_ratio = 0.0;    ///< At most so many times the copy; 0: none.
    double aim_million = 0.0;  ///< At least so many million items a second; 0: none.

    double million_a_second() const { return static_cast<double>(items) / ms / 1e3; }
    double ratio() const { return ms / copy_ms; }
};

/// Keeps the points that it is asked for.
class Recorder final : public host::ColorField {
public:
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        points_.insert(points_.end(), points.begin(), points.end());
        std::ranges::fill(colors, glm::vec3(1.0f));
    }
    std::vector<glm::vec3> points() && { return std::move(points_); }

private:
    mutable std::vector<glm::vec3> points_;
};

/// Numbers that look like chance, 0 … 2^24 - 1.
class Numbers {
public:
    std::uint32_t operator()() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::uint32_t>(state_ >> 40);
    }

private:
    std::uint64_t state_ = 1;
};

std::shared_ptr<const SampledVolume> make_volume(VolumeKind kind, std::uint32_t most) {
    SampledVolume volume;
    volume.kind = kind;
    volume.nx = volume.ny = volume.nz = kVolumeSide;
    Numbers number;
    for (std::size_t i = 0; i < volume.voxel_count(); ++i) {
        const std::uint32_t n = number();
        if (kind == VolumeKind::Colors) {
            volume.colors.push_back({static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(n >> 8),
                                     static_cast<std::uint8_t>(n >> 16), 255});
        } else {
            volume.values.push_back(static_cast<float>(n % (most + 1)));
        }
    }
    return std::make_shared<const SampledVolume>(std::move(volume));
}

std::shared_ptr<const Image> make_image() {
    Image image{1024, 512, std::vector<std::array<std::uint8_t, 4>>(1024 * 512)};
    Numbers number;
    for (auto& pixel : image.pixels) pixel.fill(static_cast<std::uint8_t>(number()));
    return std::make_shared<const Image>(std::move(image));
}

struct NamedField {
    std::string name;
    std::unique_ptr<host::ColorField> field;
};

Expected<std::vector<NamedField>> make_fields(const Mesh& mesh, const DisplayExtent& room) {
    std::vector<NamedField> fields;
    for (const char* spec :
         {"constant:orange", "gradient", "radial:gold,blue", "spherical:gold,blue", "noise", "simplex", kExpression}) {
        auto field = host::parse_color(spec);
        if (!field) return tl::unexpected(field.error());
        fields.push_back({spec, std::move(*field)});
    }
    const std::vector<glm::dvec3> stops{{0, 0, 1}, {0, 1, 0}, {1, 0.5, 0}};
    const auto colors = make_volume(VolumeKind::Colors, 0);
    const auto numbers = make_volume(VolumeKind::Scalar, 1000);
    const auto labels = make_volume(VolumeKind::Labels, 40);
    fields.push_back({"texture of colours",
                      std::make_unique<host::TextureColor>(colors, host::stretched(*colors), std::span(stops))});
    fields.push_back({"texture of numbers",
                      std::make_unique<host::TextureColor>(numbers, host::stretched(*numbers), std::span(stops))});
    fields.push_back({"labels", std::make_unique<host::LabelColor>(labels, host::stretched(*labels),
                                                                   std::span<const glm::dvec3>())});
    fields.push_back({"spherical picture", std::make_unique<host::SphericalImageColor>(make_image())});
    SurfaceColors surface;
    Numbers number;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        surface.corner_colors.push_back(glm::vec3(static_cast<float>(number()) * 0x1p-24f));
    }
    fields.push_back(
        {"surface", std::make_unique<host::SurfaceColor>(mesh.view(), std::move(surface), room.lower, room.upper)});
    return fields;
}

/// The painter's part: constant colour and noise into frames, and frames into bit planes.
Expected<std::vector<Row>> measure_painting(const DisplayDescription& display, const host::FramePainter& painter,
                                            ConstBitVolumeView volume, std::size_t voxels, const Pace& pace) {
    const auto constant = host::parse_color("constant:orange");
    const auto noise = host::parse_color("noise");
    if (!constant || !noise) return fail("a colour is not understood");
    std::vector<std::byte> frame(frame_bytes(display));
    std::vector<std::byte> copy(frame.size());
    const Panel& panel = display.panels[0];
    const device::BitPlaneLayout layout{.format = display.format,
                                        .columns = panel.columns,
                                        .rows = display.panel_count * panel.rows * display.slices,
                                        .shown = shown_bit_planes(display)};
    std::vector<std::byte> planes(layout.bytes());
    std::vector<std::byte> planes_copy(planes.size());
    bool is_right = layout.pixel_bytes() == frame.size();
    const auto paint = [&](const host::ColorField& field) {
        is_right = painter.paint(volume, field, frame) == Status::Ok && is_right;
    };
    std::vector<Runner> runners;
    runners.emplace_back([&] { std::memcpy(copy.data(), frame.data(), frame.size()); });
    runners.emplace_back([&] { paint(**constant); });
    runners.emplace_back([&] { paint(**noise); });
    runners.emplace_back([&] { std::memcpy(planes_copy.data(), planes.data(), planes.size()); });
    runners.emplace_back([&] { is_right = device::split_bit_planes(layout, frame, planes) == Status::Ok && is_right; });
    race(runners, pace);
    if (!is_right) return fail("the display's frames cannot be painted");
    const auto ms = [&](std::size_t i) { return runners[i].median_cpu_ms(); };
    return std::vector<Row>{{"constant:orange", voxels, ms(1), ms(0), 4.0, 0.0},
                            {"noise", voxels, ms(2), ms(0), 0.0, 40.0},
                            {"bit planes", frame_pixels(display), ms(4), ms(3), 4.0, 0.0}};
}

std::vector<Row> measure_fields(const std::vector<NamedField>& fields, std::span<const glm::vec3> points,
                                const Pace& pace) {
    std::vector<glm::vec3> colors(points.size());
    std::vector<Runner> runners;
    runners.emplace_back([&] { std::memcpy(colors.data(), points.data(), points.size() * sizeof(glm::vec3)); });
    for (const NamedField& named : fields) {
        runners.emplace_back([&] {
            for (std::size_t at = 0; at < points.size(); at += kBatch) {
                const std::size_t count = std::min(kBatch, points.size() - at);
                named.field->evaluate(points.subspan(at, count), std::span(colors).subspan(at, count));
            }
        });
    }
    race(runners, pace);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        rows.push_back({fields[i].name, points.size(), runners[i + 1].median_cpu_ms(), runners[0].median_cpu_ms()});
    }
    return rows;
}

void print_rows(const char* title, const char* items, const std::vector<Row>& rows) {
    fmt::print("\n{:<38}{:>10}{:>22}{:>10}   {}\n", title, "ms", fmt::format("million {}/s", items), "÷ copy", "aim");
    for (const Row& row : rows) {
        std::string aim;
        if (row.aim_ratio > 0.0) aim = fmt::format("at most {:.0f} times the copy", row.aim_ratio);
        if (row.aim_million > 0.0) aim = fmt::format("at least {:.0f} million/s", row.aim_million);
        fmt::print("{:<38}{:>10.3f}{:>22.1f}{:>9.1f}   {}\n", row.name, row.ms, row.million_a_second(), row.ratio(),
                   aim);
    }
}

std::string rows_json(const std::vector<Row>& rows) {
    std::string text;
    for (const Row& row : rows) {
        text += fmt::format(
            "{}\n    {{\"name\": {}, \"ms\": {:.6g}, \"items_per_second\": {:.6g}, \"over_copy\": {:.6g}}}",
            text.empty() ? "" : ",", json_string(row.name), row.ms, 1e6 * row.million_a_second(), row.ratio());
    }
    return text;
}

}  // namespace

Expected<void> bench_color(const BenchColorOptions& options) {
    const Expected<DisplayFile> display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    if (const auto fits = check_display_fits(*display); !fits) return fits;
    MeshOptions mesh_options;
    mesh_options.path = options.mesh;
    Expected<MeshInput> input = read_solid(mesh_options);
    if (!input) return tl::unexpected(input.error());
    Mesh& mesh = input->mesh;
    const auto placement =
        fit_to_display([&mesh](const auto& visit) { visit(mesh.positions); }, *display, options.mesh);
    if (!placement) return tl::unexpected(placement.error());
    for (glm::dvec3& position : mesh.positions) position = placement->place(position);

    const host::FramePainter painter(*display);
    BitVolume volume(painter.lattice().view());
    SolidVoxelizer voxelizer;
    Status status = voxelizer.set_mesh(mesh.view());
    if (status == Status::Ok) status = voxelizer.set_lattice(painter.lattice().view());
    if (status == Status::Ok) status = voxelizer.solid(volume.view());
    if (status != Status::Ok) return fail(options.mesh + ": cannot be voxelized; xorvox voxelize says why");
    Recorder recorder;
    std::vector<std::byte> frame(frame_bytes(*display));
    if (painter.paint(volume.view(), recorder, frame) != Status::Ok) return fail("the frame could not be painted");
    const std::vector<glm::vec3> points = std::move(recorder).points();
    if (points.empty()) return fail(options.mesh + ": no sample of the display is inside it; use another mesh");

    const auto fields = make_fields(mesh, extent(*display));
    if (!fields) return tl::unexpected(fields.error());
    const Pace pace = options.quick ? Pace{3, 2000, 60.0} : Pace{5, 2000, 1500.0};
    const Progress progress("measuring");
    const auto painted = measure_painting(*display, painter, volume.view(), points.size(), pace);
    if (!painted) return tl::unexpected(painted.error());
    const std::size_t evaluated_count = std::min(points.size(), kMostEvaluated);
    const std::vector<Row> evaluated = measure_fields(
        *fields, std::span(points).subspan((points.size() - evaluated_count) / 2, evaluated_count), pace);
    if (options.json) {
        fmt::print(
            "{{\n  \"mesh\": {}, \"display\": {}, \"voxels\": {},\n  \"painted\": [{}\n  ],\n  \"evaluated\": [{}\n  "
            "]\n}}\n",
            json_string(options.mesh), json_string(display->name.view()), points.size(), rows_json(*painted),
            rows_json(evaluated));
        return {};
    }
    fmt::print(
        "{} on {}: {} pixels lit. One core, medians of processor time; a copy is memcpy of the bytes that are "
        "written\n",
        options.mesh, display->name.view(), thousands(points.size()));
    print_rows("into a frame", "voxels", *painted);
    print_rows("colours of such voxels, in batches", "colours", evaluated);
    return {};
}

}  // namespace xorvox::tools
