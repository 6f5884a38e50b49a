#include "sim/label.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include <glm/vec4.hpp>

namespace xorvox::sim {
namespace {

constexpr glm::vec4 kInk(0.16f, 0.18f, 0.22f, 0.0f);
constexpr std::uint32_t kAdvance = 6;  ///< Five columns and a gap.

struct Letter {
    char letter;
    std::array<std::string_view, kLabelHeight> rows;
};

constexpr Letter kAlphabet[] = {
    {'d', {"    #", "    #", " ## #", "#  ##", "#   #", "#  ##", " ## #", "     ", "     "}},
    {'e', {"     ", "     ", " ### ", "#   #", "#####", "#    ", " ### ", "     ", "     "}},
    {'f', {"  ## ", " #   ", "#### ", " #   ", " #   ", " #   ", " #   ", "     ", "     "}},
    {'i', {"  #  ", "     ", " ##  ", "  #  ", "  #  ", "  #  ", " ### ", "     ", "     "}},
    {'n', {"     ", "     ", "# ## ", "##  #", "#   #", "#   #", "#   #", "     ", "     "}},
    {'o', {"     ", "     ", " ### ", "#   #", "#   #", "#   #", " ### ", "     ", "     "}},
    {'p', {"     ", "     ", "# ## ", "##  #", "#   #", "##  #", "# ## ", "#    ", "#    "}},
    {'r', {"     ", "     ", "# ## ", "##  #", "#    ", "#    ", "#    ", "     ", "     "}},
    {'s', {"     ", "     ", " ####", "#    ", " ### ", "    #", "#### ", "     ", "     "}},
    {'t', {" #   ", " #   ", "#### ", " #   ", " #   ", " #   ", "  ## ", "     ", "     "}},
};

}  // namespace

void draw_label(Film& film, std::string_view text, std::uint32_t column, std::uint32_t row, std::uint32_t size) {
    for (const char letter : text) {
        const auto* known = std::ranges::find(kAlphabet, letter, &Letter::letter);
        for (std::uint32_t y = 0; known != std::end(kAlphabet) && y < kLabelHeight * size; ++y) {
            const std::string_view pixels = known->rows[y / size];
            for (std::uint32_t x = 0; x < pixels.size() * size; ++x) {
                if (pixels[x / size] == ' ' || row + y >= film.height || column + x >= film.width) continue;
                film.pixels[std::size_t{row + y} * film.width + column + x] += kInk;
            }
        }
        column += kAdvance * size;
    }
}

}  // namespace xorvox::sim
