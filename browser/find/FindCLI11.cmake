include(${CMAKE_CURRENT_LIST_DIR}/headers.cmake)
meshorder_headers(CLI11 CLI.hpp CLI)
