# Headers included by nearly every source, parsed once: half of the time of a cold build. Off, every
# file needs its own includes; the dev presets build so.
option(CHAINTRUE_PRECOMPILED_HEADERS "Parse the common headers once" ON)
# Sources compiled together, so that shared templates are compiled once: a quarter of the remaining
# time. Names in unnamed namespaces must differ within a folder. Off, a change of one file compiles
# that file only; the dev presets build so.
option(CHAINTRUE_UNITY_BUILD "Compile several sources of a library at a time" ON)

set(chaintrue_common_headers
  <algorithm> <array> <charconv> <cmath> <filesystem> <functional> <map> <memory> <optional> <set> <span> <string>
  <string_view> <tuple> <variant> <vector>
  <Eigen/Cholesky> <Eigen/Core> <Eigen/LU> <Eigen/QR> <fmt/format.h> <tl/expected.hpp>
  ${PROJECT_SOURCE_DIR}/tools/cmake/eigen_instances.hpp)

# chaintrue_precompile(NAME library header...): a library that contains only its precompiled
# headers, and chaintrue_common the code of eigen_instances.hpp.
function(chaintrue_precompile name libraries)
  set(content "namespace {}\n")
  if(name STREQUAL "chaintrue_common")
    set(content "CHAINTRUE_EIGEN_INSTANCES(template)\n")
  endif()
  file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "${content}")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE ${libraries} chaintrue_flags)
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

# chaintrue_use_precompiled(target library): the target's sources use the precompiled headers of the
# library.
function(chaintrue_use_precompiled target library)
  if(CHAINTRUE_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${library})
  endif()
endfunction()

# chaintrue_hold_instances(target): a library that uses no other library of the project contains the
# code of eigen_instances.hpp, for itself and for whatever links it.
function(chaintrue_hold_instances target)
  if(CHAINTRUE_PRECOMPILED_HEADERS)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:chaintrue_common>)
  endif()
endfunction()

# chaintrue_compile_together(target): its sources in batches of at most 12 files and 90 kB of text. They take about as long as each
# other, so that no core waits for a last one.
function(chaintrue_compile_together target)
  if(NOT CHAINTRUE_UNITY_BUILD)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  set(batch 0)
  set(files 0)
  set(bytes 0)
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE)
    set(size 0)
    if(EXISTS ${path})
      file(SIZE ${path} size)
    endif()
    math(EXPR files "${files} + 1")
    math(EXPR bytes "${bytes} + ${size}")
    if(files GREATER 12 OR bytes GREATER 90000)
      math(EXPR batch "${batch} + 1")
      set(files 1)
      set(bytes ${size})
    endif()
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${batch})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # A class with members of its source's unnamed namespace is as safe as in a separate compilation.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()

if(CHAINTRUE_PRECOMPILED_HEADERS)
  chaintrue_precompile(chaintrue_common "Eigen3::Eigen;fmt::fmt;tl::expected" ${chaintrue_common_headers})
endif()

# chaintrue_compile_lightly(target...): reading, printing and drawing take no time that anybody notices; optimised
# less, they need a fifth less compile time. The page is sent by mail: there they are optimised for size.
# A precompiled header brings the level that it was compiled with, so these have one of their own.
function(chaintrue_compile_lightly)
  if(EMSCRIPTEN)
    set(level -Os)
  elseif(CMAKE_BUILD_TYPE STREQUAL "Release")
    set(level -O1)
  endif()
  if(CHAINTRUE_PRECOMPILED_HEADERS AND NOT TARGET chaintrue_common_light)
    chaintrue_precompile(chaintrue_common_light "Eigen3::Eigen;fmt::fmt;tl::expected" ${chaintrue_common_headers})
    target_compile_options(chaintrue_common_light PRIVATE ${level})
  endif()
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE ${level})
    chaintrue_use_precompiled(${target} chaintrue_common_light)
  endforeach()
endfunction()
