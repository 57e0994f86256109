# Debian 12's packages. Each part of the tree looks for the packages that it needs: a build of only the core looks for
# TBB and Eigen only.

include(${CMAKE_CURRENT_LIST_DIR}/find_library.cmake)

# meshorder_switch(<option> <target> <list>): an option AUTO, ON or OFF for a library that the build can do without. Sets
# MESHORDER_HAS_<option>, and adds the target to the list if it is used; ON without the library is an error.
function(meshorder_switch option target list)
  set(MESHORDER_HAS_${option} OFF PARENT_SCOPE)
  if(MESHORDER_${option} STREQUAL "OFF")
    return()
  endif()
  if(TARGET ${target})
    set(MESHORDER_HAS_${option} ON PARENT_SCOPE)
    set(${list} ${${list}} ${target} PARENT_SCOPE)
  elseif(NOT MESHORDER_${option} STREQUAL "AUTO")
    message(FATAL_ERROR "MESHORDER_${option} is ON, but its library was not found")
  endif()
endfunction()

# meshorder_require(<library> <Debian package> [option of find_package…])
macro(meshorder_require library debian)
  find_package(${library} ${ARGN} QUIET)
  if(NOT ${library}_FOUND)
    message(FATAL_ERROR "${library} was not found; Debian's package ${debian} has it")
  endif()
endmacro()

# meshorder_load_when_needed(<library>): adds a library of a file format to loaded_libraries, as its headers and the
# definition MESHORDER_<LIBRARY>_FILE, the name by which the system's loader finds the library. An archive, or a library
# without such a name, is added to file_libraries and linked.
function(meshorder_load_when_needed library)
  string(TOUPPER ${library} name)
  get_target_property(path ${library}::${library} IMPORTED_LOCATION)
  set(facts "")
  if(MESHORDER_LOAD_LIBRARIES AND path AND CMAKE_READELF)
    execute_process(COMMAND ${CMAKE_READELF} -d ${path} OUTPUT_VARIABLE facts ERROR_QUIET)
  endif()
  if(NOT facts MATCHES "SONAME[^[]*\\[([^]]+)\\]")
    set(file_libraries ${file_libraries} ${library}::${library} PARENT_SCOPE)
    return()
  endif()
  add_library(meshorder_${library} INTERFACE)
  target_compile_definitions(meshorder_${library} INTERFACE MESHORDER_${name}_FILE="${CMAKE_MATCH_1}")
  target_include_directories(meshorder_${library} SYSTEM
                             INTERFACE $<TARGET_PROPERTY:${library}::${library},INTERFACE_INCLUDE_DIRECTORIES>)
  set(loaded_libraries ${loaded_libraries} meshorder_${library} PARENT_SCOPE)
endfunction()

if(MESHORDER_SANITIZER STREQUAL "thread")
  # ThreadSanitizer must see how threads wait for each other: headers on std::thread in place of oneTBB's library
  find_package(Threads REQUIRED)
  add_library(TBB::tbb INTERFACE IMPORTED)
  target_include_directories(TBB::tbb INTERFACE ${PROJECT_SOURCE_DIR}/tests/threads)
  target_link_libraries(TBB::tbb INTERFACE Threads::Threads)
endif()
if(NOT TARGET TBB::tbb)
  meshorder_require(TBB libtbb-dev)                    # threads
endif()
meshorder_require(Eigen3 libeigen3-dev 3.4 NO_MODULE)  # small dense eigenproblems; needed to build only
if(NOT MESHORDER_METIS STREQUAL "OFF")
  meshorder_find_library(metis::metis metis.h metis)
endif()
set(metis "")
meshorder_switch(METIS metis::metis metis)

