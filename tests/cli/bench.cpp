// `xorvox bench`: what it prints, not how fast anything is.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

const std::string kDuck = std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply";

using Object = std::map<std::string, std::string>;

/// Reads a JSON array of objects of strings, numbers and nulls, which is all that bench writes; nothing for other text.
class JsonReader {
public:
    explicit JsonReader(std::string_view text) : text_(text) {}

    std::optional<std::vector<Object>> read() {
        std::vector<Object> objects;
        if (!take('[')) return std::nullopt;
        do {
            const std::optional<Object> object = read_object();
            if (!object) return std::nullopt;
            objects.push_back(*object);
        } while (take(','));
        if (!take(']')) return std::nullopt;
        skip_space();
        return text_.empty() ? std::optional(objects) : std::nullopt;
    }

private:
    void skip_space() { text_.remove_prefix(std::min(text_.find_first_not_of(" \n"), text_.size())); }
    bool take(char c) {
        skip_space();
        if (!text_.starts_with(c)) return false;
        text_.remove_prefix(1);
        return true;
    }
    std::optional<std::string> read_string() {
        if (!take('"')) return std::nullopt;
        const std::size_t end = text_.find('"');
        if (end == std::string_view::npos || text_.substr(0, end).find('\\') != std::string_view::npos) return {};
        std::string value(text_.substr(0, end));
        text_.remove_prefix(end + 1);
        return value;
    }
    std::optional<std::string> read_value() {
        skip_space();
        if (text_.starts_with('"')) return read_string();
        const std::size_t end = std::min(text_.find_first_of(",} \n"), text_.size());
        const std::string word(text_.substr(0, end));
        char* stop = nullptr;
        const bool is_number = std::isfinite(std::strtod(word.c_str(), &stop)) && !word.empty() && *stop == '\0';
        if (word != "null" && !is_number) return std::nullopt;
        text_.remove_prefix(end);
        return word;
    }
    std::optional<Object> read_object() {
        Object object;
        if (!take('{')) return std::nullopt;
        do {
            const std::optional<std::string> key = read_string();
            if (!key || !take(':')) return std::nullopt;
            const std::optional<std::string> value = read_value();
            if (!value || !object.emplace(*key, *value).second) return std::nullopt;
        } while (take(','));
        return take('}') ? std::optional(object) : std::nullopt;
    }

    std::string_view text_;
};

/// Whether bench complains of nothing but a busy machine, which is no fault of it.
bool is_calm(const std::string& err) {
    static const std::regex kBusy(
        "xorvox: warning: other programs ran at the same time: [0-9]+ of [0-9]+ medians are too long by more than a "
        "tenth\n");
    return err.empty() || std::regex_match(err, kBusy);
}

Outcome bench(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"bench", "voxelize", "--quick"});
    Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    REQUIRE(is_calm(outcome.err));
    return outcome;
}

std::vector<Object> bench_json(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    const std::string out = bench(arguments).out;
    CAPTURE(out);
    const std::optional<std::vector<Object>> objects = JsonReader(out).read();
    REQUIRE(objects);
    return *objects;
}

void refused(std::vector<std::string> arguments, const std::vector<std::string>& fragments) {
    arguments.insert(arguments.begin(), "bench");
    const Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    REQUIRE(outcome.err.starts_with("xorvox: "));
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    for (const std::string& fragment : fragments) CHECK_THAT(outcome.err, Catch::Contains(fragment));
}

}  // namespace

