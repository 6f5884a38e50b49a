// Context: OpenGL 4.5 core without a window, on a graphics card or in software.
//
// The libraries are opened when a context is asked for: programs start, and do all else, where there is no OpenGL. The
// result of drawing is read back from framebuffer objects; a context has no picture of its own.
//
//   egl           EGL on a device: graphics cards first, Mesa's software renderer last
//   surfaceless   EGL on Mesa's surfaceless platform
//   osmesa        OSMesa: software, and no EGL needed
//   auto          the first of these that works
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/gl/functions.h"

namespace xorvox::gl {

enum class ContextKind { Auto, Egl, Surfaceless, Osmesa };

/// "auto", "egl", "surfaceless", "osmesa".
constexpr std::string_view to_string(ContextKind kind) {
    switch (kind) {
        case ContextKind::Auto: return "auto";
        case ContextKind::Egl: return "egl";
        case ContextKind::Surfaceless: return "surfaceless";
        case ContextKind::Osmesa: return "osmesa";
    }
    return "unknown";
}

/// One context. It is current only while a Current of it lives, and on that thread alone. EGL and OSMesa share one
/// dispatch table in Mesa: with two of them current at once, every call silently does nothing. So a thread never holds
/// two Currents at a time, and drops the one before it makes or destroys a context.
class Context {
public:
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes the context current as long as it lives.
    class Current {
    public:
        explicit Current(Context& context) : context_(context), ok_(context.bind()) {}
        ~Current() { context_.unbind(); }
        Current(const Current&) = delete;
        Current& operator=(const Current&) = delete;

        /// False: the driver refused (the context is current on another thread, or the device is lost).
        explicit operator bool() const { return ok_; }
        const Functions* operator->() const { return &context_.functions_; }

    private:
        Context& context_;
        bool ok_;
    };

    ContextKind kind() const { return kind_; }                 ///< Never Auto.
    const std::string& renderer() const { return renderer_; }  ///< GL_RENDERER: "llvmpipe (LLVM 15.0.6, 256 bits)".

protected:
    explicit Context(ContextKind kind) : kind_(kind) {}
    using Loader = void (*(*)(const char*))();
    /// Makes the context current once, fills functions_ and renderer_. What is missing, or nothing.
    Expected<void> load(Loader get_address);

private:
    virtual bool bind() = 0;
    virtual void unbind() = 0;

    ContextKind kind_;
    std::string renderer_;
    Functions functions_;
};

/// A new context, not current. The message of an error says what was tried, what each answered, and what to install.
Expected<std::unique_ptr<Context>> make_context(ContextKind kind = ContextKind::Auto);

}  // namespace xorvox::gl
