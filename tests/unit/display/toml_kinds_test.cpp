// Display files: the kinds and tables beyond a plain stack or rotor, what is assumed, and all mistakes at once.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "driver/display/toml.h"
#include "tests/catch.h"

using namespace xorvox;
using Catch::Matchers::Contains;

namespace {

const std::string kHead = R"(name = "x"
format = "mono1"
cycles_per_second = 15
)";
const std::string kPanel = R"([[panel]]
columns = 2
rows = 3
column_pitch_mm = 1.5
row_pitch_mm = 2.5
)";
const std::string kSwept = kHead + R"(kind = "swept-plane"
slices = 10
[motion]
stroke_mm = 80
profile = "sine"
both_ways = true
dead_zone = 0.1
)" + kPanel;
const std::string kHelix = kHead + R"(kind = "helix"
slices = 10
blades = 2
clockwise = true
[motion]
stroke_mm = 80
)" + kPanel;
const std::string kFree = kHead + R"(kind = "free-points"
points = [[0, 0, 0], [1.5, 0, 0],
          [0, 1, 0], [0, 0, 1],
          [0, 0, 2], [0, 0, -3e1]]
[[panel]]
columns = 2
rows = 3
)";
const std::string kUneven = kHead + R"(kind = "stacked-planes"
slices = 3
plane_heights_mm = [-10, 0, 12.5]
)" + kPanel;
const std::string kRotor = kHead + "kind = \"rotating-panel\"\nslices = 4\n" + kPanel;

/// `text` with its only `from` replaced by `to`.
std::string with(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

DisplayFile parsed(const std::string& toml) {
    auto display = parse_display(toml, "x.toml");
    if (!display) FAIL(display.error().message);
    return *display;
}

std::string message(const std::string& toml) {
    const auto display = parse_display(toml, "x.toml");
    REQUIRE_FALSE(display);
    const auto mistakes = find_mistakes(toml);
    REQUIRE_FALSE(mistakes.empty());
    CHECK(display.error().message == "x.toml: line " + std::to_string(mistakes[0].line) + ": " + mistakes[0].message);
    return display.error().message;
}

}  // namespace

TEST_CASE("a file of a swept plane gives every field") {
    const DisplayFile display = parsed(kSwept);
    CHECK(display.kind == DisplayKind::SweptPlane);
    CHECK(display.slices == 10);
    CHECK(display.motion.stroke_mm == 80.0);
    CHECK(display.motion.profile == MotionProfile::Sine);
    CHECK(display.motion.both_ways);
    CHECK(display.motion.dead_zone == 0.1);
    CHECK(display.motion.table_size == 0);

    const Motion motion = parsed(with(kSwept, "\"sine\"", "\"table\"\ntable = [0, 0.25, 1.0]")).motion;
    CHECK(motion.profile == MotionProfile::Table);
    REQUIRE(motion.table_size == 3);
    CHECK(motion.table[1] == 0.25);
    CHECK(motion.table[2] == 1.0);
}

TEST_CASE("a file of a helix gives every field") {
    const DisplayFile display = parsed(kHelix);
    CHECK(display.kind == DisplayKind::Helix);
    CHECK(display.blades == 2);
    CHECK(display.clockwise);
    CHECK(display.motion.stroke_mm == 80.0);
}

TEST_CASE("copies of free points keep the points when the file is gone") {
    DisplayFile copy;
    {
        const DisplayFile display = parsed(kFree);
        copy = display;
    }
    CHECK(copy.kind == DisplayKind::FreePoints);
    CHECK(copy.slices == 1);
    REQUIRE(copy.points.size() == 6);
    CHECK(copy.points[1].x == 1.5);
    CHECK(copy.points[5].z == -30.0);
    CHECK(copy.panels[0].columns == 2);
    CHECK(geometry_digest(copy) == geometry_digest(parsed(kFree)));
}

TEST_CASE("copies of uneven planes keep the heights when the file is gone") {
    DisplayFile copy;
    {
        const DisplayFile display = parsed(kUneven);
        copy = display;
    }
    REQUIRE(copy.plane_heights_mm.size() == 3);
    CHECK(copy.plane_heights_mm[0] == -10.0);
    CHECK(copy.plane_heights_mm[2] == 12.5);
}

