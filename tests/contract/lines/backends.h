// The backends that the contract suite for lines runs on. A new backend is added to backends.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "transport/lines.h"

namespace xorvox::transport {

/// Open lines, and what stands at their other end.
struct Wires {
    std::string backend;         ///< Its name, for messages.
    std::shared_ptr<void> keep;  ///< What the lines use; goes last.
    UniqueLines lines;           ///< At least four outputs, at safe levels of which one is high, and one input, low.
    LineMask safe_levels = 0;
    std::function<LineMask()> seen;  ///< The outputs' levels at the other end, also after close().
    std::function<void(std::uint32_t line, bool level)> drive;  ///< Puts a level on an input.
    std::uint32_t most_edges = 0;                               ///< Of an input, that wait to be taken.
};

struct LinesBackend {
    std::string name;
    std::function<Wires()> open;
};

const std::vector<LinesBackend>& lines_backends();

}  // namespace xorvox::transport
