// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "hand_over.hpp"

#include "standard_streams.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>

namespace meshorder::command {
namespace {

// of Open MPI, of MPICH and its like, of Slurm for the step that a process is part of
constexpr std::array kSizes{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
constexpr std::array kRanks{"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK", "SLURM_PROCID"};

/// The first of these variables that is set; null if none is.
template <class Names>
const char* first_set(const Names& names) {
  const char* value = nullptr;
  for (const char* const name : names) {
    if (value == nullptr) value = std::getenv(name);
  }
  return value;
}

/// Whether a launcher started this process with others. PMIx says of a process only which one it is.
bool is_one_of_several() {
  const char* const size = first_set(kSizes);
  if (size != nullptr) return std::atoi(size) > 1;
  return std::getenv("PMIX_RANK") != nullptr;
}

bool is_first_rank() {
  const char* const rank = first_set(kRanks);
  return rank == nullptr || std::atoi(rank) == 0;
}

std::string program_beside_this_one() {
  std::error_code none;
  return std::filesystem::read_symlink("/proc/self/exe", none).replace_filename("meshorder-mpi").string();
}

}  // namespace

std::optional<int> hand_over_to_mpi(char** arguments) noexcept {
  constexpr int kBadInput = 2;
  try {
    if (!is_one_of_several()) return std::nullopt;
    ::execv(program_beside_this_one().c_str(), arguments);
    if (is_first_rank()) {
      report_failure(
          "started by mpirun, it needs meshorder-mpi beside it, which a build with -DMESHORDER_MPI=ON makes; "
          "without mpirun it runs as one process",
          kBadInput);
    }
    return kBadInput;
  } catch (const std::exception& error) {
    return report_failure(error.what(), 1);
  }
}

}  // namespace meshorder::command
