#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "driver/display/toml.h"
#include "tests/catch.h"

using namespace xorvox;
using Catch::Matchers::Contains;

namespace {

const std::string kStack = R"(name = "stack"
kind = "stacked-planes"
format = "rgb565"
slices = 12
plane_pitch_mm = 3
cycles_per_second = 50.5
summary = "twelve planes"
[[panel]]
columns = 10
rows = 8
column_pitch_mm = 1.5
row_pitch_mm = 2.5
)";

const std::string kRotor = R"(name = "rotor"
kind = "rotating-panel"
format = "rgb111"
slices = 90
cycles_per_second = 25
clockwise = true
[[panel]]
columns = 10
rows = 8
column_pitch_mm = 1.5
row_pitch_mm = 2.5
shift_mm = 0.75
offset_mm = 4
lift_mm = 100
angle_deg = 0
[[panel]]
columns = 20
rows = 8
column_pitch_mm = 0.75
row_pitch_mm = 2.5
shift_mm = -0.75
offset_mm = 5
lift_mm = 100
angle_deg = 180
)";

/// `text` with its only `from` replaced by `to`.
std::string with(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

std::string message(const std::string& toml) {
    const auto display = parse_display(toml, "x.toml");
    REQUIRE_FALSE(display);
    INFO(display.error().message);
    CHECK(display.error().message.find('\n') == std::string::npos);
    CHECK(display.error().message.back() != '.');
    return display.error().message;
}

}  // namespace

TEST_CASE("a file of stacked planes gives every field") {
    const auto display = parse_display(kStack, "x.toml");
    REQUIRE(display);
    CHECK(display->name.view() == "stack");
    CHECK(display->kind == DisplayKind::StackedPlanes);
    CHECK(display->format == PixelFormat::Rgb565);
    CHECK(display->slices == 12);
    CHECK(display->plane_pitch_mm == 3.0);
    CHECK(display->cycles_per_second == 50.5);
    CHECK(display->panel_count == 1);
    CHECK(display->panels[0].columns == 10);
    CHECK(display->panels[0].rows == 8);
    CHECK(display->panels[0].column_pitch_mm == 1.5);
    CHECK(display->panels[0].row_pitch_mm == 2.5);
}

TEST_CASE("a file of rotating panels gives every field") {
    const auto display = parse_display(kRotor, "x.toml");
    REQUIRE(display);
    CHECK(display->kind == DisplayKind::RotatingPanel);
    CHECK(display->format == PixelFormat::Rgb111);
    CHECK(display->clockwise);
    REQUIRE(display->panel_count == 2);
    CHECK(display->panels[0].shift_mm == 0.75);
    CHECK(display->panels[0].offset_mm == 4.0);
    CHECK(display->panels[0].lift_mm == 100.0);
    CHECK(display->panels[1].columns == 20);
    CHECK(display->panels[1].angle_deg == 180.0);
}

TEST_CASE("what is not TOML is refused with its line") {
    CHECK_THAT(message("name = \"x\"\nkind == 3\n"), Contains("x.toml: line 2: not valid TOML"));
    CHECK_THAT(message("name = \"x\"\nname = \"y\"\n"), Contains("x.toml: line 2: not valid TOML"));
    CHECK_THAT(message("name = \"\xff\""), Contains("not valid TOML"));
    CHECK_THAT(message("[\033panel]"),
               Contains("x.toml: line 1: not valid TOML"));  // toml++ 3.3 has an assertion here.
}

