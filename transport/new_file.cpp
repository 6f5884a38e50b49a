#include "transport/new_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "transport/hosted.h"

namespace xorvox::transport {
namespace {

/// Where it goes: `path`, or what it links to. Renaming onto a folder, a device or a pipe would fail or replace it. The
/// rules of voxelizer/io/atomic_file.h, which transport does not include.
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

NewFile::NewFile(File file, std::string path, std::string target, std::string temporary)
    : file_(std::move(file)), path_(std::move(path)), target_(std::move(target)), temporary_(std::move(temporary)) {}

NewFile::NewFile(NewFile&& other) noexcept
    : file_(std::move(other.file_)),
      path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      error_(other.error_),
      committed_(other.committed_) {}

NewFile::~NewFile() {
    if (temporary_.empty() || committed_) return;
    file_.reset();
    std::remove(temporary_.c_str());
}

Expected<NewFile> NewFile::create(const std::string& path) {
    auto target = resolve(path);
    if (!target) return tl::unexpected(std::move(target.error()));
    const std::filesystem::path folder = std::filesystem::path(*target).parent_path();
    for (unsigned attempt = 0;; ++attempt) {
        std::string temporary = (folder / fmt::format(".xorvox-{}-{}.tmp", ::getpid(), attempt)).string();
        File file(std::fopen(temporary.c_str(), "wbxe"));  // x: O_EXCL, no file that is there already; e: O_CLOEXEC.
        if (!file && errno == EEXIST) continue;
        if (!file) {
            return fail(
                fmt::format("{}: cannot be created: {}; its folder must exist and be writable", path, describe(errno)));
        }
        return NewFile(std::move(file), path, std::move(*target), std::move(temporary));
    }
}

void NewFile::write(std::span<const std::byte> bytes) {
    if (bytes.empty()) return;  // It may have no address.
    if (error_ == 0 && std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) error_ = errno;
}

void NewFile::flush() {
    if (error_ == 0 && std::fflush(file_.get()) != 0) error_ = errno;
}

Expected<void> NewFile::commit() {
    if (committed_) return {};
    flush();
    if (error_ == 0 && ::fsync(::fileno(file_.get())) != 0) error_ = errno;
    if (error_ == 0 && std::fclose(file_.release()) != 0) error_ = errno;
    if (error_ == 0 && std::rename(temporary_.c_str(), target_.c_str()) != 0) error_ = errno;
    if (error_ != 0) return fail(fmt::format("{}: cannot be written: {}; nothing was kept", path_, describe(error_)));
    committed_ = true;
    return {};
}

}  // namespace xorvox::transport
