// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "launcher.hpp"

#include <array>
#include <cstdlib>

namespace meshorder::command {
namespace {

// Variables of Open MPI, of MPICH and its derivatives, and of Slurm. Slurm's variables describe the step that
// a process belongs to.
constexpr std::array kSizes{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
constexpr std::array kRanks{"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK", "SLURM_PROCID"};

/// Returns the value of the first of these variables that is set; null if none of them is set.
template <class Names>
const char* first_set(const Names& names) {
  const char* value = nullptr;
  for (const char* const name : names) {
    if (value == nullptr) value = std::getenv(name);
  }
  return value;
}

}  // namespace

bool is_started_as_rank() { return first_set(kSizes) != nullptr || first_set(kRanks) != nullptr; }

bool is_one_of_several() {
  const char* const size = first_set(kSizes);
  // PMIx gives a process only its rank
  return size != nullptr ? std::atoi(size) > 1 : std::getenv("PMIX_RANK") != nullptr;
}

bool is_first_process() {
  const char* const rank = first_set(kRanks);
  return rank == nullptr || std::atoi(rank) == 0;
}

}  // namespace meshorder::command
