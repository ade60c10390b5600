# chaintrue_add_linear_algebra_kernels(target): interp/linear_algebra_kernels.cpp, compiled for every x86-64 and
# for those with AVX2 and FMA; which of them runs is decided when the program starts. The second sees Eigen
# under a name of its own, so that it shares no inline function with anything else: the linker keeps one of
# each, and code for AVX2 would run where there is none. For the same reason neither gets the precompiled
# headers, nor is compiled together with other sources.
function(chaintrue_add_linear_algebra_kernels target)
  set(tables baseline)
  if(NOT EMSCRIPTEN AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
    list(APPEND tables avx2)
  endif()
  foreach(table ${tables})
    set(kernels ${target}_${table})
    add_library(${kernels} OBJECT ${CMAKE_CURRENT_SOURCE_DIR}/linear_algebra_kernels.cpp)
    target_include_directories(${kernels} PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${kernels} PRIVATE Eigen3::Eigen chaintrue_flags)
    target_compile_definitions(${kernels} PRIVATE CHAINTRUE_KERNELS=${table})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${kernels}>)
  endforeach()
  if(avx2 IN_LIST tables)
    target_compile_definitions(${target}_avx2 PRIVATE Eigen=EigenAvx2)
    target_compile_options(${target}_avx2 PRIVATE -mavx2 -mfma)
    set_source_files_properties(linear_algebra.cpp PROPERTIES COMPILE_DEFINITIONS CHAINTRUE_HAS_AVX2)
  endif()
endfunction()
