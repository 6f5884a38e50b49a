#include "tools/import_sandbox.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define XORVOX_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define XORVOX_SANITIZED 1
#endif
#endif

namespace xorvox::tools {
namespace {

constexpr rlim_t kMemoryBytes = rlim_t{4} << 30;
constexpr rlim_t kCpuSeconds = 60;
constexpr rlim_t kOpenFiles = 64;

void limit(int resource, rlim_t most) {
    const rlimit both{most, most};
    if (setrlimit(resource, &both) != 0) throw std::runtime_error("its limits cannot be set");
}

#if defined(__x86_64__) || defined(__aarch64__)

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#endif

constexpr std::uint32_t kForbidden[] = {
    // The network, other processes.
    SYS_socket,
    SYS_connect,
    SYS_execve,
    SYS_execveat,
    SYS_ptrace,
    SYS_kill,
    SYS_process_vm_writev,
    SYS_clone,
    SYS_clone3,
    // Files and their names. openat2() and io_uring have their flags where a filter does not see them.
    SYS_unlinkat,
    SYS_renameat,
    SYS_renameat2,
    SYS_truncate,
    SYS_ftruncate,
    SYS_fallocate,
    SYS_mkdirat,
    SYS_symlinkat,
    SYS_linkat,
    SYS_mknodat,
    SYS_fchmod,
    SYS_fchmodat,
    SYS_fchown,
    SYS_fchownat,
    SYS_utimensat,
    SYS_setxattr,
    SYS_lsetxattr,
    SYS_fsetxattr,
    SYS_removexattr,
    SYS_lremovexattr,
    SYS_fremovexattr,
    SYS_openat2,
    SYS_open_by_handle_at,
    SYS_io_uring_setup,
#if defined(__x86_64__)
    SYS_fork,
    SYS_vfork,
    SYS_unlink,
    SYS_rename,
    SYS_mkdir,
    SYS_rmdir,
    SYS_symlink,
    SYS_link,
    SYS_mknod,
    SYS_chmod,
    SYS_chown,
    SYS_lchown,
    SYS_utime,
    SYS_utimes,
    SYS_futimesat,
    SYS_creat,
#endif
};

struct OpeningCall {
    std::uint32_t number;
    std::size_t flags;  // Which argument they are.
};
constexpr OpeningCall kOpening[] = {
    {SYS_openat, 2},
#if defined(__x86_64__)
    {SYS_open, 1},
#endif
};
constexpr std::uint32_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;  // Temporary files are writing ones, too.

void forbid_calls() {
    constexpr sock_filter refuse = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
    constexpr sock_filter allow = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    std::vector<sock_filter> program = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kMachine, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        // The same calls by other numbers: x32.
        BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, 0x4000'0000, 0, 1),
        refuse,
    };
    for (const std::uint32_t call : kForbidden) {
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1));
        program.push_back(refuse);
    }
    for (const OpeningCall& call : kOpening) {
        const auto at = static_cast<std::uint32_t>(offsetof(seccomp_data, args) + 8 * call.flags);  // Its low half.
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call.number, 0, 4));
        program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, at));
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, kWriting, 0, 1));
        program.push_back(refuse);
        program.push_back(allow);
    }
    program.push_back(allow);
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter, 0, 0);
}

#else
void forbid_calls() {}
#endif

}  // namespace

void give_up_what_is_not_needed() {
    prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_NOFILE, kOpenFiles);
    limit(RLIMIT_NPROC, 0);
    limit(RLIMIT_CPU, kCpuSeconds);
#ifndef XORVOX_SANITIZED
    limit(RLIMIT_AS, kMemoryBytes);  // A sanitizer's shadow memory does not fit into it.
#endif
    forbid_calls();
}

ModelFiles::ModelFiles(const std::string& model_path)
    : model_(std::filesystem::canonical(model_path)),
      folder_(std::filesystem::canonical(std::filesystem::absolute(model_path).parent_path()) / "") {}

bool ModelFiles::may_open(const char* path) const {
    std::error_code error;
    const std::string whole = path == nullptr ? "" : std::filesystem::canonical(path, error).string();
    return (whole == model_ || whole.starts_with(folder_)) && std::filesystem::is_regular_file(whole, error);
}

bool ModelFiles::Exists(const char* path) const {
    return may_open(path) && DefaultIOSystem::Exists(path);
}

Assimp::IOStream* ModelFiles::Open(const char* path, const char* mode) {
    return may_open(path) ? DefaultIOSystem::Open(path, mode) : nullptr;
}

}  // namespace xorvox::tools