TEST_CASE("letters beyond ASCII are allowed in texts and comments, and only there") {
    const std::string marked =
        "\xef\xbb\xbf# Würfel \"'\n" +
        with(with(kStack, "\"stack\"", "\"Würfel # \\\"ä\" # größe"), "\"twelve planes\"", "'zwölf \"\\'");
    const auto display = parse_display(marked, "x.toml");
    if (!display) FAIL(display.error().message);
    CHECK(display->name.view() == "Würfel # \"ä");

    for (const char* text :
         {"a = 1\n\nä = 2", "a = 1\n\nb = ﮮ", "a = 1\n\n\"b\" ä", "a = 1\n\n[ä]", "a = \"\n\nä", "a = 1 # ä\n\n'b'ä"}) {
        INFO(text);
        CHECK_THAT(message(text),
                   Contains("x.toml: line 3: not valid here: a character that is allowed only in texts"));
    }
    for (const char* text : {"a = 2'ä'", "a = 2='ä'", "a = [2['ä'", "a=-'ä'", "a = x'ä'"}) {
        INFO(text);
        CHECK_THAT(message(text), Contains("x.toml: line 1: not valid here: a quotation mark within a word or number"));
    }
    CHECK_THAT(message("a = \"\\ä\""), Contains("x.toml: line 1: not valid here: a character that cannot be escaped"));
    CHECK_THAT(message("a = \"\"\"\nb\"\"\""), Contains("x.toml: line 1: not valid here: a text of several lines"));
    CHECK_THAT(message("\na = '''b'''"), Contains("x.toml: line 2: not valid here: a text of several lines"));
}

TEST_CASE("an unknown key is refused with its line and the nearest known key") {
    CHECK_THAT(message(with(kStack, "slices", "slicse")),
               Contains("x.toml: line 4: unknown key \"slicse\"") && Contains("\"slices\""));
    CHECK_THAT(message(with(kStack, "rows = ", "row = ")),
               Contains("x.toml: line 10: panel 0: unknown key \"row\"") && Contains("nearest one is \"rows\""));
    CHECK_THAT(message(with(kStack, "kind", "knd")), Contains("nearest one is \"kind\""));
}

TEST_CASE("a missing key is named") {
    CHECK_THAT(message(""), Contains("required key \"kind\""));
    CHECK_THAT(message(with(kStack, "name = \"stack\"\n", "")), Contains("required key \"name\""));
    CHECK_THAT(message(with(kStack, "plane_pitch_mm = 3\n", "")), Contains("required key \"plane_pitch_mm\""));
    CHECK_THAT(message(with(kRotor, "slices = 90\n", "")), Contains("required key \"slices\""));
    CHECK_THAT(message(with(kStack, "columns = 10\n", "")),
               Contains("x.toml: line 8: panel 0: the required key \"columns\""));
    CHECK_THAT(message(kStack.substr(0, kStack.find("[[panel]]"))),
               Contains("required key \"panel\"") && Contains("[[panel]]"));
}

TEST_CASE("a key that does not apply to the kind is refused") {
    CHECK_THAT(message(with(kRotor, "slices = 90", "slices = 90\nplane_pitch_mm = 1")),
               Contains("x.toml: line 5: plane_pitch_mm: does not apply to kind \"rotating-panel\""));
    CHECK_THAT(message(with(kStack, "slices = 12", "slices = 12\nclockwise = false")),
               Contains("clockwise: does not apply"));
    for (const char* key : {"shift_mm", "offset_mm", "lift_mm", "angle_deg"}) {
        CHECK_THAT(message(kStack + key + " = 0\n"), Contains(std::string("panel 0: ") + key + ": does not apply"));
    }
}

TEST_CASE("a value of another type is refused with what was found") {
    CHECK_THAT(message(with(kStack, "\"stack\"", "12")),
               Contains("x.toml: line 1: name: found 12; allowed: a text in quotes"));
    CHECK_THAT(message(with(kStack, "slices = 12", "slices = \"many\"")),
               Contains("slices: found the text \"many\"; allowed: a whole number from 1 to 4096"));
    CHECK_THAT(message(with(kStack, "slices = 12", "slices = 12.0")), Contains("slices: found the number 12"));
    CHECK_THAT(message(with(kStack, "= 50.5", "= \"fast\"")), Contains("cycles_per_second: found the text \"fast\""));
    CHECK_THAT(message(with(kStack, "= 50.5", "= 1979-05-27")), Contains("found a date or time"));
    CHECK_THAT(message(with(kStack, "= 50.5", "= [1]")), Contains("found a list"));
    CHECK_THAT(message(with(kRotor, "= true", "= 1")), Contains("clockwise: found 1; allowed: true or false"));
    CHECK_THAT(message(with(kStack, "= \"twelve planes\"", "= false")), Contains("summary: found false"));
    CHECK_THAT(message(with(kStack, "[[panel]]", "[panel]")), Contains("panel: found a table; allowed: one [[panel]]"));
    CHECK_THAT(message(with(kStack, "[[panel]]", "[[panels]]")), Contains("unknown key \"panels\""));
    CHECK_THAT(message(kStack.substr(0, kStack.find("[[panel]]")) + "panel = [1]"),
               Contains("panel: found 1; allowed: one [[panel]]"));
    CHECK_THAT(message(kStack.substr(0, kStack.find("[[panel]]")) + "panel = []"),
               Contains("panel: found 0 panels; allowed: 1 to 8"));
}

