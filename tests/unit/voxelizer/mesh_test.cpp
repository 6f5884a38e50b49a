#include "voxelizer/mesh.h"

#include "tests/catch.h"

using namespace xorvox;

namespace {

/// The drawing at the head of mesh.h: a triangle, a triangle and a square in two faces.
Mesh drawing() {
    return {std::vector<glm::dvec3>(8), {3, 0, 1, 2, 1, 0, 4, 5, 6, 7}, {0, 3, 6, 10}, {0, 1, 3}};
}

}  // namespace

TEST_CASE("the drawing of the mesh layout is valid") {
    const Mesh mesh = drawing();
    CHECK(validate(mesh.view()) == Status::Ok);
    CHECK(mesh.view().ring_count() == 3);
    CHECK(mesh.view().face_count() == 2);
    CHECK(mesh.view().used_indices().size() == 10);
}

TEST_CASE("without tables every three indices are a face") {
    Mesh mesh = drawing();
    mesh.ring_starts = {};
    mesh.face_starts = {};
    CHECK(validate(mesh.view()) == Status::InvalidArgument);
    mesh.indices.resize(9);
    CHECK(validate(mesh.view()) == Status::Ok);
    CHECK(mesh.view().used_indices().size() == 9);
    CHECK(validate(MeshView{}) == Status::Ok);
    CHECK(MeshView{}.used_indices().empty());
}

TEST_CASE("the place of a vertex number that is too large is told, unless no face uses it") {
    Mesh mesh = drawing();
    mesh.indices[4] = 8;
    mesh.indices[7] = 8;
    std::size_t bad_index = 99;
    CHECK(validate(mesh.view(), &bad_index) == Status::InvalidArgument);
    CHECK(bad_index == 4);
    mesh.face_starts = {0, 1};
    CHECK(validate(mesh.view(), &bad_index) == Status::Ok);
    CHECK(mesh.view().used_indices().size() == 3);
}

TEST_CASE("a table at fault is told by the number of indices") {
    Mesh mesh = drawing();
    mesh.face_starts = {0, 4};
    std::size_t bad_index = 99;
    CHECK(validate(mesh.view(), &bad_index) == Status::InvalidArgument);
    CHECK(bad_index == 10);
}
