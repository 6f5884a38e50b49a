// The program: the command line into a command, its Error into one line and an exit status.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "tools/command_line.h"
#include "tools/console.h"
#include "tools/stop.h"

namespace {

using namespace xorvox;
using namespace xorvox::tools;

constexpr int kFailure = 2;

std::vector<std::string> command_names(const std::vector<Command>& commands) {
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.app->get_name());
    return names;
}

/// The option of `app` that was given more often than it takes, or null.
const CLI::Option* repeated_option(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_expected_max() == 1 && option->count() > 1) return option;
    }
    return nullptr;
}

/// CLI11's messages may run over several lines; ours never do.
std::string one_line(std::string text) {
    for (char& c : text) {
        if (c == '\n') c = ' ';
    }
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

int main_program(int argc, char** argv) {
    CLI::App program{"xorvox drives volumetric displays: meshes into voxels, voxels into light", "xorvox"};
    program.require_subcommand(1);
    program.set_version_flag("--version", "xorvox " XORVOX_VERSION);
    program.get_formatter()->column_width(32);
    examples(program,
             "  xorvox show bunny.ply --up y --display vortex --png bunny.png\n\nxorvox COMMAND --help tells more.");

    AllOptions options;
    std::vector<Command> commands = mesh_commands(program, options);
    for (Command& command : display_commands(program, options)) commands.push_back(std::move(command));
    for (Command& command : recording_commands(program, options)) commands.push_back(std::move(command));
    commands.push_back(bench_command(program, options));

    const std::vector<std::string> names = command_names(commands);
    const std::string first = argc > 1 ? argv[1] : "";
    if (!first.empty() && first != "--version" && first != "--help" && first != "-h" &&
        std::find(names.begin(), names.end(), first) == names.end()) {
        complain(fmt::format("there is no {} '{}'; there are {}; see xorvox --help",
                             first.starts_with('-') ? "option" : "command", first, fmt::join(names, ", ")));
        return kFailure;
    }
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return program.exit(error);
        std::string help = "xorvox --help";
        std::string what = one_line(error.what());
        for (const Command& command : commands) {
            if (!command.app->parsed()) continue;
            std::string name = "xorvox " + command.app->get_name();
            const CLI::App* innermost = command.app;
            for (const CLI::App* part : command.app->get_subcommands()) {
                name += ' ' + part->get_name();
                innermost = part;
            }
            help = name + " --help";
            const CLI::Option* const repeated = repeated_option(*innermost);
            if (repeated != nullptr && dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
                what = fmt::format("{} is given {} times; give it once", repeated->get_name(), repeated->count());
            }
            // CLI11 lists these from the last to the first.
            if (const auto extra = command.app->remaining(true); !extra.empty()) {
                what = fmt::format("'{}' is not known to {}", extra.front(), name);
            }
        }
        complain(fmt::format("{}; see {}", what, help));
        return kFailure;
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) continue;
        if (const Expected<void> done = command.run(); !done) {
            complain(one_line(done.error().message));
            end_if_asked_to_stop();
            return kFailure;
        }
    }
    if (std::fflush(stdout) != 0) {
        complain("standard output could not be written; files that were asked for are whole");
        return kFailure;
    }
    return options.exit_status;
}

/// Standard streams that the caller closed become ones that fail, so that no file or socket gets their numbers.
void occupy_standard_streams() {
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(fd, F_GETFD) != -1) continue;
        // The lowest free number is this one. If /dev/null is not there either, nothing is lost.
        (void)open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
}

}  // namespace

int main(int argc, char** argv) {
    occupy_standard_streams();
    std::signal(SIGXFSZ, SIG_IGN);        // a file that may not grow is an error of the write, which cleans up
    setenv("EGL_LOG_LEVEL", "fatal", 0);  // Mesa explains itself on standard error; our one line says it
    try {
        return main_program(argc, argv);
    } catch (const std::bad_alloc&) {
        complain("not enough memory for this; try a smaller mesh, grid or display");
    } catch (const std::system_error& error) {
        complain(one_line(error.what()));  // fmt, when standard output cannot be written
    } catch (const std::exception& error) {
        complain(fmt::format("internal error: {}", one_line(error.what())));
    }
    return kFailure;
}