TEST_CASE("unknown kinds and formats are refused with those that are known") {
    CHECK_THAT(message(with(kStack, "stacked-planes", "hologram")),
               Contains("x.toml: line 2: kind: found the text \"hologram\"") &&
                   Contains("\"stacked-planes\", \"rotating-panel\", \"swept-plane\", \"helix\" or \"free-points\""));
    CHECK_THAT(message(with(kStack, "\"stacked-planes\"", "1")), Contains("kind: found 1"));
    CHECK_THAT(message(with(kStack, "rgb565", "rgb666")),
               Contains("x.toml: line 3: format: found the text \"rgb666\"") && Contains("\"mono1\""));
    CHECK_THAT(message(with(kStack, "\"rgb565\"", "565")), Contains("format: found 565"));
}

TEST_CASE("numbers out of range are refused with the range") {
    CHECK_THAT(message(with(kStack, "slices = 12", "slices = 0")),
               Contains("x.toml: line 4: slices: found 0; allowed: a whole number from 1 to 4096"));
    CHECK_THAT(message(with(kStack, "slices = 12", "slices = -3")), Contains("found -3"));
    CHECK_THAT(message(with(kStack, "slices = 12", "slices = 4294967297")), Contains("slices: found 4294967297"));
    CHECK_THAT(message(with(kStack, "columns = 10", "columns = 65546")),
               Contains("x.toml: line 9: panel 0: columns: found 65546"));
    CHECK_THAT(message(with(kStack, "rows = 8", "rows = 0")), Contains("panel 0: rows: found 0"));
    CHECK_THAT(message(with(kStack, "50.5", "nan")), Contains("cycles_per_second: found nan"));
    CHECK_THAT(message(with(kStack, "50.5", "inf")), Contains("cycles_per_second: found inf"));
    CHECK_THAT(message(with(kStack, "50.5", "0")), Contains("cycles_per_second: found 0"));
    CHECK_THAT(message(with(kStack, "plane_pitch_mm = 3", "plane_pitch_mm = 0.0")),
               Contains("x.toml: line 5: plane_pitch_mm: found 0"));
    CHECK_THAT(message(with(kStack, "= 1.5", "= -1.5")), Contains("column_pitch_mm: found -1.5"));
    CHECK_THAT(message(with(kStack, "= 2.5", "= nan")), Contains("x.toml: line 12: panel 0: row_pitch_mm: found nan"));
    CHECK_THAT(message(with(kRotor, "= 180", "= inf")), Contains("x.toml: line 24: panel 1: angle_deg: found inf"));
    CHECK_THAT(message(with(kRotor, "shift_mm = 0.75", "shift_mm = 1e9")), Contains("panel 0: shift_mm: found 1"));
}

TEST_CASE("frames and lattices that are too large are refused") {
    const std::string wide = with(with(kStack, "columns = 10", "columns = 4096"), "rows = 8", "rows = 4096");
    CHECK_THAT(message(with(wide, "slices = 12", "slices = 33")),
               Contains("x.toml: line 4: slices: found 33, which makes frames of 1107296256 bytes"));
    CHECK(parse_display(with(wide, "slices = 12", "slices = 32"), "x.toml"));

    const std::string turns = with(with(kRotor, "columns = 10", "columns = 4096"), "slices = 90", "slices = 4096");
    CHECK_THAT(message(turns), Contains("makes 16859136 columns of samples") && Contains("at most 16777216"));
}

