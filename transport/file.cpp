#include "transport/file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "transport/hosted.h"
#include "transport/new_file.h"

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
    explicit FileWriter(NewFile file) : file_(std::move(file)) { file_.write(std::as_bytes(std::span(kHead))); }

    LinkInfo info() const { return {"file", kMaxPacketBytes, false}; }

    Status send(std::span<const std::byte> packet) {
        if (packet.empty() || packet.size() > kMaxFramedBytes) return Status::OutOfRange;
        if (closed()) return Status::Closed;
        std::array<std::byte, kFrameHeaderBytes> header{};
        const Status status = encode_frame_header(packet.size(), header);
        if (status != Status::Ok) return status;
        file_.write(header);
        file_.write(packet);
        return closed() ? Status::Closed : Status::Ok;
    }

    Status receive(std::span<std::byte>, std::size_t&) { return Status::Unsupported; }

    Status flush() {
        if (closed()) return Status::Closed;
        file_.flush();
        return closed() ? Status::Closed : Status::Ok;
    }

    Status wait(std::uint32_t events, std::int64_t) {
        if (closed()) return Status::Closed;
        return (events & kLinkWritable) != 0 ? Status::Ok : Status::Timeout;
    }

    Expected<void> commit() { return file_.commit(); }

private:
    bool closed() const { return !file_.is_open() || file_.failed(); }

    NewFile file_;
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

}  // namespace

Expected<UniqueLink> open_file_writer(const std::string& path) {
    Expected<NewFile> file = NewFile::create(path);
    if (!file) return tl::unexpected(std::move(file.error()));
    return make_unique_link(new FileWriter(std::move(*file)));
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
