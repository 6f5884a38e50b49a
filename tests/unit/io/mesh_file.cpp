#include "voxelizer/io/mesh_file.h"

#include <cmath>
#include <locale>
#include <thread>

#include <sys/stat.h>
#include <unistd.h>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/temp_folder.h"
#include "voxelizer/io/mesh_report.h"

using namespace xorvox;

namespace {

const std::string kCorner = "v 1 0 0\nv 0 2 0\nv 0 0 3\nv 0 0 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kTextStl =
    "solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\nendsolid\n";

std::string binary_stl() {
    std::string stl(84 + 50, '\0');
    stl.replace(0, 5, "solid");
    stl[80] = 1;
    stl[84 + 12 + 12 + 3] = 0x3f;  // 0.5
    stl[84 + 12 + 24 + 7] = 0x3f;
    return stl;
}

std::string refusal(const std::string& path, const io::MeshReadOptions& options = {}) {
    const auto mesh = io::read_mesh(path, options);
    return mesh ? std::string() : mesh.error().message;
}

}  // namespace

TEST_CASE("read_mesh reads the three formats and welds") {
    const TempFolder folder;
    put(folder / "a.ply", kPly);
    put(folder / "a.STL", kTextStl + kTextStl);
    put(folder / "b.stl", binary_stl());
    put(folder / "a.obj", "v 9 9 9\nv 0 0 0\nv -0 0 0\nv 1 0 0\nv 0 1 0\nf 2 4 5\nf 3 5 4\n");
    CHECK(io::read_mesh(folder / "a.ply")->positions.size() == 3);
    CHECK(io::read_mesh(folder / "a.STL")->positions.size() == 3);
    CHECK(io::read_mesh(folder / "b.stl")->positions.size() == 3);
    CHECK(io::read_mesh(folder / "a.obj")->positions == std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("read_mesh goes by the content before the extension") {
    const TempFolder folder;
    put(folder / "ply.obj", kPly);
    put(folder / "stl.ply", binary_stl());
    put(folder / "text", kTextStl);
    put(folder / "name.with.dots.dat", kPly);
    for (const std::string& name : folder.names()) {
        INFO(name);
        CHECK(io::read_mesh(folder / name));
    }
}

TEST_CASE("read_mesh names the formats it knows when it does not know one") {
    const TempFolder folder;
    put(folder / "mesh.step", "ISO-10303-21;");
    CHECK_THAT(refusal(folder / "mesh.step"),
               contains("mesh.step: ") && contains("'.step'") && contains(".ply, .stl and .obj"));
    put(folder / "mesh", kCorner);
    CHECK_THAT(refusal(folder / "mesh"), contains(".ply, .stl and .obj"));
}

TEST_CASE("read_mesh says what is wrong with a path") {
    const TempFolder folder;
    CHECK_THAT(refusal(folder / "no.ply"), contains("no.ply: cannot be read: No such file or directory"));
    CHECK_THAT(refusal(""), contains("cannot be read"));
    CHECK_THAT(refusal(folder.path()), contains("is a directory"));
    CHECK_THAT(refusal("/dev/null"), contains("neither a file nor a pipe"));
    put(folder / "empty.ply", "");
    CHECK_THAT(refusal(folder / "empty.ply"), contains("the file is empty"));
    put(folder / "huge.ply", kPly);
    REQUIRE(::truncate((folder / "huge.ply").c_str(), off_t{5} << 30) == 0);
    CHECK_THAT(refusal(folder / "huge.ply"), contains("longer than 4294967295 bytes"));
}

TEST_CASE("read_mesh puts the oddest name into a message of one line") {
    const TempFolder folder;
    const std::string odd = folder / "a\nb\tc.obj";
    const auto has_name = contains("/a\\x0ab\\x09c.obj: ");
    CHECK_THAT(refusal(odd), has_name && contains("cannot be read"));
    CHECK_THAT(refusal(odd, {.scale = 0}), has_name && contains("cannot be scaled"));
    put(odd, "v 1 2");
    CHECK_THAT(refusal(odd), has_name && contains("line 1: a vertex of 2 numbers"));
    put(odd, kCorner);
    CHECK_THAT(refusal(odd, {.scale = 1e308}), has_name && contains("beyond the range"));
    CHECK(io::read_mesh(odd));
}

TEST_CASE("read_mesh says that a file may not be read") {
    if (::geteuid() == 0) XORVOX_SKIP("root may read everything");
    const TempFolder folder;
    put(folder / "a.ply", kPly);
    REQUIRE(::chmod((folder / "a.ply").c_str(), 0) == 0);
    CHECK_THAT(refusal(folder / "a.ply"), contains("a.ply: cannot be read: Permission denied"));
}

TEST_CASE("read_mesh reads a pipe to its end") {
    const TempFolder folder;
    REQUIRE(::mkfifo((folder / "pipe.obj").c_str(), 0600) == 0);
    std::string obj = kCorner;
    for (int i = 0; i < 20000; ++i) obj += "f 1 2 3\n";
    std::thread writer([&] { put(folder / "pipe.obj", obj); });
    const auto mesh = io::read_mesh(folder / "pipe.obj");
    writer.join();
    REQUIRE(mesh);
    CHECK(mesh->view().face_count() == 20004);
}

TEST_CASE("read_mesh turns the up axis to z without mirroring") {
    const TempFolder folder;
    put(folder / "a.obj", kCorner);
    for (const io::UpAxis up : {io::UpAxis::X, io::UpAxis::Y, io::UpAxis::Z}) {
        const auto mesh = io::read_mesh(folder / "a.obj", {.up = up});
        REQUIRE(mesh);
        // The file's three half-axes are vertices 0, 1 and 2, of length 1, 2 and 3.
        const std::size_t axis = up == io::UpAxis::X ? 0 : up == io::UpAxis::Y ? 1 : 2;
        CHECK(mesh->positions[axis] == glm::dvec3(0, 0, static_cast<double>(axis + 1)));
        CHECK(io::report(mesh->view()).signed_volume == Approx(1.0));
    }
}

TEST_CASE("read_mesh scales by the unit") {
    const TempFolder folder;
    put(folder / "a.obj", kCorner);
    const auto mesh = io::read_mesh(folder / "a.obj", {.scale = io::unit_in_mm("in").value()});
    REQUIRE(mesh);
    CHECK(mesh->positions[1] == glm::dvec3(0, 50.8, 0));
    CHECK(io::unit_in_mm("mm") == 1.0);
    CHECK(io::unit_in_mm("cm") == 10.0);
    CHECK(io::unit_in_mm("m") == 1000.0);
    CHECK(io::unit_in_mm("ft") == 304.8);
    CHECK_THAT(io::unit_in_mm("inch").error().message, contains("'inch'") && contains("mm, cm, m, in or ft"));
    CHECK(io::up_axis("x") == io::UpAxis::X);
    CHECK(io::up_axis("y") == io::UpAxis::Y);
    CHECK(io::up_axis("z") == io::UpAxis::Z);
    CHECK_THAT(io::up_axis("up").error().message, contains("'up'") && contains("x, y or z"));
}

TEST_CASE("read_mesh refuses scales that lose the mesh") {
    const TempFolder folder;
    put(folder / "a.obj", "v 1e308 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(io::read_mesh(folder / "a.obj"));
    CHECK_THAT(refusal(folder / "a.obj", {.scale = 10}), contains("vertex 0 is beyond the range of a double"));
    for (const double scale : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
        CHECK_THAT(refusal(folder / "a.obj", {.scale = scale}), contains("cannot be scaled by"));
    }
}

TEST_CASE("read_mesh reads numbers the same under any locale") {
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
    };
    const TempFolder folder;
    put(folder / "a.obj", "v 0.5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
    const auto mesh = io::read_mesh(folder / "a.obj");
    std::locale::global(before);
    REQUIRE(mesh);
    CHECK(mesh->positions[0].x == 0.5);
}

TEST_CASE("read_mesh reads the models of the project") {
    const std::string models = XORVOX_SOURCE_DIR "/../shared/models/";
    if (!std::filesystem::exists(models)) XORVOX_SKIP("../shared/models is not there");
    const auto cube = io::report(io::read_mesh(models + "tiecube12.obj").value().view());
    CHECK(cube.signed_volume == 32768);
    CHECK(cube.orientation == io::Orientation::Outward);
    const auto broken = io::report(io::read_mesh(models + "part_csol6.obj").value().view());
    CHECK(broken.triangles == 22);
    CHECK(broken.open_edges == 4);
}
