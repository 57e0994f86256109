# meshorder_find_library(<target> <header> <names of the library> [suffix of the include folder]): libraries without a
# CMake file
function(meshorder_find_library target header libraries)
  if(TARGET ${target})
    return()
  endif()
  list(GET libraries 0 id)
  string(MAKE_C_IDENTIFIER ${id} id)
  string(TOUPPER ${id} id)
  find_path(${id}_INCLUDE_DIR ${header} PATH_SUFFIXES ${ARGN})
  find_library(${id}_LIBRARY NAMES ${libraries})
  mark_as_advanced(${id}_INCLUDE_DIR ${id}_LIBRARY)
  if(${id}_INCLUDE_DIR AND ${id}_LIBRARY)
    add_library(${target} UNKNOWN IMPORTED)
    set_target_properties(${target} PROPERTIES IMPORTED_LOCATION ${${id}_LIBRARY}
                                               INTERFACE_INCLUDE_DIRECTORIES ${${id}_INCLUDE_DIR})
  endif()
endfunction()
