# Writes OUTPUT, a C++ file that defines xorvox::presets(), from the display files in the list PRESETS.
#   cmake -D OUTPUT=presets.cpp "-D PRESETS=a.toml;b.toml" -P embed_presets.cmake
set(entries "")
foreach(file IN LISTS PRESETS)
  get_filename_component(name "${file}" NAME_WE)
  file(STRINGS "${file}" summary REGEX "^summary = \"[^\"\\]+\"$")
  if(NOT summary MATCHES "^summary = (\"[^\"]+\")$")
    message(FATAL_ERROR "${file}: a preset needs one line: summary = \"…\", without escapes")
  endif()
  set(summary "${CMAKE_MATCH_1}")
  file(READ "${file}" text)
  string(APPEND entries "        {\"${name}\", ${summary}, R\"toml(${text})toml\"},\n")
endforeach()
file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [[
// Made by embed_presets.cmake from driver/display/presets/*.toml.
#include "driver/display/toml.h"

namespace xorvox {

const std::vector<Preset>& presets() {
    static const std::vector<Preset> all = {
@entries@    };
    return all;
}

}  // namespace xorvox
]])
