// record, replay and diff, and --record of the commands that send.
#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "driver/wire/crc32c.h"
#include "driver/wire/packet.h"
#include "sim/recording/format.h"
#include "sim/recording/reader.h"
#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const std::string kRoot = XORVOX_SOURCE_DIR "/";
const std::string kDuck = kRoot + "examples/duck.ply";

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

/// Records the duck on the small cube.
std::string record(const Folder& folder, const std::string& name, const std::vector<std::string>& more = {}) {
    std::string path = folder.path(name);
    succeeds(with({"record", kDuck, "--display", "cube16-ws2812", "-o", path}, more));
    return path;
}

void refused(const std::vector<std::string>& arguments, const std::string& message) {
    const Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    CHECK_THAT(outcome.err, Catch::Contains(message));
}

/// The golden recordings and the arguments that record them.
struct Golden {
    std::string name;
    std::vector<std::string> arguments;
};
std::vector<Golden> golden() {
    std::vector<Golden> all;
    std::istringstream lines(read_file(kRoot + "tests/golden/recordings/commands.txt"));
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line.front() == '#') continue;
        std::istringstream words(line);
        Golden& one = all.emplace_back();
        words >> one.name;
        for (std::string word; words >> word;) {
            const bool is_path = word.starts_with("examples/") || word.starts_with("tests/");
            one.arguments.push_back(is_path ? kRoot + word : word);
        }
    }
    return all;
}

/// A block, to be changed by a test, or left out (`kept` false).
struct AnyBlock {
    sim::BlockHeader header;
    std::vector<std::byte> payload;
    bool kept = true;

    bool is(wire::PacketType type) const {
        wire::Header packet;
        std::span<const std::byte> content;
        return header.kind == sim::BlockKind::FromHost && wire::decode_packet(payload, packet, content) == Status::Ok &&
               packet.type == type;
    }
};

/// The recording at `path` with its blocks as `change` leaves them; CRCs and the index's place are right again.
std::string rewrite(const std::string& path, const std::function<void(std::vector<AnyBlock>&)>& change) {
    const std::string old = read_file(path);
    auto reader = sim::RecordingReader::open(
        sim::memory_source({std::as_bytes(std::span(old)).begin(), std::as_bytes(std::span(old)).end()}, path));
    REQUIRE(reader);
    std::vector<AnyBlock> blocks;
    reader->seek(sim::kRecordingHeadBytes);
    for (sim::Block block; reader->next(block) == Status::Ok;) {
        blocks.push_back({{block.kind, 0, block.time_ns}, {block.payload.begin(), block.payload.end()}});
    }
    change(blocks);
    std::string text = old.substr(0, sim::kRecordingHeadBytes);
    const auto append = [&text](std::span<const std::byte> bytes) {
        text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    std::uint64_t index_at = 0;
    for (AnyBlock& block : blocks) {
        if (!block.kept) continue;
        if (block.header.kind == sim::BlockKind::Index) index_at = text.size();
        if (block.header.kind == sim::BlockKind::End) {
            const auto place = sim::encode_u64(index_at);
            block.payload.assign(place.begin(), place.end());
        }
        block.header.length = static_cast<std::uint32_t>(block.payload.size());
        append(sim::encode(block.header));
        append(block.payload);
        append(sim::encode_u32(wire::crc32c(block.payload)));
    }
    return text;
}

}  // namespace

TEST_CASE("the driver sends what is in the golden recordings, bit for bit", "[cli]") {
    const Folder folder;
    REQUIRE(golden().size() == 3);
    for (const Golden& one : golden()) {
        const std::string today = folder.path(one.name);
        succeeds(with(with({"record"}, one.arguments), {"-o", today}));
        const Outcome outcome = run_program({"diff", kRoot + "tests/golden/recordings/" + one.name, today});
        INFO(
            "If that is meant, look at the new ones, and commit them with the reason:\n"
            "    tests/golden/recordings/record.sh build/dev/bin/xorvox\n"
            << outcome.out << outcome.err);
        CHECK(outcome.status == 0);
    }
}

