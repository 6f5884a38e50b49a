// Error and Expected: how the hosted parts (io, display files, host, link backends, sim, tools) report what went wrong.
//
// Hosted only: it allocates. Every hosted module may include it; the core, wire, device and the freestanding part of
// transport use Status instead.
#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace xorvox {

/// A failure in words for the person at the keyboard: what happened, where (file, line or byte offset), what was found
/// and what to do. One line, no trailing full stop, no newline.
struct Error {
    std::string message;
};

template <class T>
using Expected = tl::expected<T, Error>;

/// `return fail("…")` from a function that returns an Expected.
inline tl::unexpected<Error> fail(std::string message) {
    return tl::unexpected<Error>(Error{std::move(message)});
}

}  // namespace xorvox
