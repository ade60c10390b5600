# Installs chaintrue into a new folder and builds a project that uses it, from that folder alone. Called by
# ctest with BUILD_DIR (of chaintrue), SOURCE_DIR (of the consumer), WORK_DIR, CXX, CXX_FLAGS.
function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed (${result}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run("installing" ${CMAKE_COMMAND} --install ${BUILD_DIR} --component library --prefix ${WORK_DIR}/prefix)
run("configuring" ${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -G Ninja
  -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${CXX_FLAGS})
run("building" ${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run("running" ${WORK_DIR}/build/consumer ${SOURCE_DIR}/../../fixtures/grids/seven_by_four.json ${WORK_DIR}/diagnosis.json)
message("${output}")
file(READ ${WORK_DIR}/diagnosis.json diagnosis)
if(NOT output MATCHES "left [0-9.]+ mm, right [0-9.]+ mm" OR NOT diagnosis MATCHES "\"file_type\": \"chaintrue_diagnosis\"")
  message(FATAL_ERROR "the consumer answered:\n${output}\nand wrote:\n${diagnosis}")
endif()

# The documentation shows exactly this program.
file(READ ${SOURCE_DIR}/main.cpp program)
file(READ ${SOURCE_DIR}/../../docs/library.md page)
string(FIND "${page}" "${program}" shown)
if(shown EQUAL -1)
  message(FATAL_ERROR "docs/library.md does not show tests/consumer/main.cpp as it is")
endif()

# Every installed header must be self-contained: it may include neither a file that was not installed nor a
# library that the package does not require.
file(GLOB_RECURSE headers RELATIVE ${WORK_DIR}/prefix/include/chaintrue ${WORK_DIR}/prefix/include/chaintrue/*.hpp)
foreach(header ${headers})
  file(STRINGS ${WORK_DIR}/prefix/include/chaintrue/${header} includes REGEX "^#include \"")
  foreach(line ${includes})
    string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" included "${line}")
    if(NOT EXISTS ${WORK_DIR}/prefix/include/chaintrue/${included})
      message(FATAL_ERROR "${header} includes \"${included}\", which is not installed")
    endif()
  endforeach()
  file(STRINGS ${WORK_DIR}/prefix/include/chaintrue/${header} foreign REGEX "^#include <(nlohmann|libalglib|CLI)/")
  if(foreign)
    message(FATAL_ERROR "${header}: ${foreign}, but the package does not need that library")
  endif()
endforeach()
