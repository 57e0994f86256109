// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/processors.hpp"

#include <sched.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>

namespace meshorder {
namespace {

/// The hardware threads of a processor's core, as the system lists them: the same text for all of them.
std::string core_of(int processor) {
  std::ifstream in("/sys/devices/system/cpu/cpu" + std::to_string(processor) +
                   "/topology/thread_siblings_list");
  std::string siblings;
  return std::getline(in, siblings) ? siblings : std::to_string(processor);
}

}  // namespace

std::vector<int> choose_processors(int threads) {
  cpu_set_t allowed;
  if (::sched_getaffinity(0, sizeof(allowed), &allowed) != 0) return {};
  std::vector<int> firsts, others;  // the first of each core, then the rest
  std::set<std::string> cores;
  for (int processor = CPU_SETSIZE - 1; processor >= 0; --processor) {
    if (!CPU_ISSET(static_cast<std::size_t>(processor), &allowed)) continue;
    (cores.insert(core_of(processor)).second ? firsts : others).push_back(processor);
  }
  firsts.insert(firsts.end(), others.begin(), others.end());
  if (static_cast<int>(firsts.size()) < threads) return {};
  firsts.resize(static_cast<std::size_t>(threads));
  std::sort(firsts.begin(), firsts.end());
  return firsts;
}

bool bind_to(const std::vector<int>& processors) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int processor : processors) CPU_SET(static_cast<std::size_t>(processor), &set);
  return ::sched_setaffinity(0, sizeof(set), &set) == 0;
}

}  // namespace meshorder
