// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "freed_memory.hpp"

#include <cstdlib>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace meshorder::command {

void keep_freed_memory() noexcept {
#if defined(__GLIBC__)
  (void)mallopt(M_MMAP_MAX, 0);         // no blocks beside the heap
  (void)mallopt(M_TRIM_THRESHOLD, -1);  // none of which goes back
  (void)mallopt(M_ARENA_MAX, 1);        // one heap for all threads: what one frees another takes
#endif
}

}  // namespace meshorder::command
