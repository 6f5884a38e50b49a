// OSMesa, from its library's documented binary interface: distributions that have no OSMesa any more have no header
// either.
#include <array>
#include <cstddef>

#include "voxelizer/gl/backends.h"

namespace xorvox::gl {
namespace {

constexpr std::array<const char*, 4> kLibraries = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so.9",
                                                   "libOSMesa.so"};

constexpr int kFormat = 0x22;
constexpr int kRgba = 0x1908;
constexpr int kProfile = 0x33;
constexpr int kCoreProfile = 0x34;
constexpr int kMajorVersion = 0x36;
constexpr int kMinorVersion = 0x37;

struct Osmesa {
    void* (*create)(const int* attributes, void* share) = nullptr;
    void (*destroy)(void* context) = nullptr;
    unsigned char (*make_current)(void* context, void* buffer, unsigned type, int width, int height) = nullptr;
    void (*(*get_address)(const char* name))() = nullptr;
};

class OsmesaContext final : public Context {
public:
    OsmesaContext(const Osmesa& osmesa, void* context)
        : Context(ContextKind::Osmesa), osmesa_(osmesa), context_(context) {}
    ~OsmesaContext() override { osmesa_.destroy(context_); }

    Expected<void> load_functions() { return load(osmesa_.get_address); }

private:
    bool bind() override { return osmesa_.make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSide, kSide) != 0; }
    void unbind() override { osmesa_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }

    static constexpr int kSide = 4;  ///< Of the picture that OSMesa insists on; drawing goes to framebuffer objects.
    Osmesa osmesa_;
    void* context_;
    std::array<std::byte, 4 * kSide * kSide> buffer_{};
};

}  // namespace

Expected<std::unique_ptr<Context>> make_osmesa_context() {
    void* library = nullptr;
    for (const char* name : kLibraries) {
        library = open_library(name);
        if (library != nullptr) break;
    }
    if (library == nullptr) return fail("libOSMesa is not installed");

    Osmesa osmesa;
    if (!find_function(library, "OSMesaCreateContextAttribs", osmesa.create) ||
        !find_function(library, "OSMesaDestroyContext", osmesa.destroy) ||
        !find_function(library, "OSMesaMakeCurrent", osmesa.make_current) ||
        !find_function(library, "OSMesaGetProcAddress", osmesa.get_address)) {
        return fail("libOSMesa is older than version 11.2");
    }
    constexpr std::array<int, 9> attributes = {kFormat,       kRgba, kProfile, kCoreProfile, kMajorVersion, 4,
                                               kMinorVersion, 5,     0};
    void* created = osmesa.create(attributes.data(), nullptr);
    if (created == nullptr) return fail("libOSMesa has no OpenGL 4.5 core");
    auto context = std::make_unique<OsmesaContext>(osmesa, created);
    if (auto loaded = context->load_functions(); !loaded) return tl::unexpected(loaded.error());
    return context;
}

}  // namespace xorvox::gl
