# The headers as users include them, <chaintrue/model/machine.hpp>, in build/include and, from there, in
# the installed package. Inside the project headers are included by their folder, "model/machine.hpp";
# in the copies these lines name the folder chaintrue too, so that a user's include path gets no folder
# with a name as common as "model".
#
# Included, it defines chaintrue_public_includes(target). Run with SOURCE_DIR and OUTPUT_DIR (cmake -P),
# it writes the copies; those that stay the same keep their time.
set(public_folders interp model grid)
set(private_headers "/(json_[a-z_]*|[a-z0-9_]*_record|[a-z_]*_keys|pattern|record_values|records|formats|printing[a-z_]*)\\.hpp$|/printing/")

function(chaintrue_find_public_headers source_dir result)
  set(found)
  foreach(folder ${public_folders})
    file(GLOB_RECURSE headers ${ARGN} RELATIVE ${source_dir} ${source_dir}/${folder}/*.hpp ${source_dir}/${folder}/*.def)
    list(APPEND found ${headers})
  endforeach()
  list(FILTER found EXCLUDE REGEX "${private_headers}")
  set(${result} ${found} PARENT_SCOPE)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE)
  chaintrue_find_public_headers(${SOURCE_DIR} headers)
  list(JOIN public_folders "|" folders)
  set(written)
  foreach(header ${headers})
    file(READ ${SOURCE_DIR}/${header} text)
    string(REGEX REPLACE "#include \"((${folders})/[^\"]+)\"" "#include <chaintrue/\\1>" text "${text}")
    # interp/interp.hpp includes the others: <chaintrue/interp.hpp>.
    set(name ${header})
    foreach(folder ${public_folders})
      if(header STREQUAL "${folder}/${folder}.hpp")
        set(name ${folder}.hpp)
      endif()
    endforeach()
    set(copy ${OUTPUT_DIR}/chaintrue/${name})
    set(before "")
    if(EXISTS ${copy})
      file(READ ${copy} before)
    endif()
    if(NOT "${before}" STREQUAL "${text}")
      file(WRITE ${copy} "${text}")
    endif()
    list(APPEND written ${copy})
  endforeach()
  file(GLOB_RECURSE copies ${OUTPUT_DIR}/chaintrue/*)
  list(REMOVE_ITEM copies ${written})
  foreach(copy ${copies})
    file(REMOVE ${copy})
  endforeach()
  return()
endif()

chaintrue_find_public_headers(${PROJECT_SOURCE_DIR} headers CONFIGURE_DEPENDS)
list(TRANSFORM headers PREPEND ${PROJECT_SOURCE_DIR}/)
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/public_headers.stamp
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DOUTPUT_DIR=${PROJECT_BINARY_DIR}/include
    -P ${CMAKE_CURRENT_LIST_FILE}
  COMMAND ${CMAKE_COMMAND} -E touch ${PROJECT_BINARY_DIR}/public_headers.stamp
  DEPENDS ${headers} ${CMAKE_CURRENT_LIST_FILE} VERBATIM)
add_custom_target(chaintrue_public_headers DEPENDS ${PROJECT_BINARY_DIR}/public_headers.stamp)

# Targets of this project see its sources, all others the copies.
define_property(TARGET PROPERTY CHAINTRUE_INSIDE INITIALIZE_FROM_VARIABLE CHAINTRUE_INSIDE)
set(CHAINTRUE_INSIDE ON)
function(chaintrue_public_includes target)
  set(inside $<BOOL:$<TARGET_PROPERTY:CHAINTRUE_INSIDE>>)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:$<IF:${inside},${PROJECT_SOURCE_DIR},${PROJECT_BINARY_DIR}/include>>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  add_dependencies(${target} chaintrue_public_headers)
endfunction()