TEST_CASE("bench voxelize --json is one array with an object for each model, size, method and number of threads",
          "[cli]") {
    const Folder folder;
    const std::string cube = folder.file("cube.obj", cube_obj(1.0));
    const std::vector<Object> results =
        bench_json({kDuck, cube, "--sizes", "8,16", "--methods", "column,simplicial,reference", "--threads", "1,2"});
    REQUIRE(results.size() == 2 * 2 * (2 + 1 + 1));
    std::map<std::string, std::vector<std::string>> voxels_set;
    for (const Object& result : results) {
        CAPTURE(result);
        for (const char* key : {"model", "size", "method", "threads", "ms", "floor_ms", "floor_ratio", "kernel",
                                "triangles", "crossings", "set", "snap_ms", "cross_ms", "finish_ms"}) {
            CHECK(result.contains(key));
        }
        const double ms = std::stod(result.at("ms"));
        const double floor_ms = std::stod(result.at("floor_ms"));
        CHECK(ms > 0.0);
        CHECK(floor_ms > 0.0);
        CHECK(std::stod(result.at("floor_ratio")) == Approx(ms / floor_ms));
        CHECK((result.at("kernel") == "null") == (result.at("method") != "column"));
        voxels_set[result.at("model") + result.at("size")].push_back(result.at("set"));
    }
    CHECK(results.front().at("model") == "duck");
    CHECK(results.back().at("model") == "cube");
    CHECK(voxels_set.size() == 4);
    for (const auto& [model, counts] : voxels_set) {
        CAPTURE(model);
        CHECK(counts == std::vector<std::string>(4, counts.front()));  // every method gives the bits of a closed mesh
    }
}

TEST_CASE("bench and what it measures have help with an example", "[cli]") {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"bench"}, {"bench", "voxelize"}}) {
        std::vector<std::string> arguments = words;
        arguments.push_back("--help");
        const Outcome outcome = run_program(arguments);
        CHECK(outcome.status == 0);
        CHECK_THAT(outcome.out, Catch::Contains("Examples") && Catch::Contains("xorvox bench voxelize"));
    }
}

TEST_CASE("bench voxelize measures the kernel that is asked for", "[cli]") {
    const std::vector<Object> results =
        bench_json({kDuck, "--sizes", "8", "--methods", "column", "--threads", "1", "--kernel", "scalar"});
    REQUIRE(results.size() == 1);
    CHECK(results[0].at("kernel") == "scalar");
}

TEST_CASE("bench voxelize --tables sets the times of stand-ins beside those of the paper", "[cli]") {
    const Folder folder;
    const std::string gem = folder.file("gem24.obj", cube_obj(1.0));
    const std::string dragon = folder.file("dragon100k.obj", cube_obj(1.0));
    const std::string out = bench({gem, dragon, "--sizes", "64", "--methods", "column", "--tables"}).out;
    CHECK_THAT(out, Catch::Contains("Table 2") && Catch::Contains("Table 3") && Catch::Contains("Table 4"));
    CHECK_THAT(out, Catch::Contains("9.2517") && Catch::Contains("18.0581") && Catch::Contains("Rueda"));
    const std::size_t row = out.find("Simple (25), gem24 ");
    REQUIRE(row != std::string::npos);
    const std::string simple = out.substr(row, out.find('\n', row) - row);
    CAPTURE(simple);
    CHECK_THAT(simple, Catch::Contains("0.0563 |") && Catch::Contains(" - |"));  // at 128 nothing was measured
    const std::string ours = simple.substr(simple.find("0.0563 |") + 8);
    CHECK(std::stod(ours) > 0.0);
}

TEST_CASE("bench voxelize --tables leaves out the models that are not given", "[cli]") {
    const Folder folder;
    const std::string gem = folder.file("gem24.obj", cube_obj(1.0));
    const std::string out = bench({gem, "--sizes", "64", "--methods", "column", "--tables"}).out;
    CHECK_THAT(out, Catch::Contains("gem24") && !Catch::Contains("dragon100k"));
    const std::string none = bench({kDuck, "--sizes", "8", "--methods", "column", "--tables"}).out;
    CHECK_THAT(none, Catch::Contains("No tables") && Catch::Contains("dragon100k") && !Catch::Contains("Table 2"));
}

