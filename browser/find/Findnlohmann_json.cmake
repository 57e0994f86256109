include(${CMAKE_CURRENT_LIST_DIR}/headers.cmake)
meshorder_headers(nlohmann_json json.hpp nlohmann)
