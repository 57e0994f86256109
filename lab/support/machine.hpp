// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/cache.hpp"

#include <cstdint>
#include <string>

namespace meshorder {

/// The machine and the program of a study.
struct MachineRecord {
  std::string processor;  ///< its name
  int cores = 0;          ///< number of processors in the system
  std::string system;     ///< "Linux 6.1.0 x86_64"
  Caches caches;          ///< of the first processor
  std::uint64_t memory_bytes = 0;
  double read_bandwidth = 0;      ///< GB/s, one thread
  double read_bandwidth_all = 0;  ///< GB/s, all threads
  std::string program;            ///< meshorder's version
  std::string revision;           ///< of git, see build_revision; may be empty
  std::string compiler;           ///< "GNU 12.2.0"
  std::string flags;              ///< the compiler's options
  std::string simd;               ///< the target that the kernels chose at run time: "AVX3"

  bool operator==(const MachineRecord&) const = default;
};

/// Describes this machine and this program's build. Measures the bandwidths, which takes about a second; "all
/// threads" are `thread_count()` threads.
MachineRecord describe_machine();

/// Returns the processor seconds that all other programs have used on this machine since it started, those
/// that a hypervisor took away included; 0 if the system does not report them.
double seconds_of_others();

/// Returns the version and, if it is known, the revision of a study's program: "meshorder 0.2.0, revision
/// 5eed5eed5eed", "… with changes 0123abcd".
std::string program_in_words(const MachineRecord& machine);

}  // namespace meshorder
