#include "oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "voxelizer/voxelize.h"

namespace xorvox::test {
namespace {

__extension__ typedef __int128 Wide;

/// c[0] + c[1]·ε + c[2]·ε² + c[3]·ε³: every determinant below is linear in the sample's coordinates.
struct Polynomial {
    std::array<Wide, 4> c{};

    friend Polynomial operator-(Polynomial a, Wide b) {
        a.c[0] -= b;
        return a;
    }
    friend Polynomial operator*(Polynomial a, Wide b) {
        for (Wide& coefficient : a.c) coefficient *= b;
        return a;
    }
    friend Polynomial operator+(Polynomial a, const Polynomial& b) {
        for (std::size_t i = 0; i < 4; ++i) a.c[i] += b.c[i];
        return a;
    }
    /// The sign for all small positive ε.
    int sign() const {
        for (const Wide coefficient : c) {
            if (coefficient != 0) return coefficient > 0 ? 1 : -1;
        }
        return 0;
    }
};

using Point = std::array<std::int64_t, 3>;
using Sample = std::array<Polynomial, 3>;
using Triangle = std::array<Point, 3>;

Wide difference_of(const Point& a, const Point& b, std::size_t axis) {
    return Wide{b[axis]} - a[axis];
}

/// Which side of the line from a to b, seen along the third axis, the sample is on.
int side_of_line(const Point& a, const Point& b, const Sample& s, std::size_t u, std::size_t v) {
    return ((s[v] - a[v]) * difference_of(a, b, u) + (s[u] - a[u]) * -difference_of(a, b, v)).sign();
}

bool ray_meets(const Triangle& t, const Sample& s, std::size_t axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const int side = side_of_line(t[0], t[1], s, u, v);
    if (side == 0 || side_of_line(t[1], t[2], s, u, v) != side || side_of_line(t[2], t[0], s, u, v) != side)
        return false;
    const auto normal = [&t](std::size_t n) {
        const std::size_t p = (n + 1) % 3;
        const std::size_t q = (n + 2) % 3;
        return difference_of(t[0], t[1], p) * difference_of(t[0], t[2], q) -
               difference_of(t[0], t[1], q) * difference_of(t[0], t[2], p);
    };
    const Polynomial height =
        (s[0] - t[0][0]) * normal(0) + (s[1] - t[0][1]) * normal(1) + (s[2] - t[0][2]) * normal(2);
    return height.sign() * (normal(axis) > 0 ? 1 : -1) > 0;
}

/// The grid by the rules of voxelizer/snap.h, written down a second time.
struct Grid {
    std::array<double, 3> origin{};
    std::array<double, 3> length{};
    double steps = 0.0;

    explicit Grid(const Lattice& lattice) {
        if (lattice.plan.empty()) {
            int bits = 0;
            while ((1u << bits) < lattice.nx || (1u << bits) < lattice.ny || (1u << bits) < lattice.nz) ++bits;
            steps = std::ldexp(1.0, 20 - bits);
            for (int i = 0; i < 3; ++i) {
                origin[static_cast<std::size_t>(i)] = lattice.origin[i];
                length[static_cast<std::size_t>(i)] = lattice.pitch[i];
            }
            return;
        }
        steps = std::ldexp(1.0, 20);
        std::array<double, 3> high{};
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                for (std::uint32_t k = 0; k < lattice.nz; ++k) {
                    const glm::dvec3 p = sample_position(lattice, x, y, k);
                    for (int i = 0; i < 3; ++i) {
                        const auto a = static_cast<std::size_t>(i);
                        const bool first = x == 0 && y == 0 && k == 0;
                        origin[a] = first ? p[i] : std::min(origin[a], p[i]);
                        high[a] = first ? p[i] : std::max(high[a], p[i]);
                    }
                }
            }
        }
        const double plan = std::max(high[0] - origin[0], high[1] - origin[1]);
        const double height = high[2] - origin[2];
        const double any = plan > 0.0 ? plan : height > 0.0 ? height : 1.0;
        length = {plan > 0.0 ? plan : any, plan > 0.0 ? plan : any, height > 0.0 ? height : any};
    }

