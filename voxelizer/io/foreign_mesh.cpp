#include "voxelizer/io/foreign_mesh.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "voxelizer/io/corner_colors.h"
#include "voxelizer/io/descriptor.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/image_file.h"
#include "voxelizer/io/import_stream.h"
#include "voxelizer/io/model_images.h"
#include "voxelizer/io/text_scanner.h"

extern char** environ;

namespace xorvox::io {
namespace {

using Clock = std::chrono::steady_clock;

struct Format {
    std::string_view ending;
    UpAxis up;
};

// Up is what assimp 5.2.5 makes of the models in Debian's assimp-testmodels: it turns some formats, and leaves others.
constexpr std::array<Format, 29> kFormats = {
    {{".3ds", UpAxis::Y}, {".3mf", UpAxis::Z}, {".ac", UpAxis::Y},    {".acc", UpAxis::Y},     {".amf", UpAxis::Z},
     {".ase", UpAxis::Y}, {".b3d", UpAxis::Y}, {".blend", UpAxis::Z}, {".cob", UpAxis::Z},     {".dae", UpAxis::Y},
     {".dxf", UpAxis::Z}, {".fbx", UpAxis::Y}, {".hmp", UpAxis::Z},   {".lwo", UpAxis::Y},     {".lws", UpAxis::Y},
     {".lxo", UpAxis::Y}, {".md2", UpAxis::Y}, {".md3", UpAxis::Y},   {".md5mesh", UpAxis::Y}, {".ms3d", UpAxis::Y},
     {".nff", UpAxis::Y}, {".off", UpAxis::Z}, {".ogex", UpAxis::Z},  {".q3o", UpAxis::Z},     {".smd", UpAxis::Z},
     {".x", UpAxis::Y},   {".x3d", UpAxis::Y}, {".xgl", UpAxis::Y},   {".zae", UpAxis::Y}}};

constexpr const char* kInstead = "repair the file, or convert it to .ply, .obj or .glb with another program";

const Format* format_of(std::string_view path) {
    const std::string ending = extension_of(path);
    const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                    [&ending](const Format& format) { return format.ending == ending; });
    return found == kFormats.end() ? nullptr : &*found;
}

// A started importer; killed and reaped at the end.
class Child {
public:
    Child(const std::string& program, const std::string& path) {
        std::array<int, 2> pipe{};
        if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
            error_ = errno;
            return;
        }
        output_ = Descriptor(pipe[0]);
        const Descriptor input(pipe[1]);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&actions, input.number(), STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        std::string name = program;
        std::string argument = path;
        const std::array<char*, 3> arguments{name.data(), argument.data(), nullptr};
        error_ = ::posix_spawn(&pid_, program.c_str(), &actions, nullptr, arguments.data(), environ);
        if (error_ != 0) pid_ = -1;
        posix_spawn_file_actions_destroy(&actions);
    }
    ~Child() { end(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Of starting it; 0: it runs.
    int error() const { return error_; }
    int output() const { return output_.number(); }

    /// Ends it, if it has not, and gives its status as waitpid() does. One that has begun to exit keeps its status.
    int end() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            while (::waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
            }
            pid_ = -1;
        }
        return status_;
    }

private:
    pid_t pid_ = -1;
    Descriptor output_;
    int error_ = 0;
    int status_ = 0;
};

enum class Reading : std::uint8_t { Whole, TooLate, TooMuch };

Reading read_output(int from, const ImportLimits& limits, std::string& bytes) {
    constexpr std::size_t kStep = std::size_t{1} << 16;
    const auto deadline = Clock::now() + limits.time;
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0) return Reading::TooLate;
        pollfd waiting{from, POLLIN, 0};
        if (::poll(&waiting, 1, static_cast<int>(left)) <= 0) continue;  // Late, or interrupted.
        const std::size_t size = bytes.size();
        if (size > limits.output_bytes) return Reading::TooMuch;
        if (bytes.capacity() - size < kStep) bytes.reserve(2 * size + kStep);
        bytes.resize(size + kStep);
        const ssize_t got = ::read(from, bytes.data() + size, kStep);
        bytes.resize(size + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
        if (got == 0) return Reading::Whole;
    }
}

std::string how_it_ended(int status) {
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);
        if (number == SIGXCPU) return "took too much time";
        return fmt::format("crashed (signal {}, {})", number, ::strsignal(number));
    }
    return fmt::format("ended with status {}", WEXITSTATUS(status));
}

