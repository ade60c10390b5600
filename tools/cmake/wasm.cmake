# The command for a browser: Debian's emscripten 3.1.6, and the libraries' headers from a separate
# folder, so that none of the C library's headers in /usr/include are found.
set(page_headers ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${page_headers})
foreach(library CLI fast_float fmt nlohmann tl)
  if(NOT EXISTS /usr/include/${library})
    message(FATAL_ERROR "/usr/include/${library} was not found: run tools/page, which installs what it needs")
  endif()
  file(CREATE_LINK /usr/include/${library} ${page_headers}/${library} SYMBOLIC)
endforeach()

# Eigen's SSE2 packets run on WebAssembly's, two doubles wide as on any x86-64: sums are accumulated
# in the same order. Eigen takes clang for a gcc with inline assembly for loads, and includes an MMX
# header that is not needed here.
if(NOT EXISTS ${page_headers}/eigen3/Eigen/Core)
  file(COPY /usr/include/eigen3/Eigen DESTINATION ${page_headers}/eigen3)
  file(APPEND ${page_headers}/eigen3/Eigen/src/Core/util/Macros.h "\n#undef EIGEN_COMP_GNUC\n#define EIGEN_COMP_GNUC 0\n")
endif()
if(NOT EXISTS ${page_headers}/mmintrin.h)
  file(WRITE ${page_headers}/mmintrin.h "#pragma once\n")
endif()

function(chaintrue_headers_only name)
  add_library(${name} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${name} SYSTEM INTERFACE ${page_headers} ${ARGN})
endfunction()
chaintrue_headers_only(Eigen3::Eigen ${page_headers}/eigen3)
chaintrue_headers_only(nlohmann_json::nlohmann_json)
chaintrue_headers_only(CLI11::CLI11)
chaintrue_headers_only(tl::expected)
chaintrue_headers_only(fast_float::fast_float)

# LLVM 14 miscompiles sums that it vectorises by twos (the derivative of a reading with an eccentric
# sprocket; shown by contracts_tests of tools/page --suite): only Eigen's own packets are used.
add_compile_options(-fwasm-exceptions -msimd128 -msse2 -fno-slp-vectorize)
add_link_options(-fwasm-exceptions)

# fmt's functions once instead of in every translation unit: a third of the compile time.
add_library(chaintrue_fmt STATIC ${CMAKE_CURRENT_LIST_DIR}/fmt_instances.cpp)
target_compile_features(chaintrue_fmt PUBLIC cxx_std_20)
target_include_directories(chaintrue_fmt SYSTEM PUBLIC ${page_headers})
add_library(fmt::fmt ALIAS chaintrue_fmt)

# chaintrue_link_for_pages(target): a script that makes instances of the command, each with files in
# memory.
function(chaintrue_link_for_pages target)
  target_link_options(${target} PRIVATE
    -sMODULARIZE -sEXPORT_NAME=createChaintrue -sENVIRONMENT=web,worker,node -sINVOKE_RUN=0 -sEXIT_RUNTIME
    -sALLOW_MEMORY_GROWTH -sTOTAL_STACK=8388608 -sFORCE_FILESYSTEM
    -sNODEJS_CATCH_EXIT=0 -sNODEJS_CATCH_REJECTION=0 -sEXPORTED_RUNTIME_METHODS=FS,callMain)
endfunction()
