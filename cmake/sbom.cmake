# meshorder_sbom(<file> [TARGETS …] [ARGUMENTS …]): the file lists, as CycloneDX, the libraries that the targets are
# made of. packaging/sbom.py writes the file from Ninja's data after the targets are built; other generators get no
# file.
function(meshorder_sbom file)
  cmake_parse_arguments(SBOM "" "" "TARGETS;ARGUMENTS" ${ARGN})
  find_package(Python3 3.9 COMPONENTS Interpreter)
  if(NOT CMAKE_GENERATOR STREQUAL "Ninja" OR NOT Python3_Interpreter_FOUND)
    message(STATUS "No list of the libraries inside (SBOM): Ninja and Python make it")
    return()
  endif()
  set(script ${PROJECT_SOURCE_DIR}/packaging/sbom.py)
  add_custom_command(
    OUTPUT ${file}
    COMMAND ${Python3_EXECUTABLE} ${script} ${CMAKE_BINARY_DIR} ${PROJECT_VERSION} ${file} ${SBOM_ARGUMENTS}
    DEPENDS ${SBOM_TARGETS} ${script}
    COMMENT "Listing the libraries inside"
    VERBATIM)
  add_custom_target(meshorder_sbom ALL DEPENDS ${file})
endfunction()
