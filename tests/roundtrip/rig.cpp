#include "tests/roundtrip/rig.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "driver/host/pixel.h"
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

glm::vec3 Octants::color(const glm::vec3& point) {
    return {point.x > 0.4871f ? 1.0f : 0.4f, point.y > 0.5219f ? 0.8f : 0.3f, point.z > 0.4637f ? 0.6f : 0.0f};
}

void Octants::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const {
    std::transform(points.begin(), points.end(), colors.begin(), color);
}

Picture paint(const DisplayDescription& display, const Mesh& mesh) {
    host::FramePainter painter(display);
    const Lattice lattice = painter.lattice().view();
    const DisplayExtent room = extent(display);
    const double reach = room.radius_mm > 0.0 ? room.radius_mm / 1.3 : (room.upper.x - room.lower.x) / 2.0;
    const glm::dvec3 half{reach, room.radius_mm > 0.0 ? reach : (room.upper.y - room.lower.y) / 2.0,
                          (room.upper.z - room.lower.z) / 2.0};
    Mesh placed = mesh;
    for (glm::dvec3& p : placed.positions) p = p * half + (room.lower + room.upper) / 2.0;

    Picture picture;
    auto volume = voxelize(placed.view(), lattice);
    if (!volume) throw std::runtime_error(volume.error().message);
    picture.volume = std::move(*volume);

    const Octants field;
    picture.frame.resize(frame_bytes(display));
    if (painter.paint(picture.volume.view(), field, picture.frame) != Status::Ok) throw std::runtime_error("paint");

    picture.codes.resize(lattice.sample_count());
    std::size_t sample = 0;
    for (std::uint32_t z = 0; z < lattice.nz; ++z) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x, ++sample) {
                if (!picture.volume.test(x, y, z)) continue;
                const glm::dvec3 place = sample_position(lattice, x, y, z);
                const glm::vec3 point((place - room.lower) / (room.upper - room.lower));
                picture.codes[sample] = host::visible_code(Octants::color(point), display.format);
            }
        }
    }
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

sim::Simulator make_simulator(const DisplayDescription& display, Link link, const sim::Misbuild& misbuild) {
    sim::SimulatorOptions options;
    options.misbuild = misbuild;
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

Rig::Rig(const DisplayDescription& display, Over over, const transport::FaultOptions& faults,
         const sim::Misbuild& misbuild)
    : Rig(display, connect(over), over == Over::Tcp, faults, misbuild) {}

Rig::Rig(const DisplayDescription& display, std::pair<UniqueLink, UniqueLink> ends, bool in_kernel,
         const transport::FaultOptions& faults, const sim::Misbuild& misbuild)
    : host_end_(transport::with_faults(std::move(ends.first), faults)),
      device_end_(std::move(ends.second)),
      in_kernel_(in_kernel),
      simulator_(make_simulator(display, device_end_.get(), misbuild)),
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
