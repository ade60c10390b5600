# The pages of the libraries, from the comments of their headers: ninja -C build api, with Debian's
# doxygen (tools/setup does not install it: nothing else needs it).
find_program(CHAINTRUE_DOXYGEN doxygen)
if(NOT CHAINTRUE_DOXYGEN)
  add_custom_target(api COMMAND ${CMAKE_COMMAND} -E echo "doxygen is missing: apt install doxygen, then configure again" COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
  return()
endif()
configure_file(tools/cmake/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
# Where its warnings go; one fails the target.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/api)
add_custom_target(api COMMAND ${CHAINTRUE_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile DEPENDS chaintrue_public_headers VERBATIM)
if(CHAINTRUE_BUILD_TESTS)
  add_test(NAME consumer/api COMMAND ${CHAINTRUE_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile)
endif()
