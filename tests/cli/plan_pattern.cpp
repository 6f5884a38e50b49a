// plan and pattern, as a person would run them.
#include <cctype>
#include <string>
#include <vector>

#include "driver/display/toml.h"
#include "driver/host/pattern.h"
#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

void refused(const std::vector<std::string>& arguments, const std::vector<std::string>& fragments) {
    const Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    for (const std::string& fragment : fragments) CHECK_THAT(outcome.err, Catch::Contains(fragment));
}

/// Reads one JSON value; `at` is then behind it, or npos where it is not well formed.
class JsonReader {
public:
    explicit JsonReader(const std::string& text) : text_(text) {}

    bool is_one_value() {
        value();
        space();
        return good_ && at_ == text_.size();
    }

private:
    char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    void space() {
        while (std::isspace(static_cast<unsigned char>(next())) != 0) ++at_;
    }
    bool take(char c) {
        space();
        if (next() != c) return false;
        ++at_;
        return true;
    }
    void expect(char c) { good_ = take(c) && good_; }
    void value() {
        space();
        if (next() == '{' || next() == '[') return members(next() == '{');
        if (next() == '"') return string();
        const std::size_t start = at_;
        while (std::isalnum(static_cast<unsigned char>(next())) != 0 || next() == '-' || next() == '+' || next() == '.')
            ++at_;
        const std::string word = text_.substr(start, at_ - start);
        const bool is_word = word == "true" || word == "false" || word == "null";
        good_ = good_ && (is_word || (!word.empty() && word.find_first_not_of("0123456789+-.eE") == word.npos));
    }
    void members(bool named) {
        const char end = named ? '}' : ']';
        ++at_;
        if (take(end)) return;
        do {
            if (named) {
                space();
                string();
                expect(':');
            }
            value();
        } while (good_ && take(','));
        expect(end);
    }
    void string() {
        expect('"');
        while (good_ && next() != '"') {
            if (next() == '\0') good_ = false;
            at_ += next() == '\\' ? std::size_t{2} : std::size_t{1};
        }
        ++at_;
    }

    const std::string& text_;
    std::size_t at_ = 0;
    bool good_ = true;
};

bool is_json(const std::string& text) {
    return JsonReader(text).is_one_value();
}

}  // namespace

TEST_CASE("plan answers for every preset over every link, fit or not", "[cli]") {
    for (const Preset& preset : presets()) {
        const std::string name(preset.name);
        const std::string text = succeeds({"plan", name}).out;
        CHECK(text.starts_with(name + " over usb-hs: "));
        CHECK_THAT(text, Catch::Contains("\nframe\n") && Catch::Contains("\nlink: ") &&
                             Catch::Contains("\nscan-out\n") && Catch::Contains("\ncurrent\n") &&
                             Catch::Contains("\nmemory of the device half\n"));
    }
    for (const std::string link : {"usb-hs", "usb-fs", "hid-hs", "hid-fs", "tcp"}) {
        const std::string json = succeeds({"plan", "candle", "--link", link, "--json"}).out;
        CHECK(is_json(json));
        CHECK_THAT(json, Catch::Contains("\"name\": \"" + link + "\"") && Catch::Contains("\"samples\": 1920"));
    }
    CHECK_THAT(succeeds({"plan", "vortex", "--link", "hid-fs"}).out, Catch::StartsWith("vortex over hid-fs: no"));
    CHECK_THAT(succeeds({"plan", "cube8-595", "--link", "hid-fs"}).out,
               Catch::StartsWith("cube8-595 over hid-fs: yes"));
    CHECK_THAT(succeeds({"plan", "candle", "--link", "gpio", "--gpio-rate", "2e6", "--json"}).out,
               Catch::Contains("\"bytes_per_second\": 2e+06"));
}

TEST_CASE("plan says what a link that is too slow would carry", "[cli]") {
    const std::string text = succeeds({"plan", "vortex", "--link", "hid-fs"}).out;
    CHECK_THAT(text, Catch::Contains("would work") && Catch::Contains(" frames a second in rgb332") &&
                         Catch::Contains(" in mono1, with compression") && Catch::Contains("over usb-hs"));
    const std::string json = succeeds({"plan", "vortex", "--link", "hid-fs", "--json"}).out;
    CHECK(is_json(json));
    CHECK_THAT(json, Catch::Contains("\"would_work\": [{\"format\": \"rgb332\""));
    // As many slices as in the text: the display has no more.
    CHECK_THAT(succeeds({"plan", "vortex", "--json"}).out,
               Catch::Contains("\"slices_compressed\": 360") && Catch::Contains("\"would_work\": []"));
}

TEST_CASE("plan refuses what it cannot answer", "[cli]") {
    refused({"plan", "nope"}, {"nope", "vortex"});
    refused({"plan"}, {"display"});
    refused({"plan", "candle", "--link", "usb3"}, {"usb3", "usb-hs", "usb-fs", "hid-hs", "hid-fs", "tcp", "gpio"});
    refused({"plan", "candle", "--link", "gpio"}, {"--gpio-rate"});
    refused({"plan", "candle", "--link", "gpio", "--gpio-rate", "0"}, {"--gpio-rate"});
    refused({"plan", "candle", "--link", "gpio", "--gpio-rate", "-3"}, {"--gpio-rate"});
    for (const std::string rate : {"1e30", "1e-9"}) {
        refused({"plan", "candle", "--link", "gpio", "--gpio-rate", rate}, {"--gpio-rate", "8 lines", "1 to 1e10"});
    }
    refused({"plan", "candle", "--link", "gpio", "--gpio-rate", "fast"}, {"--gpio-rate"});
    refused({"plan", "candle", "--link", "tcp", "--gpio-rate", "1e6"}, {"--gpio-rate", "gpio"});
    refused({"plan", "candle", "vortex"}, {"vortex"});
}