TEST_CASE("bench voxelize measures what is given twice once, and tells namesakes apart", "[cli]") {
    const Folder folder;
    std::filesystem::create_directory(folder.path("a"));
    std::filesystem::create_directory(folder.path("b"));
    const std::string first = folder.file("a/cube.obj", cube_obj(1.0));
    const std::string second = folder.file("b/cube.obj", cube_obj(2.0));
    const std::vector<Object> results = bench_json({first, second, first, "--sizes", "8,8", "--methods",
                                                    "column,column", "--threads", "1,1", "--kernel", "scalar"});
    REQUIRE(results.size() == 2);
    CHECK(results[0].at("model") == "a/cube");
    CHECK(results[1].at("model") == "b/cube");

    std::filesystem::create_directories(folder.path("c/a"));
    const std::string third = folder.file("c/a/cube.obj", cube_obj(3.0));  // its folder does not tell it from the first
    const std::vector<Object> paths =
        bench_json({first, third, "--sizes", "8", "--methods", "column", "--threads", "1"});
    REQUIRE(paths.size() == 2);
    CHECK(paths[0].at("model") == first);
    CHECK(paths[1].at("model") == third);
}

TEST_CASE("bench voxelize sets its columns apart, however long a name is", "[cli]") {
    const Folder folder;
    const std::string cube = folder.file("a-cube-with-a-name-of-very-many-letters.obj", cube_obj(1.0));
    const std::string out = bench({kDuck, cube, "--sizes", "8", "--methods", "column", "--threads", "1"}).out;
    std::istringstream lines(out);
    std::string heading;
    std::getline(lines, heading);
    CHECK_THAT(heading, Catch::Contains("finish ms") && Catch::Contains("floor ms  ÷ floor"));
    const std::size_t sizes_end = heading.find("size") + 4;
    std::size_t results = 0;
    for (std::string line; std::getline(lines, line); ++results) {
        CAPTURE(line);
        CHECK(line.substr(sizes_end - 3, 5) == "  8  ");
    }
    CHECK(results == 2);
}

TEST_CASE("bench voxelize --plot writes a picture and nothing else", "[cli]") {
    const Folder folder;
    bench({kDuck, "--sizes", "4,8", "--plot", folder.path("chart.png")});
    CHECK(read_file(folder.path("chart.png")).starts_with("\x89PNG"));
    CHECK(folder.names() == std::vector<std::string>{"chart.png"});
}

TEST_CASE("mistakes on the command line of bench are refused before anything is measured", "[cli]") {
    const Folder folder;
    const std::string mesh = folder.file("cube.obj", cube_obj(1.0));
    refused({}, {"xorvox bench --help"});
    refused({"melt"}, {"melt", "xorvox bench --help"});
    refused({"voxelize"}, {"meshes", "xorvox bench voxelize --help"});
    refused({"voxelize", mesh, "--jsonn"}, {"--jsonn", "xorvox bench voxelize --help"});
    refused({"voxelize", mesh, "--json", "--tables"}, {"--json", "--tables"});
    refused({"voxelize", mesh, "--sizes", "0"}, {"--sizes", "'0'", "4096"});
    refused({"voxelize", mesh, "--sizes", "64,4097"}, {"--sizes", "4097", "4096"});
    refused({"voxelize", mesh, "--sizes", "64,"}, {"--sizes", "''"});
    refused({"voxelize", mesh, "--sizes", "big"}, {"--sizes", "big"});
    refused({"voxelize", mesh, "--methods", "column,magic"}, {"--methods", "magic", "column, simplicial, reference"});
    refused({"voxelize", mesh, "--threads", "0"}, {"--threads", "'0'"});
    refused({"voxelize", mesh, "--threads", "-1"}, {"--threads", "-1"});
    refused({"voxelize", mesh, "--kernel", "abacus"}, {"--kernel", "abacus", "scalar"});
    refused({"voxelize", mesh, "--plot", folder.path("chart.jpg")}, {"chart.jpg", ".png"});
    refused({"voxelize", mesh, "--plot", folder.path("missing/chart.png")}, {"missing"});
    refused({"voxelize", mesh, folder.path("none.ply"), "--plot", folder.path("chart.png")}, {"none.ply"});
    CHECK(folder.names() == std::vector<std::string>{"cube.obj"});
}
