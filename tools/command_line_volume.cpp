// The options of volumes, and the command convert.
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "driver/host/color.h"
#include "tools/command_line.h"

namespace xorvox::tools {

void add_volume(CLI::App& app, VolumeOptions& volume) {
    app.add_option_function<std::string>(
           "--threshold",
           [&volume](const std::string& text) {
               const std::vector<double> numbers = parse_numbers(text);
               if (numbers.size() != 1 || !std::isfinite(numbers[0])) {
                   throw CLI::ValidationError("--threshold", fmt::format("'{}' is not a number", text));
               }
               volume.threshold = numbers[0];
           },
           "Of a volume of values: inside is what is at least so much (default: found by Otsu's method)")
        ->type_name("VALUE");
    app.add_option_function<std::string>(
           "--volume",
           [&volume](const std::string& text) {
               volume.frame = parse_count("--volume", text, std::numeric_limits<std::uint32_t>::max());
           },
           "Only this one of a sequence of volumes, counted from 0")
        ->type_name("N");
}

void add_transfer(CLI::App& app, VolumeOptions& volume) {
    app.add_option_function<std::string>(
           "--transfer",
           [&volume](const std::string& text) {
               auto transfer = TransferFunction::parse(text, host::parse_color_name);
               if (!transfer) throw CLI::ValidationError("--transfer", transfer.error().message);
               volume.transfer = std::move(*transfer);
           },
           "Of a volume of values: their colours, mixed in between; a third part of a stop is its opacity, 0 to "
           "1 (default: blue to gold from the threshold to the most value)")
        ->type_name("VALUE:COLOR,…");
}

Command convert_command(CLI::App& program, ConvertOptions& options) {
    CLI::App& app = *program.add_subcommand("convert", "Turn a volume of another program into a volume of bits");
    app.add_option("input", options.input,
                   "The volume: .binvox, .nrrd, .nhdr, .vox, .nii, .nii.gz, or a .png of a numbered row or a folder of "
                   "such")
        ->required()
        ->type_name("IN");
    app.add_option("output", options.output, "The bits: .nrrd, .binvox, .nii, .nii.gz, .vox, .bits, or a stack of .png")
        ->required()
        ->type_name("OUT");
    add_volume(app, options.volume);
    app.add_flag("--gzip", options.gzip, "Pack a .nrrd file");
    app.add_flag("--json", options.json, "One JSON object on standard output");
    examples(app,
             "  xorvox convert scan.nii.gz scan.binvox --threshold 300\n"
             "  xorvox convert castle.vox castle.nrrd --gzip\n"
             "  xorvox convert slices/slice000.png slices.nrrd");
    return {&app, [&options] { return convert(options); }};
}

}  // namespace xorvox::tools
