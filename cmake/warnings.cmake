# Every target of ours links this; a warning is an error.
add_library(meshorder_warnings INTERFACE)
target_compile_options(meshorder_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)
# GCC 12 and 13 warn of an overlap within std::string that cannot happen (GCC bug 105651)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  target_compile_options(meshorder_warnings INTERFACE -Wno-restrict)
endif()