Expected<ImportedModel> run(const std::string& path, const std::string& name, const std::string& program,
                            const ImportLimits& limits) {
    Child child(program, path);
    if (child.error() != 0) {
        return fail(
            fmt::format("{}: {} files are read by the program {}, which does not start: {}; install it, or "
                        "convert the file to .ply, .obj or .glb",
                        name, extension_of(path), printable_name(program), std::strerror(child.error())));
    }
    std::string bytes;
    const Reading reading = read_output(child.output(), limits, bytes);
    const int status = child.end();
    if (reading == Reading::TooLate) {
        return fail(fmt::format("{}: its import took more than {} s; {}", name,
                                static_cast<double>(limits.time.count()) / 1000.0, kInstead));
    }
    if (reading == Reading::TooMuch) {
        return fail(fmt::format("{}: its import gives more than {} bytes; {}", name, limits.output_bytes, kInstead));
    }
    bool refused = false;
    auto model = parse_import(bytes, refused);
    if (model) return model;
    const std::string why = refused       ? model.error().message
                            : status != 0 ? "the importer " + how_it_ended(status)
                                          : "the importer gives " + model.error().message;
    // quoted() would cut what assimp says.
    return fail(fmt::format("{}: cannot be imported: {}; {}", name, printable_name(why.substr(0, 300)), kInstead));
}

Expected<std::vector<Image>> read_images(const ImportedModel& model, const std::string& name,
                                         const SideFiles& side_files) {
    ModelImages images(name);
    for (const ImportedImage& from : model.images) {
        Expected<std::string> bytes = from.bytes;
        if (from.is_name) bytes = side_files.read_by_name(from.bytes, name, kImageFile);
        if (!bytes) return tl::unexpected(std::move(bytes.error()));
        const auto added = images.add(decode_image(
            *bytes, from.is_name ? fmt::format("{}: {}", name, quoted(from.bytes)) : name + ": an image in it"));
        if (!added) return tl::unexpected(added.error());
    }
    return std::move(images).take();
}

void add_colors(ImportedModel& model, const std::string& name, const SideFiles& side_files, ParsedModel& parsed) {
    if (const char* wrong = color_fault(model)) {
        parsed.colors_fault = fmt::format("{}: {}; repair the file", name, wrong);
        return;
    }
    auto images = read_images(model, name, side_files);
    if (!images) {
        parsed.colors_fault = images.error().message;
        return;
    }
    SurfaceColors& colors = parsed.colors;
    colors.images = std::move(*images);
    colors.corner_colors = std::move(model.corner_colors);
    for (glm::vec3& color : colors.corner_colors) color = linear_color(color);
    colors.corner_texcoords = std::move(model.corner_texcoords);
    colors.face_materials = std::move(model.face_materials);
    colors.materials = std::move(model.materials);
    for (SurfaceMaterial& material : colors.materials) material.factor = linear_color(material.factor);
    drop_white(colors);
}

}  // namespace

bool is_foreign(std::string_view path) {
    return format_of(path) != nullptr;
}

UpAxis foreign_up(std::string_view path) {
    const Format* format = format_of(path);
    return format ? format->up : UpAxis::Z;
}

std::string foreign_endings() {
    std::string endings;
    for (const Format& format : kFormats) endings += fmt::format("{}{}", endings.empty() ? "" : ", ", format.ending);
    return endings;
}

Expected<ParsedModel> import_foreign(const std::string& path, const std::string& name, Wanted wanted,
                                     const std::string& program, const ImportLimits& limits) {
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) {
        return fail(
            fmt::format("{}: cannot be read: {}; check the name and the permissions", name, std::strerror(errno)));
    }
    if (!S_ISREG(info.st_mode)) return fail(fmt::format("{}: is no regular file; name a mesh file", name));
    if (program.empty()) {
        return fail(
            fmt::format("{}: {} files are read by the program xorvox-import, which was not named; convert the "
                        "file to .ply, .obj or .glb",
                        name, extension_of(path)));
    }
    auto model = run(path, name, program, limits);
    if (!model) return tl::unexpected(std::move(model.error()));
    if (model->face_sizes.empty()) {
        return fail(fmt::format("{}: {} vertices but no faces; a mesh needs faces", name, model->positions.size()));
    }
    ParsedModel parsed;
    parsed.mesh.positions = std::move(model->positions);
    parsed.mesh.indices = std::move(model->indices);
    if (std::any_of(model->face_sizes.begin(), model->face_sizes.end(), [](std::uint32_t n) { return n != 3; })) {
        parsed.mesh.ring_starts.push_back(0);
        for (const std::uint32_t size : model->face_sizes) {
            parsed.mesh.ring_starts.push_back(parsed.mesh.ring_starts.back() + size);
        }
    }
    for (const std::string& note : model->notes) parsed.notes.push_back(printable_name(note.substr(0, 200)));
    if (wanted == Wanted::ShapeAndColors) add_colors(*model, name, SideFiles(path), parsed);
    return parsed;
}

}  // namespace xorvox::io
