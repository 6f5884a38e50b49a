# Who may include whom. cmake -DROOT=… -P check_includes.cmake fails with every include that the table forbids.
cmake_policy(VERSION 3.25)

# The module of a file, by its path from the root; the first pattern that matches.
function(module_of path out)
  set(patterns
    "^voxelizer/status\\.h$" status        "^voxelizer/error\\.h$" error
    "^voxelizer/io/" io                    "^voxelizer/gl/" gl                "^voxelizer/" core
    "^transport/(link\\.h|lines\\.h|framing\\.)" link                                   "^transport/" transport
    "^driver/display/description\\.h$" description                            "^driver/display/" display
    "^driver/wire/" wire                   "^driver/device/" device           "^driver/host/" host
    "^sim/" sim                            "^(tools|tests|examples)/" top)
  while(patterns)
    list(POP_FRONT patterns pattern module)
    if(path MATCHES "${pattern}")
      set(${out} ${module} PARENT_SCOPE)
      return()
    endif()
  endwhile()
  set(${out} "" PARENT_SCOPE)
endfunction()

# Each module may include itself, status and description, and:
set(may_core error)                       # error.h only in the hosted conveniences; the Cortex-M test compiles the rest
set(may_io core error)
set(may_gl core error)
set(may_link)
set(may_transport link error)
set(may_wire)
set(may_display core error)
set(may_host core error display wire link)
set(may_device wire link)
set(may_sim core error display wire device link transport gl)  # never host
set(may_status)
set(may_error)
set(may_description)
set(may_top core error io gl link transport display wire host device sim top)

# Modules that firmware compiles include nothing but these from outside.
set(freestanding status description link wire device)
# immintrin.h is the compiler's own; its file is empty but on x86 with an operating system.
set(freestanding_headers algorithm array atomic bit concepts cstddef cstdint cstring immintrin.h
  limits span string_view type_traits utility)

file(GLOB_RECURSE files RELATIVE ${ROOT}
  ${ROOT}/voxelizer/*.h ${ROOT}/voxelizer/*.cpp ${ROOT}/transport/*.h ${ROOT}/transport/*.cpp
  ${ROOT}/driver/*.h ${ROOT}/driver/*.cpp ${ROOT}/sim/*.h ${ROOT}/sim/*.cpp ${ROOT}/tools/*.h ${ROOT}/tools/*.cpp)
set(violations "")
set(checked 0)
foreach(file ${files})
  module_of(${file} module)
  file(STRINGS ${ROOT}/${file} includes REGEX "^[ \t]*#[ \t]*include[ \t]")
  foreach(line ${includes})
    math(EXPR checked "${checked} + 1")
    if(line MATCHES "<([^>]+)>")
      if(EXISTS ${ROOT}/${CMAKE_MATCH_1})
        set(line "\"${CMAKE_MATCH_1}\"")  # ours, whichever brackets it stands in
      endif()
    endif()
    if(line MATCHES "\"([^\"]+)\"")
      set(target ${CMAKE_MATCH_1})
      module_of(${target} target_module)
      if(NOT EXISTS ${ROOT}/${target} OR target_module STREQUAL "")
        string(APPEND violations "${file}: includes \"${target}\", which is no path from the root\n")
      elseif(NOT target_module IN_LIST may_${module} AND NOT target_module STREQUAL module
             AND NOT target_module STREQUAL status AND NOT target_module STREQUAL description)
        string(APPEND violations "${file}: module ${module} may not include ${target_module} (\"${target}\")\n")
      elseif(module STREQUAL status)
        string(APPEND violations "${file}: status includes nothing of ours\n")
      endif()
    elseif(line MATCHES "<([^>]+)>")
      set(target ${CMAKE_MATCH_1})
      if(module IN_LIST freestanding AND NOT target IN_LIST freestanding_headers)
        string(APPEND violations "${file}: module ${module} is firmware and may not include <${target}>\n")
      elseif(target MATCHES "^hwy/" AND NOT file MATCHES "^voxelizer/kernels/")
        string(APPEND violations "${file}: only voxelizer/kernels may include <${target}>\n")
      endif()
    endif()
  endforeach()
endforeach()
if(violations)
  message(NOTICE "${violations}")  # as it is: FATAL_ERROR would wrap the lines
  message(FATAL_ERROR "these includes are forbidden")
endif()
if(checked LESS 1)
  message(FATAL_ERROR "no include was found under ${ROOT}")
endif()
message(STATUS "${checked} includes obey the table")
