# Files installed by `cmake --install`: the command, the libraries with their headers, and the files
# for find_package(chaintrue) in other projects.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/chaintrue)
set(libraries chaintrue_interp chaintrue_model chaintrue_grid)
foreach(library ${libraries})
  string(REPLACE chaintrue_ "" exported ${library})
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${exported})
endforeach()

if(TARGET chaintrue)
  install(TARGETS chaintrue RUNTIME COMPONENT command)
endif()
install(TARGETS ${libraries} EXPORT chaintrueTargets ARCHIVE COMPONENT library LIBRARY COMPONENT library)
install(DIRECTORY ${PROJECT_BINARY_DIR}/include/chaintrue
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
install(EXPORT chaintrueTargets NAMESPACE chaintrue:: DESTINATION ${package_dir} COMPONENT library)

configure_package_config_file(tools/cmake/chaintrueConfig.cmake.in
  ${PROJECT_BINARY_DIR}/chaintrueConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/chaintrueConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/chaintrueConfig.cmake
  ${PROJECT_BINARY_DIR}/chaintrueConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT library)
