#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "driver/display/lattice.h"
#include "sim/camera.h"
#include "sim/develop.h"
#include "sim/outline.h"
#include "sim/picture.h"
#include "sim/shaders.h"
#include "sim/surface.h"

namespace xorvox::sim {
namespace {

constexpr std::uint32_t kFiner = 2;  ///< Drawn so many times larger, and averaged.
constexpr float kNear = 0.02f;       ///< In camera distances.
constexpr float kLineWidth_px = 1.1f;
constexpr float kGlow = 0.35f;
constexpr glm::vec3 kLineTint(0.030f, 0.038f, 0.052f);
constexpr std::uint32_t kRowsAtOnce = 64;

/// What the GPU is given for each voxel; the attributes of kVoxelVertex.
struct VoxelVertex {
    glm::vec3 place;
    glm::vec3 half_size;
    glm::vec2 across;
    glm::vec3 normal;
    glm::vec3 light;
    float open;
};
static_assert(sizeof(VoxelVertex) == 15 * sizeof(float));

struct LineVertex {
    glm::vec3 from;
    glm::vec3 to;
};

/// Relative to the eye, in camera distances: small numbers, whatever the display's size and place.
glm::vec3 seen_from(const Camera& camera, const glm::dvec3& place_mm) {
    return glm::vec3((place_mm - camera.eye_mm) / camera.distance_mm);
}

std::vector<VoxelVertex> voxel_vertices(std::span<const Voxel> voxels, const Camera& camera) {
    std::vector<VoxelVertex> vertices;
    vertices.reserve(voxels.size());
    const float size = kVoxelFilling / static_cast<float>(camera.distance_mm);
    for (const Voxel& voxel : voxels) {
        vertices.push_back({seen_from(camera, voxel.place_mm), voxel.half_mm * size, voxel.across, voxel.normal,
                            voxel.light, voxel.open});
    }
    return vertices;
}

/// The part of the outline that is in front of the camera.
std::vector<LineVertex> line_vertices(std::span<const Segment> segments, const Camera& camera) {
    std::vector<LineVertex> vertices;
    vertices.reserve(segments.size());
    const glm::vec3 forward(camera.forward);
    for (const Segment& segment : segments) {
        glm::vec3 from = seen_from(camera, segment.from_mm);
        glm::vec3 to = seen_from(camera, segment.to_mm);
        const float from_depth = glm::dot(from, forward);
        const float to_depth = glm::dot(to, forward);
        const float near = 2.0f * kNear;
        if (from_depth < near && to_depth < near) continue;
        if (from_depth < near) from += (to - from) * ((near - from_depth) / (to_depth - from_depth));
        if (to_depth < near) to += (from - to) * ((near - to_depth) / (from_depth - to_depth));
        vertices.push_back({from, to});
    }
    return vertices;
}

glm::mat4 clip_matrix(const Camera& camera, float far) {
    const glm::vec3 right = glm::vec3(camera.right) / static_cast<float>(camera.tan_x);
    const glm::vec3 up = glm::vec3(camera.up) / static_cast<float>(camera.tan_y);
    const glm::vec3 forward(camera.forward);
    const float scale = (far + kNear) / (far - kNear);
    const float offset = -2.0f * far * kNear / (far - kNear);
    glm::mat4 matrix(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        matrix[axis] = {right[axis], up[axis], scale * forward[axis], forward[axis]};
    }
    matrix[3] = {0.0f, 0.0f, offset, 0.0f};
    return matrix;
}

/// Everything that one picture has on the GPU; freed together, while the context is current.
class Stage {
public:
    explicit Stage(const gl::Context::Current& current) : gl_(current) {
        gl_->GenFramebuffers(1, &framebuffer_);
        gl_->GenRenderbuffers(2, targets_.data());
        gl_->GenVertexArrays(1, &vertex_array_);
        gl_->GenBuffers(1, &buffer_);
    }
    ~Stage() {
        gl_->DeleteBuffers(1, &buffer_);
        gl_->DeleteVertexArrays(1, &vertex_array_);
        gl_->DeleteFramebuffers(1, &framebuffer_);
        gl_->DeleteRenderbuffers(2, targets_.data());
        for (const GLuint program : programs_) gl_->DeleteProgram(program);
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    Expected<void> make_film(GLsizei width, GLsizei height) {
        gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        constexpr std::array<std::pair<GLenum, GLenum>, 2> kinds = {
            {{GL_RGBA16F, GL_COLOR_ATTACHMENT0}, {GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT}}};
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            gl_->BindRenderbuffer(GL_RENDERBUFFER, targets_[i]);
            gl_->RenderbufferStorage(GL_RENDERBUFFER, kinds[i].first, width, height);
            gl_->FramebufferRenderbuffer(GL_FRAMEBUFFER, kinds[i].second, GL_RENDERBUFFER, targets_[i]);
        }
        if (gl_->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
            return fail(
                fmt::format("OpenGL cannot draw a picture of {} by {} pixels; ask for a smaller one", width, height));
        }
        gl_->Viewport(0, 0, width, height);
        gl_->ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
        gl_->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        gl_->Enable(GL_DEPTH_TEST);
        return {};
    }

