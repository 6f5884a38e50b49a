#include "tests/unit/io/contains.h"
#include "tests/unit/io/hostile.h"
#include "voxelizer/io/mesh_file.h"

using namespace xorvox;

namespace {

const Parse kParse = io::parse_obj;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::vector<std::uint32_t> corners(const std::string& faces) {
    const auto mesh = io::parse_obj(kSquare + faces, "file");
    REQUIRE(mesh);
    return mesh->indices;
}

std::string refused(const std::string& line) {
    return refusal(kParse, kSquare + line + "\n");
}

using List = std::vector<std::uint32_t>;

}  // namespace

TEST_CASE("obj: polygons stay polygons, triangles alone need no ring table") {
    const auto quad = io::parse_obj(kSquare + "f 1 2 3 4\nf 4 3 2\n", "file");
    REQUIRE(quad);
    CHECK(quad->positions == std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    CHECK(quad->indices == List{0, 1, 2, 3, 3, 2, 1});
    CHECK(quad->ring_starts == List{0, 4, 7});
    const auto triangle = io::parse_obj(kSquare + "f 1 2 3", "file");
    REQUIRE(triangle);
    CHECK(triangle->ring_starts.empty());
}

TEST_CASE("obj: all forms of a corner name its vertex") {
    CHECK(corners("f 1/1 2/2 3/3\n") == List{0, 1, 2});
    CHECK(corners("f 1//1 2//2 4//3\n") == List{0, 1, 3});
    CHECK(corners("f 1/7/1 2/7/2 4/7/3\n") == List{0, 1, 3});
    CHECK(corners("f 1/ 2// 3//\n") == List{0, 1, 2});
    CHECK(corners("f -4 -3/-1 -1/-1/-1\n") == List{0, 1, 3});
}

TEST_CASE("obj: negative numbers count from the last vertex so far") {
    const auto mesh = io::parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -1 -2 -3\n", "file");
    REQUIRE(mesh);
    CHECK(mesh->indices == List{0, 1, 2, 3, 2, 1});
}

TEST_CASE("obj: a face may come before its vertices") {
    const auto mesh = io::parse_obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", "file");
    REQUIRE(mesh);
    CHECK(mesh->indices == List{0, 1, 2});
    CHECK_THAT(refusal(kParse, "# first\nf 1 2 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"),
               contains("file: line 2: vertex 4 of a file with 3"));
}

TEST_CASE("obj: weights and colours are passed over, doubles stay doubles") {
    const auto mesh = io::parse_obj("v 0.1 2e-300 +3 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 1 1 1\nf 1 2 3\n", "file");
    REQUIRE(mesh);
    CHECK(mesh->positions == std::vector<glm::dvec3>{{0.1, 2e-300, 3}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("obj: everything that is no geometry is passed over") {
    const auto mesh = io::parse_obj("\xef\xbb\xbf# a mark and a comment \\\n\r\nmtllib C:\\models\\\n" + kSquare +
                                        "vt 0.5 \\\n0.5\nvn 0 0 1\nvp 0 0\no name # 1\ng a b\ns off\nusemtl red\nl 1 "
                                        "2\np 1\n  f 1 2 \\\r\n\t3 4 # the face\n",
                                    "file");
    REQUIRE(mesh);
    CHECK(mesh->positions.size() == 4);
    CHECK(mesh->indices == List{0, 1, 2, 3});
}

TEST_CASE("obj: what is wrong is named with its line") {
    CHECK_THAT(refused("f 1 2"), contains("file: line 5: a face of 2 corners"));
    CHECK_THAT(refused("f"), contains("a face of 0 corners"));
    CHECK_THAT(refused("f 1 2 0"), contains("'0' is vertex 0, but the first one is 1"));
    CHECK_THAT(refused("f 1 2 5"), contains("line 5: vertex 5 of a file with 4"));
    CHECK_THAT(refused("f 1 2 4294967297"), contains("beyond the last vertex"));
    CHECK_THAT(refused("f 1 2 99999999999999999999"), contains("is too large"));
    CHECK_THAT(refused("f 1 2 -5"), contains("'-5' goes back before the first of 4 vertices"));
    CHECK_THAT(refused("f 1 2 3.5"), contains("'3.5' is not a whole number"));
    CHECK_THAT(refused("f 1 2 3/x"), contains("'3/x' is none of"));
    CHECK_THAT(refused("f 1 2 3/1/1/1"), contains("'3/1/1/1' is none of"));
    CHECK_THAT(refused("v 1 2"), contains("line 5: a vertex of 2 numbers"));
    CHECK_THAT(refused("v 1 2 3 4 5"), contains("a vertex of 5 numbers"));
    CHECK_THAT(refused("v 1 2 3 4 5 6 7 8"), contains("more than 7"));
    CHECK_THAT(refused("v 1 nan 3"), contains("'nan' is not a finite number"));
    CHECK_THAT(refused("v 1 -1e999 3"), contains("'-1e999' is beyond the range"));
    CHECK_THAT(refused("v 1 2 three"), contains("'three' is not a number"));
    CHECK_THAT(refused("v 1 \\\n2 \\\nthree"), contains("line 7"));
    CHECK_THAT(refused("surf 0 1 0 1"), contains("line 5: the keyword 'surf' is not read"));
    CHECK_THAT(refused("\x01\xff"), contains("'\\x01\\xff'"));
    CHECK_THAT(refusal(kParse, kSquare), contains("file: 4 vertices but no faces"));
    CHECK_THAT(refusal(kParse, "# nothing"), contains("0 vertices but no faces"));
}

TEST_CASE("obj: cut at every length and mutated at random it gives a mesh or a message") {
    check_hostile_variants(kParse, kSquare + "vt 0 0\nf 1/1/1 2//2 \\\n3/3 -1\ng name\nf 1 2 3\n");
}
