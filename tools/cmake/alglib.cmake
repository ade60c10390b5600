# Debian's ALGLIBConfig.cmake sets variables only; this makes them one imported target.
find_package(ALGLIB REQUIRED CONFIG)
if(NOT TARGET ALGLIB::ALGLIB)
  find_library(CHAINTRUE_ALGLIB_LIBRARY alglib REQUIRED)
  add_library(ALGLIB::ALGLIB UNKNOWN IMPORTED)
  set_target_properties(ALGLIB::ALGLIB PROPERTIES IMPORTED_LOCATION ${CHAINTRUE_ALGLIB_LIBRARY})
endif()
