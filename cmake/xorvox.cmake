# What all targets of xorvox share: the language, exact floating point, warnings, and how a module is declared.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(XORVOX_CCACHE ccache)
if(XORVOX_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Precompiled headers are cached only with this sloppiness (ccache's manual, "Precompiled headers").
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${XORVOX_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${XORVOX_CCACHE})
endif()

add_library(xorvox_options INTERFACE)
target_compile_features(xorvox_options INTERFACE cxx_std_20)
# The same bits from every compiler: no fused multiply-add that the source does not ask for.
target_compile_options(xorvox_options INTERFACE -ffp-contract=off)
if(XORVOX_DEVELOPER)
  target_compile_options(xorvox_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -Wno-missing-field-initializers
    -Werror)
endif()

# xorvox_module(NAME SOURCES … HEADERS … [LINK …] [PRIVATE_LINK …])
# A static library xorvox_NAME with alias xorvox::NAME. HEADERS are public: included, here and when installed, by their
# path from the root.
function(xorvox_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;LINK;PRIVATE_LINK" ${ARGN})
  set(target xorvox_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(xorvox::${name} ALIAS ${target})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
  set_target_properties(${target} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON EXPORT_NAME ${name})
  target_link_libraries(${target} PUBLIC ${ARG_LINK} PRIVATE $<BUILD_INTERFACE:xorvox_options> ${ARG_PRIVATE_LINK})
  target_compile_features(${target} PUBLIC cxx_std_20)
endfunction()
