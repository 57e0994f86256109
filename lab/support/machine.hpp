// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/cache.hpp"

#include <cstdint>
#include <istream>
#include <string>

namespace meshorder {

/// What a study was measured on, and with.
struct MachineRecord {
  std::string processor;  ///< as it calls itself
  int cores = 0;          ///< that the system has
  std::string system;     ///< "Linux 6.1.0 x86_64"
  Caches caches;          ///< of the first processor
  std::uint64_t memory_bytes = 0;
  double read_bandwidth = 0;      ///< GB/s, one thread
  double read_bandwidth_all = 0;  ///< GB/s, all threads
  std::string program;            ///< meshorder's version
  std::string compiler;           ///< "GNU 12.2.0"
  std::string flags;              ///< its options
  std::string simd;               ///< what the kernels chose at run time: "AVX3"

  bool operator==(const MachineRecord&) const = default;
};

/// This machine, and what this program was made with. Measures the bandwidths, in about a second; that of all
/// threads with as many as `thread_count` says.
MachineRecord describe_machine();

/// What the first processor calls itself in Linux's /proc/cpuinfo. ARM's have no name there but numbers of
/// who made them and what: "aarch64 processor, implementer 0x41, part 0xd0c". Of what says neither,
/// "`architecture` processor".
std::string processor_name(std::istream& cpuinfo, const std::string& architecture);

}  // namespace meshorder
