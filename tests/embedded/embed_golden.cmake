# cmake -DIN=conversation.hex -DOUT=golden_conversation.h -P embed_golden.cmake: a golden conversation (the format is in
# tests/golden/golden.h) as constant arrays for firmware.
file(STRINGS ${IN} lines)
set(bytes "")
set(steps "")
set(offset 0)
set(kind "")

macro(finish_packet)
  if(kind)
    string(APPEND steps "    {'${kind}', ${offset}, ${count}},\n")
    math(EXPR offset "${offset} + ${count}")
    set(kind "")
  endif()
endmacro()

foreach(line ${lines})
  string(REGEX REPLACE "#.*" "" line "${line}")
  if(line MATCHES "^at ([0-9]+)")
    set(time ${CMAKE_MATCH_1})
    finish_packet()
    string(APPEND steps "    {'@', ${time}u, 0},\n")
  elseif(line MATCHES "^boundary")
    finish_packet()
    string(APPEND steps "    {'|', 0, 0},\n")
  elseif(line MATCHES "^[<>]")
    string(SUBSTRING "${line}" 0 1 direction)
    finish_packet()
    set(kind ${direction})
    set(count 0)
  endif()
  if(kind)
    string(REGEX MATCHALL " [0-9a-f][0-9a-f]" digits "${line}")
    foreach(digit ${digits})
      string(STRIP ${digit} digit)
      string(APPEND bytes "0x${digit},")
      math(EXPR count "${count} + 1")
    endforeach()
    string(APPEND bytes "\n")
  endif()
endforeach()
finish_packet()

file(WRITE ${OUT} "// Made from tests/golden/conversation.hex.
#pragma once

#include <cstdint>

struct GoldenStep {
    char kind;             // '@': at, '|': boundary, '>': host to device, '<': device to host
    std::uint64_t number;  // '@': nanoseconds; packets: offset in kGoldenBytes
    std::uint32_t bytes;
};

inline constexpr std::uint8_t kGoldenBytes[] = {
${bytes}};

inline constexpr GoldenStep kGoldenSteps[] = {
${steps}};
")
