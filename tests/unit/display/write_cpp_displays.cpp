// write_cpp_displays FOLDER: every preset and every sample as a C++ header there, and all.h, which includes them all
// and lists them as kCompiled.
#include <cstdio>
#include <fstream>
#include <string>

#include "driver/display/cpp.h"
#include "driver/display/toml.h"
#include "tests/unit/display/cpp_samples.h"

using namespace xorvox;

int main(int argument_count, char** arguments) {
    if (argument_count != 2) return 2;
    const std::string folder = std::string(arguments[1]) + "/";
    std::string includes = "#pragma once\n";
    std::string names;
    int count = 0;
    const auto write = [&](const Expected<DisplayFile>& display) {
        if (!display) {
            std::fprintf(stderr, "%s\n", display.error().message.c_str());
            return false;
        }
        const std::string header = "display" + std::to_string(count++) + ".h";
        std::ofstream file(folder + header);
        file << to_cpp(*display);
        includes += "#include \"" + header + "\"\n";
        names += "    &xorvox::displays::" + cpp_name(display->name.view()) + ",\n";
        return file.good();
    };
    for (const Preset& preset : presets()) {
        if (!write(parse_display(preset.text, preset.name))) return 1;
    }
    for (const char* sample : test::kCppSamples) {
        if (!write(parse_display(sample, "sample"))) return 1;
    }
    std::ofstream all(folder + "all.h");
    all << includes << "\ninline constexpr const xorvox::DisplayDescription* kCompiled[] = {\n" << names << "};\n";
    return all.good() ? 0 : 1;
}
