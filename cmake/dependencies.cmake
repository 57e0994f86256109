# Debian 12's packages; `./run` installs them.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)   # dense linear algebra
find_package(TBB REQUIRED)                    # threads
find_package(fmt REQUIRED)                    # text
find_package(nlohmann_json REQUIRED)          # --json
find_package(hwy REQUIRED)                    # SIMD chosen at run time
find_package(ZLIB REQUIRED)                   # compressed arrays of .vtu
find_package(LibLZMA REQUIRED)
find_package(meshoptimizer REQUIRED)          # fewer triangles for what is only looked at
find_package(CLI11 REQUIRED)                  # command line

# METIS and LZ4 ship without a CMake file
find_path(METIS_INCLUDE_DIR metis.h REQUIRED)
find_library(METIS_LIBRARY metis REQUIRED)
add_library(metis::metis UNKNOWN IMPORTED)
set_target_properties(metis::metis PROPERTIES IMPORTED_LOCATION ${METIS_LIBRARY}
                                              INTERFACE_INCLUDE_DIRECTORIES ${METIS_INCLUDE_DIR})
find_path(LZ4_INCLUDE_DIR lz4.h REQUIRED)
find_library(LZ4_LIBRARY lz4 REQUIRED)
add_library(lz4::lz4 UNKNOWN IMPORTED)
set_target_properties(lz4::lz4 PROPERTIES IMPORTED_LOCATION ${LZ4_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${LZ4_INCLUDE_DIR})

# CHOLMOD: of its modules only those under the LGPL are called
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
add_library(cholmod::cholmod UNKNOWN IMPORTED)
set_target_properties(cholmod::cholmod PROPERTIES IMPORTED_LOCATION ${CHOLMOD_LIBRARY}
                                                  INTERFACE_INCLUDE_DIRECTORIES ${CHOLMOD_INCLUDE_DIR})