TEST_CASE("one frame is recorded unless told, and equal input gives equal bytes", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr");
    CHECK(read_file(a) == read_file(record(folder, "b.xvr")));
    CHECK(number(succeeds({"replay", a, "--json"}).out, "frames") == 1);
    const std::string three = record(folder, "three.xvr", {"--spin", "60", "--frames", "3"});
    CHECK(number(succeeds({"replay", three, "--json"}).out, "frames") == 3);
    CHECK(read_file(three) == read_file(record(folder, "again.xvr", {"--spin", "60", "--frames", "3"})));
    CHECK(folder.names() == std::vector<std::string>{"a.xvr", "again.xvr", "b.xvr", "three.xvr"});
}

TEST_CASE("what is replayed is lit as what is shown", "[cli]") {
    const Folder folder;
    const std::string shown = succeeds({"show", kDuck, "--display", "cube16-ws2812", "--json"}).out;
    const std::string replayed =
        succeeds({"replay", record(folder, "a.xvr"), "--json", "--png", folder.path("a.png")}).out;
    for (const char* key : {"pixels_lit", "voxels_lit", "light_outside", "brightness_ratio"}) {
        CHECK(number(replayed, key) == number(shown, key));
    }
    CHECK(read_file(folder.path("a.png")).starts_with("\x89PNG"));
}

TEST_CASE("a recording is replayed at any speed, from any moment, and recorded again", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr", {"--spin", "60", "--frames", "6"});
    CHECK(number(succeeds({"replay", a, "--json"}).out, "frames_presented") == 6);
    CHECK(number(succeeds({"replay", a, "--speed", "max", "--json"}).out, "frames_presented") == 6);
    const std::string half = succeeds({"replay", a, "--speed", "0.5", "--json"}).out;
    CHECK(number(half, "frames_presented") >= 9);  // Each for two cycles, the first perhaps for more.
    CHECK(number(half, "frames_presented") <= 14);
    CHECK(number(half, "pixels_lit") > 100);
    const std::string twice = succeeds({"replay", a, "--speed", "2", "--json"}).out;
    CHECK(number(twice, "frames_presented") < 6);
    CHECK(number(twice, "pixels_lit") == number(half, "pixels_lit"));
    const std::string late = succeeds({"replay", a, "--seek", "0.04", "--json"}).out;
    CHECK(number(late, "frames_presented") < 6);
    CHECK(number(late, "frames_presented") > 0);
    succeeds({"replay", a, "--record", folder.path("b.xvr")});
    CHECK(run_program({"diff", a, folder.path("b.xvr")}).status == 0);
    succeeds({"replay", a, "--to", "file:" + folder.path("packets"), "--record", folder.path("c.xvr")});
    CHECK(read_file(folder.path("packets")).starts_with("XORVOX\x01\n"));
    refused({"replay", a, "--seek", "100"}, "s long");
    refused({"replay", a, "--seek", "-1"}, "--seek: '-1' is not a number, 0 or above");
    refused({"replay", a, "--speed", "fast"}, "--speed: 'fast' is not a number, 0 or above");
}

TEST_CASE("diff says what differs, by its exit status and in words", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr", {"--color", "constant:red"});
    const std::string b = record(folder, "b.xvr", {"--color", "constant:blue"});
    CHECK(succeeds({"diff", a, a}).out == "equal: 1 frame\n");
    const Outcome differ = run_program({"diff", a, b});
    CHECK(differ.status == 1);
    CHECK(differ.err.empty());
    CHECK_THAT(differ.out, Catch::StartsWith("different: frame 0, slice "));
    CHECK_THAT(differ.out,
               Catch::Contains("code 0x0000ff (#ff0000) in " + a) && Catch::Contains("0xff0000 (#0000ff) in " + b));
    const Outcome json = run_program({"diff", a, b, "--json"});
    CHECK(json.status == 1);
    CHECK(number(json.out, "code_a") == 0x0000ff);
    CHECK(number(json.out, "frame") == 0);
    refused({"diff", a, folder.path("none.xvr")}, "none.xvr: cannot be opened");
    const std::string bytes = read_file(a);
    refused({"diff", a, folder.file("cut.xvr", bytes.substr(0, bytes.size() - 5))}, "byte ");
}

