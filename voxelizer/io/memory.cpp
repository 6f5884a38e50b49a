#include "voxelizer/io/memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <sys/resource.h>

namespace xorvox::io {

std::uint64_t available_bytes() {
    rlimit limit = {};
    std::uint64_t allowed = std::numeric_limits<std::uint64_t>::max();
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) allowed = limit.rlim_cur;
    std::ifstream meminfo("/proc/meminfo");
    std::string key;
    std::uint64_t kib = 0;
    while (meminfo >> key) {
        if (key == "MemAvailable:" && meminfo >> kib) return std::min(allowed, kib * 1024);
    }
    return allowed;
}

Expected<void> check_memory(std::uint64_t bytes, std::string_view source) {
    const std::uint64_t available = available_bytes();
    if (bytes <= available) return {};
    return fail(fmt::format("{}: its voxels need {} MiB of memory and there are {} MiB free; cut or reduce the volume",
                            source, bytes >> 20, available >> 20));
}

}  // namespace xorvox::io