TEST_CASE("pattern without a name lists the patterns, and a wrong name does, too", "[cli]") {
    const std::string list = succeeds({"pattern", "vortex"}).out;
    const std::string json = succeeds({"pattern", "vortex", "--json"}).out;
    CHECK(is_json(json));
    std::vector<std::string> names{"'panel'"};
    for (const host::PatternInfo& info : host::patterns()) {
        names.emplace_back(info.name);
        CHECK_THAT("\n" + list, Catch::Contains("\n" + names.back() + " "));
        CHECK_THAT(json, Catch::Contains("\"name\": \"" + names.back() + "\""));
    }
    refused({"pattern", "vortex", "panel"}, names);
    refused({"pattern", "nope", "panels"}, {"nope", "vortex"});
    refused({"pattern"}, {"display"});
    refused({"pattern", "vortex", "panels", "--seconds", "5"}, {"--seconds", "panels"});
    refused({"pattern", "vortex", "walk", "--seconds", "-5"}, {"--seconds"});
    refused({"pattern", "vortex", "panels", "--to", "nowhere"}, {"--to"});
    refused({"pattern", "vortex", "panels", "--hold"}, {"--hold"});
    refused({"pattern", "vortex", "panels", "--png", "out.jpg"}, {"out.jpg", "PNG"});
}

TEST_CASE("every pattern that stands still lights a simulated display of every kind", "[cli]") {
    for (const std::string display : {"candle", "cube8-595"}) {
        for (const host::PatternInfo& info : host::patterns()) {
            if (info.moves) continue;
            const std::string json = succeeds({"pattern", display, std::string(info.name), "--json"}).out;
            CAPTURE(display, info.name, json);
            CHECK(is_json(json));
            CHECK_THAT(json, Catch::Contains("\"pattern\": \"" + std::string(info.name) + "\"") &&
                                 Catch::Contains("\"light_outside\": 0"));
        }
    }
    CHECK_THAT(succeeds({"pattern", "cube8-595", "all"}).out, Catch::Contains("512 pixels"));
}

TEST_CASE("a pattern is drawn into a picture", "[cli]") {
    const Folder folder;
    succeeds({"pattern", "candle", "axis", "--view", "orthographic", "--png", folder.path("axis.png")});
    CHECK(read_file(folder.path("axis.png")).starts_with("\x89PNG"));
}

TEST_CASE("a picture of a pattern to be read at rest has one slice, and one of very many pixels is thinned out",
          "[cli]") {
    const Folder folder;
    const std::vector<std::string> picture{"--view", "orthographic", "--png", folder.path("out.png"), "--json"};
    const auto shown = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), picture.begin(), picture.end());
        return succeeds(arguments).out;
    };
    CHECK_THAT(shown({"pattern", "candle", "orientation"}), Catch::Contains("\"slices_shown\": 1,"));
    CHECK_THAT(shown({"pattern", "candle", "axis"}), Catch::Contains("\"slices_shown\": 24,"));
    CHECK_THAT(shown({"pattern", "cube8-595", "orientation"}), Catch::Contains("\"slices_shown\": 8,"));
    CHECK_THAT(succeeds({"pattern", "candle", "orientation", "--json"}).out, Catch::Contains("\"slices_shown\": 24,"));
    // 199,618,560 pixels, of which 25 slices apart fewer than 8 million stay.
    CHECK_THAT(succeeds({"pattern", "vx1", "all"}).out,
               Catch::Contains("199,618,560 pixels") && Catch::Contains("8 of the 192 slices"));
}

TEST_CASE("a pattern says where its marks are to be", "[cli]") {
    CHECK_THAT(succeeds({"pattern", "candle", "axis"}).out,
               Catch::Contains("band 0, the lowest: panel 0, right side") && Catch::Contains("mm from the axis"));
    // A quarter of the time of a sine of 80 mm.
    CHECK_THAT(succeeds({"pattern", "vx1", "index", "--json"}).out,
               Catch::Contains("slice 0, all of it, at -40.0 mm; slice 48, its border, 11.9 mm above it"));
}

TEST_CASE("patterns are recorded, and equal ones are equal files", "[cli]") {
    const Folder folder;
    for (const std::string name : {"a", "b"}) {
        succeeds({"pattern", "candle", "panels", "--to", "file:" + folder.path(name)});
    }
    CHECK_THAT(succeeds({"pattern", "candle", "panels", "--to", "file:" + folder.path("c")}).out,
               Catch::Contains("sent: ") && Catch::Contains(folder.path("c") + " is written"));
    CHECK(read_file(folder.path("a")).size() > 100);
    CHECK(read_file(folder.path("a")) == read_file(folder.path("b")));
}

TEST_CASE("a pattern that moves is shown once through, or for as long as asked", "[cli]") {
    const std::string once = succeeds({"pattern", "cube8-595", "walk", "--json"}).out;
    CHECK(is_json(once));
    CHECK_THAT(once, Catch::Contains("\"frames\": 512") && Catch::Contains("\"pixels_lit\": 1"));
    const std::string text = succeeds({"pattern", "cube8-595", "planes", "--seconds", "0.5"}).out;
    CHECK_THAT(text, Catch::StartsWith("planes on cube8-595: "));
}