TEST_CASE("a damaged recording is refused by the byte, and what is whole of it is played on request", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr", {"--spin", "60", "--frames", "3"});
    const std::string bytes = read_file(a);
    const std::string cut = folder.file("cut.xvr", bytes.substr(0, bytes.size() - 200));
    refused({"replay", cut}, "cut.xvr: byte " + std::to_string(bytes.size() - 200) + ": the recording ends here");
    const Outcome outcome = run_program({"replay", cut, "--keep-going", "--json"});
    CHECK(outcome.status == 0);
    CHECK(number(outcome.out, "frames_presented") == 3);
    CHECK_THAT(outcome.err, Catch::StartsWith("xorvox: warning: "));

    std::string damaged = bytes;
    damaged[bytes.size() / 2] ^= 0x10;
    const std::string bad = folder.file("bad.xvr", damaged);
    refused({"replay", bad}, "bad.xvr: byte ");
    CHECK(run_program({"replay", bad, "--keep-going"}).status == 0);

    refused({"replay", folder.file("text", "no recording at all")}, "not the mark of a recording");
    refused({"replay", folder.path("")}, "no regular file");
    succeeds({"show", kDuck, "--display", "cube16-ws2812", "--to", "file:" + folder.path("packets")});
    refused({"replay", folder.path("packets")}, "is a stream of packets, as --to file: writes them");
    CHECK(run_program({"replay", folder.file("empty.xvr", "")}).status == 2);
}

TEST_CASE("a recording whose description is damaged is played for a display that is named", "[cli]") {
    const Folder folder;
    std::string bytes = read_file(record(folder, "a.xvr"));
    bytes[100] ^= 1;
    const std::string bad = folder.file("bad.xvr", bytes);
    refused({"replay", bad}, "byte 16: the description of the display is damaged");
    CHECK(run_program({"replay", bad, "--keep-going"}).status == 2);
    const Outcome played = run_program({"replay", bad, "--keep-going", "--display", "cube16-ws2812", "--json"});
    CHECK(played.status == 0);
    CHECK(number(played.out, "frames_presented") == 1);
}

TEST_CASE("a recording is not played for a display of another geometry", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr");
    succeeds({"replay", a, "--display", "cube16-ws2812"});
    refused({"replay", a, "--display", "cube20-ws2812"}, "was recorded for cube16-ws2812, and --display cube20-ws2812");
    Background display({"sim", "--display", "cube20-ws2812", "--listen", "tcp:0", "--json"});
    const std::string listening = *display.line();
    const std::size_t at = listening.find("tcp:");
    refused({"replay", a, "--to", listening.substr(at, listening.find('"', at) - at)}, "cube20-ws2812");
}

TEST_CASE("a recording cannot overwrite the one that is replayed, nor one be made where none can", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr");
    refused({"replay", a, "--record", a}, "is the input itself");
    refused({"record", kDuck, "--display", "cube16-ws2812", "-o", folder.path("no/such.xvr")}, "cannot be created");
    refused({"record", kDuck, "--display", "cube16-ws2812", "-o", folder.path("b.xvr"), "--frames", "0"}, "1 or more");
    refused({"record", kDuck, "--display", "cube16-ws2812"}, "--output is required");
    CHECK(folder.names() == std::vector<std::string>{"a.xvr"});
}

