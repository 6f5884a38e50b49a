#include "voxelizer/io/mesh_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace xorvox::io {
namespace {

using Ring = std::span<const std::uint32_t>;

// Calls visit(from, to) for every side of `ring`.
template <class Visit>
void for_each_side(Ring ring, Visit visit) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t from = ring[i];
        const std::uint32_t to = ring[i + 1 < ring.size() ? i + 1 : 0];
        if (from != to) visit(from, to);
    }
}

// A side, filed under the lower of its vertices.
struct Side {
    std::uint32_t higher;
    bool upward;  // Runs from the lower to the higher number.
};

// Sides of all rings: those of lower vertex v are at [start[v], start[v + 1]), sorted by the higher one.
struct SideTable {
    std::vector<std::size_t> start;
    std::vector<Side> sides;
};

// Whether `ring` only goes there and back between two vertices, or stays at one.
bool is_collapsed(Ring ring) {
    if (ring.empty()) return true;
    const auto second = std::find_if(ring.begin(), ring.end(), [&](std::uint32_t v) { return v != ring[0]; });
    return std::none_of(second, ring.end(), [&](std::uint32_t v) { return v != ring[0] && v != *second; });
}

// Calls visit(from, to) for every side that bounds a face.
template <class Visit>
void for_each_side(const MeshView& mesh, Visit visit) {
    for (std::size_t r = 0; r < mesh.ring_count(); ++r) {
        if (!is_collapsed(mesh.ring(r))) for_each_side(mesh.ring(r), visit);
    }
}

SideTable collect_sides(const MeshView& mesh) {
    SideTable table;
    table.start.resize(mesh.positions.size() + 2);
    for_each_side(mesh, [&](std::uint32_t a, std::uint32_t b) { ++table.start[std::min(a, b) + 2]; });
    // start[v + 1] is where v's sides begin until they are filed, then where they end.
    std::partial_sum(table.start.begin(), table.start.end(), table.start.begin());
    table.sides.resize(table.start.back());
    for_each_side(mesh, [&](std::uint32_t a, std::uint32_t b) {
        table.sides[table.start[std::min(a, b) + 1]++] = {std::max(a, b), a < b};
    });
    return table;
}

void count_edges(const MeshView& mesh, MeshReport& report) {
    SideTable table = collect_sides(mesh);
    for (std::size_t v = 0; v + 1 < table.start.size(); ++v) {
        const auto end = table.sides.begin() + static_cast<std::ptrdiff_t>(table.start[v + 1]);
        auto edge = table.sides.begin() + static_cast<std::ptrdiff_t>(table.start[v]);
        std::sort(edge, end, [](const Side& a, const Side& b) { return a.higher < b.higher; });
        while (edge != end) {
            std::size_t upward = 0;
            std::size_t count = 0;
            for (const std::uint32_t higher = edge->higher; edge != end && edge->higher == higher; ++edge) {
                upward += edge->upward ? 1u : 0u;
                ++count;
            }
            report.open_edges += count % 2;
            report.non_manifold_edges += count > 2 ? 1u : 0u;
            report.inconsistent_edges += count % 2 == 0 && 2 * upward != count ? 1u : 0u;
        }
    }
}

using Sides = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// The sides of face `f` as pairs of numbers, lower first, sorted: equal for duplicates.
void sides_of(const MeshView& mesh, std::size_t f, Sides& sides) {
    sides.clear();
    for (std::size_t r = mesh.face_begin(f); r < mesh.face_end(f); ++r) {
        for_each_side(mesh.ring(r), [&](std::uint32_t a, std::uint32_t b) { sides.emplace_back(std::minmax(a, b)); });
    }
    std::sort(sides.begin(), sides.end());
}

std::size_t count_duplicates(const MeshView& mesh) {
    struct Face {
        std::uint64_t hash;  // Of its sides.
        std::size_t number;
    };
    Sides a;
    Sides b;
    std::vector<Face> faces(mesh.face_count());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        sides_of(mesh, f, a);
        std::uint64_t hash = 0xcbf2'9ce4'8422'2325;  // FNV-1a over vertex numbers instead of bytes.
        for (const auto& [low, high] : a) hash = ((hash ^ low) * 0x100'0000'01b3 ^ high) * 0x100'0000'01b3;
        faces[f] = {hash, f};
    }
    std::sort(faces.begin(), faces.end(), [&](const Face& left, const Face& right) {
        if (left.hash != right.hash) return left.hash < right.hash;
        sides_of(mesh, left.number, a);
        sides_of(mesh, right.number, b);
        return a < b;
    });
    std::size_t duplicates = 0;
    for (std::size_t i = 1; i < faces.size(); ++i) {
        if (faces[i].hash != faces[i - 1].hash) continue;
        sides_of(mesh, faces[i - 1].number, a);
        sides_of(mesh, faces[i].number, b);
        duplicates += a == b ? 1u : 0u;
    }
    return duplicates;
}