    /// Compiles and uses a program; its name.
    Expected<GLuint> use(const char* vertex, const char* fragment) {
        const GLuint program = gl_->CreateProgram();
        programs_.push_back(program);
        for (const auto& [kind, source] : {std::pair{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}}) {
            const GLuint shader = gl_->CreateShader(static_cast<GLenum>(kind));
            gl_->ShaderSource(shader, 1, &source, nullptr);
            gl_->CompileShader(shader);
            gl_->AttachShader(program, shader);
            GLint compiled = 0;
            std::array<char, 512> log{};
            gl_->GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
            if (compiled == 0) gl_->GetShaderInfoLog(shader, log.size(), nullptr, log.data());
            gl_->DeleteShader(shader);
            if (compiled == 0) return fail(fmt::format("OpenGL refused a shader: {}", log.data()));
        }
        gl_->LinkProgram(program);
        GLint linked = 0;
        gl_->GetProgramiv(program, GL_LINK_STATUS, &linked);
        if (linked == 0) return fail("OpenGL refused to link the picture's shaders");
        gl_->UseProgram(program);
        return program;
    }

    /// Draws a strip of four vertices for each of `instances`, whose floats go to attributes of these sizes in order.
    template <class Instance>
    void draw(const std::vector<Instance>& instances, std::initializer_list<GLint> sizes) {
        gl_->BindVertexArray(vertex_array_);
        gl_->BindBuffer(GL_ARRAY_BUFFER, buffer_);
        gl_->BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(Instance)), instances.data(),
                        GL_STREAM_DRAW);
        GLuint attribute = 0;
        std::size_t offset = 0;
        for (const GLint size : sizes) {
            gl_->EnableVertexAttribArray(attribute);
            gl_->VertexAttribPointer(attribute, size, GL_FLOAT, GL_FALSE, sizeof(Instance),
                                     reinterpret_cast<const void*>(offset));
            gl_->VertexAttribDivisor(attribute, 1);
            offset += sizeof(float) * static_cast<std::size_t>(size);
            ++attribute;
        }
        gl_->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
    }

    /// Reads the film, each pixel the mean of kFiner².
    Film read_film(std::uint32_t width, std::uint32_t height) {
        Film film{width, height, std::vector<glm::vec4>(std::size_t{width} * height)};
        const std::size_t wide = std::size_t{width} * kFiner;
        std::vector<glm::vec4> strip(wide * kRowsAtOnce * kFiner);
        for (std::uint32_t first = 0; first < height; first += kRowsAtOnce) {
            const std::uint32_t rows = std::min(kRowsAtOnce, height - first);
            gl_->ReadPixels(0, static_cast<GLint>(first * kFiner), static_cast<GLsizei>(wide),
                            static_cast<GLsizei>(rows * kFiner), GL_RGBA, GL_FLOAT, strip.data());
            for (std::size_t y = 0; y < rows * kFiner; ++y) {
                // OpenGL's rows begin at the bottom.
                glm::vec4* line = film.pixels.data() + (height - 1 - first - y / kFiner) * width;
                for (std::size_t x = 0; x < wide; ++x) {
                    line[x / kFiner] += strip[y * wide + x] / static_cast<float>(kFiner * kFiner);
                }
            }
        }
        return film;
    }

private:
    const gl::Context::Current& gl_;
    GLuint framebuffer_ = 0;
    std::array<GLuint, 2> targets_{};
    GLuint vertex_array_ = 0;
    GLuint buffer_ = 0;
    std::vector<GLuint> programs_;
};

struct Scene {
    Camera camera;
    std::vector<VoxelVertex> voxels;
    std::vector<LineVertex> lines;
};

Scene make_scene(const DisplayDescription& display, const LightField& field, const PictureOptions& options) {
    const std::vector<Voxel> voxels = visible_voxels(display, field);
    std::vector<Segment> segments = outline(display);
    std::vector<Target> targets;
    const auto aim_at = [&targets](const std::vector<Voxel>& framed) {
        for (const Voxel& voxel : framed) {
            targets.push_back({voxel.place_mm, kVoxelFilling * glm::length(voxel.half_mm) / 1.7});
        }
    };
    aim_at(options.framed != nullptr ? visible_voxels(display, *options.framed) : voxels);
    if (options.framing == Framing::Display) {
        const std::vector<Segment> more = marks(display);
        segments.insert(segments.end(), more.begin(), more.end());
    }
    if (options.framing == Framing::Display || targets.empty()) {
        for (const Segment& segment : segments) {
            targets.push_back({segment.from_mm, 0.0});
            targets.push_back({segment.to_mm, 0.0});
        }
    }
    Scene scene;
    scene.camera =
        fit_camera(targets, options.azimuth_deg, options.elevation_deg, double{1.0} * options.width / options.height);
    scene.voxels = voxel_vertices(voxels, scene.camera);
    scene.lines = line_vertices(segments, scene.camera);
    return scene;
}

