# meshorder_headers(<library> <header> <folder>): a target <library>::<library> of a library's headers alone. It uses a
# link to their folder, since the folder above, /usr/include, has the headers of another system.
function(meshorder_headers library header name)
  find_path(${library}_HEADERS ${header} PATHS /usr/include /usr/local/include PATH_SUFFIXES ${name}
            NO_CMAKE_FIND_ROOT_PATH)
  mark_as_advanced(${library}_HEADERS)
  set(${library}_FOUND OFF PARENT_SCOPE)
  if(${library}_HEADERS)
    set(folder ${CMAKE_BINARY_DIR}/headers)
    file(MAKE_DIRECTORY ${folder})
    file(CREATE_LINK ${${library}_HEADERS} ${folder}/${name} SYMBOLIC)
    add_library(${library}::${library} INTERFACE IMPORTED)
    target_include_directories(${library}::${library} INTERFACE ${folder})
    set(${library}_FOUND ON PARENT_SCOPE)
  endif()
endfunction()
