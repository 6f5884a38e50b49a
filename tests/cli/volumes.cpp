// Volumes in and out: every format by the program, and what a person can do wrong with them.
#include <filesystem>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

void refused(const std::vector<std::string>& arguments, const std::vector<std::string>& fragments) {
    const Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    REQUIRE(outcome.err.starts_with("xorvox: "));
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    for (const std::string& fragment : fragments) CHECK_THAT(outcome.err, Catch::Contains(fragment));
}

/// A NRRD of 4 × 4 × 4 floats, 0 to 63.
std::string ramp_nrrd() {
    std::string bytes =
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 4 4 4\nendian: little\nencoding: raw\n"
        "space directions: (2,0,0) (0,2,0) (0,0,2)\nspace dimension: 3\nspace origin: (1,1,1)\n\n";
    for (int n = 0; n < 64; ++n) {
        const float value = static_cast<float>(n);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    return bytes;
}

/// A NRRD of `frames`, which follow each other in time, of 4 × 4 × 4 floats each, half of them 0 and half a value.
std::string halves_nrrd(const std::vector<float>& frames) {
    std::string bytes = "NRRD0004\ntype: float\ndimension: 4\nsizes: 4 4 4 " + std::to_string(frames.size()) +
                        "\nkinds: domain domain domain time\nendian: little\nencoding: raw\n\n";
    for (const float most : frames) {
        for (int n = 0; n < 64; ++n) {
            const float value = n % 4 < 2 ? 0.0f : most;
            bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        }
    }
    return bytes;
}

}  // namespace

TEST_CASE("volumes that follow each other have one threshold, found in all of them", "[cli]") {
    const Folder folder;
    const std::string faint = folder.file("faint.nrrd", halves_nrrd({10}));
    const std::string bright = folder.file("bright.nrrd", halves_nrrd({100}));
    const std::string both = folder.file("both.nrrd", halves_nrrd({10, 100}));
    // Alone, the faint one is parted between 0 and 10; with the bright one, between 10 and 100.
    const double threshold = number(succeeds({"info", both, "--json"}).out, "threshold");
    CHECK(threshold > 10.0);
    CHECK(number(succeeds({"info", faint, "--json"}).out, "threshold") < 10.0);
    const auto inside = [&](const std::vector<std::string>& files, const std::string& seconds) {
        std::vector<std::string> arguments{"play", "--display", "cube8-595", "--seconds", seconds, "--json"};
        arguments.insert(arguments.end(), files.begin(), files.end());
        const Outcome outcome = run_program(arguments);
        REQUIRE(outcome.status == 0);
        return number(outcome.out, "inside");
    };
    CHECK(inside({faint, bright}, "0.1") == 0);
    CHECK(inside({faint, bright}, "0.2") > 0);
    CHECK(inside({both}, "0.1") == 0);
    CHECK(inside({both}, "0.2") > 0);
}

TEST_CASE("options of meshes with volumes, and of volumes with meshes, are refused before any file is made", "[cli]") {
    const Folder folder;
    const std::string volume = folder.file("ramp.nrrd", ramp_nrrd());
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    // Nothing can be written there, which would be found later.
    const std::vector<std::string> to{"--display", "cube8-595", "--png", folder.path("none/picture.png")};
    const auto refused_on = [&](std::vector<std::string> arguments, const std::string& message) {
        arguments.insert(arguments.end(), to.begin(), to.end());
        refused(arguments, {message});
    };
    const std::string of_meshes = "--unit, --up, --strict and --animation are for meshes, and ";
    refused_on({"show", volume, "--unit", "cm"}, of_meshes);
    refused_on({"show", volume, "--up", "y"}, of_meshes);
    refused_on({"show", volume, "--strict"}, of_meshes);
    refused_on({"play", volume, "--animation", "0", "--spin", "6"}, of_meshes);
    refused_on({"play", mesh, mesh, "--animation", "0"}, "--animation is for one file alone");
    refused_on({"play", mesh, volume}, "a sequence has one kind");
    for (const std::vector<std::string>& option :
         {std::vector<std::string>{"--threshold", "1"}, {"--volume", "0"}, {"--transfer", "0:black,1:white"}}) {
        refused_on({"show", mesh, option[0], option[1]}, "--threshold, --transfer and --volume are for volumes, and ");
    }
    refused_on({"show", volume, "--transfer", "0:blak"}, "--transfer: ");
}

TEST_CASE("a mesh written in any format converts to the same bits", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    succeeds({"voxelize", mesh, "--size", "20", "-o", folder.path("direct.bits")});
    const std::string direct = read_file(folder.path("direct.bits"));
    REQUIRE(direct.size() > 72);
    for (const std::string name : {"a.nrrd", "a.binvox", "a.nii", "a.nii.gz", "a.vox", "a.png"}) {
        CAPTURE(name);
        succeeds({"voxelize", mesh, "--size", "20", "-o", folder.path(name)});
        const std::string input = name == "a.png" ? "a000.png" : name;
        succeeds({"convert", folder.path(input), folder.path("again.bits")});
        CHECK(read_file(folder.path("again.bits")).substr(72) == direct.substr(72));
    }
    succeeds({"voxelize", mesh, "--size", "20", "--gzip", "-o", folder.path("z.nrrd")});
    succeeds({"convert", folder.path("z.nrrd"), folder.path("again.bits")});
    CHECK(read_file(folder.path("again.bits")) == direct);
    CHECK(std::filesystem::file_size(folder.path("z.nrrd")) < std::filesystem::file_size(folder.path("a.nrrd")) / 4);
}

