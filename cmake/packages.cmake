# Debian packages: cmake --preset packages && cmake --build --preset packages && cpack --preset packages
# They hold the shared library. Distributors give their name by -DCPACK_PACKAGE_CONTACT="NAME <ADDRESS>".

find_program(MESHORDER_GZIP gzip)
find_program(MESHORDER_DPKG_DEB dpkg-deb)
mark_as_advanced(MESHORDER_GZIP MESHORDER_DPKG_DEB)
if(NOT MESHORDER_GZIP OR NOT MESHORDER_DPKG_DEB)
  return()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME meshorder)
set(CPACK_PACKAGE_CONTACT "The meshorder authors <authors@meshorder.invalid>" CACHE STRING "Maintainer of the packages")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own, the first line of its description
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL library c development command)
if(TARGET meshorder-lab)
  list(APPEND CPACK_COMPONENTS_ALL lab)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(minor ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(debian_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

# packages of the libraries that are loaded when a file needs them, which shlibdeps does not see
set(recommended "")
foreach(library IN LISTS loaded_libraries)
  string(REPLACE meshorder_ "" library ${library})
  get_target_property(path ${library}::${library} IMPORTED_LOCATION)
  file(REAL_PATH ${path} path)
  execute_process(COMMAND dpkg -S ${path} OUTPUT_VARIABLE owner ERROR_QUIET)
  if(owner MATCHES "^([^:]+):")
    list(APPEND recommended ${CMAKE_MATCH_1})
  endif()
endforeach()
list(JOIN recommended ", " recommended)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS ${recommended})
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS ${recommended})

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libmeshorder${minor})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION
    "orders of meshes and sparse matrices, C++ library
meshorder reorders the vertices and elements of simulation meshes so that
neighbours in the mesh are neighbours in memory. This is the shared library
for programs in C++. Its binary interface changes with each minor version.")

# CPack's own scripts run ldconfig as well
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/debian/triggers)
set(CPACK_DEBIAN_C_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/debian/triggers)

set(CPACK_DEBIAN_C_PACKAGE_NAME libmeshorder-c1)
set(CPACK_DEBIAN_C_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_C_DESCRIPTION
    "orders of meshes and sparse matrices, C library
meshorder reorders the vertices and elements of simulation meshes so that
neighbours in the mesh are neighbours in memory. This is the shared library
for programs in C, Fortran and other languages. Its binary interface is
stable.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libmeshorder-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libmeshorder${minor} (= ${debian_version}), libmeshorder-c1 (= ${debian_version})")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
    "orders of meshes and sparse matrices, development files
meshorder reorders the vertices and elements of simulation meshes so that
neighbours in the mesh are neighbours in memory. This package has the headers
for C++ and C, the files for CMake and pkg-config, and examples.")

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME meshorder)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS meshorder-lab)
set(CPACK_DEBIAN_COMMAND_DESCRIPTION
    "reorders simulation meshes so that physics runs faster
meshorder reorders the vertices and elements of a simulation mesh, with all
data in its file, so that neighbours in the mesh are neighbours in memory. It
reads and writes TetGen, Vega, Gmsh, Medit, SU2, Abaqus, Nastran, I-deas, AVS
UCD, Exodus, XDMF, VTKHDF, CGNS, MED, VTK, OFF, OBJ, PLY and STL files,
predicts and measures what an order is worth, and compares orders.")

set(CPACK_DEBIAN_LAB_PACKAGE_NAME meshorder-lab)
set(CPACK_DEBIAN_LAB_PACKAGE_SECTION science)
set(CPACK_DEBIAN_LAB_PACKAGE_DEPENDS "meshorder (= ${debian_version})")
set(CPACK_DEBIAN_LAB_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_LAB_PACKAGE_SUGGESTS tetgen)
set(CPACK_DEBIAN_LAB_DESCRIPTION
    "simulators and studies of orders of meshes
meshorder reorders the vertices and elements of simulation meshes so that
physics on them runs faster. This package has its subcommands simulate,
reproduce, report and models: elastic bodies and water in several orders,
the study of these orders, and pages for the browser.")

# files that Debian requires in the folder of each package; not part of `cmake --install`
string(TIMESTAMP debian_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(packaging/debian/changelog.in ${generated}/changelog.Debian @ONLY)
configure_file(CHANGELOG.md ${generated}/changelog COPYONLY)
execute_process(COMMAND ${MESHORDER_GZIP} -9nfk ${generated}/changelog.Debian ${generated}/changelog
                COMMAND_ERROR_IS_FATAL ANY)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} id)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${id}_PACKAGE_NAME})
  install(FILES packaging/debian/copyright ${generated}/changelog.gz ${generated}/changelog.Debian.gz
          DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

# the list of other software in the program (SBOM)
if(TARGET meshorder)
  include(cmake/sbom.cmake)
  set(three "")
  if(MESHORDER_THREE_JS)
    set(three --three ${MESHORDER_THREE_JS})
  endif()
  meshorder_sbom(${generated}/meshorder.cdx.json TARGETS meshorder ${lab} ARGUMENTS ${three})
endif()
if(TARGET meshorder_sbom)
  install(FILES ${generated}/meshorder.cdx.json DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_COMMAND_PACKAGE_NAME}
          COMPONENT command EXCLUDE_FROM_ALL)
endif()

include(CPack)
