// Runs the xorvox program as a person would, and what to look at afterwards.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace xorvox::test {

/// What a program said and how it ended.
struct Outcome {
    int status = -1;  ///< Exit status; 128 + signal when killed.
    std::string out;
    std::string err;
};

/// Runs the program to its end. Standard input is empty. `memory_limit_bytes`: what its address space may grow to; 0 is
/// no limit.
Outcome run_program(const std::vector<std::string>& arguments, std::uint64_t memory_limit_bytes = 0);

/// The number behind "key": in a JSON text; the test fails if there is none.
double number(const std::string& json, const std::string& key);

/// run_program(); the test fails unless it ends with status 0 and nothing on standard error.
Outcome succeeds(const std::vector<std::string>& arguments);

/// A program that runs beside the test; killed and reaped at the end.
class Background {
public:
    explicit Background(const std::vector<std::string>& arguments);
    ~Background();
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    /// The next line of its standard output, or nothing when it has ended.
    std::optional<std::string> line();
    pid_t pid() const { return pid_; }
    /// Sends SIGTERM and gives the exit status.
    int terminate();

private:
    pid_t pid_ = -1;
    int out_ = -1;
    std::string buffer_;
};

/// A new empty folder, deleted at the end.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string path(const std::string& name) const { return (root_ / name).string(); }
    /// Writes a file and gives its path.
    std::string file(const std::string& name, const std::string& bytes) const;
    /// Names of everything in the folder, sorted.
    std::vector<std::string> names() const;

private:
    std::filesystem::path root_;
};

std::string read_file(const std::string& path);

/// A display file of a rotor that is small enough to be simulated in an instant; more tables may follow it.
inline const std::string kSmallRotor = R"(
name = "small-rotor"
kind = "rotating-panel"
format = "rgb332"
slices = 60
cycles_per_second = 50

[[panel]]
columns = 33
rows = 16
column_pitch_mm = 2
row_pitch_mm = 2
)";

/// A cube from (0,0,0) to (side,side,side) as OBJ, its sixth face left out on request.
std::string cube_obj(double side, bool open = false);

}  // namespace xorvox::test
