#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/display/names.h"
#include "driver/display/toml.h"
#include "tools/commands.h"
#include "tools/console.h"

namespace xorvox::tools {
namespace {

/// What is wrong with a file.
struct Problem {
    std::size_t line;     ///< 0: the file as a whole.
    std::string message;  ///< Without the line.
    std::string text;     ///< The whole message, as "FILE: line 7: …".
};

/// One file, and what is wrong with it.
struct Verdict {
    std::string file;
    std::string display;  ///< What it is, in words; empty if there are problems.
    std::vector<Problem> problems;
    bool complete = false;  ///< Whether it was looked at what contradicts itself, which is last.
};

std::string in_words(const DisplayFile& display) {
    return fmt::format("\"{}\", {}: {} slice{} of {}, {} bytes a frame, {} frames a second", display.name.view(),
                       display::kind_name(display.kind), display.slices, display.slices == 1 ? "" : "s",
                       to_string(display.format), thousands(frame_bytes(display)), display.cycles_per_second);
}

Verdict judge(const std::string& file) {
    Verdict verdict{file, {}, {}, false};
    const auto source = find_display(file);
    if (!source) {
        verdict.problems.push_back({0, source.error().message, source.error().message});
        return verdict;
    }
    auto mistakes = find_mistakes(source->text);
    verdict.complete = mistakes.empty() || mistakes.front().contradiction;
    for (DisplayMistake& mistake : mistakes) {
        std::string text = fmt::format("{}: line {}: {}", file, mistake.line, mistake.message);
        verdict.problems.push_back({mistake.line, std::move(mistake.message), std::move(text)});
    }
    if (!verdict.problems.empty()) return verdict;
    if (const auto display = parse_display(source->text, file)) verdict.display = in_words(*display);
    return verdict;
}

void print_json(const std::vector<Verdict>& verdicts) {
    std::string all;
    for (const Verdict& verdict : verdicts) {
        std::string mistakes;
        for (const Problem& problem : verdict.problems) {
            mistakes +=
                fmt::format("{}{{\"line\": {}, \"message\": {}}}", mistakes.empty() ? "" : ", ",
                            problem.line == 0 ? "null" : fmt::format("{}", problem.line), json_string(problem.message));
        }
        all +=
            fmt::format("{}\n  {{\"file\": {}, \"valid\": {}, \"display\": {}, \"complete\": {}, \"mistakes\": [{}]}}",
                        all.empty() ? "" : ",", json_string(verdict.file), verdict.problems.empty(),
                        json_string(verdict.display), verdict.complete, mistakes);
    }
    fmt::print("[{}\n]\n", all);
}

}  // namespace

Expected<void> validate(const ValidateOptions& options) {
    std::vector<Verdict> verdicts;
    for (const std::string& file : options.files) verdicts.push_back(judge(file));
    if (options.json) print_json(verdicts);

    std::vector<std::string> problems;
    for (const Verdict& verdict : verdicts) {
        if (verdict.problems.empty() && !options.json) fmt::print("{}: fine: {}\n", verdict.file, verdict.display);
        for (const Problem& problem : verdict.problems) problems.push_back(problem.text);
        const bool was_read = !verdict.problems.empty() && verdict.problems.front().line > 0;
        if (!was_read || verdict.complete) continue;
        problems.push_back(verdict.file +
                           ": further mistakes may show once these are mended: what contradicts itself is"
                           " looked for last");
    }
    if (problems.empty()) return {};
    // The last one is the command's Error, which the program prints in the same way.
    for (std::size_t i = 0; i + 1 < problems.size(); ++i) complain(problems[i]);
    return fail(std::move(problems.back()));
}

}  // namespace xorvox::tools
