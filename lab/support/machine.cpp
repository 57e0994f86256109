// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/machine.hpp"

#include "base/host.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "kernels/simd_dispatch.hpp"
#include "lab/support/revision.hpp"
#include "payoff/machine.hpp"
#include "payoff/memory_probe.hpp"

#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace meshorder {
namespace {

constexpr int kPasses = 8;

/// Returns four times the last cache's bytes, from 256 MiB to 1 GiB, but at most an eighth of the memory.
std::size_t buffer_bytes(const MachineRecord& machine) {
  constexpr std::size_t kMin = std::size_t{256} << 20;
  constexpr std::size_t kMax = std::size_t{1} << 30;
  const auto last = static_cast<std::size_t>(machine.caches.level_bytes.back());
  return std::min(std::clamp(4 * last, kMin, kMax), static_cast<std::size_t>(machine.memory_bytes) / 8);
}

}  // namespace

double seconds_of_others() {
  std::ifstream in("/proc/stat");
  std::string title;
  in >> title;
  double ticks = 0;
  for (int column = 0; column < 8; ++column) {
    constexpr int kIdle = 3;
    constexpr int kWaiting = 4;
    double count = 0;
    if (!(in >> count)) break;
    if (column != kIdle && column != kWaiting) ticks += count;
  }
  rusage own{};
  (void)getrusage(RUSAGE_SELF, &own);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  const double all = ticks / static_cast<double>(std::max(1L, sysconf(_SC_CLK_TCK)));
  return std::max(0.0, all - seconds(own.ru_utime) - seconds(own.ru_stime));
}

std::string program_in_words(const MachineRecord& machine) {
  std::string words = "meshorder ";
  words += machine.program;
  if (machine.revision.empty()) return words;
  const std::size_t plus = machine.revision.find('+');
  words += ", revision ";
  words += machine.revision.substr(0, std::min<std::size_t>(plus, 12));
  if (plus == std::string::npos) return words;
  words += " with changes ";
  return words + machine.revision.substr(plus + 1);
}

MachineRecord describe_machine() {
  MachineRecord machine;
  utsname system{};
  uname(&system);
  machine.processor = processor_of_this_machine();
  machine.cores = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  machine.system = std::string(system.sysname) + " " + system.release + " " + system.machine;
  machine.caches = caches_of_this_machine();
  machine.memory_bytes = usable_memory();
  const std::size_t bytes = buffer_bytes(machine);
  machine.read_bandwidth = read_bandwidth(bytes, kPasses);
  const int threads = thread_count();
  machine.read_bandwidth_all = threads > 1 ? read_bandwidth(bytes, kPasses, threads) : machine.read_bandwidth;
  machine.program = MESHORDER_VERSION;
  machine.revision = build_revision();
  machine.compiler = MESHORDER_COMPILER;
  machine.flags = trimmed(MESHORDER_FLAGS);
  machine.simd = simd_target();
  return machine;
}

}  // namespace meshorder