TEST_CASE("a rotor's panels have every part of their pose and wiring") {
    const DisplayFile display = parsed("sweep_deg = 360\n" + kRotor +
                                       "offset_mm = 3\ntilt_deg = -10\nskew_mm = 0.5\nmirrored = true\nturned = 3\n"
                                       "connector = 5\nchain_position = 0\n");
    const Panel& panel = display.panels[0];
    CHECK(display.sweep_deg == 360.0);
    CHECK(panel.tilt_deg == -10.0);
    CHECK(panel.skew_mm == 0.5);
    CHECK(panel.mirrored);
    CHECK(panel.turned == 3);
    CHECK(panel.connector == 5);
    CHECK(panel.chain_position == 0);
    CHECK(parsed("sweep_deg = 180.0\n" + kRotor).sweep_deg == 180.0);
}

TEST_CASE("every format is known") {
    for (const PixelFormat format : kPixelFormats) {
        CHECK(parsed(with(kUneven, "mono1", to_string(format))).format == format);
    }
}

TEST_CASE("how a display is driven is read") {
    const std::string sync = R"([sync]
index = "encoder"
index_pulses = 65536
index_phase = 0.25
slowest_cycles_per_second = 1.5
fastest_cycles_per_second = 30
)";
    const Sync read = parsed(kRotor + sync).sync;
    CHECK(read.index == IndexSource::Encoder);
    CHECK(read.index_pulses == 65536);
    CHECK(read.index_phase == 0.25);
    CHECK(read.slowest_cycles_per_second == 1.5);
    CHECK(read.fastest_cycles_per_second == 30.0);
    CHECK(parsed(kRotor + with(sync, "encoder", "pulses")).sync.index == IndexSource::Pulses);
    CHECK(parsed(kRotor + "[sync]\nindex = \"none\"\n").sync.index == IndexSource::None);

    const std::string scan = R"([scan]
driver = "74hc595"
pixel_clock_hz = 8_000_000
latch_ns = 1
min_on_ns = 7
rise_ns = 3
fall_ns = 4
row_groups = 3
bit_planes = 1
bit_order = "lsb-first"
register_order = "layers-first"
color_order = "bgr"
)";
    const std::string colored = with(kUneven, "mono1", "rgb111");
    const Scan shifted = parsed(colored + scan).scan;
    CHECK(shifted.driver == DriverChip::ShiftRegister595);
    CHECK(shifted.pixel_clock_hz == 8000000);
    CHECK(shifted.latch_ns == 1);
    CHECK(shifted.min_on_ns == 7);
    CHECK(shifted.rise_ns == 3);
    CHECK(shifted.fall_ns == 4);
    CHECK(shifted.row_groups == 3);
    CHECK(shifted.bit_planes == 1);
    CHECK_FALSE(shifted.msb_first);
    CHECK(shifted.layers_first);
    CHECK(shifted.color_order == std::array{'b', 'g', 'r'});
    for (const auto& [name, chip] :
         {std::pair{"ws2812", DriverChip::Ws2812}, std::pair{"apa102", DriverChip::Apa102}}) {
        const Scan strings =
            parsed(colored + "[scan]\ndriver = \"" + name + "\"\nstrings = 3\nserpentine = true\n").scan;
        CHECK(strings.driver == chip);
        CHECK(strings.strings == 3);
        CHECK(strings.serpentine);
        CHECK(strings.msb_first);
    }
    CHECK(parsed(kSwept + "[scan]\ndriver = \"dlp\"\nplanes_per_frame = 24\n").scan.planes_per_frame == 24);
    CHECK(parsed(with(kSwept, "rows = 3", "rows = 2") + "[scan]\ndriver = \"hub75\"\n").scan.driver ==
          DriverChip::Hub75);
    CHECK(parsed(kSwept + "[scan]\ndriver = \"direct\"\n").scan.driver == DriverChip::Direct);

    const Power power = parsed(kUneven + "[power]\nled_ma = 20\nmax_duty = 0.125\nlimit_ma = 1e4\n").power;
    CHECK(power.led_ma == 20.0);
    CHECK(power.max_duty == 0.125);
    CHECK(power.limit_ma == 10000.0);
}

TEST_CASE("what light a code gives is read, and is in proportion to it where nothing is said") {
    CHECK(parsed(kUneven).light.response == Response::Linear);
    CHECK(parsed(kUneven + "[light]\n").light.response == Response::Linear);
    CHECK(parsed(kUneven + "[light]\nresponse = \"linear\"\n").light.response == Response::Linear);
    CHECK(parsed(kUneven + "[light]\nresponse = \"srgb\"\n").light.response == Response::Srgb);
    CHECK(parsed(kUneven + "[light]\nresponse = \"cie1931\"\n").light.response == Response::Cie1931);
    CHECK(parsed(kUneven + "[light]\nresponse = \"gamma\"\n").light.gamma == 2.2);
    const Light light = parsed(kSwept + "[light]\ngamma = 1.8\nresponse = \"gamma\"\n").light;
    CHECK(light.response == Response::Gamma);
    CHECK(light.gamma == 1.8);
}

