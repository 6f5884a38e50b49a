#include "voxelizer/io/read_file.h"

#include <cerrno>
#include <cstddef>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "voxelizer/io/descriptor.h"

namespace xorvox::io {
namespace {

std::string last_error() {
    return std::system_category().message(errno);
}

tl::unexpected<Error> too_long(const std::string& name, const FileKind& kind) {
    return fail(
        fmt::format("{}: longer than {} bytes, the most that is read; {}", name, kind.most_bytes, kind.shorten));
}

}  // namespace

Expected<std::string> read_file(const std::string& path, const std::string& name, const FileKind& kind) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat info {};
    if (file.number() < 0 || ::fstat(file.number(), &info) != 0) {
        return fail(fmt::format("{}: cannot be read: {}; check the name and the permissions", name, last_error()));
    }
    if (S_ISDIR(info.st_mode)) {
        return fail(fmt::format("{}: is a directory; name {} in it", name, kind.noun));
    }
    if (!S_ISREG(info.st_mode) && !S_ISFIFO(info.st_mode)) {
        return fail(fmt::format("{}: is neither a file nor a pipe; name {}", name, kind.noun));
    }
    const auto announced = static_cast<std::uint64_t>(info.st_size);
    if (announced > kind.most_bytes) return too_long(name, kind);

    // One byte more than announced, so that the end of a regular file is seen without growing.
    constexpr std::size_t kPipeBytes = std::size_t{1} << 16;
    std::string bytes(S_ISREG(info.st_mode) ? announced + 1 : kPipeBytes, '\0');
    std::size_t size = 0;
    for (;;) {
        const ssize_t got = ::read(file.number(), bytes.data() + size, bytes.size() - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return fail(fmt::format("{}: byte {}: cannot be read: {}", name, size, last_error()));
        if (got == 0) break;
        size += static_cast<std::size_t>(got);
        if (size > kind.most_bytes) return too_long(name, kind);
        if (size == bytes.size()) bytes.resize(2 * size);
    }
    if (size == 0) return fail(fmt::format("{}: byte 0: the file is empty; write it again", name));
    bytes.resize(size);
    return bytes;
}

}  // namespace xorvox::io
