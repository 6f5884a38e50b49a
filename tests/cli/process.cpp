#include "tests/cli/process.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.h"

extern char** environ;

namespace xorvox::test {
namespace {

struct Spawned {
    pid_t pid = -1;
    int out = -1;
    int err = -1;
};

Spawned spawn(const std::vector<std::string>& arguments, bool capture_err) {
    std::vector<std::string> all{XORVOX_PROGRAM};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& argument : all) argv.push_back(argument.data());
    argv.push_back(nullptr);

    int out[2];
    int err[2] = {-1, -1};
    if (pipe2(out, O_CLOEXEC) != 0 || (capture_err && pipe2(err, O_CLOEXEC) != 0)) throw std::runtime_error("pipe2");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out[1], 1);
    if (capture_err) posix_spawn_file_actions_adddup2(&actions, err[1], 2);
    Spawned spawned{-1, out[0], err[0]};
    const int failed = posix_spawn(&spawned.pid, XORVOX_PROGRAM, &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]);
    if (capture_err) close(err[1]);
    if (failed != 0) throw std::runtime_error("posix_spawn " XORVOX_PROGRAM);
    return spawned;
}

void drain(int fd, std::string& into) {
    char buffer[65536];
    ssize_t n = 0;
    while ((n = read(fd, buffer, sizeof buffer)) > 0) into.append(buffer, static_cast<std::size_t>(n));
    close(fd);
}

int wait_for(pid_t pid) {
    int status = 0;
    waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

Outcome run_program(const std::vector<std::string>& arguments, std::uint64_t memory_limit_bytes) {
    rlimit usual = {};
    getrlimit(RLIMIT_AS, &usual);
    if (memory_limit_bytes != 0) {
        const rlimit tight{memory_limit_bytes, usual.rlim_max};  // inherited by the program
        setrlimit(RLIMIT_AS, &tight);
    }
    const Spawned spawned = spawn(arguments, true);
    setrlimit(RLIMIT_AS, &usual);
    Outcome outcome;
    std::thread errors([&] { drain(spawned.err, outcome.err); });
    drain(spawned.out, outcome.out);
    errors.join();
    outcome.status = wait_for(spawned.pid);
    return outcome;
}

Outcome succeeds(const std::vector<std::string>& arguments) {
    Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    REQUIRE(outcome.err.empty());
    return outcome;
}

double number(const std::string& json, const std::string& key) {
    const std::size_t at = json.find("\"" + key + "\": ");
    CAPTURE(json, key);
    REQUIRE(at != json.npos);
    return std::stod(json.substr(at + key.size() + 4));
}

Background::Background(const std::vector<std::string>& arguments) {
    const Spawned spawned = spawn(arguments, false);
    pid_ = spawned.pid;
    out_ = spawned.out;
}

Background::~Background() {
    if (pid_ > 0) {
        kill(pid_, SIGKILL);
        wait_for(pid_);
    }
    close(out_);
}

std::optional<std::string> Background::line() {
    for (;;) {
        if (const std::size_t end = buffer_.find('\n'); end != std::string::npos) {
            std::string line = buffer_.substr(0, end);
            buffer_.erase(0, end + 1);
            return line;
        }
        char bytes[4096];
        const ssize_t n = read(out_, bytes, sizeof bytes);
        if (n <= 0) return std::nullopt;
        buffer_.append(bytes, static_cast<std::size_t>(n));
    }
}

int Background::terminate() {
    const pid_t pid = std::exchange(pid_, -1);
    kill(pid, SIGTERM);
    return wait_for(pid);
}

Folder::Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "xorvox-cli-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp");
    root_ = pattern;
}

Folder::~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
}

std::string Folder::file(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
}

std::vector<std::string> Folder::names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(root_))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string read_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string cube_obj(double side, bool open) {
    std::ostringstream out;
    for (int i = 0; i < 8; ++i)
        out << "v " << (i & 1) * side << ' ' << (i >> 1 & 1) * side << ' ' << (i >> 2) * side << '\n';
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n";
    if (!open) out << "f 2 4 8 6\n";
    return out.str();
}

}  // namespace xorvox::test