if("io" IN_LIST components)
  meshorder_require(fmt libfmt-dev)                    # text
  if(NOT MESHORDER_ZLIB STREQUAL "OFF")
    find_package(ZLIB)                                 # compressed arrays of .vtu
  endif()
  if(NOT MESHORDER_LZMA STREQUAL "OFF")
    find_package(LibLZMA)
  endif()
  if(NOT MESHORDER_LZ4 STREQUAL "OFF")
    meshorder_find_library(lz4::lz4 lz4.h lz4)
  endif()
  if(NOT MESHORDER_NETCDF STREQUAL "OFF")
    meshorder_find_library(netcdf::netcdf netcdf.h netcdf)  # Exodus II
  endif()
  if(NOT MESHORDER_HDF5 STREQUAL "OFF")
    meshorder_find_library(hdf5::hdf5 hdf5.h "hdf5_serial;hdf5" hdf5/serial)  # MED, VTKHDF, XDMF's arrays
    find_package(pugixml QUIET)                        # XDMF's XML
  endif()
  if(NOT MESHORDER_CGNS STREQUAL "OFF" AND TARGET hdf5::hdf5)
    meshorder_find_library(cgns::cgns cgns_io.h cgns)  # CGNS
  endif()
  set(file_libraries "")
  meshorder_switch(ZLIB ZLIB::ZLIB file_libraries)
  meshorder_switch(LZMA LibLZMA::LibLZMA file_libraries)
  meshorder_switch(LZ4 lz4::lz4 file_libraries)
  set(loaded_libraries "")  # needed to build only
  foreach(library netcdf hdf5 cgns)
    string(TOUPPER ${library} option)
    set(found "")
    meshorder_switch(${option} ${library}::${library} found)
    if(found)
      meshorder_load_when_needed(${library})
    endif()
  endforeach()
  set(MESHORDER_HAS_XDMF OFF)
  if(MESHORDER_HAS_HDF5 AND TARGET pugixml::pugixml)
    set(MESHORDER_HAS_XDMF ON)
    list(APPEND file_libraries pugixml::pugixml)
  elseif(MESHORDER_HAS_HDF5 AND NOT MESHORDER_HDF5 STREQUAL "AUTO")
    message(FATAL_ERROR "MESHORDER_HDF5 is ON, but pugixml, which XDMF needs, was not found")
  endif()
endif()
if("payoff" IN_LIST components)
  meshorder_require(hwy libhwy-dev)                    # SIMD chosen at run time
  # Only the headers: the library takes 7 ms at each start of a program that links it. Of the instruction sets, SSSE3
  # gains nothing for doubles over SSE4; vectors of unknown length (SVE, RISC-V) cannot be members of structs, as the
  # kernels' values are.
  add_library(meshorder_highway INTERFACE)
  target_compile_definitions(
    meshorder_highway INTERFACE
    HWY_DISABLED_TARGETS=\(HWY_SSSE3|HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV\))
  target_include_directories(meshorder_highway SYSTEM
                             INTERFACE $<TARGET_PROPERTY:hwy::hwy,INTERFACE_INCLUDE_DIRECTORIES>)
  if(sanitizers)
    target_link_libraries(meshorder_highway INTERFACE hwy::hwy)  # reports failed checks of the headers
  else()
    target_compile_definitions(meshorder_highway INTERFACE HWY_IS_DEBUG_BUILD=0)  # the headers check nothing
  endif()
endif()
if("payoff" IN_LIST components OR MESHORDER_CLI OR MESHORDER_FUZZ OR build_lab)
  meshorder_require(nlohmann_json nlohmann-json3-dev)  # results, calibrations
endif()
if(build_lab)
  meshorder_require(meshoptimizer libmeshoptimizer-dev)  # simplifies surfaces for display
  # of CHOLMOD's modules only those under the LGPL are called
  meshorder_find_library(cholmod::cholmod cholmod.h cholmod suitesparse)
  meshorder_require(ZLIB zlib1g-dev)                   # checkpoints, the page's arrays
endif()
if(MESHORDER_CLI)
  meshorder_require(CLI11 libcli11-dev)                # the command line
endif()
if(MESHORDER_MPI)
  meshorder_require(MPI libopenmpi-dev COMPONENTS C)   # ranks
  # PT-Scotch comes in two widths of numbers with the same function names. Links the archives and hides their symbols:
  # otherwise a library in the same process that uses the other width would call these functions, or these would call
  # the functions of the other width.
  find_path(PTSCOTCH_INCLUDE_DIR ptscotch.h PATH_SUFFIXES scotch-int64)
  set(ptscotch_archives ptscotch scotch ptscotcherr)
  set(ptscotch_libraries "")
  foreach(library IN LISTS ptscotch_archives)
    find_library(${library}_ARCHIVE NAMES lib${library}.a PATH_SUFFIXES scotch-int64)
    mark_as_advanced(${library}_ARCHIVE)
    if(NOT ${library}_ARCHIVE OR NOT PTSCOTCH_INCLUDE_DIR)
      message(FATAL_ERROR "PT-Scotch was not found; Debian's package libptscotch-dev has it")
    endif()
    list(APPEND ptscotch_libraries ${${library}_ARCHIVE})
  endforeach()
  mark_as_advanced(PTSCOTCH_INCLUDE_DIR)
  find_package(Threads REQUIRED)
  meshorder_require(ZLIB zlib1g-dev)                   # PT-Scotch's own files
  add_library(ptscotch::ptscotch INTERFACE IMPORTED)
  target_include_directories(ptscotch::ptscotch INTERFACE ${PTSCOTCH_INCLUDE_DIR})
  target_link_libraries(ptscotch::ptscotch INTERFACE ${ptscotch_libraries} MPI::MPI_C ZLIB::ZLIB Threads::Threads m)
  target_link_options(ptscotch::ptscotch INTERFACE LINKER:--exclude-libs,libptscotch.a:libscotch.a:libptscotcherr.a)
endif()
