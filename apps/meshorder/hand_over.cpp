// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "hand_over.hpp"

#include "launcher.hpp"
#include "standard_streams.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>

namespace meshorder::command {
namespace {

constexpr std::array<std::string_view, 6> kOptionsOfParts{"--parts",     "--pieces",  "--ghosts",
                                                          "--partition", "--balance", "--interface"};

/// Returns the first option of `order` that only `meshorder-mpi` has; empty if there is none.
std::string_view option_of_parts(char** arguments) {
  if (arguments[0] == nullptr || arguments[1] == nullptr || std::string_view(arguments[1]) != "order")
    return {};
  for (char** argument = arguments + 2; *argument != nullptr; ++argument) {
    const std::string_view word = *argument;
    const std::string_view name = word.substr(0, word.find('='));
    if (std::find(kOptionsOfParts.begin(), kOptionsOfParts.end(), name) != kOptionsOfParts.end()) return name;
  }
  return {};
}

std::string program_beside_this_one() {
  std::error_code none;
  return std::filesystem::read_symlink("/proc/self/exe", none).replace_filename("meshorder-mpi").string();
}

}  // namespace

std::optional<int> hand_over_to_mpi(char** arguments) noexcept {
  constexpr int kBadInput = 2;
  try {
    const bool is_launched = is_one_of_several();
    const std::string option(option_of_parts(arguments));
    if (!is_launched && option.empty()) return std::nullopt;
    ::execv(program_beside_this_one().c_str(), arguments);
    if (is_first_process()) {
      const std::string needs = "needs meshorder-mpi beside it, which a build with -DMESHORDER_MPI=ON makes";
      report_failure(is_launched
                         ? "started by mpirun, it " + needs + "; without mpirun it runs as one process"
                         : option + " " + needs,
                     kBadInput);
    }
    return kBadInput;
  } catch (const std::exception& error) {
    return report_failure(error.what(), 1);
  }
}

}  // namespace meshorder::command
