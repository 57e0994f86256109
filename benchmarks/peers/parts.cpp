// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "parts.hpp"

#include "io/npy.hpp"

#include <fmt/format.h>
#include <mpi.h>
#include <sys/resource.h>

#include <cstdio>
#include <exception>
#include <numeric>

namespace peer {
namespace {

int rank() {
  int result = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &result);
  return result;
}

int ranks() {
  int result = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &result);
  return result;
}

/// Returns the processor time of this process in user mode.
double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

/// Returns, at the first rank, the numbers of all ranks, one rank after another.
std::vector<int> gathered(const std::vector<int>& own) {
  const int count = static_cast<int>(own.size());
  std::vector<int> counts(static_cast<std::size_t>(ranks())), starts(counts.size(), 0);
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  std::partial_sum(counts.begin(), counts.end() - 1, starts.begin() + 1);
  std::vector<int> all(static_cast<std::size_t>(std::reduce(counts.begin(), counts.end())));
  MPI_Gatherv(own.data(), count, MPI_INT, all.data(), counts.data(), starts.data(), MPI_INT, 0,
              MPI_COMM_WORLD);
  return all;
}

}  // namespace

std::vector<std::int64_t> read_numbers(const std::string& path) { return meshorder::read_npy(path); }

Range own_range(std::int64_t count) { return {count * rank() / ranks(), count * (rank() + 1) / ranks()}; }

void measure_parts(const std::string& path, const std::function<std::vector<int>()>& partition) {
  MPI_Barrier(MPI_COMM_WORLD);
  const double before = processor_seconds();
  const std::vector<int> own = partition();
  const double seconds = processor_seconds() - before;
  double sum = 0;
  MPI_Reduce(&seconds, &sum, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  const std::vector<int> parts = gathered(own);
  if (rank() != 0) return;
  meshorder::write_npy(parts, path);
  fmt::print("{}\n", sum);
}

void run_on_ranks(const std::function<void()>& solve) {
  try {
    solve();
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
}

}  // namespace peer
