// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Shared by the programs that partitions.py runs under mpirun: they read folders of .npy files, time their
// partitioner, and write the part of each vertex or element. C++17, as Trilinos' headers are.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace peer {

/// Reads an .npy file of whole numbers.
std::vector<std::int64_t> read_numbers(const std::string& path);

/// A range of vertices or elements.
struct Range {
  std::int64_t begin;
  std::int64_t end;
};

/// Returns this rank's share of `count` items; the shares' sizes differ by at most 1.
Range own_range(std::int64_t count);

/// Partitions, prints the sum of all ranks' processor seconds in user mode, and writes the parts.
///
/// @param path       of the .npy file
/// @param partition  returns the parts of this rank's range
void measure_parts(const std::string& path, const std::function<std::vector<int>()>& partition);

/// Calls `solve` and prints errors on stderr; an error on one rank ends all ranks.
void run_on_ranks(const std::function<void()>& solve);

}  // namespace peer
