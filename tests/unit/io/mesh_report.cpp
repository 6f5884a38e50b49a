#include "voxelizer/io/mesh_report.h"

#include <cmath>
#include <map>
#include <random>
#include <string>

#include "tests/catch.h"

using namespace xorvox;

namespace {

using List = std::vector<std::uint32_t>;

// The unit cube of quads, outward; corner x + 2y + 4z.
const std::vector<List> kCubeFaces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

void add_face(Mesh& mesh, const List& corners, std::uint32_t first = 0) {
    if (mesh.ring_starts.empty()) mesh.ring_starts.push_back(0);
    for (const std::uint32_t corner : corners) mesh.indices.push_back(first + corner);
    mesh.ring_starts.push_back(static_cast<std::uint32_t>(mesh.indices.size()));
}

void add_cube(Mesh& mesh, glm::dvec3 at, double side = 1) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i) mesh.positions.push_back(at + side * glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
    for (const List& face : kCubeFaces) add_face(mesh, face, first);
}

Mesh cube() {
    Mesh mesh;
    add_cube(mesh, {0, 0, 0});
    return mesh;
}

}  // namespace

TEST_CASE("report of a cube") {
    const auto r = io::report(cube().view());
    CHECK(r.vertices == 8);
    CHECK(r.faces == 6);
    CHECK(r.triangles == 12);
    CHECK(r.min == glm::dvec3(0));
    CHECK(r.max == glm::dvec3(1));
    CHECK(r.open_edges == 0);
    CHECK(r.non_manifold_edges == 0);
    CHECK(r.inconsistent_edges == 0);
    CHECK(r.degenerate_faces == 0);
    CHECK(r.duplicate_faces == 0);
    CHECK(r.components == 1);
    CHECK(r.signed_volume == Approx(1));
    CHECK(r.closed_mod2);
    CHECK(r.orientation == io::Orientation::Outward);
}

TEST_CASE("report of a cube without a lid counts its four open edges") {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
    for (std::size_t f = 0; f < 5; ++f) add_face(mesh, kCubeFaces[f]);
    const auto r = io::report(mesh.view());
    CHECK(r.open_edges == 4);
    CHECK_FALSE(r.closed_mod2);
    CHECK(r.orientation == io::Orientation::Undefined);
    CHECK(r.inconsistent_edges == 0);
}

TEST_CASE("report of a cube inside out is inward") {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
    for (const List& face : kCubeFaces) add_face(mesh, {face.rbegin(), face.rend()});
    const auto r = io::report(mesh.view());
    CHECK(r.signed_volume == Approx(-1));
    CHECK(r.orientation == io::Orientation::Inward);
}

TEST_CASE("report of a flipped face finds the edges around it") {
    Mesh mesh = cube();
    std::swap(mesh.indices[1], mesh.indices[3]);
    const auto r = io::report(mesh.view());
    CHECK(r.inconsistent_edges == 4);
    CHECK(r.closed_mod2);
    CHECK(r.orientation == io::Orientation::Undefined);
}

TEST_CASE("report of two cubes that share an edge: closed, not manifold") {
    Mesh mesh = cube();
    for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(1 + (i & 1), 1 + (i >> 1 & 1), i >> 2);
    for (const List& face : kCubeFaces) {
        List shared;
        for (const std::uint32_t corner : face) shared.push_back(corner == 0 ? 3 : corner == 4 ? 7 : 8 + corner);
        add_face(mesh, shared);
    }
    const auto r = io::report(mesh.view());
    CHECK(r.non_manifold_edges == 1);
    CHECK(r.open_edges == 0);
    CHECK(r.inconsistent_edges == 0);
    CHECK(r.components == 1);
    CHECK(r.orientation == io::Orientation::Outward);
    CHECK(r.signed_volume == Approx(2));
}

TEST_CASE("report of an edge with three faces: open and not manifold") {
    Mesh mesh = cube();
    mesh.positions.emplace_back(0.5, -1, -1);
    add_face(mesh, {0, 1, 8});
    const auto r = io::report(mesh.view());
    CHECK(r.non_manifold_edges == 1);
    CHECK(r.open_edges == 3);
}

