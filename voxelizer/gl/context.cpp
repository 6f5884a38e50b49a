#include "voxelizer/gl/context.h"

#include <array>
#include <utility>

#include "voxelizer/gl/backends.h"

namespace xorvox::gl {
namespace {

using Maker = Expected<std::unique_ptr<Context>> (*)();

struct Way {
    ContextKind kind;
    Maker make;
};

constexpr std::array<Way, 3> kWays = {{{ContextKind::Egl, make_egl_device_context},
                                       {ContextKind::Surfaceless, make_egl_surfaceless_context},
                                       {ContextKind::Osmesa, make_osmesa_context}}};

}  // namespace

Expected<void> Context::load(Loader get_address) {
    const Current current(*this);
    if (!current) return fail("the context cannot be made current");
    const auto find = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(get_address(name));
        return function != nullptr;
    };
#define XORVOX_GL_LOAD(type, name) \
    if (!find(functions_.name, "gl" #name)) return fail("it has no function gl" #name);
    XORVOX_GL_FUNCTIONS(XORVOX_GL_LOAD)
#undef XORVOX_GL_LOAD

    // Mesa answers calls of a context that is not really current with nothing at all.
    const GLubyte* renderer = functions_.GetString(GL_RENDERER);
    if (renderer == nullptr) return fail("it does not answer calls");
    renderer_ = reinterpret_cast<const char*>(renderer);
    return {};
}

Expected<std::unique_ptr<Context>> make_context(ContextKind kind) {
    std::string tried;
    for (const Way& way : kWays) {
        if (kind != ContextKind::Auto && kind != way.kind) continue;
        auto context = way.make();
        if (context) return context;
        if (!tried.empty()) tried += "; ";
        tried += std::string(to_string(way.kind)) + ": " + context.error().message;
    }
    return fail("no OpenGL 4.5 core context (" + tried +
                "); install libegl1 and libgl1-mesa-dri, or libosmesa6, for OpenGL in software");
}

}  // namespace xorvox::gl