TEST_CASE("what a program sends to a simulated display is recorded there and can be replayed to another", "[cli]") {
    const Folder folder;
    const std::string seen = folder.path("seen.xvr");
    const auto address_of = [](Background& display) {
        const std::string line = *display.line();
        const std::size_t at = line.find("tcp:");
        return line.substr(at, line.find('"', at) - at);
    };
    {
        Background display({"sim", "--display", "cube16-ws2812", "--listen", "tcp:0", "--json", "--record", seen});
        const std::string address = address_of(display);
        succeeds({"show", kDuck, "--display", "cube16-ws2812", "--to", address, "--record", folder.path("sent.xvr")});
        CHECK(display.terminate() == 0);
    }
    CHECK(run_program({"diff", folder.path("sent.xvr"), seen}).status == 0);
    CHECK(number(succeeds({"replay", seen, "--json"}).out, "pixels_lit") > 100);
    Background display({"sim", "--display", "cube16-ws2812", "--listen", "tcp:0", "--json"});
    const std::string sent = succeeds({"replay", seen, "--speed", "max", "--to", address_of(display), "--json"}).out;
    CHECK(number(sent, "frames_presented") >= 1);
}

TEST_CASE("a recorder that is killed leaves nothing under the name, and beside it what was whole", "[cli]") {
    const Folder folder;
    const std::string seen = folder.path("seen.xvr");
    Background display({"sim", "--display", "cube16-ws2812", "--listen", "tcp:0", "--json", "--record", seen});
    const std::string listening = *display.line();
    const std::size_t at = listening.find("tcp:");
    succeeds({"show", kDuck, "--display", "cube16-ws2812", "--to", listening.substr(at, listening.find('"', at) - at)});
    REQUIRE(kill(display.pid(), SIGKILL) == 0);
    while (display.line()) {
    }
    REQUIRE(folder.names().size() == 1);
    const std::string left = folder.names()[0];
    CHECK_THAT(left, Catch::StartsWith(".xorvox-") && Catch::EndsWith(".tmp"));
    refused({"replay", folder.path(left)}, "its program was killed");
    const Outcome played =
        run_program({"replay", folder.path(left), "--keep-going", "--json", "--record", folder.path("whole.xvr")});
    CHECK(played.status == 0);
    CHECK(number(played.out, "frames_presented") >= 1);
    CHECK(number(played.out, "pixels_lit") > 100);
    succeeds({"replay", folder.path("whole.xvr")});
}

TEST_CASE("a program in Python that was written from docs/recordings.md reads what is recorded", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr", {"--spin", "60", "--frames", "3"});
    const std::string list = folder.path("list");
    const std::string command = "python3 " + kRoot + "examples/list_recording.py '" + a + "' > '" + list + "' 2>&1";
    if (std::system("python3 --version > /dev/null 2>&1") != 0) XORVOX_SKIP("there is no python3");
    CHECK(std::system(command.c_str()) == 0);
    CHECK_THAT(read_file(list), Catch::Contains("frame 2: "));
}

TEST_CASE("what diff calls damaged is not played, and with --keep-going is told", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr", {"--spin", "60", "--frames", "3"});
    const auto last = [](std::vector<AnyBlock>& blocks, const auto& is) {
        return std::find_if(blocks.rbegin(), blocks.rend(), is);
    };
    struct Case {
        std::string what;
        std::function<void(std::vector<AnyBlock>&)> change;
        double shown;
    };
    const std::vector<Case> cases{
        {"the digest of the frame before is not",
         [&](auto& blocks) {
             last(blocks, [](const AnyBlock& b) { return b.header.kind == sim::BlockKind::Frame; })->payload[24] ^=
                 std::byte{1};
         },
         3},
        {"the frame that ends here is not whole",
         [&](auto& blocks) {
             last(blocks, [](const AnyBlock& b) { return b.is(wire::PacketType::FrameEnd); })->kept = false;
         },
         2},
        {"the frame before is not in the index",
         [&](auto& blocks) {
             last(blocks, [](const AnyBlock& b) { return b.header.kind == sim::BlockKind::Index; })->payload.clear();
         },
         3},
        {"time goes back here",
         [&](auto& blocks) {
             last(blocks, [](const AnyBlock& b) {
                 return b.header.kind == sim::BlockKind::FromDevice;
             })->header.time_ns = 1;
         },
         3},
    };
    for (const Case& one : cases) {
        CAPTURE(one.what);
        const std::string bad = folder.file("bad.xvr", rewrite(a, one.change));
        refused({"replay", bad}, one.what);
        refused({"replay", bad, "--to", "file:" + folder.path("packets")}, one.what);
        refused({"diff", bad, bad}, one.what);
        const Outcome played = run_program({"replay", bad, "--keep-going", "--json"});
        CHECK(played.status == 0);
        CHECK(number(played.out, "frames_presented") == one.shown);
        CHECK_THAT(played.err, Catch::StartsWith("xorvox: warning: ") && !Catch::Contains("--keep-going"));
        CHECK(played.err.find('\n') == played.err.size() - 1);
    }
}