TEST_CASE("info says what a volume is", "[cli]") {
    const Folder folder;
    const std::string ramp = folder.file("ramp.nrrd", ramp_nrrd());
    const std::string text = succeeds({"info", ramp}).out;
    for (const char* fragment : {"scalar", "4 × 4 × 4 = 64", "2 × 2 × 2 mm", "0 to 63", "Otsu", "0, 0, 0 to 8, 8, 8"}) {
        CHECK_THAT(text, Catch::Contains(fragment));
    }
    const std::string json = succeeds({"info", ramp, "--threshold", "60", "--json"}).out;
    CHECK_THAT(json, Catch::Contains("\"kind\": \"scalar\"") && Catch::Contains("\"inside\": 4") &&
                         Catch::Contains("\"threshold\": 60"));
}

TEST_CASE("convert says which threshold it found, and takes another", "[cli]") {
    const Folder folder;
    const std::string ramp = folder.file("ramp.nrrd", ramp_nrrd());
    CHECK_THAT(succeeds({"convert", ramp, folder.path("a.nrrd")}).out,
               Catch::Contains("threshold 31.") && Catch::Contains("--threshold sets another") &&
                   Catch::Contains("32 of 4 × 4 × 4 voxels set"));
    CHECK_THAT(succeeds({"convert", ramp, folder.path("b.nrrd"), "--threshold", "60"}).out, Catch::Contains("4 of 4"));
}

TEST_CASE("volumes that lie turned keep their shape", "[cli]") {
    const Folder folder;
    std::string turned = ramp_nrrd();
    turned.replace(turned.find("(2,0,0) (0,2,0) (0,0,2)"), 23, "(0,0,-2) (2,0,0) (0,2,0)");
    CHECK_THAT(succeeds({"convert", folder.file("t.nrrd", turned), folder.path("t.bits"), "--threshold", "63"}).out,
               Catch::Contains("1 of 4 × 4 × 4"));
    // The last voxel, (3, 3, 3), is at x 1 + 6, y 1 + 6, z 1 - 6.
    const std::string bits = read_file(folder.path("t.bits"));
    CHECK(bits[72 + 8 * (3 + 4 * 0)] == 8);
    std::string askew = ramp_nrrd();
    askew.replace(askew.find("(2,0,0) (0,2,0) (0,0,2)"), 23, "(2,1,0) (0,2,0) (0,0,2)");
    CHECK_THAT(succeeds({"convert", folder.file("s.nrrd", askew), folder.path("s.bits"), "--threshold", "1"}).out,
               Catch::Contains("askew"));
}

TEST_CASE("a small volume that would be huge when it is straightened is refused", "[cli]") {
    const Folder folder;
    const std::string askew =
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nspace: right-anterior-superior\n"
        "space directions: (1000,1000,1000) (1,-1,0) (0,1,-1)\nencoding: raw\n\n\1";
    refused({"convert", folder.file("askew.nrrd", askew), folder.path("out.nrrd")},
            {"askew.nrrd", "lies askew", "1 × 1 × 1 voxels become"});
    CHECK_FALSE(std::filesystem::exists(folder.path("out.nrrd")));
}

TEST_CASE("volumes cut short, absurd or unknown are refused, and nothing is written", "[cli]") {
    const Folder folder;
    const std::string out = folder.path("out.nrrd");
    const std::string ramp = ramp_nrrd();
    for (const std::size_t percent : {1u, 20u, 60u, 99u}) {
        refused({"convert", folder.file("cut.nrrd", ramp.substr(0, ramp.size() * percent / 100)), out}, {"cut.nrrd"});
    }
    const std::string huge =
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1200 1200 1200\nencoding: gzip\n\n\x1f\x8b and so on";
    refused({"info", folder.file("huge.nrrd", huge)}, {"huge.nrrd", "cannot hold"});
    refused({"info", folder.file("empty.vox", "")}, {"empty.vox", "empty"});
    refused({"info", folder.path("none.nii.gz")}, {"none.nii.gz", "No such file"});
    refused({"convert", folder.file("x.obj", cube_obj(1)), out}, {"x.obj", "'.obj'", ".nrrd"});
    const std::string good = folder.file("good.nrrd", ramp);
    refused({"convert", good, folder.path("out.vdb")}, {"out.vdb", ".nrrd"});
    refused({"convert", good, folder.path("out.vox"), "--gzip"}, {"only .nrrd"});
    refused({"convert", good, out, "--volume", "1"}, {"--volume is 1"});
    refused({"convert", good, out, "--threshold", "low"}, {"--threshold", "'low'"});
    refused({"convert", good, out, "--threshold", "nan"}, {"--threshold"});
    succeeds({"convert", good, folder.path("bits.nrrd")});
    refused({"convert", folder.path("bits.nrrd"), out, "--threshold", "1"}, {"--threshold", "only inside and outside"});
    refused({"info", good, "--unit", "cm"}, {"--unit", "good.nrrd is a volume"});
    refused({"info", folder.path("x.obj"), "--threshold", "1"}, {"--threshold", "x.obj is a mesh"});
    refused({"voxelize", folder.path("x.obj"), "--size", "300", "-o", folder.path("out.vox")}, {"256 voxels a side"});
    CHECK_FALSE(std::filesystem::exists(out));
    CHECK_FALSE(std::filesystem::exists(folder.path("out.vox")));
}