    std::int64_t units(double distance, std::size_t axis) const {
        return static_cast<std::int64_t>(std::nearbyint(distance / length[axis] * steps));
    }
    Point snapped(const glm::dvec3& p) const {
        return {units(p.x - origin[0], 0), units(p.y - origin[1], 1), units(p.z - origin[2], 2)};
    }
    Point sample(const Lattice& lattice, std::uint32_t x, std::uint32_t y, std::uint32_t k) const {
        if (lattice.plan.empty()) {
            const auto pitch = static_cast<std::int64_t>(steps);
            return {x * pitch + pitch / 2, y * pitch + pitch / 2, k * pitch + pitch / 2};
        }
        Point p = snapped(sample_position(lattice, x, y, 0));
        p[2] += units(lattice.z[k] - lattice.z[0], 2);
        return p;
    }
};

std::vector<Triangle> triangles_of(const MeshView& mesh, const Grid& grid) {
    std::vector<Triangle> triangles;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        std::vector<Point> corners;
        std::vector<std::array<Point, 2>> edges;
        for (std::size_t r = mesh.face_begin(f); r < mesh.face_end(f); ++r) {
            const auto ring = mesh.ring(r);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Point from = grid.snapped(mesh.positions[ring[i]]);
                corners.push_back(from);
                edges.push_back({from, grid.snapped(mesh.positions[ring[(i + 1) % ring.size()]])});
            }
        }
        if (corners.empty()) continue;
        const Point apex = *std::min_element(corners.begin(), corners.end());
        for (const auto& [from, to] : edges) triangles.push_back({apex, from, to});
    }
    return triangles;
}

}  // namespace

BitVolume oracle(const MeshView& mesh, const Lattice& lattice, Ray ray) {
    const Grid grid(lattice);
    const std::vector<Triangle> triangles = triangles_of(mesh, grid);
    BitVolume volume(lattice);
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                const Point p = grid.sample(lattice, x, y, k);
                const Sample s{Polynomial{{p[0], 1, 0, 0}}, Polynomial{{p[1], 0, 1, 0}}, Polynomial{{p[2], 0, 0, 1}}};
                for (const Triangle& t : triangles) {
                    if (ray_meets(t, s, static_cast<std::size_t>(ray))) volume.view().flip(x, y, k);
                }
            }
        }
    }
    return volume;
}

std::string difference(const BitVolume& got, const BitVolume& expected) {
    if (got == expected) return {};
    const ConstBitVolumeView a = got.view();
    const ConstBitVolumeView b = expected.view();
    if (a.nx != b.nx || a.ny != b.ny || a.nz != b.nz) return "the shapes differ";
    for (std::uint32_t k = 0; k < a.nz; ++k) {
        for (std::uint32_t y = 0; y < a.ny; ++y) {
            for (std::uint32_t x = 0; x < a.nx; ++x) {
                if (a.test(x, y, k) == b.test(x, y, k)) continue;
                return "voxel (" + std::to_string(x) + ", " + std::to_string(y) + ", " + std::to_string(k) + ") is " +
                       (a.test(x, y, k) ? "set" : "clear") + "; counts " + std::to_string(a.count()) + " and " +
                       std::to_string(b.count());
            }
        }
    }
    return "the padding differs";
}

BitVolume reference(const MeshView& mesh, const Lattice& lattice) {
    struct alignas(16) Block {
        std::byte bytes[16];
    };
    std::vector<Block> scratch(solid_scratch_bytes(mesh, lattice) / sizeof(Block) + 1);
    BitVolume volume(lattice);
    const Status status = voxelize_solid(mesh, lattice, std::as_writable_bytes(std::span(scratch)), volume.view());
    if (status != Status::Ok) throw std::runtime_error(std::string("voxelize_solid: ") + to_string(status));
    return volume;
}

BitVolume voxelized(const MeshView& mesh, const Lattice& lattice) {
    BitVolume expected = reference(mesh, lattice);
    for (const Kernel kernel : available_kernels()) {
        const Expected<BitVolume> got = voxelize(mesh, lattice, SolidOptions{.kernel = kernel});
        if (!got) throw std::runtime_error(std::string(to_string(kernel)) + ": " + got.error().message);
        const std::string differs = difference(*got, expected);
        if (!differs.empty()) throw std::runtime_error(std::string(to_string(kernel)) + ": " + differs);
    }
    return expected;
}

}  // namespace xorvox::test
