#include "examples/duck.h"

#include "tests/catch.h"
#include "tests/unit/io/temp_folder.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/mesh_report.h"

using namespace xorvox;

TEST_CASE("the demo model is what make_duck writes") {
    const bool same = contents(XORVOX_SOURCE_DIR "/examples/duck.ply") == examples::duck_ply();
    CHECK(same);
}

TEST_CASE("the demo model is closed, outward and stands upright") {
    const auto mesh = io::read_mesh(XORVOX_SOURCE_DIR "/examples/duck.ply");
    REQUIRE(mesh);
    const auto r = io::report(mesh->view());
    CHECK(r.triangles >= 50'000);
    CHECK(r.triangles <= 100'000);
    CHECK(r.open_edges == 0);
    CHECK(r.non_manifold_edges == 0);
    CHECK(r.inconsistent_edges == 0);
    CHECK(r.degenerate_faces == 0);
    CHECK(r.duplicate_faces == 0);
    CHECK(r.components == 1);
    CHECK(r.orientation == io::Orientation::Outward);
    // As many vertices in the file as positions: nothing was welded.
    CHECK(r.vertices * 2 == r.triangles + 4);
    const glm::dvec3 size = r.max - r.min;
    CHECK(size.x > 90);
    CHECK(size.x < 130);
    CHECK(size.z > size.y);
}
