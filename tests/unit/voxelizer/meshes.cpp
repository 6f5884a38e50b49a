#include "meshes.h"

namespace xorvox::test {
namespace {

std::uint32_t add_vertex(Mesh& mesh, const glm::dvec3& p) {
    mesh.positions.push_back(p);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

}  // namespace

void add_triangle(Mesh& mesh, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    for (const glm::dvec3& p : {a, b, c}) mesh.indices.push_back(add_vertex(mesh, p));
}

void add_tetrahedron(Mesh& mesh, const Corners& p) {
    add_triangle(mesh, p[0], p[2], p[1]);
    add_triangle(mesh, p[0], p[1], p[3]);
    add_triangle(mesh, p[1], p[2], p[3]);
    add_triangle(mesh, p[2], p[0], p[3]);
}

void add_box(Mesh& mesh, const glm::dvec3& lower, const glm::dvec3& upper) {
    const auto corner = [&](int i) {
        return glm::dvec3(i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z);
    };
    constexpr std::array<std::array<int, 4>, 6> kSides{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& side : kSides) {
        add_triangle(mesh, corner(side[0]), corner(side[1]), corner(side[2]));
        add_triangle(mesh, corner(side[0]), corner(side[2]), corner(side[3]));
    }
}

Mesh box_mesh(const glm::dvec3& lower, const glm::dvec3& upper) {
    Mesh mesh;
    add_box(mesh, lower, upper);
    return mesh;
}

void add_polygon(Mesh& mesh, const Rings& rings) {
    if (mesh.ring_starts.empty()) mesh.ring_starts.push_back(0);
    if (mesh.face_starts.empty()) mesh.face_starts.push_back(0);
    for (const auto& ring : rings) {
        for (const glm::dvec3& p : ring) mesh.indices.push_back(add_vertex(mesh, p));
        mesh.ring_starts.push_back(static_cast<std::uint32_t>(mesh.indices.size()));
    }
    mesh.face_starts.push_back(static_cast<std::uint32_t>(mesh.ring_starts.size() - 1));
}

Mesh prism(const PlanRings& rings, double bottom, double top) {
    Mesh mesh;
    for (const double z : {bottom, top}) {
        Rings cap;
        for (const auto& ring : rings) {
            cap.emplace_back();
            for (const glm::dvec2& p : ring) cap.back().emplace_back(p, z);
        }
        add_polygon(mesh, cap);
    }
    for (const auto& ring : rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2& a = ring[i];
            const glm::dvec2& b = ring[(i + 1) % ring.size()];
            add_polygon(mesh, {{{a, bottom}, {b, bottom}, {b, top}, {a, top}}});
        }
    }
    return mesh;
}

glm::dvec3 IntegerPoints::operator()() {
    glm::dvec3 p{};
    for (int i = 0; i < 3; ++i) p[i] = std::uniform_int_distribution<int>(lower_[i], upper_[i])(random_);
    return p;
}

Mesh tetrahedra(IntegerPoints& points, int count, const glm::dvec3& scale) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        Corners corners;
        for (glm::dvec3& corner : corners) corner = points() * scale;
        add_tetrahedron(mesh, corners);
    }
    return mesh;
}

Lattice integer_lattice(const glm::uvec3& n, const glm::dvec3& pitch) {
    return {.nx = n.x, .ny = n.y, .nz = n.z, .origin = -0.5 * pitch, .pitch = pitch};
}

}  // namespace xorvox::test
