#include <cstring>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/hostile.h"
#include "voxelizer/io/mesh_file.h"

using namespace xorvox;

namespace {

const Parse kParse = io::parse_stl;

std::string binary(std::string header, const std::vector<float>& coordinates) {
    header.resize(80, ' ');
    const auto count = static_cast<std::uint32_t>(coordinates.size() / 9);
    header.append(reinterpret_cast<const char*>(&count), 4);
    for (std::uint32_t i = 0; i < count; ++i) {
        header.append(12, '\xff');  // The normal is nan, as degenerate ones are in real files.
        header.append(reinterpret_cast<const char*>(&coordinates[9 * i]), 36);
        header.append("\x01\x80", 2);
    }
    return header;
}

const std::vector<float> kTwoTriangles = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0.1f, 0, 1};

const std::string kText =
    "solid two words\n"
    "  facet normal 0 0 1\n"
    "    outer loop\n"
    "      vertex 0 0 0\n"
    "      vertex 1 0 0\n"
    "      vertex 0 1 0\n"
    "    endloop\n"
    "  endfacet\n"
    "  FACET NORMAL -nan(ind) nan 0\n"
    "    OUTER LOOP\n"
    "      VERTEX 0 0 0\n"
    "      VERTEX 0 1 0\n"
    "      VERTEX 1e-1 0 1\n"
    "    ENDLOOP\n"
    "  ENDFACET\n"
    "endsolid two words\n";

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("stl: binary is told by its size, whatever its header says") {
    for (const char* header : {"", "solid", "solid facet normal", "ply"}) {
        const auto mesh = io::parse_stl(binary(header, kTwoTriangles), "file");
        REQUIRE(mesh);
        CHECK(mesh->positions.size() == 6);
        CHECK(mesh->positions[5] == glm::dvec3(0.1f, 0, 1));
        CHECK(mesh->indices == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5});
        CHECK(mesh->ring_starts.empty());
    }
}

TEST_CASE("stl: text in either case, with nonsense for normals") {
    const auto mesh = io::parse_stl(kText, "file");
    REQUIRE(mesh);
    CHECK(mesh->positions.size() == 6);
    CHECK(mesh->positions[5] == glm::dvec3(0.1, 0, 1));
    CHECK(mesh->view().face_count() == 2);
}

TEST_CASE("stl: several solids, words on other lines, no names") {
    const std::string one_line =
        "solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0\n1 0 endloop endfacet endsolid\r\n";
    const auto mesh = io::parse_stl(kText + "\n" + one_line, "file");
    REQUIRE(mesh);
    CHECK(mesh->view().face_count() == 3);
}

TEST_CASE("stl: what is wrong in text is named with its line") {
    CHECK_THAT(refusal(kParse, "solid\n"), contains("line 2: the file ends where 'facet' or 'endsolid' is due"));
    CHECK_THAT(refusal(kParse, "solid\nfacets\n"), contains("line 2: expected 'facet' or 'endsolid', found 'facets'"));
    const auto with = [](std::string_view from, std::string_view to) {
        return refusal(kParse, replaced(kText, from, to));
    };
    CHECK_THAT(with("vertex 1 0 0", "vertex 1 0"), contains("file: line 6: the coordinate 'vertex' is not a number"));
    CHECK_THAT(with("vertex 1 0 0", "vertex 1 inf 0"), contains("line 5") && contains("'inf' is not a finite number"));
    CHECK_THAT(with("vertex 1 0 0", "vertex 1 1e999 0"), contains("line 5") && contains("beyond the range"));
    CHECK_THAT(with("    endloop\n", "vertex 1 1 0\n endloop\n"),
               contains("line 7") && contains("expected 'endloop', found 'vertex'"));
    CHECK_THAT(with("0 0 1\n    outer", "0 0\n    outer"), contains("line 3") && contains("normal"));
    CHECK_THAT(with("endsolid two words\n", ""), contains("the file ends") && contains("cut short"));
    CHECK_THAT(refusal(kParse, kText + "garbage"), contains("line 17: expected 'solid', found 'garbage'"));
    CHECK_THAT(refusal(kParse, "solid empty\nendsolid empty\n"), contains("no faces"));
}

TEST_CASE("stl: what is wrong in binary is named with its byte") {
    auto coordinates = kTwoTriangles;
    coordinates[10] = NAN;
    CHECK_THAT(refusal(kParse, binary("", coordinates)), contains("file: byte 150: a coordinate of triangle 1 is nan"));
    const std::string good = binary("made by hand", kTwoTriangles);
    CHECK_THAT(refusal(kParse, good + "x"),
               contains("byte 80: 2 triangles announced, which makes 184 bytes, but the file has 185"));
    CHECK_THAT(refusal(kParse, good.substr(0, 183)), contains("the file has 183"));
    CHECK_THAT(refusal(kParse, good.substr(0, 83)), contains("byte 83: the file ends"));
    CHECK_THAT(refusal(kParse, binary("", {})), contains("no faces"));
    CHECK_THAT(refusal(kParse, ""), contains("the file is empty"));
    std::string huge = good;
    std::memset(huge.data() + 80, 0xff, 4);
    CHECK_THAT(refusal(kParse, huge), contains("4294967295 triangles announced, which makes 214748364834 bytes"));
}

TEST_CASE("stl: cut at every length and mutated at random it gives a mesh or a message") {
    check_hostile_variants(kParse, kText);
    check_hostile_variants(kParse, binary("", kTwoTriangles));
    check_hostile_variants(kParse, binary("solid", kTwoTriangles));
}

TEST_CASE("stl: no part of a file is a file") {
    for (const std::string& file :
         {kText.substr(0, kText.rfind("endsolid") + 8), binary("", kTwoTriangles), binary("solid", kTwoTriangles)}) {
        for (std::size_t length = 0; length < file.size(); ++length) {
            CHECK_FALSE(io::parse_stl(std::string_view(file).substr(0, length), "file"));
        }
    }
}
