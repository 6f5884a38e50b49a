#include "voxelizer/gl/context.h"

#include <array>
#include <string>
#include <thread>

#include "tests/catch.h"
#include "tests/gl/required.h"

namespace xorvox {
namespace {

using gl::ContextKind;

/// Clears a framebuffer to `red` and reads it back: that calls really reach this context.
int red_after_clear(const gl::Context::Current& current, float red) {
    GLuint framebuffer = 0;
    GLuint target = 0;
    current->GenFramebuffers(1, &framebuffer);
    current->GenRenderbuffers(1, &target);
    current->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    current->BindRenderbuffer(GL_RENDERBUFFER, target);
    current->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 2, 2);
    current->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
    current->ClearColor(red, 0.0f, 0.0f, 1.0f);
    current->Clear(GL_COLOR_BUFFER_BIT);
    std::array<GLubyte, 16> pixels{};
    current->ReadPixels(0, 0, 2, 2, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    current->DeleteFramebuffers(1, &framebuffer);
    current->DeleteRenderbuffers(1, &target);
    CHECK(current->GetError() == GL_NO_ERROR);
    return pixels[0];
}

TEST_CASE("each kind of context draws") {
    const auto kind = GENERATE(ContextKind::Egl, ContextKind::Surfaceless, ContextKind::Osmesa);
    INFO(gl::to_string(kind));
    const auto context = gl::make_context(kind);
    XORVOX_NEED_GL(context);
    CHECK((*context)->kind() == kind);
    CHECK_FALSE((*context)->renderer().empty());
    const gl::Context::Current current(**context);
    REQUIRE(current);
    CHECK(red_after_clear(current, 1.0f) == 255);
}

TEST_CASE("automatic choice answers with a real kind") {
    const auto context = gl::make_context();
    XORVOX_NEED_GL(context);
    CHECK((*context)->kind() != ContextKind::Auto);
}

TEST_CASE("contexts of EGL and OSMesa take turns on a thread") {
    const auto egl = gl::make_context(ContextKind::Surfaceless);
    XORVOX_NEED_GL(egl);
    const auto osmesa = gl::make_context(ContextKind::Osmesa);
    XORVOX_NEED_GL(osmesa);
    for (int turn = 0; turn < 3; ++turn) {
        CHECK(red_after_clear(gl::Context::Current(**egl), 1.0f) == 255);
        CHECK(red_after_clear(gl::Context::Current(**osmesa), 1.0f) == 255);
    }
}

TEST_CASE("one context outlives another of its kind") {
    auto first = gl::make_context(ContextKind::Surfaceless);
    XORVOX_NEED_GL(first);
    const auto second = gl::make_context(ContextKind::Surfaceless);
    REQUIRE(second.has_value());
    first->reset();
    CHECK(red_after_clear(gl::Context::Current(**second), 1.0f) == 255);
}

TEST_CASE("a context moves to another thread") {
    const auto context = gl::make_context();
    XORVOX_NEED_GL(context);
    int red = 0;
    std::thread([&] { red = red_after_clear(gl::Context::Current(**context), 1.0f); }).join();
    CHECK(red == 255);
    CHECK(red_after_clear(gl::Context::Current(**context), 0.0f) == 0);
}

}  // namespace
}  // namespace xorvox