TEST_CASE("report counts pieces, and only vertices in use make the box") {
    Mesh mesh = cube();
    add_cube(mesh, {5, 5, 5}, 2);
    mesh.positions.emplace_back(100, 100, 100);
    const auto r = io::report(mesh.view());
    CHECK(r.components == 2);
    CHECK(r.vertices == 17);
    CHECK(r.max == glm::dvec3(7));
    CHECK(r.signed_volume == Approx(9));
}

TEST_CASE("report takes a face for a duplicate wherever it starts and whichever way it runs") {
    Mesh mesh = cube();
    add_face(mesh, {3, 1, 0, 2});
    add_face(mesh, {1, 3, 2, 0});
    add_face(mesh, {0, 1, 2, 3});  // The same corners, but a bow tie.
    const auto r = io::report(mesh.view());
    CHECK(r.duplicate_faces == 2);
}

TEST_CASE("report lets a face of two corners, there and back, change no edge") {
    Mesh mesh = cube();
    add_face(mesh, {0, 0, 1});
    add_face(mesh, {1, 3, 1, 3});
    add_face(mesh, {2, 2, 2});
    add_face(mesh, {0, 0, 3, 0});  // 0 and 3 are opposite corners of a quad.
    const auto r = io::report(mesh.view());
    CHECK(r.open_edges == 0);
    CHECK(r.non_manifold_edges == 0);
    CHECK(r.inconsistent_edges == 0);
    CHECK(r.closed_mod2);
    CHECK(r.orientation == io::Orientation::Outward);
    CHECK(r.degenerate_faces == 4);
    CHECK(r.duplicate_faces == 0);
}

TEST_CASE("report counts the open edges that parity has, whatever the faces repeat") {
    std::mt19937 random(36);
    for (int round = 0; round < 2000; ++round) {
        Mesh mesh;
        mesh.positions.resize(5);
        std::map<std::pair<std::uint32_t, std::uint32_t>, bool> odd;
        for (int face = 0; face < 4; ++face) {
            List corners(3 + random() % 3);
            for (std::uint32_t& corner : corners) corner = static_cast<std::uint32_t>(random() % 5);
            add_face(mesh, corners);
            for (std::size_t i = 0; i < corners.size(); ++i) {
                const auto edge = std::minmax(corners[i], corners[(i + 1) % corners.size()]);
                if (edge.first != edge.second) odd[edge] = !odd[edge];
            }
        }
        std::size_t open = 0;
        for (const auto& [edge, is_odd] : odd) open += is_odd ? 1u : 0u;
        REQUIRE(io::report(mesh.view()).open_edges == open);
    }
}

TEST_CASE("report of a volume is finite wherever a double can hold it, and never nan") {
    const auto of_cube = [](double at, double side) {
        Mesh mesh;
        add_cube(mesh, glm::dvec3(at), side);
        return io::report(mesh.view());
    };
    CHECK(of_cube(0, 0x1p340).signed_volume == 0x1p1020);
    CHECK(of_cube(0, 0x1p-340).signed_volume == 0x1p-1020);
    CHECK(of_cube(0x1p300, 0x1p290).signed_volume == 0x1p870);
    for (const double side : {1e200, 1.7e308}) {
        const auto r = of_cube(-side / 2, side);
        CHECK(r.signed_volume == HUGE_VAL);
        CHECK(r.orientation == io::Orientation::Outward);
        CHECK(r.degenerate_faces == 0);
    }
    CHECK(of_cube(0, -1e200).signed_volume == -HUGE_VAL);
    CHECK(of_cube(0, 1e-200).signed_volume == 0);
    CHECK(of_cube(0, 1e-200).degenerate_faces == 0);
    CHECK(of_cube(0, 5e-324).degenerate_faces == 0);
    CHECK(of_cube(1e308, 0).signed_volume == 0);
    // Long in one direction and thin in the others: the volume is a number though the cube of the length is none.
    Mesh needle = cube();
    for (glm::dvec3& p : needle.positions) p *= glm::dvec3(1e300, 1e-10, 1e-10);
    CHECK(io::report(needle.view()).signed_volume == Approx(1e280));
    // From one end of the range of doubles to the other.
    Mesh widest = cube();
    for (glm::dvec3& p : widest.positions) p = (p * 2.0 - 1.0) * glm::dvec3(1.7e308, 1e-308, 1);
    CHECK(io::report(widest.view()).signed_volume == Approx(3.4 * 2 * 2));
    // A plane figure has none.
    Mesh flat = cube();
    for (glm::dvec3& p : flat.positions) p *= glm::dvec3(1e200, 1e200, 0);
    CHECK(io::report(flat.view()).signed_volume == 0);
}

