#include "driver/host/example_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/lattice.h"
#include "driver/host/color.h"
#include "driver/host/encoder.h"
#include "driver/host/slices.h"
#include "driver/wire/messages.h"
#include "driver/wire/packet.h"
#include "voxelizer/mesh.h"
#include "voxelizer/voxelize.h"

namespace xorvox::host {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kExampleTurnsPerSecond = 10.0 / 60.0;
constexpr std::size_t kFrameBeginBytes = 21;
constexpr std::size_t kFrameEndBytes = 8;

/// The lobed ball in the box of `room`, turned by `turns`.
Mesh make_ball(const DisplayExtent& room, double turns) {
    constexpr std::uint32_t kRings = 64;
    constexpr std::uint32_t kSegments = 128;
    constexpr double kFilled = 63.0 / 64.0;
    const double reach = room.radius_mm > 0.0 ? room.radius_mm : 0.5 * (room.upper.x - room.lower.x);
    const double reach_y = room.radius_mm > 0.0 ? room.radius_mm : 0.5 * (room.upper.y - room.lower.y);
    const glm::dvec3 half = kFilled * glm::dvec3(reach, reach_y, 0.5 * (room.upper.z - room.lower.z));
    const glm::dvec3 middle = 0.5 * (room.lower + room.upper);
    Mesh mesh;
    for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
        const double polar = kTurn / 2.0 * ring / kRings;
        for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
            const double around = kTurn * segment / kSegments;
            const double lobes = 0.75 + 0.25 * std::cos(5.0 * around) * std::sin(polar);
            const double away = lobes * std::sin(polar);
            const glm::dvec3 place(away * std::cos(around + kTurn * turns), away * std::sin(around + kTurn * turns),
                                   -std::cos(polar));
            mesh.positions.push_back(middle + half * place);
        }
    }
    for (std::uint32_t ring = 0; ring < kRings; ++ring) {
        for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
            const std::uint32_t next = (segment + 1) % kSegments;
            const std::uint32_t low = ring * kSegments;
            const std::uint32_t high = low + kSegments;
            mesh.indices.insert(mesh.indices.end(),
                                {low + segment, low + next, high + next, low + segment, high + next, high + segment});
        }
    }
    return mesh;
}

/// A display of fewer slices at the same place. `heights` keeps its uneven planes.
DisplayDescription with_fewer_slices(const DisplayDescription& display, std::uint32_t slices,
                                     std::vector<double>& heights) {
    DisplayDescription fewer = display;
    fewer.slices = slices;
    fewer.plane_pitch_mm = display.plane_pitch_mm * display.slices / slices;
    if (!display.plane_heights_mm.empty()) {
        for (std::uint64_t slice = 0; slice < slices; ++slice) {
            heights.push_back(display.plane_heights_mm[slice * display.slices / slices]);
        }
        fewer.plane_heights_mm = heights;
    }
    return fewer;
}

double wire_bytes(const FrameEncoder& encoder) {
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < encoder.payload_count(); ++i) {
        bytes += encoder.payload(i).bytes.size() + wire::kPacketOverhead;
    }
    return static_cast<double>(bytes);
}

}  // namespace

Expected<ExampleFrames> measure_example(const DisplayDescription& display, std::uint64_t most_samples) {
    const std::uint64_t slice_samples = frame_pixels(display) / display.slices;
    const auto slices =
        static_cast<std::uint32_t>(std::clamp<std::uint64_t>(most_samples / slice_samples, 1, display.slices));
    std::vector<double> heights;
    const DisplayDescription measured =
        slices == display.slices ? display : with_fewer_slices(display, slices, heights);
    const double scale = static_cast<double>(display.slices) / slices;

    const FramePainter painter(measured);
    const Lattice lattice = painter.lattice().view();
    const double turns_a_frame = kExampleTurnsPerSecond / display.cycles_per_second;
    BitVolume volumes[2];
    for (int i = 0; i < 2; ++i) {
        const Mesh ball = make_ball(extent(measured), i * turns_a_frame);
        Expected<BitVolume> volume = voxelize(ball.view(), lattice);
        if (!volume) return tl::unexpected(volume.error());
        volumes[i] = std::move(*volume);
    }

    ExampleFrames result;
    result.measured_slices = slices;
    result.lit = static_cast<double>(volumes[0].count()) / static_cast<double>(lattice.sample_count());
    std::vector<std::byte> frames[2];
    for (std::vector<std::byte>& frame : frames) frame.resize(frame_bytes(measured));
    FrameEncoder encoder({.max_packet_bytes = wire::kMaxPacketBytes, .lz4 = true});
    const auto measure = [&](std::string_view color, ExampleBytes& bytes) -> Expected<void> {
        const auto field = parse_color(color);
        if (!field) return tl::unexpected(field.error());
        for (int i = 0; i < 2; ++i) {
            if (painter.paint(volumes[i].view(), **field, frames[i]) != Status::Ok) {
                return fail("the example could not be painted");
            }
        }
        encoder.encode({.id = 1, .content = frames[0]});
        bytes.keyframe = scale * wire_bytes(encoder);
        encoder.encode({.id = 2, .content = frames[1], .base_id = 1, .base = frames[0]});
        bytes.moving = scale * wire_bytes(encoder);
        return {};
    };
    if (const auto done = measure("constant:white", result.constant); !done) return tl::unexpected(done.error());
    if (const auto done = measure("gradient", result.gradient); !done) return tl::unexpected(done.error());
    return result;
}

std::uint64_t raw_wire_bytes(std::uint64_t frame_bytes) {
    constexpr std::uint64_t kInPacket = wire::kMaxPacketBytes - wire::kPacketOverhead - wire::kChunkHeaderBytes;
    const std::uint64_t chunks = (frame_bytes + kInPacket - 1) / kInPacket;
    return frame_bytes + chunks * (wire::kPacketOverhead + wire::kChunkHeaderBytes) + kFrameBeginBytes +
           kFrameEndBytes + 2 * wire::kPacketOverhead;
}

}  // namespace xorvox::host
