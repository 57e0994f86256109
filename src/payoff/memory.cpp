// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/memory.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace meshorder {

std::size_t memory_of_this_machine() {
  const auto physical =
      static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::size_t limit = 0;
  std::ifstream control_group("/sys/fs/cgroup/memory.max");
  return control_group >> limit ? std::min(limit, physical) : physical;
}

}  // namespace meshorder
