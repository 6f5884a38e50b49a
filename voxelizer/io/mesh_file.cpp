#include "voxelizer/io/mesh_file.h"

#include <cerrno>
#include <cmath>
#include <new>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/text_scanner.h"
#include "voxelizer/io/weld.h"

namespace xorvox::io {
namespace {

std::string last_error() {
    return std::system_category().message(errno);
}

tl::unexpected<Error> too_long(std::string_view source) {
    return fail(fmt::format("{}: longer than {} bytes, the most that is read; split or simplify the mesh", source,
                            kMaxMeshFileBytes));
}

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }

private:
    int number_;
};

// Messages call the file `name`.
Expected<std::string> read_file(const std::string& path, const std::string& name) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat info {};
    if (file.number() < 0 || ::fstat(file.number(), &info) != 0) {
        return fail(fmt::format("{}: cannot be read: {}; check the name and the permissions", name, last_error()));
    }
    if (S_ISDIR(info.st_mode)) return fail(fmt::format("{}: is a directory; name a mesh file in it", name));
    if (!S_ISREG(info.st_mode) && !S_ISFIFO(info.st_mode)) {
        return fail(fmt::format("{}: is neither a file nor a pipe; name a mesh file", name));
    }
    const auto announced = static_cast<std::uint64_t>(info.st_size);
    if (announced > kMaxMeshFileBytes) return too_long(name);

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
        if (size > kMaxMeshFileBytes) return too_long(name);
        if (size == bytes.size()) bytes.resize(2 * size);
    }
    bytes.resize(size);
    return bytes;
}

Expected<Mesh> parse_any(std::string_view bytes, const std::string& name) {
    if (begins_like_ply(bytes)) return parse_ply(bytes, name);
    if (has_size_of_binary_stl(bytes)) return parse_stl(bytes, name);
    const std::string ending = extension_of(name);
    if (ending == ".ply") return parse_ply(bytes, name);
    if (ending == ".stl") return parse_stl(bytes, name);
    if (ending == ".obj") return parse_obj(bytes, name);
    if (begins_like_text_stl(bytes)) return parse_stl(bytes, name);
    return fail(fmt::format(
        "{}: neither its content nor its extension {} is of a known format; xorvox reads .ply, .stl and .obj", name,
        quoted(ending)));
}

Expected<void> place(Mesh& mesh, const MeshReadOptions& options, std::string_view source) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        glm::dvec3& p = mesh.positions[i];
        if (options.up == UpAxis::Y) p = {p.x, -p.z, p.y};
        if (options.up == UpAxis::X) p = {p.y, p.z, p.x};
        p *= options.scale;
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            return fail(
                fmt::format("{}: vertex {} is beyond the range of a double after scaling by {}; use a smaller unit",
                            source, i, options.scale));
        }
    }
    return {};
}

}  // namespace

Expected<void> check_size(std::string_view bytes, std::string_view source) {
    if (bytes.empty()) return fail(fmt::format("{}: byte 0: the file is empty; export the mesh again", source));
    if (bytes.size() > kMaxMeshFileBytes) return too_long(source);
    return {};
}

Expected<double> unit_in_mm(std::string_view name) {
    if (name == "mm") return 1.0;
    if (name == "cm") return 10.0;
    if (name == "m") return 1000.0;
    if (name == "in") return 25.4;
    if (name == "ft") return 304.8;
    return fail(fmt::format("the unit {} is not known; use mm, cm, m, in or ft", quoted(name)));
}

Expected<UpAxis> up_axis(std::string_view name) {
    if (name == "x") return UpAxis::X;
    if (name == "y") return UpAxis::Y;
    if (name == "z") return UpAxis::Z;
    return fail(fmt::format("the axis {} is not known; use x, y or z", quoted(name)));
}

Expected<Mesh> read_mesh(const std::string& path, const MeshReadOptions& options) {
    const std::string name = printable_name(path);
    if (!std::isfinite(options.scale) || options.scale <= 0) {
        return fail(fmt::format("{}: cannot be scaled by {}; use a finite positive number", name, options.scale));
    }
    try {
        const auto bytes = read_file(path, name);
        if (!bytes) return tl::unexpected(bytes.error());
        if (auto ok = check_size(*bytes, name); !ok) return tl::unexpected(std::move(ok.error()));
        auto mesh = parse_any(*bytes, name);
        if (!mesh) return mesh;
        if (auto ok = place(*mesh, options, name); !ok) return tl::unexpected(std::move(ok.error()));
        weld(*mesh);
        return mesh;
    } catch (const std::bad_alloc&) {
        return fail(fmt::format("{}: not enough memory to read it; split or simplify the mesh", name));
    }
}

}  // namespace xorvox::io
