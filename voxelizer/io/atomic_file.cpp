#include "voxelizer/io/atomic_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "voxelizer/io/file_name.h"

namespace xorvox::io {
namespace {

tl::unexpected<Error> cannot_create(std::string_view shown, int number) {
    return fail(fmt::format("{}: cannot be created: {}; its folder must exist and be writable", shown,
                            std::system_category().message(number)));
}

tl::unexpected<Error> cannot_write(std::string_view shown, int number) {
    return fail(fmt::format("{}: cannot be written: {}; nothing was left behind", shown,
                            std::system_category().message(number)));
}

// Where the bytes go: `path`, or what it links to. Messages call it `shown`.
Expected<std::string> resolve(const std::string& path, const std::string& shown) {
    using std::filesystem::file_type;
    if (path.empty()) return fail("the name of the file to write is empty; name a file");
    std::error_code error;
    const file_type type = std::filesystem::status(path, error).type();
    if (type == file_type::none) return cannot_create(shown, error.value());
    if (type == file_type::directory) return fail(fmt::format("{}: is a directory; name a file in it", shown));
    if (type != file_type::regular && type != file_type::not_found) {
        return fail(fmt::format("{}: is a device or a pipe, which cannot be replaced as a whole; name a file", shown));
    }
    if (std::filesystem::symlink_status(path, error).type() != file_type::symlink) return path;
    std::string target = std::filesystem::canonical(path, error).string();
    if (error) return fail(fmt::format("{}: is a link to nothing; remove it or choose another name", shown));
    return target;
}

// A name beside `target` for the `attempt`th try to find one that is free.
std::string temporary_name(const std::string& target, unsigned attempt) {
    const auto folder = std::filesystem::path(target).parent_path();
    return (folder / fmt::format(".xorvox-{}-{}.tmp", ::getpid(), attempt)).string();
}

// By this name linkat() finds an open file that has none.
std::string name_of_descriptor(int descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor);
}

bool link_to(int descriptor, const std::string& name) {
    return ::linkat(AT_FDCWD, name_of_descriptor(descriptor).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

// A new file without a name in the folder of `target`; none where that cannot be or could not be named later.
Descriptor open_unnamed(const std::string& target) {
    const std::string folder = std::filesystem::path(target).parent_path().string();
    Descriptor file(::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
    if (::access(name_of_descriptor(file.number()).c_str(), F_OK) != 0) file.close();
    return file;
}

}  // namespace

Expected<AtomicFile> AtomicFile::create(const std::string& path) {
    std::string shown = printable_name(path);
    auto target = resolve(path, shown);
    if (!target) return tl::unexpected(std::move(target.error()));
    if (Descriptor file = open_unnamed(*target); file.number() >= 0) {
        return AtomicFile(std::move(shown), std::move(*target), {}, std::move(file));
    }
    for (unsigned attempt = 0;; ++attempt) {
        std::string name = temporary_name(*target, attempt);
        Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        if (file.number() >= 0) {
            return AtomicFile(std::move(shown), std::move(*target), std::move(name), std::move(file));
        }
        if (errno != EEXIST) return cannot_create(shown, errno);
    }
}

AtomicFile::AtomicFile(std::string shown, std::string target, std::string name, Descriptor file)
    : shown_(std::move(shown)), target_(std::move(target)), name_(std::move(name)), file_(std::move(file)) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : shown_(std::move(other.shown_)),
      target_(std::move(other.target_)),
      name_(std::exchange(other.name_, {})),
      file_(std::move(other.file_)) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
    if (this != &other) {
        discard();
        shown_ = std::move(other.shown_);
        target_ = std::move(other.target_);
        name_ = std::exchange(other.name_, {});
        file_ = std::move(other.file_);
    }
    return *this;
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::discard() noexcept {
    file_.close();
    if (!name_.empty()) ::unlink(name_.c_str());
    name_.clear();
}

Expected<void> AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file_.number(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return cannot_write(shown_, errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return {};
}

// Gives the unnamed file the name of its target, or a temporary one when that is taken: linkat() replaces nothing.
Expected<void> AtomicFile::take_name() {
    std::string name = target_;
    for (unsigned attempt = 0; !link_to(file_.number(), name); ++attempt) {
        if (errno != EEXIST) return cannot_create(shown_, errno);
        name = temporary_name(target_, attempt);
    }
    name_ = std::move(name);
    return {};
}

Expected<void> AtomicFile::commit() {
    if (name_.empty()) {
        if (auto ok = take_name(); !ok) return ok;
    }
    if (file_.close() != 0) return cannot_write(shown_, errno);
    if (name_ != target_ && ::rename(name_.c_str(), target_.c_str()) != 0) return cannot_create(shown_, errno);
    name_.clear();
    return {};
}

Expected<void> write_file_atomically(const std::string& path, std::string_view bytes) {
    auto file = AtomicFile::create(path);
    if (!file) return tl::unexpected(std::move(file.error()));
    if (auto ok = file->write(bytes); !ok) return ok;
    return file->commit();
}

}  // namespace xorvox::io
