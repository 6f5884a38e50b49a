#include "tests/contract/lines/backends.h"

#include <memory>

#include "transport/virtual_lines.h"

namespace xorvox::transport {
namespace {

constexpr LineMask kOutputs = 0xf0;
constexpr LineMask kInputs = 0x03;
constexpr LineMask kSafe = 0x40;
constexpr std::uint32_t kMostEdges = 16;

/// With `without_options`, what is optional is not there.
Wires open_lines(bool without_options) {
    const auto lines = std::make_shared<VirtualLines>(VirtualLinesOptions{
        .outputs = kOutputs, .inputs = kInputs, .set_hz = 10'000'000, .safe_levels = kSafe, .edges_kept = kMostEdges});
    Wires wires;
    wires.keep = lines;
    Lines opened = lines->lines();
    if (without_options) {
        static LinesOperations least;
        least = *opened.operations;
        least.write = nullptr;
        least.strobe = nullptr;
        least.join = nullptr;
        least.edges = nullptr;
        least.wait = nullptr;
        opened.operations = &least;
    }
    wires.lines = UniqueLines(opened);
    wires.safe_levels = kSafe;
    wires.seen = [lines] { return lines->levels() & kOutputs; };
    wires.drive = [lines](std::uint32_t line, bool level) { lines->drive(line, level); };
    wires.most_edges = kMostEdges;
    return wires;
}

}  // namespace

const std::vector<LinesBackend>& lines_backends() {
    static const std::vector<LinesBackend> all = {
        {"virtual", [] { return open_lines(false); }},
        {"virtual, without what is optional", [] { return open_lines(true); }},
    };
    return all;
}

}  // namespace xorvox::transport
