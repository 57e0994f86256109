# Protection of optimised builds against exploits: checks of the sizes of copies into arrays, of return addresses on the
# stack, of the stack's growth, and of jump targets; programs are loaded at a random address, and their table of
# functions is read-only after start-up. tests/package/test_hardening.py looks for these in the programs.

include(CheckCXXCompilerFlag)
include(CheckCXXSourceCompiles)
include(CheckPIESupported)

set(guards "")
foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection)
  string(MAKE_C_IDENTIFIER "MESHORDER_HAS${flag}" known)
  check_cxx_compiler_flag(${flag} ${known})
  if(${known})
    list(APPEND guards ${flag})
  endif()
endforeach()
# glibc before 2.34 warns of level 3
foreach(level 3 2)
  set(CMAKE_REQUIRED_FLAGS "-O2 -Werror -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=${level}")
  check_cxx_source_compiles("#include <cstdlib>\nint main() { return 0; }" MESHORDER_HAS_FORTIFY_${level})
  unset(CMAKE_REQUIRED_FLAGS)
  if(MESHORDER_HAS_FORTIFY_${level})
    list(APPEND guards -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=${level})
    break()
  endif()
endforeach()
target_compile_options(meshorder_warnings INTERFACE "$<$<NOT:$<CONFIG:Debug>>:${guards}>")

check_pie_supported(LANGUAGES CXX)
if(UNIX AND NOT APPLE)
  target_link_options(meshorder_warnings INTERFACE LINKER:-z,relro LINKER:-z,now LINKER:-z,noexecstack)
endif()

# meshorder_at_random_address(<program> [its static libraries]). Libraries get -fPIE: with -fPIC, CMake's default, the
# compiler inlines less.
function(meshorder_at_random_address program)
  if(CMAKE_CXX_LINK_PIE_SUPPORTED)
    set_target_properties(${program} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    foreach(library IN LISTS ARGN)
      target_compile_options(${library} PRIVATE -fPIE)
    endforeach()
  endif()
endfunction()
