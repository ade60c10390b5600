# The tests of interp, model and grid compiled to WebAssembly, under node: tools/page --suite.

# GoogleTest from the sources of its Debian package.
set(googletest /usr/src/googletest)
if(NOT EXISTS ${googletest}/googlemock/src/gmock-all.cc)
  message(FATAL_ERROR "${googletest} was not found: run tools/page --suite, which installs what it needs")
endif()
foreach(library gtest gmock)
  file(CREATE_LINK /usr/include/${library} ${page_headers}/${library} SYMBOLIC)
endforeach()
# Levenberg and Marquardt of the laboratory's firmware.
file(COPY /usr/include/eigen3/unsupported DESTINATION ${page_headers}/eigen3)
add_library(chaintrue_googletest STATIC EXCLUDE_FROM_ALL
  ${googletest}/googletest/src/gtest-all.cc ${googletest}/googlemock/src/gmock-all.cc)
target_include_directories(chaintrue_googletest SYSTEM PUBLIC ${page_headers} PRIVATE ${googletest}/googletest ${googletest}/googlemock)
target_compile_features(chaintrue_googletest PUBLIC cxx_std_20)
add_library(GTest::gmock ALIAS chaintrue_googletest)

# Tests that start the command or threads: there are neither processes nor threads in one module.
function(chaintrue_leave_out_processes list)
  foreach(source ${${list}})
    file(STRINGS ${source} processes REGEX "command_fixture\\.hpp|<thread>|CHAINTRUE_COMMAND")
    if(processes)
      list(REMOVE_ITEM ${list} ${source})
    endif()
  endforeach()
  set(${list} ${${list}} PARENT_SCOPE)
endfunction()

add_custom_target(wasm_suite)
# Not as in Emscripten's own module: its options are those of the first node versions with WebAssembly.
find_program(CHAINTRUE_NODE node REQUIRED)

# Without the linker's own optimiser: it takes longer than the tests gain.
function(chaintrue_run_under_node target)
  target_link_options(${target} PRIVATE -O0 -sASSERTIONS=0 -sENVIRONMENT=node -sNODERAWFS -sWASM_ASYNC_COMPILATION=0 -sEXIT_RUNTIME -sALLOW_MEMORY_GROWTH
    -sTOTAL_STACK=8388608)
  set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON CROSSCOMPILING_EMULATOR ${CHAINTRUE_NODE})
  add_dependencies(wasm_suite ${target})
endfunction()
