#include "tests/roundtrip/rig.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include <glm/common.hpp>

#include "driver/display/lattice.h"
#include "driver/host/pixel_encoder.h"
#include "driver/host/slices.h"
#include "transport/loopback.h"
#include "transport/tcp.h"
#include "voxelizer/voxelize.h"

namespace xorvox::test {

Mesh lopsided(std::uint32_t turn) {
    Mesh mesh;
    const double t = 0.13 * turn;
    mesh.positions = {{-0.9 + t, -0.8, -0.97}, {0.96, -0.7 + t, -0.9}, {-0.3, 0.93 - t, -0.8}, {0.2 - t, 0.15, 0.98}};
    mesh.indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    return mesh;
}

Mesh hollow(std::uint32_t turn) {
    Mesh mesh = lopsided(turn);
    const auto corners = static_cast<std::uint32_t>(mesh.positions.size());
    const std::vector<std::uint32_t> faces = mesh.indices;
    glm::dvec3 middle(0.0);
    for (std::uint32_t i = 0; i < corners; ++i) middle += mesh.positions[i] / static_cast<double>(corners);
    for (std::uint32_t i = 0; i < corners; ++i) mesh.positions.push_back(middle + 0.92 * (mesh.positions[i] - middle));
    for (const std::uint32_t index : faces) mesh.indices.push_back(index + corners);
    return mesh;
}

namespace {

constexpr glm::vec3 kBorder(0.4871f, 0.5219f, 0.4637f);  ///< Of Octants.

bool is_at_a_border(const glm::dvec3& point) {
    constexpr double kNear = 1e-6;
    const glm::dvec3 away = glm::abs(point - glm::dvec3(kBorder));
    return std::min({away.x, away.y, away.z}) < kNear;
}

/// As large as the display, and where it is.
Mesh placed_in(const DisplayExtent& room, Mesh mesh) {
    glm::dvec3 half = (room.upper - room.lower) / 2.0;
    if (room.radius_mm > 0.0) half.x = half.y = room.radius_mm / 1.3;
    for (glm::dvec3& p : mesh.positions) p = p * half + (room.lower + room.upper) / 2.0;
    return mesh;
}

}  // namespace

glm::vec3 Octants::color(const glm::vec3& point) {
    return {point.x > kBorder.x ? 1.0f : 0.4f, point.y > kBorder.y ? 0.8f : 0.3f, point.z > kBorder.z ? 0.6f : 0.0f};
}

void Octants::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const {
    std::transform(points.begin(), points.end(), colors.begin(), color);
}

void Plain::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const {
    std::fill_n(colors.begin(), points.size(), kColor);
}

Picture paint(const DisplayDescription& display, const Mesh& mesh, const host::ColorField& field) {
    const host::FramePainter painter(display);
    const host::PixelEncoder encoder(display);
    const Lattice lattice = painter.lattice().view();
    const DisplayExtent room = extent(display);
    Picture picture;
    auto volume = voxelize(placed_in(room, mesh).view(), lattice);
    if (!volume) throw std::runtime_error(volume.error().message);
    picture.volume = std::move(*volume);

    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            const std::span<std::uint64_t> row = picture.volume.view().row(y, k);
            for (std::size_t word = 0; word < row.size(); ++word) {
                for (std::uint64_t rest = row[word]; rest != 0; rest &= rest - 1) {
                    const auto x =
                        static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(rest));
                    const glm::dvec3 place = sample_position(lattice, x, y, k);
                    const glm::dvec3 point = (place - room.lower) / (room.upper - room.lower);
                    if (is_at_a_border(point)) {
                        picture.volume.view().flip(x, y, k);
                        continue;
                    }
                    const glm::vec3 asked(point);
                    glm::vec3 color;
                    field.evaluate({&asked, 1}, {&color, 1});
                    const std::uint64_t sample = (std::uint64_t{k} * lattice.ny + y) * lattice.nx + x;
                    picture.codes.push_back({sample, encoder.nearest(color)});
                }
            }
        }
    }
    picture.frame.resize(frame_bytes(display));
    if (painter.paint(picture.volume.view(), field, picture.frame) != Status::Ok) throw std::runtime_error("paint");
    return picture;
}

namespace {

std::pair<UniqueLink, UniqueLink> connect(Rig::Over over) {
    if (over == Rig::Over::Loopback) return transport::make_loopback();
    auto listener = transport::TcpListener::listen(0);
    if (!listener) throw std::runtime_error(listener.error().message);
    auto host_end = transport::connect_tcp("127.0.0.1", listener->port());
    if (!host_end) throw std::runtime_error(host_end.error().message);
    UniqueLink device_end;
    while (listener->accept(device_end) == Status::WouldBlock) (void)listener->wait(1'000'000'000);
    return {std::move(*host_end), std::move(device_end)};
}

sim::Simulator make_simulator(const DisplayDescription& display, Link link, const sim::Faults& broken) {
    sim::SimulatorOptions options;
    options.faults = broken;
    auto simulator = sim::Simulator::make(display, link, options);
    if (!simulator) throw std::runtime_error(simulator.error().message);
    return std::move(*simulator);
}

host::SessionOptions patient() {
    host::SessionOptions options;
    options.attempts = 1000;
    return options;
}

}  // namespace

Rig::Rig(const DisplayDescription& display, Over over, const transport::FaultOptions& faults, const sim::Faults& broken)
    : Rig(display, connect(over), over == Over::Tcp, faults, broken) {}

Rig::Rig(const DisplayDescription& display, std::pair<UniqueLink, UniqueLink> ends, bool in_kernel,
         const transport::FaultOptions& faults, const sim::Faults& broken)
    : host_end_(transport::with_faults(std::move(ends.first), faults)),
      device_end_(std::move(ends.second)),
      in_kernel_(in_kernel),
      simulator_(make_simulator(display, device_end_.get(), broken)),
      session_(host_end_.get(), display, patient()) {}

void Rig::look() {
    const device::Shown shown = simulator_.device().shown();
    // A small page is compared after every step, a large one when it comes.
    if (shown.page.empty() || (shown.frame == looked_at_ && shown.page.size() > 100'000)) return;
    looked_at_ = shown.frame;
    const bool known = std::any_of(sent_.begin(), sent_.end(),
                                   [&](const auto& frame) { return std::ranges::equal(frame, shown.page); });
    whole_ = whole_ && known;
}

bool Rig::show(const std::vector<std::byte>& frame) {
    sent_.push_back(frame);
    bool submitted = false;
    while (session_.state() != host::SessionState::Failed) {
        const Status host_moved = session_.poll(now_ns_);
        const Status device_moved = simulator_.poll(now_ns_);
        look();
        if (!submitted) submitted = session_.submit(frame) == Status::Ok;
        if (submitted && session_.idle() && simulator_.device().shown().frame == session_.last_accepted()) {
            return true;
        }
        if (host_moved != Status::WouldBlock || device_moved != Status::WouldBlock) continue;
        if (in_kernel_) {
            // Bytes may still be on their way; time goes on, in longer steps, only when nothing comes.
            if (host_end_->wait(session_.events(), 200'000) == Status::Ok) continue;
            now_ns_ += 100'000'000;
        }
        now_ns_ = std::max(now_ns_, simulator_.next_boundary_ns());
    }
    return false;
}

}  // namespace xorvox::test
