// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "freed_memory.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace meshorder::command {

void keep_freed_memory() noexcept {
#if defined(__GLIBC__)
  (void)mallopt(M_MMAP_MAX, 0);         // no blocks outside the heap
  (void)mallopt(M_TRIM_THRESHOLD, -1);  // no memory of the heap goes back to the system
  (void)mallopt(M_ARENA_MAX, 1);        // one heap for all threads: each can use what another freed
#endif
}

}  // namespace meshorder::command
