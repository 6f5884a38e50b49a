// What a person can do wrong: one clear line on standard error, exit status 2, no output file left behind.
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

/// Expects the refusal of `arguments` and every fragment in its one line.
void refused(const std::vector<std::string>& arguments, const std::vector<std::string>& fragments) {
    const Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    REQUIRE(outcome.err.starts_with("xorvox: "));
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    for (const std::string& fragment : fragments) CHECK_THAT(outcome.err, Catch::Contains(fragment));
}

const std::string kGridOfTen = "10,10,10";

}  // namespace

TEST_CASE("missing, unreadable and wrong mesh files are refused by name", "[cli]") {
    const Folder folder;
    const std::string out = folder.path("out.nrrd");
    refused({"voxelize", folder.path("none.ply"), "-o", out}, {"none.ply", "No such file"});
    refused({"voxelize", folder.path(""), "-o", out}, {"directory"});
    refused({"voxelize", folder.file("mesh.xyz", "1 2 3\n"), "-o", out}, {"mesh.xyz", "ply", "stl", "obj"});
    refused({"voxelize", folder.file("empty.obj", ""), "-o", out}, {"empty.obj"});
    refused({"voxelize", folder.file("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "-o", out},
            {"nan.obj: line 1", "nan"});
    refused({"voxelize", folder.file("inf.obj", "v 1e999 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "-o", out},
            {"inf.obj: line 1", "1e999"});
    refused({"voxelize", folder.file("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "-o", out},
            {"index.obj: line 4", "9"});
    refused({"info", folder.path("none.stl"), "--json"}, {"none.stl"});
    refused({"show", folder.path("none.obj"), "--display", "cube16-ws2812"}, {"none.obj"});
    CHECK(folder.names() == std::vector<std::string>{"empty.obj", "index.obj", "inf.obj", "mesh.xyz", "nan.obj"});
}

TEST_CASE("a truncated mesh is refused at every length and leaves no volume", "[cli]") {
    const Folder folder;
    const std::string whole = read_file(std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply");
    REQUIRE(whole.size() > 1000);
    for (const std::size_t percent : {1u, 5u, 20u, 50u, 80u, 99u}) {
        const std::string cut = folder.file("cut.ply", whole.substr(0, whole.size() * percent / 100));
        refused({"voxelize", cut, "--size", "16", "-o", folder.path("out.binvox")}, {"cut.ply"});
    }
    const std::string cut = folder.file("cut.ply", whole.substr(0, whole.size() - 7));
    refused({"voxelize", cut, "--size", "16", "-o", folder.path("out.binvox")}, {"cut.ply", "byte"});
    CHECK(folder.names() == std::vector<std::string>{"cut.ply"});
}

TEST_CASE("grids that cannot be are refused", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    const std::string out = folder.path("out.nrrd");
    refused({"voxelize", mesh, "--size", "0", "-o", out}, {"--size", "0", "4096"});
    refused({"voxelize", mesh, "--size", "5000", "-o", out}, {"--size", "5000", "4096"});
    refused({"voxelize", mesh, "--size", "ten", "-o", out}, {"--size", "ten"});
    refused({"voxelize", mesh, "--size", "", "-o", out}, {"--size", "not a whole number"});
    refused({"voxelize", mesh, "--size", "-4", "-o", out}, {"--size"});
    refused({"voxelize", mesh, "--grid", kGridOfTen, "-o", out}, {"--grid", "--origin", "--pitch"});
    refused({"voxelize", mesh, "--grid", "10,0,10", "--origin", "0,0,0", "--pitch", "1", "-o", out},
            {"--grid", "0", "y"});
    refused({"voxelize", mesh, "--grid", "10,2.5,10", "--origin", "0,0,0", "--pitch", "1", "-o", out},
            {"--grid", "2.5"});
    refused({"voxelize", mesh, "--grid", "10,10", "--origin", "0,0,0", "--pitch", "1", "-o", out}, {"--grid", "10,10"});
    refused({"voxelize", mesh, "--grid", kGridOfTen, "--origin", "0,nan,0", "--pitch", "1", "-o", out}, {"--origin"});
    refused({"voxelize", mesh, "--grid", kGridOfTen, "--origin", "0,0,0", "--pitch", "0", "-o", out}, {"--pitch", "0"});
    refused({"voxelize", mesh, "--grid", kGridOfTen, "--origin", "0,0,0", "--pitch", "-1", "-o", out},
            {"--pitch", "-1"});
    refused({"voxelize", mesh, "--grid", kGridOfTen, "--size", "10", "-o", out}, {"--size", "--grid"});
    refused({"voxelize", mesh, "--grid", kGridOfTen, "--origin", "0,0,0", "--pitch", "1e-12", "-o", out}, {"vertex"});
    CHECK(folder.names() == std::vector<std::string>{"cube.obj"});
}

TEST_CASE("a grid of more bytes than memory is refused before any work by methods that need it whole", "[cli]") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    XORVOX_SKIP("a sanitizer's shadow memory does not fit into a limited address space");
#endif
    const Folder folder;
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    const Outcome outcome = run_program({"voxelize", mesh, "--method", "reference", "--grid", "4096,4096,4096",
                                         "--origin", "0,0,0", "--pitch", "1", "-o", folder.path("out.bits")},
                                        std::uint64_t{1} << 30);
    CAPTURE(outcome.err);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Catch::Contains("8192 MiB") && Catch::Contains("1024 MiB"));
    CHECK(folder.names() == std::vector<std::string>{"cube.obj"});
}

TEST_CASE("outputs that cannot be are refused", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    refused({"voxelize", mesh, "-o", folder.path("out.vdb")}, {"out.vdb", ".nrrd", ".binvox", ".bits"});
    refused({"voxelize", mesh, "-o", folder.path("out")}, {".nrrd"});
    refused({"voxelize", mesh, "-o", folder.path("missing/out.nrrd")}, {"missing"});
    refused({"voxelize", mesh}, {"--output", "xorvox voxelize --help"});
    refused(
        {"show", mesh, "--display", "cube16-ws2812", "--view", "orthographic", "--png", folder.path("missing/p.png")},
        {"missing"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--png", folder.path("p.png"), "--to", "tcp:127.0.0.1:1"},
            {"--png", "loopback"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--to", "file:" + folder.path("missing/f")}, {"missing"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--to", "file:" + mesh}, {"the input itself"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--png", folder.path("p.jpg")}, {"p.jpg", ".png"});
    CHECK(read_file(mesh) == cube_obj(1.0));
    CHECK(folder.names() == std::vector<std::string>{"cube.obj"});
}

TEST_CASE("unknown words on the command line are refused and point to the help", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    refused({}, {"xorvox --help"});
    refused({"melt"}, {"melt", "xorvox --help"});
    refused({"info"}, {"mesh", "xorvox info --help"});
    refused({"info", mesh, "--jsonn"}, {"--jsonn", "xorvox info --help"});
    refused({"info", mesh, "--up", "w"}, {"--up", "w"});
    refused({"info", mesh, "--unit", "parsec"}, {"--unit", "parsec", "mm"});
    refused({"show", mesh}, {"--display", "xorvox show --help"});
    refused({"show", mesh, "--display", "cube17"}, {"cube17", "cube16-ws2812", "vortex"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--color", "constant:octarine"}, {"--color", "octarine"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--color", "plaid"}, {"--color", "plaid", "gradient"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--to", "pigeon:post"}, {"--to", "pigeon", "tcp"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--to", "tcp:127.0.0.1:99999"}, {"--to", "99999"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--view", "sideways"}, {"--view", "sideways"});
    refused({"sim", "--display", "cube17", "--listen", "tcp:0"}, {"cube17"});
    refused({"sim"}, {"--listen"});
    refused({"sim", "--listen", "file:x"}, {"--listen", "tcp"});
    refused({"--bogus"}, {"--bogus", "xorvox --help"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--view", "orthographic"}, {"--view", "--png"});
    refused({"show", mesh, "--display", "cube16-ws2812", "--hold"}, {"--hold", "tcp"});
}

TEST_CASE("mistakes in a display file are explained by line", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    refused({"show", mesh, "--display", folder.file("syntax.toml", "name = \"x\"\nkind = \n")},
            {"syntax.toml: line 2"});
    refused(
        {"show", mesh, "--display", folder.file("key.toml", "name = \"x\"\nkind = \"stacked-planes\"\nslicez = 3\n")},
        {"key.toml: line 3", "slicez", "slices"});
    refused({"show", mesh, "--display", folder.path("none.toml")}, {"none.toml"});
}

TEST_CASE("nobody at the other end is said plainly", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    Background display({"sim", "--listen", "tcp:0"});
    const std::string listening = display.line().value_or("");
    const std::string address = listening.substr(listening.rfind("tcp:"));
    const std::string port = address.substr(address.rfind(':') + 1);
    refused({"sim", "--listen", "tcp:" + port}, {port, "in use"});
    CHECK(display.terminate() == 0);
    refused({"show", mesh, "--display", "cube16-ws2812", "--to", "tcp:127.0.0.1:" + port}, {port});
}

TEST_CASE("an open mesh is voxelized with a warning that counts the open edges, and refused with --strict", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("open.obj", cube_obj(1.0, true));
    const Outcome outcome = run_program({"voxelize", mesh, "--size", "16", "-o", folder.path("open.nrrd")});
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.err, Catch::Contains("warning") && Catch::Contains("4 open edges"));
    refused({"voxelize", mesh, "--strict", "-o", folder.path("strict.nrrd")}, {"4 open edges", "--strict"});
    CHECK(folder.names() == std::vector<std::string>{"open.nrrd", "open.obj"});
}
