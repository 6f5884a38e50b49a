// A file system without unnamed files (O_TMPFILE), as far as one thread can tell.
#pragma once

#include <cerrno>
#include <cstddef>
#include <functional>
#include <thread>

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

/// Runs `body` in a thread in which O_TMPFILE is answered with EOPNOTSUPP; false, and `body` not run, where the kernel
/// does not let us.
inline bool run_without_unnamed_files(const std::function<void()>& body) {
    bool ran = false;
    std::thread([&] {
        constexpr auto kCall = static_cast<unsigned>(offsetof(seccomp_data, nr));
        constexpr auto kFlags = static_cast<unsigned>(offsetof(seccomp_data, args[2]));  // Its low half, little-endian.
        sock_filter filter[] = {
            BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kCall),
            BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 4),
            BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kFlags),
            BPF_STMT(BPF_ALU | BPF_AND | BPF_K, O_TMPFILE),
            BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, O_TMPFILE, 0, 1),
            BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EOPNOTSUPP),
            BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
        };
        const sock_fprog program = {sizeof filter / sizeof filter[0], filter};
        if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return;
        if (::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) return;
        ran = true;
        body();
    }).join();
    return ran;
}

/// Whether `folder` takes unnamed files.
inline bool takes_unnamed_files(const char* folder) {
    const int descriptor = ::open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor >= 0) ::close(descriptor);
    return descriptor >= 0;
}
