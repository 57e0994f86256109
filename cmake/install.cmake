# What `cmake --install` puts where. Install components: library (shared C++ library), c (shared C library), development
# (headers, archives, CMake and pkg-config files, examples), mpi (shared library for many ranks, if it was built), petsc
# (plugin for PETSc, if it was built), command (program, manual, completions, documents), lab (meshorder-lab and its manual)
# and licence. All paths are relative to the prefix, so that an installed tree can be moved.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/meshorder)
set(generated ${CMAKE_CURRENT_BINARY_DIR}/installed)

# ---- libraries and headers, each component with an export of its own

foreach(component IN LISTS components)
  set(runtime library)
  set(targets meshorder_${component})
  if(component STREQUAL "c")
    set(runtime c)
  elseif(component STREQUAL "core" AND BUILD_SHARED_LIBS)
    list(APPEND targets meshorder_library)
  endif()
  set(export meshorder-${component}-targets)
  install(
    TARGETS ${targets}
    EXPORT ${export}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${runtime} NAMELINK_COMPONENT development
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${runtime}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
  install(EXPORT ${export} NAMESPACE meshorder:: DESTINATION ${cmake_folder} COMPONENT development)
endforeach()

# not among the headers that are checked alone: it needs Eigen, which its users provide
install(FILES ${PROJECT_SOURCE_DIR}/include/meshorder/eigen.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/meshorder
        COMPONENT development)

if(TARGET meshorder_mpi)
  install(
    TARGETS meshorder_mpi
    EXPORT meshorder-mpi-targets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT mpi NAMELINK_COMPONENT development
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
  install(EXPORT meshorder-mpi-targets NAMESPACE meshorder:: DESTINATION ${cmake_folder} COMPONENT development)
endif()

# ---- find_package(meshorder)

# users of an archive must link the libraries that it needs
set(MESHORDER_STATIC ON)
if(BUILD_SHARED_LIBS)
  set(MESHORDER_STATIC OFF)
endif()
configure_package_config_file(
  cmake/meshorder-config.cmake.in ${generated}/meshorder-config.cmake INSTALL_DESTINATION ${cmake_folder}
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${generated}/meshorder-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${generated}/meshorder-config.cmake ${generated}/meshorder-config-version.cmake
              ${PROJECT_SOURCE_DIR}/cmake/find_library.cmake
        DESTINATION ${cmake_folder} COMPONENT development)

# ---- pkg-config

# meshorder_pkg_config(<component> DESCRIPTION … REQUIRES <modules> LIBRARIES <flags> DEFINITIONS <flags>
#                      INSTALL_COMPONENT <name>)   by default the install component is development
function(meshorder_pkg_config component)
  cmake_parse_arguments(PC "" "DESCRIPTION;INSTALL_COMPONENT" "REQUIRES;LIBRARIES;DEFINITIONS" ${ARGN})
  if(NOT PC_INSTALL_COMPONENT)
    set(PC_INSTALL_COMPONENT development)
  endif()
  set(prefix ${CMAKE_INSTALL_PREFIX})
  if(NOT IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
    file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    string(REGEX REPLACE "/$" "" prefix "\${pcfiledir}/${up}")
  endif()
  foreach(folder LIBDIR INCLUDEDIR)
    set(${folder} "\${prefix}/${CMAKE_INSTALL_${folder}}")
    if(IS_ABSOLUTE ${CMAKE_INSTALL_${folder}})
      set(${folder} ${CMAKE_INSTALL_${folder}})
    endif()
  endforeach()
  list(JOIN PC_REQUIRES " " requires)
  list(JOIN PC_LIBRARIES " " libraries)
  list(JOIN PC_DEFINITIONS " " definitions)
  configure_file(cmake/component.pc.in ${generated}/meshorder-${component}.pc @ONLY)
  install(FILES ${generated}/meshorder-${component}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
          COMPONENT ${PC_INSTALL_COMPONENT})
endfunction()

set(core_text "orders of graphs and meshes, C++20")
set(core_requires tbb)
set(core_libraries ${CMAKE_DL_LIBS})
if(MESHORDER_HAS_METIS)
  list(PREPEND core_libraries metis)
endif()
set(hdf5_module hdf5)
if(HDF5_SERIAL_LIBRARY MATCHES "hdf5_serial")
  set(hdf5_module hdf5-serial)  # Debian also has modules of HDF5 for MPI
endif()
set(io_text "meshes with files, C++20")
set(io_requires meshorder-core fmt)
foreach(library IN ITEMS ZLIB::ZLIB.zlib LibLZMA::LibLZMA.liblzma lz4::lz4.liblz4 netcdf::netcdf.netcdf
                         hdf5::hdf5.${hdf5_module} pugixml::pugixml.pugixml)
  string(REPLACE "." ";" library ${library})
  list(GET library 0 target)
  list(GET library 1 module)
  if(target IN_LIST file_libraries)
    list(APPEND io_requires ${module})
  endif()
endforeach()
if(cgns::cgns IN_LIST file_libraries)
  list(APPEND io_libraries cgns)
endif()
set(payoff_text "what an order is worth, C++20")
set(payoff_requires meshorder-io fmt)
foreach(component IN LISTS components)
  if(component STREQUAL "c")
    meshorder_pkg_config(c DESCRIPTION "orders of graphs and meshes, C" LIBRARIES -lmeshorder_c)
  elseif(BUILD_SHARED_LIBS)
    meshorder_pkg_config(${component} DESCRIPTION ${${component}_text} LIBRARIES -lmeshorder
                         DEFINITIONS -DMESHORDER_SHARED)
  else()
    list(TRANSFORM ${component}_libraries PREPEND -l)
    meshorder_pkg_config(${component} DESCRIPTION ${${component}_text} REQUIRES ${${component}_requires}
                         LIBRARIES -lmeshorder_${component} ${${component}_libraries})
  endif()
endforeach()

if(TARGET meshorder_mpi)
  # MPI's compiler wrappers provide its headers and libraries
  meshorder_pkg_config(mpi DESCRIPTION "orders of meshes that many ranks share, C and C++20" LIBRARIES -lmeshorder_mpi)
endif()

# ---- plugins for solvers: headers, which need their solver where they are included, and a library

install(FILES plugins/dealii/meshorder/dealii.hpp plugins/dolfinx/meshorder/dolfinx.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/meshorder COMPONENT development)
if(TARGET meshorder_petsc)
  install(TARGETS meshorder_petsc LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT petsc)
  install(FILES plugins/petsc/meshorder_petsc.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT petsc)
  meshorder_pkg_config(petsc DESCRIPTION "orders for PETSc" REQUIRES PETSc LIBRARIES -lmeshorder_petsc
                       INSTALL_COMPONENT petsc)
endif()

# ---- the command, with a manual and completions made from its help

set(MESHORDER_ZSH_FOLDER ${CMAKE_INSTALL_DATADIR}/zsh/site-functions CACHE STRING "Where zsh looks for completions")
if(TARGET meshorder)
  install(TARGETS meshorder RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  if(TARGET meshorder-mpi)
    install(TARGETS meshorder-mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  endif()
  set(lab "")
  if(TARGET meshorder-lab)
    install(TARGETS meshorder-lab RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT lab)
    set(lab meshorder-lab)  # the command passes requests for help to it
  endif()
  find_package(Python3 3.9 COMPONENTS Interpreter)
  if(CMAKE_CROSSCOMPILING OR NOT Python3_Interpreter_FOUND)
    message(STATUS "No manual pages and completions: they are made by running the command and Python")
  else()
    set(pages ${CMAKE_CURRENT_BINARY_DIR}/pages)
    add_custom_command(
      OUTPUT ${pages}/made
      COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/command_pages.py $<TARGET_FILE:meshorder> ${pages}
      COMMAND ${CMAKE_COMMAND} -E touch ${pages}/made
      DEPENDS meshorder ${lab} ${PROJECT_SOURCE_DIR}/scripts/command_pages.py
      COMMENT "Writing manual pages and completions"
      VERBATIM)
    add_custom_target(meshorder_pages ALL DEPENDS ${pages}/made)
    set(of_lab REGEX "meshorder-(simulate|reproduce|report|models)")
    install(DIRECTORY ${pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT command ${of_lab} EXCLUDE)
    if(TARGET meshorder-lab)
      install(DIRECTORY ${pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT lab FILES_MATCHING ${of_lab})
    endif()
    install(FILES ${pages}/completions/meshorder DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
            COMPONENT command)
    install(FILES ${pages}/completions/_meshorder DESTINATION ${MESHORDER_ZSH_FOLDER} COMPONENT command)
    install(FILES ${pages}/completions/meshorder.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
            COMPONENT command)
  endif()
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT command FILES_MATCHING PATTERN *.md PATTERN *.json
          PATTERN pictures EXCLUDE PATTERN reproduction EXCLUDE PATTERN site EXCLUDE)
  install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT command)
endif()

install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development FILES_MATCHING PATTERN *.cpp)
install(FILES LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)

if(PROJECT_IS_TOP_LEVEL)
  include(cmake/packages.cmake)
endif()