std::size_t count_components(const MeshView& mesh) {
    constexpr std::uint32_t kUnused = 0xffff'ffff;
    std::vector<std::uint32_t> parent(mesh.positions.size(), kUnused);
    for (const std::uint32_t v : mesh.used_indices()) parent[v] = v;
    const auto root = [&parent](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        std::uint32_t first = kUnused;
        for (std::size_t r = mesh.face_begin(f); r < mesh.face_end(f); ++r) {
            for (const std::uint32_t v : mesh.ring(r)) {
                if (first == kUnused) first = v;
                const std::uint32_t a = root(first);
                const std::uint32_t b = root(v);
                parent[std::max(a, b)] = std::min(a, b);
            }
        }
    }
    std::size_t components = 0;
    for (std::uint32_t v = 0; v < parent.size(); ++v) components += parent[v] == v ? 1u : 0u;
    return components;
}

// Powers of two, one an axis, that bring a box to a size of which cubes do not overflow. Products with them are exact,
// so volumes are the same to the last bit as without.
struct Scale {
    glm::dvec3 factor{1.0};
    int exponent = 0;  // Of what undoes the three factors.
};

Scale scale_of(const glm::dvec3& min, const glm::dvec3& max) {
    constexpr int kMost = 1000;  // 2 to this and to minus this are doubles; what remains of larger ones does no harm.
    Scale scale;
    for (int axis = 0; axis < 3; ++axis) {
        const double extent = max[axis] - min[axis];  // May be infinite, which ilogb takes for very large.
        if (extent <= 0) continue;
        const int exponent = std::clamp(std::ilogb(extent), -kMost, kMost);
        scale.factor[axis] = std::ldexp(1.0, -exponent);
        scale.exponent += exponent;
    }
    return scale;
}

void measure(const MeshView& mesh, MeshReport& report) {
    const auto used = mesh.used_indices();
    if (used.empty()) return;
    report.min = report.max = mesh.positions[used[0]];
    for (const std::uint32_t v : used) {
        report.min = glm::min(report.min, mesh.positions[v]);
        report.max = glm::max(report.max, mesh.positions[v]);
    }
    const Scale scale = scale_of(report.min, report.max);
    const auto scaled = [&](std::uint32_t v) { return mesh.positions[v] * scale.factor; };
    const glm::dvec3 centre = 0.5 * (report.min * scale.factor) + 0.5 * (report.max * scale.factor);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        bool has_area = false;
        for (std::size_t r = mesh.face_begin(f); r < mesh.face_end(f); ++r) {
            const Ring ring = mesh.ring(r);
            if (ring.size() < 3) continue;
            const glm::dvec3 a = scaled(ring[0]);
            for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
                const glm::dvec3 normal = glm::cross(scaled(ring[i]) - a, scaled(ring[i + 1]) - a);
                has_area = has_area || normal != glm::dvec3(0.0);
                report.signed_volume += glm::dot(a - centre, normal) / 6.0;
            }
            report.triangles += ring.size() - 2;
        }
        report.degenerate_faces += has_area ? 0u : 1u;
    }
    report.signed_volume = std::ldexp(report.signed_volume, scale.exponent);
}

}  // namespace

const char* to_string(Orientation orientation) {
    switch (orientation) {
        case Orientation::Undefined: return "undefined";
        case Orientation::Outward: return "outward";
        case Orientation::Inward: return "inward";
    }
    return "undefined";
}

MeshReport report(const MeshView& mesh) {
    MeshReport report;
    report.vertices = mesh.positions.size();
    report.faces = mesh.face_count();
    measure(mesh, report);
    count_edges(mesh, report);
    report.duplicate_faces = count_duplicates(mesh);
    report.components = count_components(mesh);
    report.closed_mod2 = report.open_edges == 0;
    if (report.closed_mod2 && report.inconsistent_edges == 0 && report.signed_volume != 0) {
        report.orientation = report.signed_volume > 0 ? Orientation::Outward : Orientation::Inward;
    }
    return report;
}

}  // namespace xorvox::io
