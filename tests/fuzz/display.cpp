// Arbitrary text as a display file: refused with a message of one line, or a description that is valid, can be written
// as C++, and gives a lattice and frames of bounded size.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "driver/display/cpp.h"
#include "driver/display/lattice.h"
#include "driver/display/toml.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto display = xorvox::parse_display(text, "fuzz.toml");
    const auto mistakes = xorvox::find_mistakes(text);
    if (display.has_value() != mistakes.empty()) std::abort();
    for (const xorvox::DisplayMistake& mistake : mistakes) {
        if (mistake.line < 1 || mistake.message.empty() || mistake.message.find('\n') != std::string::npos)
            std::abort();
    }
    if (!display) {
        const std::string& message = display.error().message;
        if (!message.starts_with("fuzz.toml:") || message.find('\n') != std::string::npos) std::abort();
        return 0;
    }
    if (!xorvox::validate_display(*display) || xorvox::frame_bytes(*display) > (std::size_t{1} << 30)) std::abort();
    if (xorvox::to_cpp(*display).find("display.kind") == std::string::npos) std::abort();
    if (display->slices > 256) return 0;  // Larger lattices are only slower.
    const xorvox::DisplayLattice lattice(*display);
    if (xorvox::validate(lattice.view()) != xorvox::Status::Ok) std::abort();
    if (lattice.view().column_count() != xorvox::lattice_columns(*display)) std::abort();
    if (lattice.view().sample_count() != xorvox::frame_pixels(*display)) std::abort();
    return 0;
}