TEST_CASE("light that is not understood is refused with its line") {
    const std::string lines = std::to_string(std::ranges::count(kSwept, '\n') + 2);
    const auto line = [&](const std::string& light) { return message(kSwept + "[light]\n" + light + "\n"); };
    CHECK_THAT(line("response = \"cie\""), Contains("line " + lines +
                                                    ": light.response: found the text \"cie\"; allowed: "
                                                    "\"linear\", \"gamma\", \"srgb\" or \"cie1931\""));
    CHECK_THAT(line("response = 2.2"), Contains("light.response: found the number 2.2"));
    CHECK_THAT(line("response = \"gamma\"\ngamma = 0.9"),
               Contains("light.gamma: found 0.9; allowed: a number from 1 to 4"));
    CHECK_THAT(line("response = \"gamma\"\ngamma = 4.1"), Contains("light.gamma: found 4.1"));
    CHECK_THAT(line("response = \"gamma\"\ngamma = nan"), Contains("light.gamma: found nan"));
    CHECK_THAT(
        line("gamma = 2.2"),
        Contains("line " + lines + ": light.gamma: found with response \"linear\"; allowed: with \"gamma\" alone"));
    CHECK_THAT(line("response = \"srgb\"\ngamma = 9"), Contains("light.gamma: found with response \"srgb\""));
    CHECK(find_mistakes(kSwept + "[light]\nresponse = \"gama\"\ngamma = 2\n").size() == 1);
    CHECK_THAT(line("brightness = 1"), Contains("unknown key \"light.brightness\""));
}

TEST_CASE("keys of tables are refused like others, with table and line") {
    CHECK_THAT(message(with(kSwept, "dead_zone", "deadzone")),
               Contains("line 10: unknown key \"motion.deadzone\"; the nearest one is \"dead_zone\" of stroke_mm"));
    CHECK_THAT(message(with(kSwept, "stroke_mm = 80\n", "")),
               Contains("line 6: the required key \"motion.stroke_mm\" is missing"));
    CHECK_THAT(message(with(kSwept, "0.1", "\"some\"")),
               Contains("line 10: motion.dead_zone: found the text \"some\"; allowed: a number"));
    CHECK_THAT(message(with(kSwept, "\"sine\"", "\"cosine\"")),
               Contains("line 8: motion.profile: found the text \"cosine\"; allowed: \"constant\", \"sine\" or"));
    CHECK_THAT(message(with(kHelix, "stroke_mm = 80", "stroke_mm = 80\nprofile = \"sine\"")),
               Contains("motion.profile: does not apply to kind \"helix\", only to \"swept-plane\"; remove it"));
    CHECK_THAT(message("scan = 3\n" + kSwept), Contains("line 1: scan: found 3; allowed: a [scan] table"));
    CHECK_THAT(message(kSwept + "[scan]\nstrings = 256\n"), Contains("scan.strings: found 256; allowed: a whole"));
    CHECK_THAT(message(kSwept + "[scan]\ncolor_order = \"rg\"\n"), Contains("scan.color_order: found \"rg\""));
    CHECK_THAT(message(kSwept + "[scan]\ncolor_order = \"\"\n"), Contains("scan.color_order: found \"\""));
    CHECK_THAT(message(kSwept + "[scan]\nbit_order = \"msb\"\n"), Contains("\"msb-first\" or \"lsb-first\""));
    CHECK_THAT(message(kSwept + "[sync]\nindex = \"sensor\"\n"), Contains("\"none\", \"pulses\" or \"encoder\""));
    CHECK_THAT(message(kSwept + "[power]\nlimit_ma = -5\n"), Contains("power.limit_ma: found -5"));
}

