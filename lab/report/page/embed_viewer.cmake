# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#
# Writes viewer_sources.cpp into the build folder: viewer/* and three.js are compiled into the program, which
# then needs no other files to make a page.
include(${PROJECT_SOURCE_DIR}/cmake/find_three.cmake)
if(NOT MESHORDER_THREE_JS)
  message(FATAL_ERROR "three.min.js is missing; the report page needs it to show meshes: install Debian's libjs-three, "
                      "or name the file by -DMESHORDER_THREE_JS=…")
endif()

# meshorder_read(<variable> <file>…) sets the variable to the files one after another; CMake runs again when
# one of them changes
function(meshorder_read variable)
  set(all "")
  foreach(file ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} text)
    string(APPEND all "${text}")
  endforeach()
  set(${variable} "${all}" PARENT_SCOPE)
endfunction()

set(viewer ${PROJECT_SOURCE_DIR}/viewer)
file(GLOB scripts CONFIGURE_DEPENDS ${viewer}/*.js) # by name
meshorder_read(MESHORDER_VIEWER_PAGE ${viewer}/page.html)
meshorder_read(MESHORDER_VIEWER_COMPARISON ${viewer}/comparison.html)
meshorder_read(MESHORDER_VIEWER_STYLE ${viewer}/style.css)
meshorder_read(MESHORDER_VIEWER_SCRIPTS ${scripts})
meshorder_read(MESHORDER_VIEWER_THREE ${viewer}/three_licence.txt ${MESHORDER_THREE_JS})
configure_file(${CMAKE_CURRENT_LIST_DIR}/viewer_sources.cpp.in viewer_sources.cpp @ONLY)