float farthest(const Scene& scene) {
    const glm::vec3 forward(scene.camera.forward);
    float far = 2.0f;
    for (const VoxelVertex& voxel : scene.voxels) far = std::max(far, glm::dot(voxel.place, forward));
    for (const LineVertex& line : scene.lines) {
        far = std::max({far, glm::dot(line.from, forward), glm::dot(line.to, forward)});
    }
    return 1.1f * far;
}

Expected<Film> shoot(const gl::Context::Current& current, const Scene& scene, std::uint32_t width,
                     std::uint32_t height) {
    Stage stage(current);
    if (auto made = stage.make_film(static_cast<GLsizei>(width * kFiner), static_cast<GLsizei>(height * kFiner));
        !made) {
        return tl::unexpected(made.error());
    }
    const Camera& camera = scene.camera;
    const glm::mat4 to_clip = clip_matrix(camera, farthest(scene));

    const auto voxels = stage.use(kVoxelVertex, kVoxelFragment);
    if (!voxels) return tl::unexpected(voxels.error());
    const glm::vec3 lamp = glm::normalize(glm::vec3(-0.62 * camera.right + 0.68 * camera.up - 0.55 * camera.forward));
    const glm::vec3 up(camera.up);
    current->UniformMatrix4fv(current->GetUniformLocation(*voxels, "to_clip"), 1, GL_FALSE, &to_clip[0][0]);
    current->Uniform3f(current->GetUniformLocation(*voxels, "camera_up"), up.x, up.y, up.z);
    current->Uniform3f(current->GetUniformLocation(*voxels, "lamp"), lamp.x, lamp.y, lamp.z);
    stage.draw(scene.voxels, {3, 3, 2, 3, 3, 1});

    // Lines never cross the body, even those in front of it.
    const auto lines = stage.use(kLineVertex, kLineFragment);
    if (!lines) return tl::unexpected(lines.error());
    current->Enable(GL_BLEND);
    current->BlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    current->UniformMatrix4fv(current->GetUniformLocation(*lines, "to_clip"), 1, GL_FALSE, &to_clip[0][0]);
    current->Uniform2f(current->GetUniformLocation(*lines, "half_width"), kLineWidth_px / static_cast<float>(width),
                       kLineWidth_px / static_cast<float>(height));
    current->Uniform3f(current->GetUniformLocation(*lines, "tint"), kLineTint.x, kLineTint.y, kLineTint.z);
    stage.draw(scene.lines, {3, 3});

    Film film = stage.read_film(width, height);
    if (const GLenum error = current->GetError(); error != GL_NO_ERROR) {
        return fail(fmt::format("OpenGL failed while drawing the picture (error 0x{:04x})", error));
    }
    return film;
}

}  // namespace

Expected<Picture> render_perspective(const DisplayDescription& display, const LightField& field,
                                     const PictureOptions& options) {
    const auto between = [](auto value, auto low, auto high) { return value >= low && value <= high; };
    if (!between(options.width, 16u, 4096u) || !between(options.height, 16u, 4096u)) {
        return fail(
            fmt::format("a picture of {} by {} pixels; allowed: 16 to 4096 a side", options.width, options.height));
    }
    if (!between(options.elevation_deg, -89.0, 89.0) || !between(options.azimuth_deg, -360.0, 360.0)) {
        return fail(fmt::format("a camera at azimuth {}, elevation {} degrees; allowed: -360 to 360 and -89 to 89",
                                options.azimuth_deg, options.elevation_deg));
    }
    const auto context = gl::make_context(options.context);
    if (!context) return tl::unexpected(context.error());

    const Scene scene = make_scene(display, field, options);
    const gl::Context::Current current(**context);
    if (!current) return fail("the OpenGL context cannot be used on this thread");
    const Expected<Film> film = shoot(current, scene, options.width, options.height);
    if (!film) return tl::unexpected(film.error());

    Picture picture;
    picture.image = develop(*film, kGlow);
    picture.cover = cover_of(*film);
    picture.covered = covered_share(*film);
    picture.clipped = clipped_share(picture.image);
    picture.drawn_by = fmt::format("{}: {}", gl::to_string((*context)->kind()), (*context)->renderer());
    return picture;
}

}  // namespace xorvox::sim