TEST_CASE("each kind needs its own keys and refuses those of others") {
    CHECK_THAT(message(kHead + "kind = \"helix\"\nslices = 3\n" + kPanel),
               Contains("the required key \"motion\" is missing; add a [motion] table"));
    CHECK_THAT(message(with(kFree,
                            "points = [[0, 0, 0], [1.5, 0, 0],\n          [0, 1, 0], [0, 0, 1],\n          [0, 0, "
                            "2], [0, 0, -3e1]]\n",
                            "")),
               Contains("the required key \"points\" is missing"));
    CHECK_THAT(message("slices = 1\n" + kFree), Contains("line 1: slices: does not apply to kind \"free-points\""));
    CHECK_THAT(message("blades = 1\n" + kSwept), Contains("blades: does not apply"));
    CHECK_THAT(message("clockwise = true\n" + kSwept), Contains("only to \"rotating-panel\" or \"helix\""));
    CHECK_THAT(message("sweep_deg = 180\n" + kHelix), Contains("sweep_deg: does not apply"));
    CHECK_THAT(message("points = [[0, 0, 0]]\n" + kHelix), Contains("points: does not apply"));
    CHECK_THAT(message("plane_heights_mm = [1]\n" + kRotor), Contains("plane_heights_mm: does not apply"));
    CHECK_THAT(message(kUneven + "tilt_deg = 0\n"), Contains("panel 0: tilt_deg: does not apply"));
    CHECK_THAT(message("plane_pitch_mm = 1\n" + kUneven), Contains("plane_heights_mm: found beside plane_pitch_mm"));
    CHECK_THAT(message(with(kUneven, "plane_heights_mm = [-10, 0, 12.5]\n", "")),
               Contains("the required key \"plane_pitch_mm\" is missing"));
}

TEST_CASE("lists are checked item by item") {
    CHECK_THAT(message(with(kUneven, "0, 12.5", "\"0\", 12.5")),
               Contains("line 6: plane_heights_mm: found the text \"0\"; allowed: a list of numbers"));
    CHECK_THAT(message(with(kUneven, "[-10, 0, 12.5]", "3")), Contains("plane_heights_mm: found 3; allowed: a list"));
    CHECK_THAT(message(with(kFree, "[0, 1, 0]", "[0, 1]")),
               Contains("line 6: points: found a place of 2 numbers; allowed: a list of places"));
    CHECK_THAT(message(with(kFree, "[0, 1, 0]", "7")), Contains("line 6: points: found 7"));
    CHECK_THAT(message(with(kFree, "[0, 1, 0]", "[0, true, 0]")), Contains("line 6: points: found true"));
    CHECK_THAT(message(with(kFree, "[0, 1, 0]", "[0, nan, 0]")), Contains("line 6: points: found nan; allowed"));
    std::string many = "0";
    for (int i = 1; i < 65; ++i) many += ", " + std::to_string(i);
    CHECK_THAT(message(with(kSwept, "\"sine\"", "\"table\"\ntable = [" + many + "]")),
               Contains("line 9: motion.table: found 65 heights; allowed: 2 to 64"));
}

TEST_CASE("assumed names keys of the file") {
    const DisplayFile display =
        parsed("assumed = [\"cycles_per_second\", \"panel.rows\", \"motion.stroke_mm\"]\n" + kSwept);
    CHECK(display.assumed == std::vector<std::string>{"cycles_per_second", "panel.rows", "motion.stroke_mm"});
    CHECK(parsed(kSwept).assumed.empty());
    CHECK_THAT(message("assumed = [\n\"panel.rows\",\n\"scan.latch_ns\"]\n" + kSwept),
               Contains("line 3: assumed: found \"scan.latch_ns\", which is no key of this file"));
    CHECK_THAT(message("assumed = [\"panel.shift_mm\"]\n" + kRotor), Contains("which is no key of this file"));
    CHECK_THAT(message("assumed = [\"slices.x\"]\n" + kRotor), Contains("which is no key of this file"));
    CHECK_THAT(message("assumed = [\"motion\"]\n" + kSwept), Contains("\"motion\", which is a table"));
    CHECK_THAT(message("assumed = [\"panel\"]\n" + kSwept), Contains("\"panel\", which is a table"));
    CHECK_THAT(message("assumed = [7]\n" + kSwept), Contains("assumed: found 7; allowed: a list of texts"));
    CHECK_THAT(message("assumed = \"rows\"\n" + kSwept), Contains("assumed: found the text \"rows\""));
}

TEST_CASE("the summary of a file is read") {
    CHECK(parsed("summary = \"one line\"\n" + kSwept).summary == "one line");
    CHECK(parsed(kSwept).summary.empty());
}

