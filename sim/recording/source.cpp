#include "sim/recording/source.h"

#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace xorvox::sim {
namespace {

class File {
public:
    explicit File(int descriptor) : descriptor_(descriptor) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() { ::close(descriptor_); }

    bool read(std::uint64_t offset, std::span<std::byte> out) const {
        while (!out.empty()) {
            const ssize_t count = ::pread(descriptor_, out.data(), out.size(), static_cast<off_t>(offset));
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) return false;
            offset += static_cast<std::uint64_t>(count);
            out = out.subspan(static_cast<std::size_t>(count));
        }
        return true;
    }

private:
    int descriptor_;
};

std::string reason() {
    return std::generic_category().message(errno);
}

}  // namespace

Expected<ByteSource> open_source(const std::string& path) {
    // O_NONBLOCK: a pipe without a writer is refused instead of waited for.
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return fail(fmt::format("{}: cannot be opened: {}", path, reason()));
    const auto file = std::make_shared<const File>(descriptor);
    struct stat status {};
    if (::fstat(descriptor, &status) != 0) return fail(fmt::format("{}: cannot be read: {}", path, reason()));
    if (!S_ISREG(status.st_mode)) {
        return fail(fmt::format("{}: is no regular file; give the name of a recording", path));
    }
    return ByteSource{path, static_cast<std::uint64_t>(status.st_size),
                      [file](std::uint64_t offset, std::span<std::byte> out) { return file->read(offset, out); }};
}

ByteSource memory_source(std::vector<std::byte> bytes, std::string name) {
    const auto owned = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
    return {std::move(name), owned->size(), [owned](std::uint64_t offset, std::span<std::byte> out) {
                std::copy_n(owned->begin() + static_cast<std::ptrdiff_t>(offset), out.size(), out.begin());
                return true;
            }};
}

}  // namespace xorvox::sim
