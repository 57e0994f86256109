# Replaces oneTBB, which starts threads: the parts that the project uses, on the one thread of a page's worker.
add_library(TBB::tbb INTERFACE IMPORTED)
target_include_directories(TBB::tbb INTERFACE ${PROJECT_SOURCE_DIR}/tests/threads)
set(TBB_FOUND TRUE)
