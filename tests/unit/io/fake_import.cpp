// An importer that does what its file says: how import_foreign() meets a program that fails in every way.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "tools/import_sandbox.h"
#include "voxelizer/io/import_stream.h"

using namespace xorvox;

namespace {

// What a process may still do after it has given up what an importer does not need, beside the file at `path`.
std::string done_in_sandbox(const std::string& path) {
    tools::give_up_what_is_not_needed();
    const std::string other = path + ".other";
    std::string done;
    const auto attempt = [&done](const char* name, bool succeeded) {
        if (succeeded) done += std::string(done.empty() ? "" : ", ") + name;
    };
    attempt("read", ::open(path.c_str(), O_RDONLY) >= 0);
    attempt("write", ::open(path.c_str(), O_WRONLY) >= 0);
    attempt("empty", ::open(path.c_str(), O_RDONLY | O_TRUNC) >= 0);
    attempt("create", ::open(other.c_str(), O_RDONLY | O_CREAT, 0600) >= 0);
    attempt("truncate", ::truncate(path.c_str(), 0) == 0);
    attempt("chmod", ::chmod(path.c_str(), 0777) == 0);
    attempt("mkdir", ::mkdir(other.c_str(), 0700) == 0);
    attempt("link", ::link(path.c_str(), other.c_str()) == 0);
    attempt("symlink", ::symlink(path.c_str(), other.c_str()) == 0);
    attempt("rename", ::rename(path.c_str(), other.c_str()) == 0);
    attempt("unlink", ::unlink(path.c_str()) == 0);
    attempt("socket", ::socket(AF_UNIX, SOCK_STREAM, 0) >= 0);
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    attempt("fork", child > 0);
#ifdef __x86_64__
    constexpr long kX32 = 0x4000'0000;
    errno = 0;
    attempt("x32", ::syscall(kX32 + SYS_getpid) >= 0 || errno != EPERM);
#endif
    int files = 0;
    while (files < 100 && ::open("/dev/null", O_RDONLY) >= 0) ++files;
    attempt("100 files", files == 100);
    return done;
}

}  // namespace

int main(int, char** arguments) {
    std::string word;
    std::ifstream(arguments[1]) >> word;
    if (word == "hang") {
        for (;;) ::pause();
    }
    if (word == "hang-silently") {
        ::close(STDOUT_FILENO);
        for (;;) ::pause();
    }
    if (word == "crash") std::raise(SIGSEGV);
    if (word == "killed") std::raise(SIGKILL);
    if (word == "fail") return 7;
    if (word == "flood") {
        const std::string much(1 << 16, 'x');
        while (std::fwrite(much.data(), 1, much.size(), stdout) == much.size()) {
        }
    }
    if (word == "garbage") std::fputs("Segmentation violated", stdout);
    if (word == "sandbox") {
        std::fputs(io::encode_import_error("it could " + done_in_sandbox(arguments[1])).c_str(), stdout);
        std::fflush(stdout);
        std::_Exit(0);  // As xorvox-import ends: a leak checker would start a process.
    }
    if (word == "refuse") std::fputs(io::encode_import_error("no such\nformat").c_str(), stdout);
    if (word == "triangle" || word == "cut") {
        io::ImportedModel model;
        model.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        model.indices = {0, 1, 2};
        model.face_sizes = {3};
        model.face_materials = {0};
        model.materials.emplace_back();
        const std::string bytes = encode_import(model);
        std::fwrite(bytes.data(), 1, bytes.size() - (word == "cut" ? 1 : 0), stdout);
    }
    return 0;
}
