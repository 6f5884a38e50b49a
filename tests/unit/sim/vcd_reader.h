// A small reader of value change dumps, for tests: wires of one bit in one scope.
#pragma once

#include <cstdint>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace xorvox::test {

struct Vcd {
    struct Change {
        std::uint64_t time = 0;
        std::string wire;
        bool level = false;

        bool operator==(const Change&) const = default;
    };

    std::string timescale;
    std::string scope;
    std::vector<std::string> wires;       ///< In the order of their declarations.
    std::map<std::string, bool> initial;  ///< Of $dumpvars.
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
    std::vector<Change> changes;
};

/// Throws std::runtime_error for what is none, with the word where it stopped.
inline Vcd read_vcd(const std::string& text) {
    Vcd vcd;
    std::istringstream in(text);
    std::string word;
    const auto next = [&] {
        if (!(in >> word)) throw std::runtime_error("the dump ends too early");
        return word;
    };
    const auto until_end = [&] {
        std::string all;
        while (next() != "$end") all += (all.empty() ? "" : " ") + word;
        return all;
    };
    std::map<std::string, std::string> names;
    // Others put the levels of the beginning behind the first time, without $dumpvars.
    const auto is_first = [&] { return vcd.end == vcd.begin && !vcd.initial.contains(names.at(word.substr(1))); };
    while (next() != "$enddefinitions") {
        if (word == "$timescale") {
            vcd.timescale = until_end();
        } else if (word == "$scope") {
            if (next() != "module") throw std::runtime_error(word);
            vcd.scope = until_end();
        } else if (word == "$var") {
            if (next() != "wire" || next() != "1") throw std::runtime_error(word);
            const std::string code = next();
            vcd.wires.push_back(until_end());
            if (!names.emplace(code, vcd.wires.back()).second) throw std::runtime_error("twice: " + code);
        } else if (word == "$version" || word == "$upscope" || word == "$date" || word == "$comment") {
            (void)until_end();
        } else {
            throw std::runtime_error(word);
        }
    }
    (void)until_end();
    bool dumping = false;
    bool begun = false;
    while (in >> word) {
        if (word[0] == '#') {
            const std::uint64_t time = std::stoull(word.substr(1));
            if (begun && time <= vcd.end) throw std::runtime_error("time does not go on: " + word);
            if (!begun) vcd.begin = time;
            begun = true;
            vcd.end = time;
        } else if (word == "$dumpvars") {
            dumping = true;
        } else if (word == "$end" && dumping) {
            dumping = false;
        } else if (word[0] == '0' || word[0] == '1') {
            const auto name = names.find(word.substr(1));
            if (name == names.end() || !begun) throw std::runtime_error(word);
            if (dumping || is_first()) {
                vcd.initial[name->second] = word[0] == '1';
            } else {
                vcd.changes.push_back({vcd.end, name->second, word[0] == '1'});
            }
        } else {
            throw std::runtime_error(word);
        }
    }
    return vcd;
}

}  // namespace xorvox::test
