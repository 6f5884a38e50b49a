#include "voxelizer/io/atomic_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace xorvox::io {
namespace {

tl::unexpected<Error> system_failure(std::string_view path, std::string_view what, int number,
                                     std::string_view advice) {
    return fail(fmt::format("{}: {}: {}; {}", path, what, std::system_category().message(number), advice));
}

// Where the bytes go: `path`, or what it links to.
Expected<std::string> resolve(const std::string& path) {
    using std::filesystem::file_type;
    std::error_code ignored;
    const file_type type = std::filesystem::status(path, ignored).type();
    if (type == file_type::directory) return fail(fmt::format("{}: is a directory; name a file in it", path));
    if (type != file_type::regular && type != file_type::not_found && type != file_type::none) {
        return fail(fmt::format("{}: is a device or a pipe, which cannot be replaced as a whole; name a file", path));
    }
    if (std::filesystem::symlink_status(path, ignored).type() != file_type::symlink) return path;
    std::error_code error;
    std::string target = std::filesystem::canonical(path, error).string();
    if (error) return fail(fmt::format("{}: is a link to nothing; remove it or choose another name", path));
    return target;
}

}  // namespace

Expected<AtomicFile> AtomicFile::create(const std::string& path) {
    auto target = resolve(path);
    if (!target) return tl::unexpected(std::move(target.error()));
    const auto folder = std::filesystem::path(*target).parent_path();
    for (unsigned attempt = 0;; ++attempt) {
        std::string temporary = (folder / fmt::format(".xorvox-{}-{}.tmp", ::getpid(), attempt)).string();
        const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) return AtomicFile(path, std::move(*target), std::move(temporary), descriptor);
        if (errno != EEXIST) {
            return system_failure(path, "cannot be created", errno, "its folder must exist and be writable");
        }
    }
}

AtomicFile::AtomicFile(std::string path, std::string target, std::string temporary, int descriptor)
    : path_(std::move(path)), target_(std::move(target)), temporary_(std::move(temporary)), descriptor_(descriptor) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
    if (this != &other) {
        discard();
        path_ = std::move(other.path_);
        target_ = std::move(other.target_);
        temporary_ = std::exchange(other.temporary_, {});
        descriptor_ = std::exchange(other.descriptor_, -1);
    }
    return *this;
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::discard() noexcept {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    temporary_.clear();
}

Expected<void> AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return system_failure(path_, "cannot be written", errno, "nothing was left behind");
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return {};
}

Expected<void> AtomicFile::commit() {
    if (::close(std::exchange(descriptor_, -1)) != 0) {
        return system_failure(path_, "cannot be written", errno, "nothing was left behind");
    }
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
        return system_failure(path_, "cannot be created", errno, "nothing was left behind");
    }
    temporary_.clear();
    return {};
}

Expected<void> write_file_atomically(const std::string& path, std::string_view bytes) {
    auto file = AtomicFile::create(path);
    if (!file) return tl::unexpected(std::move(file.error()));
    if (auto ok = file->write(bytes); !ok) return ok;
    return file->commit();
}

}  // namespace xorvox::io
