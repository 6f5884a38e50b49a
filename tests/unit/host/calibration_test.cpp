#include "driver/host/calibration.h"

#include <cmath>
#include <string>

#include "tests/catch.h"
#include "tests/displays.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

DisplayDescription stack() {
    return test::odd_displays().front();  // 7 planes of 13 × 9
}

DisplayDescription rotor() {
    return test::upright_rotor(false, false, 0);  // panels of 67 × 11 and 10 × 11
}

std::string complaint(const std::string& text, const DisplayDescription& display = stack()) {
    const auto read = Calibration::parse(text, display);
    return read ? "none" : read.error().message;
}

const std::string kPlaneHead = "plane,row,column,red,green,blue\n";

}  // namespace

TEST_CASE("a calibration file names LEDs, by plane or by panel") {
    const auto planes =
        Calibration::parse("# measured\n\n" + kPlaneHead + "6,8,12,0,1,0.5\r\n 0 , 1,2 ,.25,1,1 # dim\n", stack());
    REQUIRE(planes);
    REQUIRE(planes->leds().size() == 2);
    CHECK(planes->leds()[0].unit == 0);
    CHECK(planes->leds()[0].pixel == 1 * 13 + 2);
    CHECK(planes->leds()[0].gain == glm::vec3(0.25f, 1, 1));
    CHECK(planes->leds()[1].unit == 6);
    CHECK(planes->leds()[1].pixel == 8 * 13 + 12);
    CHECK(planes->leds()[1].gain == glm::vec3(0, 1, 0.5f));

    const auto panels = Calibration::parse("row,column,panel,blue,green,red\n10,9,1,0.1,0.2,0.3", rotor());
    REQUIRE(panels);
    REQUIRE(panels->leds().size() == 1);
    CHECK(panels->leds()[0].unit == 1);
    CHECK(panels->leds()[0].pixel == 67 * 11 + 10 * 10 + 9);
    CHECK(panels->leds()[0].gain == glm::vec3(0.3f, 0.2f, 0.1f));

    CHECK(Calibration::parse(kPlaneHead, stack())->leds().empty());
}

TEST_CASE("a gain of minus zero is zero") {
    const auto read = Calibration::parse(kPlaneHead + "0,0,0,-0,-0.0,-0e5\n", stack());
    REQUIRE(read);
    for (int c = 0; c < 3; ++c) {
        CHECK(read->leds()[0].gain[c] == 0.0f);
        CHECK_FALSE(std::signbit(read->leds()[0].gain[c]));
    }
}

TEST_CASE("what is wrong in a calibration file is told by its line") {
    CHECK(complaint("") == "there is no line of columns: plane,row,column,red,green,blue");
    CHECK(complaint("# nothing\n") == "there is no line of columns: plane,row,column,red,green,blue");
    CHECK(complaint("\nplane,row,colum,red,green,blue\n") ==
          "line 2: unknown column \"colum\"; the columns are plane,row,column,red,green,blue");
    CHECK(complaint(kPlaneHead, rotor()) ==
          "line 1: unknown column \"plane\"; the columns are panel,row,column,red,green,blue");
    CHECK(complaint("plane,row,column,red,green\n") == "line 1: column \"blue\" is missing");
    CHECK(complaint("plane,row,column,red,green,blue,red\n") == "line 1: column \"red\" is there twice");
    CHECK(complaint(kPlaneHead + "0,0,0,1,1\n") == "line 2: 5 fields; there must be 6");
    CHECK(complaint(kPlaneHead + "0,0,0,1,1,1,1\n") == "line 2: 7 fields; there must be 6");
    CHECK(complaint(kPlaneHead + "0,0,zero,1,1,1\n") == "line 2: column \"zero\" is no whole number");
    CHECK(complaint(kPlaneHead + "0,-1,0,1,1,1\n") == "line 2: row \"-1\" is no whole number");
    CHECK(complaint(kPlaneHead + "7,0,0,1,1,1\n") == "line 2: plane 7: the display has 7 of them, from 0 to 6");
    CHECK(complaint(kPlaneHead + "0,9,0,1,1,1\n") == "line 2: row 9: the display has 9 of them, from 0 to 8");
    CHECK(complaint(kPlaneHead + "0,0,99999999999,1,1,1\n") == "line 2: column \"99999999999\" is no whole number");
    CHECK(complaint(kPlaneHead + "0,0,0,1,1.01,1\n") == "line 2: green is 1.01; a gain is 0 to 1");
    CHECK(complaint(kPlaneHead + "0,0,0,1,1,-0.1\n") == "line 2: blue is -0.1; a gain is 0 to 1");
    CHECK(complaint(kPlaneHead + "0,0,0,nan,1,1\n") == "line 2: red is nan; a gain is 0 to 1");
    CHECK(complaint(kPlaneHead + "0,0,0,bright\x1b[2J,1,1\n") == "line 2: red \"bright?[2J\" is no number");
    CHECK(complaint(kPlaneHead + "0,0,0,1,1,1\n1,0,0,1,1,1\n0,0,0,1,1,1\n") == "line 4: the LED of line 2 again");
    CHECK(complaint(std::string(Calibration::kMostBytes + 1, '\n')) == "67108865 bytes; at most 67108864 are read");
}