TEST_CASE("frames whose session's request is damaged are played all the same", "[cli]") {
    const Folder folder;
    std::string bytes = read_file(record(folder, "a.xvr", {"--spin", "60", "--frames", "3"}));
    bytes[bytes.find("\xb7R>") + sim::kBlockHeaderBytes + 2] ^= 1;
    const std::string bad = folder.file("bad.xvr", bytes);
    refused({"replay", bad}, "the contents of this block are damaged");
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--speed", "2"}, {"--seek", "0.01"}}) {
        const Outcome played = run_program(with({"replay", bad, "--keep-going", "--json"}, more));
        CAPTURE(more, played.err);
        CHECK(played.status == 0);
        CHECK(number(played.out, "frames_presented") >= 1);
        if (more.empty()) CHECK(number(played.out, "frames_presented") == 3);
        CHECK(played.err.find('\n') == played.err.size() - 1);
    }
}

TEST_CASE("of a recording of which nothing is whole, nothing is played with exit status 0", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr");
    const std::string bad = folder.file("bad.xvr", rewrite(a, [](auto& blocks) {
                                            for (AnyBlock& b : blocks) b.kept = !b.is(wire::PacketType::FrameEnd);
                                        }));
    const Outcome outcome = run_program({"replay", bad, "--keep-going"});
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Catch::Contains("nothing of it could be shown"));
}

TEST_CASE("a recording of more than a day is not played, whatever its times are", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr", {"--frames", "2"});
    for (const std::uint64_t late_ns : {std::uint64_t{300'000'000} << 30, std::uint64_t{1} << 63, ~std::uint64_t{0}}) {
        for (const bool all : {true, false}) {
            const std::string bad = folder.file("bad.xvr", rewrite(a, [&](auto& blocks) {
                                                    for (AnyBlock& b : blocks) {
                                                        const bool later =
                                                            all ? b.header.kind != sim::BlockKind::Display
                                                                : b.header.kind == sim::BlockKind::End;
                                                        if (later) b.header.time_ns = late_ns;
                                                    }
                                                }));
            CHECK(run_program({"replay", bad}).status == 2);
            const Outcome outcome = run_program({"replay", bad, "--keep-going"});
            CHECK(outcome.status == 2);
            CHECK_THAT(outcome.err, Catch::Contains("more than a day"));
        }
    }
}

TEST_CASE("a recording without its description is played for no display of another geometry", "[cli]") {
    const Folder folder;
    std::string bytes = read_file(record(folder, "a.xvr"));
    bytes[100] ^= 1;
    const Outcome outcome =
        run_program({"replay", folder.file("bad.xvr", bytes), "--keep-going", "--display", "cube20-ws2812"});
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Catch::Contains("of another display than --display cube20-ws2812"));
}

