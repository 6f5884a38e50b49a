#include "transport/file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "transport/hosted.h"

namespace xorvox::transport {
namespace {

constexpr std::array<unsigned char, 8> kHead = {'X', 'O', 'R', 'V', 'O', 'X', 0x01, 0x0A};
constexpr auto kMaxPacketBytes = static_cast<std::uint32_t>(kMaxFramedBytes);

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

class FileWriter {
public:
    /// Writes into `file`, which stands at `temporary` until it moves to `target`. Messages call it `path`.
    FileWriter(File file, std::string path, std::string target, std::string temporary)
        : file_(std::move(file)),
          path_(std::move(path)),
          target_(std::move(target)),
          temporary_(std::move(temporary)) {}
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;
    ~FileWriter() {
        if (committed_) return;
        file_.reset();
        std::remove(temporary_.c_str());
    }

    LinkInfo info() const { return {"file", kMaxPacketBytes, false}; }

    Status send(std::span<const std::byte> packet) {
        if (packet.empty() || packet.size() > kMaxFramedBytes) return Status::OutOfRange;
        if (!file_ || error_ != 0) return Status::Closed;
        std::array<std::byte, kFrameHeaderBytes> header{};
        const Status status = encode_frame_header(packet.size(), header);
        if (status != Status::Ok) return status;
        write(header);
        write(packet);
        return error_ == 0 ? Status::Ok : Status::Closed;
    }

    Status receive(std::span<std::byte>, std::size_t&) { return Status::Unsupported; }

    Status flush() {
        if (!file_) return Status::Closed;
        if (error_ == 0 && std::fflush(file_.get()) != 0) error_ = errno;
        return error_ == 0 ? Status::Ok : Status::Closed;
    }

    Status wait(std::uint32_t events, std::int64_t) {
        if (!file_ || error_ != 0) return Status::Closed;
        return (events & kLinkWritable) != 0 ? Status::Ok : Status::Timeout;
    }

    void write(std::span<const std::byte> bytes) {
        if (error_ == 0 && std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) error_ = errno;
    }

    Expected<void> commit() {
        if (committed_) return {};
        if (flush() == Status::Ok && ::fsync(::fileno(file_.get())) != 0) error_ = errno;
        if (error_ == 0 && std::fclose(file_.release()) != 0) error_ = errno;
        if (error_ == 0 && std::rename(temporary_.c_str(), target_.c_str()) != 0) error_ = errno;
        if (error_ != 0)
            return fail(fmt::format("{}: cannot be written: {}; nothing was kept", path_, describe(error_)));
        committed_ = true;
        return {};
    }

private:
    File file_;
    std::string path_;
    std::string target_;
    std::string temporary_;
    int error_ = 0;
    bool committed_ = false;
};

class FileReader {
public:
    explicit FileReader(File file) : file_(std::move(file)) {}

    LinkInfo info() const { return {"file", kMaxPacketBytes, true}; }

    Status send(std::span<const std::byte> packet) {
        return packet.empty() || packet.size() > kMaxFramedBytes ? Status::OutOfRange : Status::Ok;
    }

    Status receive(std::span<std::byte> buffer, std::size_t& size) {
        return input_.receive([this](std::span<std::byte> bytes) { return read(bytes); }, buffer, size);
    }

    Status flush() { return Status::Ok; }

    Status wait(std::uint32_t, std::int64_t) {
        return input_.pull([this](std::span<std::byte> bytes) { return read(bytes); });
    }

private:
    std::ptrdiff_t read(std::span<std::byte> bytes) {
        return static_cast<std::ptrdiff_t>(std::fread(bytes.data(), 1, bytes.size(), file_.get()));
    }

    File file_;
    FramedInput input_;
};

/// Where a recording goes: `path`, or what it links to. Renaming onto a folder, a device or a pipe would fail or
/// replace it. The rules of voxelizer/io/atomic_file.h, which transport does not include.
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

Expected<UniqueLink> open_file_writer(const std::string& path) {
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
        auto writer = std::make_unique<FileWriter>(std::move(file), path, std::move(*target), std::move(temporary));
        writer->write(std::as_bytes(std::span(kHead)));
        return make_unique_link(writer.release());
    }
}

Expected<void> commit_file(Link writer) {
    if (writer.operations != &kOperations<FileWriter>) return fail("commit_file: the link does not write a file");
    return static_cast<FileWriter*>(writer.self)->commit();
}

Expected<UniqueLink> open_file_reader(const std::string& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) {
        return fail(fmt::format("{}: is a directory; give the name of a recording", path));
    }
    File file(std::fopen(path.c_str(), "rb"));
    if (!file) return fail(fmt::format("{}: cannot be opened: {}", path, describe(errno)));
    std::array<unsigned char, kHead.size()> head{};
    const std::size_t count = std::fread(head.data(), 1, head.size(), file.get());
    if (count < head.size() && std::ferror(file.get()) != 0) {
        return fail(fmt::format("{}: cannot be read: {}", path, describe(errno)));
    }
    if (count != head.size() || head != kHead) {
        return fail(
            fmt::format("{}: is no recording of xorvox: the first {} bytes are not its mark; "
                        "make one with --to file:PATH",
                        path, head.size()));
    }
    return make_unique_link(new FileReader(std::move(file)));
}

}  // namespace xorvox::transport