TEST_CASE("report finds faces without area") {
    Mesh mesh = cube();
    mesh.positions.emplace_back(2, 0, 0);
    mesh.positions.emplace_back(0, 0, 0);
    add_face(mesh, {0, 1, 8});     // On a line.
    add_face(mesh, {0, 0, 1});     // A corner twice.
    add_face(mesh, {1, 0, 9});     // Two vertices at one place.
    add_face(mesh, {0, 1, 8, 1});  // There and back.
    add_face(mesh, {0, 1, 8, 3});  // A quad with three corners on a line has area.
    add_face(mesh, {0, 1, 2, 3});  // A bow tie has area, though its halves cancel.
    const auto r = io::report(mesh.view());
    CHECK(r.degenerate_faces == 4);
}

TEST_CASE("report takes a polygon with a hole as one face") {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0}};
    mesh.indices = {0, 1, 2, 3, 4, 7, 6, 5};
    mesh.ring_starts = {0, 4, 8};
    mesh.face_starts = {0, 2};
    auto r = io::report(mesh.view());
    CHECK(r.faces == 1);
    CHECK(r.triangles == 4);
    CHECK(r.open_edges == 8);
    CHECK(r.components == 1);
    CHECK(r.degenerate_faces == 0);
    // The same again with the rings the other way round and in the other order.
    mesh.indices = {0, 1, 2, 3, 4, 7, 6, 5, 5, 6, 7, 4, 3, 2, 1, 0};
    mesh.ring_starts = {0, 4, 8, 12, 16};
    mesh.face_starts = {0, 2, 4};
    r = io::report(mesh.view());
    CHECK(r.duplicate_faces == 1);
    CHECK(r.closed_mod2);
}

TEST_CASE("report of a torus of triangles") {
    constexpr std::uint32_t kAround = 48;
    constexpr std::uint32_t kAcross = 24;
    const double tau = 2 * std::acos(-1.0);
    Mesh mesh;
    for (std::uint32_t i = 0; i < kAround; ++i) {
        for (std::uint32_t j = 0; j < kAcross; ++j) {
            const double a = tau * i / kAround;
            const double b = tau * j / kAcross;
            mesh.positions.emplace_back((3 + std::cos(b)) * std::cos(a), (3 + std::cos(b)) * std::sin(a), std::sin(b));
            const std::uint32_t right = (i + 1) % kAround * kAcross;
            const std::uint32_t above = (j + 1) % kAcross;
            const std::uint32_t here = i * kAcross;
            mesh.indices.insert(mesh.indices.end(),
                                {here + j, right + j, right + above, here + j, right + above, here + above});
        }
    }
    const auto r = io::report(mesh.view());
    CHECK(r.triangles == 2 * kAround * kAcross);
    CHECK(r.open_edges == 0);
    CHECK(r.non_manifold_edges == 0);
    CHECK(r.inconsistent_edges == 0);
    CHECK(r.components == 1);
    CHECK(r.orientation == io::Orientation::Outward);
    CHECK(r.signed_volume == Approx(tau * tau / 2 * 3).epsilon(0.02));
}

TEST_CASE("report of nothing, and of a part of a mesh") {
    const auto none = io::report(MeshView{});
    CHECK(none.faces == 0);
    CHECK(none.closed_mod2);
    CHECK(none.orientation == io::Orientation::Undefined);
    const Mesh mesh = cube();
    MeshView view = mesh.view();
    view.ring_starts = view.ring_starts.subspan(1, 2);  // The second face only.
    const auto part = io::report(view);
    CHECK(part.faces == 1);
    CHECK(part.open_edges == 4);
    CHECK(part.min == glm::dvec3(0, 0, 1));
    CHECK(part.components == 1);
}

TEST_CASE("orientations have names") {
    CHECK(std::string(io::to_string(io::Orientation::Outward)) == "outward");
    CHECK(std::string(io::to_string(io::Orientation::Inward)) == "inward");
    CHECK(std::string(io::to_string(io::Orientation::Undefined)) == "undefined");
}