TEST_CASE("as many frames are sent as were recorded, and half of them at twice the speed", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr", {"--spin", "60", "--frames", "20"});
    const std::string file = "file:" + folder.path("packets");
    CHECK(number(run_program({"replay", a, "--to", file, "--json"}).out, "frames_sent") == 20);
    CHECK(number(run_program({"replay", a, "--to", file, "--json", "--speed", "2"}).out, "frames_sent") == 10);
    CHECK(number(run_program({"replay", a, "--to", file, "--json", "--speed", "max"}).out, "frames_sent") == 20);
}

TEST_CASE("a recording has a keyframe each second", "[cli]") {
    const Folder folder;
    const auto reader = sim::open_recording(record(folder, "a.xvr", {"--spin", "60", "--frames", "130"}));
    REQUIRE(reader);
    std::uint64_t key_ns = 0;
    std::size_t deltas = 0;
    for (const sim::FrameEntry& frame : reader->frames()) {
        if (frame.keyframe) key_ns = frame.time_ns;
        deltas += !frame.keyframe;
        CHECK(frame.time_ns - key_ns < 1'050'000'000);
    }
    CHECK(deltas > 100);
}

TEST_CASE("what was sent until the display's plug was pulled is kept as a recording", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr", {"--spin", "60", "--frames", "200"});
    const std::string kept = folder.path("kept.xvr");
    Background display({"sim", "--display", "cube16-ws2812", "--listen", "tcp:0", "--json"});
    const std::string listening = *display.line();
    const std::size_t at = listening.find("tcp:");
    Background player({"replay", a, "--to", listening.substr(at, listening.find('"', at) - at), "--record", kept});
    // The display tells what it shows.
    for (auto line = display.line(); line && line->find("\"shown\"") == std::string::npos;) line = display.line();
    REQUIRE(kill(display.pid(), SIGKILL) == 0);
    std::string said;
    while (const auto line = player.line()) said += *line + "\n";
    CHECK_THAT(said, Catch::Contains("recorded: "));
    CHECK(player.terminate() == 2);
    CHECK(number(succeeds({"replay", kept, "--json"}).out, "frames") >= 1);
}

TEST_CASE("a display that is replayed to is not left alone while it is looked at", "[cli]") {
    const Folder folder;
    const std::string seen = succeeds({"replay", record(folder, "a.xvr"), "--exposure", "5", "--json"}).out;
    CHECK(number(seen, "silent_host") == 0);
    CHECK(number(seen, "fault") == 0);
}

TEST_CASE("what is wrong with a recording is told once, where it begins", "[cli]") {
    const Folder folder;
    const std::string a = record(folder, "a.xvr", {"--spin", "60", "--frames", "29"});
    const std::string bytes = read_file(a);
    const Outcome cut =
        run_program({"replay", folder.file("cut.xvr", bytes.substr(0, bytes.size() / 2)), "--keep-going"});
    CHECK(cut.status == 0);
    CHECK(cut.err.find('\n') == cut.err.size() - 1);
    CHECK_THAT(cut.err, Catch::Contains("is cut off") && !Catch::Contains("--keep-going"));
    refused({"replay", folder.file("more.xvr", bytes + "12345")},
            "byte " + std::to_string(bytes.size()) + ": 5 bytes more behind the end of the recording");
    refused({"replay", a, "--seek", "0.9"}, "a.xvr is 0.483 s long");
    CHECK_THAT(succeeds({"replay", record(folder, "one.xvr")}).out, Catch::Contains("shown: 1 frame,"));
    refused({"record", kDuck, "--display", "cube16-ws2812", "-o", folder.path("x.ply")}, "does not end in .xvr");
    const std::string said = folder.path("said");
    const std::string list = "python3 " + kRoot + "examples/list_recording.py '" + folder.path("none.xvr") + "'";
    if (std::system("python3 --version > /dev/null 2>&1") != 0) XORVOX_SKIP("there is no python3");
    CHECK(std::system((list + " > '" + said + "' 2>&1").c_str()) != 0);
    CHECK(read_file(said) == folder.path("none.xvr") + ": No such file or directory\n");
}
