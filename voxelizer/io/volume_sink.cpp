#include "voxelizer/io/volume_sink.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

#include "voxelizer/io/atomic_file.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/png_stack.h"

namespace xorvox::io {
namespace {

class FileSink final : public VolumeSink {
public:
    explicit FileSink(AtomicFile file) : file_(std::move(file)) {}
    Expected<void> write(std::string_view bytes) override { return file_.write(bytes); }
    Expected<void> commit() override { return file_.commit(); }

private:
    AtomicFile file_;
};

// Packs what is written; the gzip header has no date and no name, so that equal volumes give equal files.
class GzipSink final : public VolumeSink {
public:
    explicit GzipSink(AtomicFile file) : file_(std::move(file)), packed_(std::size_t{1} << 16) {
        constexpr int kGzip = 16 + MAX_WBITS;
        constexpr int kMemory = 8;
        ready_ =
            ::deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) == Z_OK;
    }
    ~GzipSink() override {
        if (ready_) ::deflateEnd(&stream_);
    }

    Expected<void> write(std::string_view bytes) override {
        while (!bytes.empty()) {
            const std::size_t piece = std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max());
            if (auto ok = pack(bytes.substr(0, piece), Z_NO_FLUSH); !ok) return ok;
            bytes.remove_prefix(piece);
        }
        return {};
    }
    Expected<void> write_plain(std::string_view bytes) override { return file_.write(bytes); }
    Expected<void> commit() override {
        if (auto ok = pack({}, Z_FINISH); !ok) return ok;
        return file_.commit();
    }

private:
    Expected<void> pack(std::string_view bytes, int flush) {
        if (!ready_) return fail("not enough memory to pack the volume");
        // zlib does not write through next_in.
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
        stream_.avail_in = static_cast<uInt>(bytes.size());
        do {
            stream_.next_out = packed_.data();
            stream_.avail_out = static_cast<uInt>(packed_.size());
            // Cannot fail: the stream is sound, and there is room for the result.
            (void)::deflate(&stream_, flush);
            const std::size_t size = packed_.size() - stream_.avail_out;
            if (auto ok = file_.write({reinterpret_cast<const char*>(packed_.data()), size}); !ok) return ok;
        } while (stream_.avail_out == 0);
        return {};
    }

    AtomicFile file_;
    std::vector<Bytef> packed_;
    z_stream stream_{};
    bool ready_ = false;
};

class PictureSink final : public VolumeSink {
public:
    PictureSink(std::string shown, std::string folder, std::vector<std::string> paths)
        : shown_(std::move(shown)), folder_(std::move(folder)), paths_(std::move(paths)) {}
    ~PictureSink() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }

    Expected<void> write(std::string_view bytes) override {
        const auto ok = write_file_atomically(fmt::format("{}/{}", folder_, written_++), bytes);
        if (!ok) return fail(fmt::format("{}: {}", shown_, ok.error().message));
        return {};
    }
    Expected<void> commit() override {
        for (std::size_t n = 0; n < paths_.size(); ++n) {
            std::error_code error;
            std::filesystem::rename(fmt::format("{}/{}", folder_, n), paths_[n], error);
            if (error) {
                return fail(fmt::format("{}: picture {} cannot be created: {}; those before it are there", shown_,
                                        printable_name(paths_[n]), error.message()));
            }
        }
        return {};
    }

private:
    std::string shown_;
    std::string folder_;
    std::vector<std::string> paths_;
    std::size_t written_ = 0;
};

// Refuses a row that has more pictures than those at `paths`.
Expected<void> check_row(const std::string& shown, const std::vector<std::string>& paths) {
    const NumberedName own = numbered_name(paths.front());
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(own.folder, error)) {
        if (extension_of(entry.path().string()) != ".png") continue;
        const NumberedName name = numbered_name(entry.path().string());
        if (name.before != own.before || name.digits.empty()) continue;
        const auto same = [&](const std::string& path) {
            return std::filesystem::path(path).filename() == entry.path().filename();
        };
        if (std::ranges::any_of(paths, same)) continue;
        return fail(
            fmt::format("{}: {} would be taken for a part of this stack; move it, or choose another name or "
                        "folder",
                        shown, printable_name(entry.path().string())));
    }
    if (error) {
        return fail(
            fmt::format("{}: cannot be created: {}; its folder must exist and be writable", shown, error.message()));
    }
    return {};
}

}  // namespace

Expected<std::unique_ptr<VolumeSink>> file_sink(const std::string& path, bool gzip) {
    auto file = AtomicFile::create(path);
    if (!file) return tl::unexpected(std::move(file.error()));
    if (gzip) return std::make_unique<GzipSink>(std::move(*file));
    return std::make_unique<FileSink>(std::move(*file));
}

Expected<std::unique_ptr<VolumeSink>> picture_sink(const std::string& path, std::size_t count) {
    const std::string shown = printable_name(path);
    const std::size_t digits = std::max<std::size_t>(3, std::to_string(count - 1).size());
    const std::string before = path.substr(0, path.size() - extension_of(path).size());
    if (!numbered_name(path).digits.empty()) {
        return fail(fmt::format("{}: ends in a number, and the pictures get their own; leave it away", shown));
    }
    std::vector<std::string> paths;
    for (std::size_t n = 0; n < count; ++n) paths.push_back(fmt::format("{}{:0{}}.png", before, n, digits));
    if (auto ok = check_row(shown, paths); !ok) return tl::unexpected(std::move(ok.error()));
    std::string folder = numbered_name(path).folder + "/.xorvox-XXXXXX";
    if (::mkdtemp(folder.data()) == nullptr) {
        return fail(fmt::format("{}: cannot be created: {}; its folder must exist and be writable", shown,
                                std::system_category().message(errno)));
    }
    return std::make_unique<PictureSink>(shown, std::move(folder), std::move(paths));
}

}  // namespace xorvox::io