TEST_CASE("all mistakes of a file are found, by line") {
    const std::string text = with(with(with(kSwept, "15", "\"x\""), "\"sine\"", "7"), "rows = 3", "rowz = 3");
    const auto mistakes = find_mistakes("colour = 1\n" + text);
    REQUIRE(mistakes.size() == 4);
    CHECK(mistakes[0].line == 1);
    CHECK_THAT(mistakes[0].message, Contains("unknown key \"colour\""));
    CHECK(mistakes[1].line == 4);
    CHECK_THAT(mistakes[1].message, Contains("cycles_per_second: found the text"));
    CHECK(mistakes[2].line == 9);
    CHECK_THAT(mistakes[2].message, Contains("motion.profile: found 7"));
    CHECK(mistakes[3].line == 14);  // That rows is missing goes without saying.
    CHECK_THAT(mistakes[3].message, Contains("panel 0: unknown key \"rowz\""));

    const auto numbers = find_mistakes(with(with(kSwept, "80", "0"), "1.5", "-1.5"));
    REQUIRE(numbers.size() == 2);
    CHECK_THAT(numbers[0].message, Contains("motion.stroke_mm: found 0"));
    CHECK_THAT(numbers[1].message, Contains("panel 0: column_pitch_mm: found -1.5"));

    CHECK(std::ranges::none_of(mistakes, &DisplayMistake::contradiction));
    CHECK(find_mistakes(kSwept).empty());
    CHECK(find_mistakes("name = ").size() == 1);
}

TEST_CASE("values of another type and values out of range are found together, each once") {
    std::string text = with(with(with(kSwept, "15", "\"x\""), "80", "-1"), "dead_zone = 0.1", "dead_zone = 0.5");
    text = with(with(text, "column_pitch_mm = 1.5", "column_pitch_mm = []"), "row_pitch_mm = 2.5", "row_pitch_mm = 0");
    const auto mistakes = find_mistakes(text + "[power]\nmax_duty = 2\nled_ma = true\n[scan]\nstrings = 0\n");
    const std::vector<std::string> wanted{"cycles_per_second: found the text", "motion.stroke_mm: found -1",
                                          "motion.dead_zone: found 0.5",       "panel 0: column_pitch_mm: found a list",
                                          "panel 0: row_pitch_mm: found 0",    "power.max_duty: found 2",
                                          "power.led_ma: found true",          "scan.strings: found 0"};
    REQUIRE(mistakes.size() == wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) CHECK_THAT(mistakes[i].message, Catch::StartsWith(wanted[i]));
}

TEST_CASE("what does not apply, is missing or is unknown is not found out of range as well") {
    const auto messages = [](const std::string& toml) {
        std::string all;
        for (const DisplayMistake& mistake : find_mistakes(toml)) all += mistake.message + "\n";
        return all;
    };
    CHECK(messages("plane_heights_mm = [1]\n" + kRotor) ==
          "plane_heights_mm: does not apply to kind \"rotating-panel\", only to \"stacked-planes\"; remove it\n");
    CHECK_THAT(messages(with(kSwept, "stroke_mm = 80", "strok_mm = 80")),
               Contains("unknown key \"motion.strok_mm\"") && !Contains("motion.stroke_mm: found"));
    CHECK(messages("motion = 3\n" + kHead + "kind = \"helix\"\nslices = 3\n" + kPanel) ==
          "motion: found 3; allowed: a [motion] table\n");
    CHECK(messages("plane_pitch_mm = 3\n" + kUneven) ==
          "plane_heights_mm: found beside plane_pitch_mm; allowed: one of the two\n");
    CHECK(messages(with(kSwept, "rows = 3\n", "")) == "panel 0: the required key \"rows\" is missing\n");
}

TEST_CASE("without a kind that is known, values of another type are found all the same") {
    const auto mistakes = find_mistakes(with(with(with(kSwept, "swept-plane", "swept"), "15", "[]"), "\"sine\"", "1"));
    REQUIRE(mistakes.size() == 3);
    CHECK_THAT(mistakes[0].message, Contains("cycles_per_second: found a list"));
    CHECK_THAT(mistakes[1].message, Contains("kind: found the text \"swept\""));
    CHECK_THAT(mistakes[2].message, Contains("motion.profile: found 1"));
}

TEST_CASE("the text of a preset is found by its name") {
    const auto source = find_display("vx1");
    REQUIRE(source);
    CHECK(source->name == "vx1");
    CHECK(find_mistakes(source->text).empty());
    CHECK_FALSE(find_display("vx2"));
}
