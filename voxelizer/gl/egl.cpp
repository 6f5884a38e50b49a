#define EGL_NO_X11
#define MESA_EGL_NO_X11_HEADERS
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "voxelizer/gl/backends.h"

namespace xorvox::gl {
namespace {

struct Egl {
    PFNEGLGETPROCADDRESSPROC get_address = nullptr;
    PFNEGLINITIALIZEPROC initialize = nullptr;
    PFNEGLBINDAPIPROC bind_api = nullptr;
    PFNEGLQUERYSTRINGPROC query_string = nullptr;
    PFNEGLCREATECONTEXTPROC create_context = nullptr;
    PFNEGLDESTROYCONTEXTPROC destroy_context = nullptr;
    PFNEGLMAKECURRENTPROC make_current = nullptr;
    PFNEGLGETERRORPROC get_error = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;
    // Of EGL_EXT_device_enumeration and EGL_EXT_device_query; null without them.
    PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;
    PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string = nullptr;
};

bool has_word(const char* words, std::string_view word) {
    const std::string spaced = " " + std::string(words == nullptr ? "" : words) + " ";
    return spaced.find(" " + std::string(word) + " ") != std::string::npos;
}

Expected<Egl> open_egl() {
    void* library = open_library("libEGL.so.1");
    if (library == nullptr) return fail("libEGL.so.1 is not installed");
    Egl egl;
    if (!find_function(library, "eglGetProcAddress", egl.get_address) ||
        !find_function(library, "eglInitialize", egl.initialize) ||
        !find_function(library, "eglBindAPI", egl.bind_api) ||
        !find_function(library, "eglQueryString", egl.query_string) ||
        !find_function(library, "eglCreateContext", egl.create_context) ||
        !find_function(library, "eglDestroyContext", egl.destroy_context) ||
        !find_function(library, "eglMakeCurrent", egl.make_current) ||
        !find_function(library, "eglGetError", egl.get_error)) {
        return fail("libEGL.so.1 is older than EGL 1.4");
    }
    const char* extensions = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const auto find_extension = [&](const char* name, auto& function) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(egl.get_address(name));
    };
    if (has_word(extensions, "EGL_EXT_platform_base")) {
        find_extension("eglGetPlatformDisplayEXT", egl.get_platform_display);
    }
    if (has_word(extensions, "EGL_EXT_device_enumeration") || has_word(extensions, "EGL_EXT_device_base")) {
        find_extension("eglQueryDevicesEXT", egl.query_devices);
        find_extension("eglQueryDeviceStringEXT", egl.query_device_string);
    }
    if (egl.get_platform_display == nullptr) return fail("EGL knows no platforms (EGL_EXT_platform_base is missing)");
    return egl;
}

class EglContext final : public Context {
public:
    EglContext(ContextKind kind, const Egl& egl, EGLDisplay display, EGLContext context)
        : Context(kind), egl_(egl), display_(display), context_(context) {}
    /// The display stays: it is the process's, and others may be using it.
    ~EglContext() override { egl_.destroy_context(display_, context_); }

    Expected<void> load_functions() { return load(egl_.get_address); }

private:
    bool bind() override {
        // The API is a setting of the thread.
        return egl_.bind_api(EGL_OPENGL_API) && egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
    }
    void unbind() override { egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

    Egl egl_;
    EGLDisplay display_;
    EGLContext context_;
};

std::string error_name(const Egl& egl) {
    constexpr std::string_view digits = "0123456789abcdef";
    const auto code = static_cast<unsigned>(egl.get_error());
    std::string name = "EGL error 0x";
    for (int shift = 12; shift >= 0; shift -= 4) name += digits[(code >> shift) & 0xf];
    return name;
}

Expected<std::unique_ptr<Context>> make_on(ContextKind kind, const Egl& egl, EGLenum platform, void* native) {
    const EGLDisplay display = egl.get_platform_display(platform, native, nullptr);
    if (display == EGL_NO_DISPLAY) return fail("no display (" + error_name(egl) + ")");
    if (!egl.initialize(display, nullptr, nullptr)) return fail("no driver (" + error_name(egl) + ")");
    const char* extensions = egl.query_string(display, EGL_EXTENSIONS);
    for (const char* needed : {"EGL_KHR_surfaceless_context", "EGL_KHR_no_config_context"}) {
        if (!has_word(extensions, needed)) return fail(std::string("no ") + needed);
    }
    if (!egl.bind_api(EGL_OPENGL_API)) return fail("no OpenGL (" + error_name(egl) + ")");
    constexpr std::array<EGLint, 7> attributes = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    const EGLContext created = egl.create_context(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (created == EGL_NO_CONTEXT) return fail("no OpenGL 4.5 core (" + error_name(egl) + ")");
    auto context = std::make_unique<EglContext>(kind, egl, display, created);
    if (auto loaded = context->load_functions(); !loaded) return tl::unexpected(loaded.error());
    return context;
}

}  // namespace

Expected<std::unique_ptr<Context>> make_egl_device_context() {
    const Expected<Egl> egl = open_egl();
    if (!egl) return tl::unexpected(egl.error());
    if (egl->query_devices == nullptr || egl->query_device_string == nullptr) return fail("EGL lists no devices");

    std::array<EGLDeviceEXT, 32> found{};
    EGLint count = 0;
    if (!egl->query_devices(static_cast<EGLint>(found.size()), found.data(), &count)) {
        return fail("EGL lists no devices (" + error_name(*egl) + ")");
    }
    const auto devices_end = found.begin() + count;
    const auto in_software = [&](EGLDeviceEXT device) {
        return has_word(egl->query_device_string(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
    };
    std::stable_partition(found.begin(), devices_end, [&](EGLDeviceEXT device) { return !in_software(device); });
    std::string tried;
    for (auto device = found.begin(); device != devices_end; ++device) {
        auto context = make_on(ContextKind::Egl, *egl, EGL_PLATFORM_DEVICE_EXT, *device);
        if (context) return context;
        tried += (tried.empty() ? "device " : ", device ") + std::to_string(device - found.begin()) + ": " +
                 context.error().message;
    }
    return fail(tried.empty() ? "no devices" : tried);
}

Expected<std::unique_ptr<Context>> make_egl_surfaceless_context() {
    const Expected<Egl> egl = open_egl();
    if (!egl) return tl::unexpected(egl.error());
    if (!has_word(egl->query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless")) {
        return fail("EGL has no surfaceless platform");
    }
    return make_on(ContextKind::Surfaceless, *egl, EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
}

}  // namespace xorvox::gl
