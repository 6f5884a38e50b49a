// share: the examples in C and in Python draw on a display, by the commands of docs/share.md.
#include <cstdio>
#include <string>
#include <vector>

#include <sys/wait.h>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

const std::string kSpin = XORVOX_SPIN;
const std::string kWave = "python3 " XORVOX_SOURCE_DIR "/examples/share/wave.py";

/// Runs a line of the shell: status, and both outputs in one.
Outcome shell(const std::string& line) {
    Outcome outcome;
    std::FILE* const pipe = ::popen((line + " 2>&1").c_str(), "r");
    REQUIRE(pipe != nullptr);
    char bytes[4096];
    for (std::size_t n = 0; (n = std::fread(bytes, 1, sizeof bytes, pipe)) > 0;) outcome.out.append(bytes, n);
    const int status = ::pclose(pipe);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome;
}

bool has_python() {
    return shell("python3 -c 'import socket; socket.recv_fds'").status == 0;
}

/// What a drawing program says of its last frame.
double said_lit(const std::string& text) {
    const std::size_t at = text.find(" pixels are lit");
    CAPTURE(text);
    REQUIRE(at != text.npos);
    return std::stod(text.substr(text.rfind('\n', at) + 1));
}

/// The report of `xorvox share`, upon `frames` frames drawn by `program`; what the program said.
std::string share_with(const std::string& display, const std::string& program, int frames,
                       const std::vector<std::string>& more, std::string& said) {
    const Folder folder;
    const std::string socket = folder.path("socket");
    std::vector<std::string> arguments{
        "share", "--display", display, "--socket", socket, "--frames", std::to_string(frames), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Background server(arguments);
    CHECK_THAT(server.line().value_or(""), Catch::Contains("\"event\": \"ready\"") && Catch::Contains(socket));
    const std::size_t space = program.find('|');
    const Outcome drawn = shell(program.substr(0, space) + " " + socket + " " + std::to_string(frames) +
                                (space == program.npos ? "" : " " + program.substr(space + 1)));
    CAPTURE(drawn.out);
    CHECK(drawn.status == 0);
    said = drawn.out;
    const std::string report = server.line().value_or("");
    CHECK_FALSE(server.line());
    CHECK(folder.names().empty());
    return report;
}

}  // namespace

TEST_CASE("a program in C draws on a display, by message", "[cli]") {
    const Folder folder;
    const std::string display = GENERATE(std::string("cube16-ws2812"), kSmallRotor);
    const std::string file = display == kSmallRotor ? folder.file("rotor.toml", kSmallRotor) : display;
    std::string said;
    const std::string report = share_with(file, kSpin, 10, {}, said);
    CHECK(number(report, "pixels_lit") == said_lit(said));
    CHECK(number(report, "pixels_lit") == (display == kSmallRotor ? 60 * 33 : 256));
    CHECK(number(report, "by_message") == 10);
    CHECK(number(report, "last_tag") == 9);
    CHECK(number(report, "frames_handed_on") >= 1);
    CHECK(number(report, "light_outside") == 0);
}

TEST_CASE("a program in C draws on a display, by atomics", "[cli]") {
    const Folder folder;
    const std::string socket = folder.path("socket");
    Background server({"share", "--display", "cube8-595", "--socket", socket, "--frames", "1", "--json"});
    server.line();
    const Outcome drawn = shell(kSpin + " " + socket + " 1 atomics");
    CAPTURE(drawn.out);
    CHECK(drawn.status == 0);
    const std::string report = server.line().value_or("");
    CHECK(number(report, "by_atomics") == 1);
    CHECK(number(report, "pixels_lit") == 64);
}

TEST_CASE("a program in Python draws on a display, with a picture of it", "[cli]") {
    if (!has_python()) XORVOX_SKIP("no python3 of version 3.9 or later");
    const Folder folder;
    const std::string display = GENERATE(std::string("cube16-ws2812"), std::string("cube8-595"), kSmallRotor);
    const std::string file = display == kSmallRotor ? folder.file("rotor.toml", kSmallRotor) : display;
    std::string said;
    std::vector<std::string> more;
    if (display == "cube16-ws2812") more = {"--png", folder.path("wave.png"), "--view", "orthographic"};
    const std::string report = share_with(file, kWave, 5, more, said);
    CHECK(number(report, "pixels_lit") == said_lit(said));
    CHECK(number(report, "pixels_lit") == (display == kSmallRotor ? 60 * 33 : display == "cube8-595" ? 64 : 256));
    if (!more.empty()) CHECK(read_file(folder.path("wave.png")).starts_with("\x89PNG"));
}

TEST_CASE("what programs draw reaches a display in another program", "[cli]") {
    Background display({"sim", "--display", "cube8-595", "--listen", "tcp:0"});
    const std::string line = display.line().value_or("");
    std::string said;
    const std::string report = share_with("cube8-595", kSpin, 5, {"--to", line.substr(line.rfind("tcp:"))}, said);
    CHECK(number(report, "by_message") == 5);
    CHECK(number(report, "frames_presented") >= 1);
    std::string shown;
    while (shown.find(": 64 pixels lit") == shown.npos) {
        const std::optional<std::string> more = display.line();
        REQUIRE(more);
        shown = *more;
    }
}

TEST_CASE("share ends upon a signal with its figures, and removes its socket", "[cli]") {
    const Folder folder;
    Background server({"share", "--display", "cube8-595", "--socket", folder.path("socket")});
    CHECK(server.line() == "cube8-595: programs may draw at " + folder.path("socket"));
    CHECK(shell(kSpin + " " + folder.path("socket") + " 2").status == 0);
    CHECK(::kill(server.pid(), SIGTERM) == 0);
    std::string figures;
    while (const auto more = server.line()) figures += *more + "\n";
    CHECK_THAT(figures, Catch::Contains("drawn: 2 frames by 1 program,") && Catch::Contains("sent: "));
    CHECK(folder.names().empty());
}

TEST_CASE("share and its examples refuse bad input with one line", "[cli]") {
    const Folder folder;
    const Outcome missing = run_program({"share", "--display", "cube8-595", "--socket", folder.path("a/b")});
    CHECK(missing.status == 2);
    CHECK_THAT(missing.err, Catch::Contains("--socket") && Catch::Contains("name a folder that is there"));
    CHECK(run_program({"share", "--display", "cube8-595"}).status == 2);
    CHECK(run_program({"share", "--display", "cube8-595", "--socket", "x", "--frames", "-1"}).status == 2);
    const std::string nobody = folder.path("nobody");
    const Outcome spin = shell(kSpin + " " + nobody);
    CHECK(spin.status == 2);
    CHECK(spin.out == "spin: " + nobody + ": No such file or directory (xorvox share must be running there)\n");
    if (!has_python()) XORVOX_SKIP("no python3 of version 3.9 or later");
    const Outcome wave = shell(kWave + " " + nobody);
    CHECK(wave.status == 1);
    CHECK_THAT(wave.out, Catch::Contains("No such file") && !Catch::Contains("Traceback"));
    Background server({"share", "--display", "cube8-595", "--socket", folder.path("socket"), "--json"});
    server.line();
    const Outcome second = run_program({"share", "--display", "cube8-595", "--socket", folder.path("socket")});
    CHECK(second.status == 2);
    CHECK_THAT(second.err, Catch::Contains("a program listens there already"));
}
