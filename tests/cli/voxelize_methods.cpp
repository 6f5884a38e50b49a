// `xorvox voxelize` by every method, kernel, number of threads and amount of memory: the same file.
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

using Arguments = std::vector<std::string>;

const std::string kDuck = std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply";

Arguments voxelize(const std::string& mesh, const std::string& output, const Arguments& more) {
    Arguments arguments{"voxelize", mesh, "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

/// What the program says to a call that succeeds without a warning.
std::string says(const Arguments& arguments) {
    const Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    REQUIRE(outcome.err.empty());
    return outcome.out;
}

/// The volume that these options give.
std::string volume(const std::string& mesh, const Arguments& options, const std::string& name = "a.nrrd") {
    const Folder folder;
    says(voxelize(mesh, folder.path(name), options));
    return read_file(folder.path(name));
}

/// The one line of a call that is refused.
std::string refusal(const Arguments& options) {
    const Folder folder;
    const Outcome outcome = run_program(voxelize(kDuck, folder.path("a.nrrd"), options));
    CAPTURE(options, outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    CHECK(folder.names().empty());
    return outcome.err;
}

/// The kernels of this program and machine, which the refusal of a wrong one lists.
Arguments kernels() {
    const std::string listed = refusal({"--kernel", "none"});
    const std::size_t at = listed.find(" can run ");
    REQUIRE(at != std::string::npos);
    std::istringstream words(listed.substr(at + 9));
    Arguments names;
    for (std::string name; words >> name;) names.push_back(name.substr(0, name.find(',')));
    return names;
}

}  // namespace

TEST_CASE("every method gives the same file", "[cli]") {
    for (const std::string size : {"1", "33", "64", "100"}) {
        const std::string column = volume(kDuck, {"--size", size});
        CHECK(volume(kDuck, {"--size", size, "--method", "column"}) == column);
        CHECK(volume(kDuck, {"--size", size, "--method", "reference"}) == column);
        CHECK(volume(kDuck, {"--size", size, "--method", "simplicial"}) == column);
    }
}

TEST_CASE("every apex and sweep gives the same file", "[cli]") {
    const Folder folder;
    const std::string cube = folder.file("cube.obj", cube_obj(4.0));
    const Arguments grid{"--grid", "9,7,8", "--origin", "-1,-1,-1", "--pitch", "1"};
    const auto with = [](Arguments options, const Arguments& more) {
        options.insert(options.end(), more.begin(), more.end());
        return options;
    };
    const std::string duck_bits = volume(kDuck, {});
    const std::string cube_bits = volume(cube, grid);
    // The middle, a vertex of the cube, a sample, a point on the plane of a face, and far outside.
    for (const std::string apex : {"centroid", "0,0,0", "1.5,2.5,0.5", "4,17,-3", "-500,3,2000"}) {
        for (const std::string sweep : {"x", "y", "z"}) {
            CAPTURE(apex, sweep);
            const Arguments simplicial{"--method", "simplicial", "--apex", apex, "--sweep", sweep};
            CHECK(volume(kDuck, simplicial) == duck_bits);
            CHECK(volume(cube, with(grid, simplicial)) == cube_bits);
        }
    }
}

TEST_CASE("every kernel and number of threads gives the same file", "[cli]") {
    const std::string expected = volume(kDuck, {"--size", "90", "--method", "reference"});
    const Arguments names = kernels();
    REQUIRE(names.front() == "scalar");
    for (const std::string& kernel : names) {
        for (const std::string threads : {"1", "2", "3", "auto"}) {
            CAPTURE(kernel, threads);
            CHECK(volume(kDuck, {"--size", "90", "--kernel", kernel, "--threads", threads}) == expected);
        }
        const Folder folder;
        const std::string json =
            says(voxelize(kDuck, folder.path("a.bits"), {"--kernel", kernel, "--threads", "3", "--json"}));
        CHECK_THAT(json, Catch::Contains("\"method\": \"column\"") && Catch::Contains("\"threads\": 3") &&
                             Catch::Contains("\"kernel\": \"" + kernel + "\""));
    }
}

TEST_CASE("a volume larger than the memory allowed is written slab by slab, and the same", "[cli]") {
    const Arguments all{"--size", "400", "--threads", "2", "--json"};
    const Arguments part{"--size", "400", "--threads", "2", "--json", "--region", "7,0,1,390,400,398"};
    for (const Arguments& options : {all, part}) {
        for (const std::string name : {"a.nrrd", "a.bits", "a.binvox"}) {
            CAPTURE(name, options);
            const Folder folder;
            const std::string whole = says(voxelize(kDuck, folder.path("whole-" + name), options));
            CHECK(number(whole, "slabs") == 1);
            Arguments tight = options;
            tight.insert(tight.end(), {"--memory", "6"});  // The volume has 8.5 MiB.
            const std::string slabs = says(voxelize(kDuck, folder.path(name), tight));
            CHECK(number(slabs, "slabs") > 1);
            CHECK(number(slabs, "set") == number(whole, "set"));
            CHECK(read_file(folder.path(name)) == read_file(folder.path("whole-" + name)));
        }
    }
    CHECK_THAT(refusal({"--memory", "0"}), Catch::Contains("needs at least") && Catch::Contains("--memory allows 0"));
}

TEST_CASE("the memory that a refusal asks for is enough, and less is not", "[cli]") {
    // One layer, whose bytes decide; among these is a least amount little below a whole number of MiB.
    for (int side = 400; side <= 1000; side += 50) {
        CAPTURE(side);
        const std::string count = std::to_string(side);
        const auto with_memory = [&](int mib) {
            return Arguments{"--grid",   count + "," + count + ",1", "--origin", "-60,-60,30", "--pitch", "0.1",
                             "--memory", std::to_string(mib)};
        };
        const std::string before = "needs at least ";
        const std::string text = refusal(with_memory(0));
        REQUIRE_THAT(text, Catch::Contains(before));
        const int least = std::stoi(text.substr(text.find(before) + before.size()));
        CHECK_THAT(refusal(with_memory(least - 1)), Catch::Contains(before + std::to_string(least) + " MiB"));
        const Folder folder;
        says(voxelize(kDuck, folder.path("a.bits"), with_memory(least)));
    }
}

TEST_CASE("a region is that part of the grid, at its place", "[cli]") {
    const Folder folder;
    const std::string cube = folder.file("cube.obj", cube_obj(4.0));
    const Arguments grid{"--grid", "9,7,8", "--origin", "-1,-1,-1", "--pitch", "1"};
    const std::string whole = volume(cube, grid);
    for (const std::string name : {"a.nrrd", "a.bits", "a.binvox"}) {
        Arguments part = grid;
        part.insert(part.end(), {"--region", "2,0,3,4,7,4"});
        // All voxels of the part are where a grid of its own would have them.
        CHECK(volume(cube, part, name) ==
              volume(cube, {"--grid", "4,7,4", "--origin", "1,-1,2", "--pitch", "1"}, name));
        part.back() = "0,0,0,9,7,8";
        CHECK(volume(cube, part, name) == volume(cube, grid, name));
    }
    CHECK_THAT(refusal({"--region", "0,0,60,64,64,5"}), Catch::Contains("--region") && Catch::Contains("64 × 64 × 64"));
    CHECK_THAT(refusal({"--region", "0,0,0,64,0,5"}), Catch::Contains("64 × 0 × 5"));
    CHECK_THAT(refusal({"--region", "0,0,0,64,64"}), Catch::Contains("0,0,8,64,64,4"));
    CHECK_THAT(refusal({"--region", "0,0,-1,64,64,4"}), Catch::Contains("-1"));
}

TEST_CASE("signed sums tell a face that runs against its neighbours, and leave the volume as it is", "[cli]") {
    const Folder folder;
    const std::string good = folder.file("good.obj", cube_obj(4.0));
    const std::string bad = folder.file("bad.obj", cube_obj(4.0, true) + "f 6 8 4 2\n");
    const std::string out = folder.path("a.nrrd");
    const Arguments options{"--size", "16", "--method", "simplicial", "--signed"};
    const Arguments json{"--size", "16", "--method", "simplicial", "--signed", "--json"};

    CHECK_THAT(says(voxelize(good, out, options)), Catch::Contains("no fault of orientation"));
    const std::string expected = read_file(out);
    const std::string consistent = says(voxelize(good, out, json));
    CHECK(number(consistent, "inside") == number(consistent, "set"));
    CHECK(number(consistent, "negative") + number(consistent, "multiple") == 0);

    CHECK_THAT(says(voxelize(bad, out, options)), Catch::Contains("against their neighbours"));
    CHECK(read_file(out) == expected);
    const std::string faulty = says(voxelize(bad, out, json));
    CHECK(number(faulty, "negative") > 0);
    CHECK(number(faulty, "lowest") == -1);
    CHECK(number(faulty, "set") == number(consistent, "set"));

    const std::string open = folder.file("open.obj", cube_obj(4.0, true));
    const Outcome unknown = run_program(voxelize(open, out, options));
    CHECK(unknown.status == 0);
    CHECK_THAT(unknown.out, Catch::Contains("the mesh is open") && !Catch::Contains("no fault"));
}

TEST_CASE("the apex that was used is told, in the units of the mesh", "[cli]") {
    const Folder folder;
    const std::string cube = folder.file("cube.obj", cube_obj(4.0));
    const std::string out = folder.path("a.nrrd");
    const Arguments grid{"--grid", "8,8,8", "--origin", "-1,-1,-1", "--pitch", "1", "--method", "simplicial", "--json"};
    CHECK_THAT(says(voxelize(cube, out, grid)), Catch::Contains("\"apex\": [2, 2, 2]"));
    Arguments given = grid;
    given.insert(given.end(), {"--apex", "0.5,-3,2"});
    CHECK_THAT(says(voxelize(cube, out, given)), Catch::Contains("\"apex\": [0.5, -3, 2]"));
}

TEST_CASE("options of one method are refused with another", "[cli]") {
    for (const Arguments& option : std::vector<Arguments>{{"--apex", "centroid"}, {"--sweep", "x"}, {"--signed"}}) {
        CHECK_THAT(refusal(option), Catch::Contains(option[0]) && Catch::Contains("only for --method simplicial"));
    }
    for (const Arguments& option : std::vector<Arguments>{
             {"--kernel", "scalar"}, {"--threads", "2"}, {"--memory", "500"}, {"--region", "0,0,0,1,1,1"}}) {
        for (const std::string method : {"simplicial", "reference"}) {
            Arguments both = option;
            both.insert(both.end(), {"--method", method});
            CHECK_THAT(refusal(both), Catch::Contains(option[0]) && Catch::Contains("only for --method column"));
        }
    }
}

TEST_CASE("methods, kernels, threads, apexes and sweeps that are none are refused", "[cli]") {
    CHECK_THAT(refusal({"--method", "magic"}), Catch::Contains("--method") && Catch::Contains("magic") &&
                                                   Catch::Contains("column") && Catch::Contains("simplicial"));
    CHECK_THAT(refusal({"--kernel", "avx9"}), Catch::Contains("'avx9'") && Catch::Contains("scalar"));
    CHECK_THAT(refusal({"--threads", "many"}), Catch::Contains("--threads") && Catch::Contains("many"));
    CHECK_THAT(refusal({"--threads", "0"}), Catch::Contains("--threads") && Catch::Contains("1 to 256"));
    CHECK_THAT(refusal({"--memory", "99999999999"}), Catch::Contains("--memory") && Catch::Contains("4294967295"));
    CHECK_THAT(refusal({"--size", "8", "--size", "9"}), Catch::Contains("--size is given 2 times"));
    CHECK_THAT(refusal({"--threads", "257"}), Catch::Contains("257") && Catch::Contains("256"));
    CHECK_THAT(refusal({"--method", "simplicial", "--apex", "1,2"}), Catch::Contains("--apex: '1,2'"));
    CHECK_THAT(refusal({"--method", "simplicial", "--apex", "0,0,1e300"}), Catch::Contains("--apex"));
    CHECK_THAT(refusal({"--method", "simplicial", "--apex", "0,nan,0"}), Catch::Contains("--apex"));
    CHECK_THAT(refusal({"--method", "simplicial", "--sweep", "w"}), Catch::Contains("--sweep: 'w'"));
}

TEST_CASE("the simplicial method warns of open edges in its own words", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("open.obj", cube_obj(1.0, true));
    const Outcome outcome =
        run_program(voxelize(mesh, folder.path("a.nrrd"), {"--size", "16", "--method", "simplicial"}));
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.err, Catch::Contains("warning") && Catch::Contains("4 open edges") && Catch::Contains("apex"));
    CHECK(run_program(voxelize(mesh, folder.path("b.nrrd"), {"--method", "simplicial", "--strict"})).status == 2);
    CHECK(folder.names() == Arguments{"a.nrrd", "open.obj"});
}

TEST_CASE("a signal while a volume is written leaves no file and ends the program", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    Background program(voxelize(mesh, folder.path("a.nrrd"), {"--size", "1024"}));
    // Its file has no name, but its first bytes can be seen among the files that it has open.
    const std::string open_files = "/proc/" + std::to_string(program.pid()) + "/fd";
    const auto has_begun = [&] {
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(open_files, ignored)) {
            const std::string target = std::filesystem::read_symlink(entry.path(), ignored).string();
            if (target.starts_with(folder.path("")) && target.find("cube.obj") == std::string::npos &&
                std::filesystem::file_size(entry.path(), ignored) > 0) {
                return true;
            }
        }
        return false;
    };
    while (!has_begun() && !std::filesystem::exists(folder.path("a.nrrd"))) std::this_thread::yield();
    CHECK(program.terminate() == 128 + 15);
    CHECK(folder.names() == Arguments{"cube.obj"});
}
