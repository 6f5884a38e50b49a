// The ways to get a Context; private to this module.
#pragma once

#include <dlfcn.h>

#include <memory>

#include "voxelizer/gl/context.h"

namespace xorvox::gl {

Expected<std::unique_ptr<Context>> make_egl_device_context();
Expected<std::unique_ptr<Context>> make_egl_surfaceless_context();
Expected<std::unique_ptr<Context>> make_osmesa_context();

/// Opens a library so that its names stay its own (EGL's and OSMesa's OpenGL do not mix), and for good: Mesa does not
/// survive being unloaded. Null if it is not there; dlerror() says why.
inline void* open_library(const char* name) {
    return dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
}

/// Sets `function` to the library's function `name`; false if it has none.
template <class Function>
bool find_function(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    return function != nullptr;
}

}  // namespace xorvox::gl
