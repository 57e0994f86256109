// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/cache.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Returns the data caches that a folder of Linux describes, such as /sys/devices/system/cpu/cpu0/cache. If a
/// cache has more than 16 MiB for each hardware thread that shares it, other virtual machines use it, too;
/// then it counts as 4 MiB for each.
Caches caches_in(const std::string& folder);

/// Returns the data caches of this machine's first processor, as Linux or the C library reports them; no
/// caches if neither reports them.
Caches reported_caches();

/// Returns reported_caches(); 32K, 512K and 16M if there are none.
Caches caches_of_this_machine();

/// Returns the caches of the Intel Xeon E5-1620 v4, on which the paper measured: 32 KB, 256 KB and 10 MB.
Caches caches_of_the_paper();

/// Returns this machine's caches for "this" or "", the paper's caches for "paper", else the result of
/// parse_cache_sizes. Throws InvalidArgument as parse_cache_sizes.
Caches parse_caches(std::string_view text);

/// Returns the version of this program, its compiler with the options, and the instruction set that its
/// kernels chose here. Times measured with another build are not comparable.
std::string build_of_this_program();

/// Returns processors to bind `threads` threads to, ascending. These are the last processors that this
/// process may use, because systems tend to serve interrupts on the first ones. They are on different cores
/// if there are enough cores. Empty if the system does not report its processors or has fewer than `threads`.
std::vector<int> choose_processors(int threads);

/// Binds the calling thread, and the threads and processes that it starts later, to the processors. Returns
/// false if the system refuses.
bool bind_to(const std::vector<int>& processors);

}  // namespace meshorder
