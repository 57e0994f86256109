# Settings for the compilation of our targets.

# Warnings: every target of ours links this.
add_library(meshorder_warnings INTERFACE)
target_compile_options(meshorder_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
if(MESHORDER_WERROR)
  target_compile_options(meshorder_warnings INTERFACE -Werror)
endif()
# GCC 12 and 13 warn of an overlap (GCC bug 105651) and of sizes within std::string that cannot happen
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  target_compile_options(meshorder_warnings INTERFACE -Wno-restrict -Wno-stringop-overflow)
endif()
target_compile_features(meshorder_warnings INTERFACE cxx_std_20)
set(sanitizers "")
if(MESHORDER_SANITIZER STREQUAL "thread")
  set(sanitizers -fsanitize=thread)
elseif(MESHORDER_SANITIZER STREQUAL "address" OR MESHORDER_SANITIZE)
  set(sanitizers -fsanitize=address,undefined)
elseif(MESHORDER_SANITIZER)
  message(FATAL_ERROR "MESHORDER_SANITIZER: unknown sanitizer '${MESHORDER_SANITIZER}'; known: address and thread")
endif()
if(sanitizers)
  target_compile_options(meshorder_warnings INTERFACE ${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_compile_definitions(meshorder_warnings INTERFACE MESHORDER_IS_SANITIZED)
  target_link_options(meshorder_warnings INTERFACE ${sanitizers})
endif()

# meshorder_computes(<target>): ./test compiles its build with sanitizers without optimisation, in a third of the time.
# Targets that compute are optimised there, too: their tests would otherwise take longer than that saves.
function(meshorder_computes target)
  if(sanitizers)
    target_compile_options(${target} PRIVATE -O1)
  endif()
endfunction()

# meshorder_simd_sources(<source>…): sources that Highway compiles once for each instruction set; in a unity build each
# is compiled alone
function(meshorder_simd_sources)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# meshorder_not_optimised(<source>…): sources that clang takes minutes to optimise with sanitizers
function(meshorder_not_optimised)
  if(sanitizers)
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -O0)
  endif()
endfunction()

if(MESHORDER_HARDENED AND NOT sanitizers)
  include(${CMAKE_CURRENT_LIST_DIR}/hardening.cmake)
endif()

# Programs and libraries omit functions that nothing in them calls; wheels are 5 % smaller.
if(UNIX AND NOT APPLE AND NOT sanitizers)
  target_compile_options(meshorder_warnings INTERFACE "$<$<NOT:$<CONFIG:Debug>>:-ffunction-sections;-fdata-sections>")
  target_link_options(meshorder_warnings INTERFACE LINKER:--gc-sections)
endif()

# the compiler and flags that a program reports
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} -std=c++20" flags)
string(REGEX REPLACE "-f[a-z]+-prefix-map=[^ ]* ?" "" flags "${flags}")  # paths of the machine that builds
string(JOIN " " flags ${flags} ${sanitizers})
set(build_definitions MESHORDER_COMPILER="${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
                      MESHORDER_FLAGS="${flags}")
