# The include check must see red: plants one violation of each kind in a copy and expects the check to name it.
foreach(case
    "sim/optics.cpp|#include \"driver/host/session.h\"|module sim may not include host"
    "sim/optics.cpp|#include <driver/host/session.h>|module sim may not include host"
    "driver/device/device.cpp|#include \"voxelizer/mesh.h\"|module device may not include core"
    "driver/wire/packet.cpp|#include <vector>|module wire is firmware and may not include <vector>"
    "transport/tcp.cpp|#include \"driver/wire/packet.h\"|module transport may not include wire"
    "voxelizer/solid.cpp|#include <hwy/highway.h>|only voxelizer/kernels may include"
    "driver/host/slices.cpp|#include \"packet.h\"|which is no path from the root")
  string(REPLACE "|" ";" case "${case}")
  list(GET case 0 file)
  list(GET case 1 line)
  list(GET case 2 expected)
  file(REMOVE_RECURSE ${WORK})
  foreach(folder voxelizer transport driver sim tools)
    file(COPY ${ROOT}/${folder} DESTINATION ${WORK} FILES_MATCHING PATTERN *.h PATTERN *.cpp)
  endforeach()
  file(APPEND ${WORK}/${file} "\n${line}\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${WORK} -P ${CMAKE_CURRENT_LIST_DIR}/check_includes.cmake
                  RESULT_VARIABLE result ERROR_VARIABLE output OUTPUT_VARIABLE output)
  string(FIND "${output}" "${expected}" found)
  if(result EQUAL 0 OR found EQUAL -1)
    message(FATAL_ERROR "planted '${line}' in ${file}; expected '${expected}', the check said:\n${output}")
  endif()
endforeach()
file(REMOVE_RECURSE ${WORK})