TEST_CASE("panels of a rotor may differ in rows, pitch and lift") {
    CHECK(parse_display(with(kRotor, "columns = 20\nrows = 8", "columns = 20\nrows = 9"), "x.toml"));
    CHECK(parse_display(with(kRotor, "0.75\nrow_pitch_mm = 2.5", "0.75\nrow_pitch_mm = 2.25"), "x.toml"));
    CHECK(parse_display(with(kRotor, "lift_mm = 100\nangle_deg = 180", "lift_mm = 99\nangle_deg = 180"), "x.toml"));
}

TEST_CASE("stacked planes have one panel and a rotor at most eight") {
    const std::string panel = kStack.substr(kStack.find("[[panel]]"));
    CHECK_THAT(message(kStack + panel), Contains("panel: found 2 panels; allowed on stacked-planes: exactly one"));
    std::string nine = with(kStack, "stacked-planes", "rotating-panel");
    nine = with(nine, "plane_pitch_mm = 3\n", "");
    for (int i = 1; i < 8; ++i) nine += panel + "offset_mm = " + std::to_string(i) + "\n";
    CHECK(parse_display(nine, "x.toml"));
    CHECK_THAT(message(nine + panel), Contains("panel: found 9 panels; allowed: 1 to 8"));
}

TEST_CASE("a name is one line of 1 to 31 bytes") {
    CHECK_THAT(message(with(kStack, "\"stack\"", "\"\"")), Contains("name: found 0 bytes; allowed: 1 to 31"));
    CHECK_THAT(message(with(kStack, "\"stack\"", "\"" + std::string(32, 'x') + "\"")), Contains("found 32 bytes"));
    CHECK(parse_display(with(kStack, "\"stack\"", "\"" + std::string(31, 'x') + "\""), "x.toml"));
    CHECK_THAT(message(with(kStack, "\"stack\"", "\"a\\nb\"")),
               Contains("name: found the text \"a?b\"") && Contains("control"));
}

TEST_CASE("long and odd texts stay short and on one line in messages") {
    std::string text;
    for (int i = 0; i < 5000; ++i) text += "ä";
    const std::string report = message(with(kStack, "stacked-planes", "x" + text));
    CHECK(report.size() < 300);
    CHECK_THAT(report, Contains("ää…"));
    CHECK(message("\"" + text + "\" = 1").size() < 300);
    CHECK_THAT(message("\"a\\nb\" = 1"), Contains("unknown key \"a?b\""));
}

TEST_CASE("loading by path reads a file and names it in messages") {
    const auto folder = std::filesystem::temp_directory_path() / "xorvox_display_test";
    std::filesystem::create_directories(folder);
    const std::string path = (folder / "my display.toml").string();

    std::ofstream(path) << kStack;
    REQUIRE(load_display(path));
    CHECK(load_display(path)->name.view() == "stack");

    std::ofstream(path) << with(kStack, "slices = 12", "slices = 0");
    CHECK_THAT(load_display(path).error().message, Contains(path + ": line 4: slices"));

    std::ofstream(path) << "# " << std::string(1 << 20, 'x');
    CHECK_THAT(load_display(path).error().message, Contains(path) && Contains("longer than 1048576 bytes"));

    CHECK_THAT(load_display(folder.string()).error().message, Contains("is a directory"));
    CHECK_THAT(load_display((folder / "none.toml").string()).error().message,
               Contains("none.toml: cannot open") && Contains("No such file"));
    CHECK_THAT(load_display("none.toml").error().message, Contains("none.toml: cannot open"));
    std::filesystem::remove_all(folder);
}

TEST_CASE("an unknown preset is refused with the presets") {
    CHECK_THAT(load_display("cube17").error().message,
               Contains("unknown display \"cube17\"; presets: candle, cube16-ws2812, cube20-ws2812, cube8-595,"));
    CHECK_THAT(load_display("").error().message, Contains("unknown display \"\""));
}
