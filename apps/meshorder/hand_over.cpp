// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "hand_over.hpp"

#include "lab_commands.hpp"
#include "launcher.hpp"
#include "standard_streams.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>

namespace meshorder::command {
namespace {

constexpr int kBadInput = 2;
constexpr const char* kMpi = "meshorder-mpi";
constexpr const char* kLab = "meshorder-lab";

constexpr std::array<std::string_view, 6> kOptionsOfParts{"--parts",     "--pieces",  "--ghosts",
                                                          "--partition", "--balance", "--interface"};

/// Returns the word that names the subcommand; null if there is none, or if an option before it requests
/// something else.
char** subcommand(char** arguments) {
  if (*arguments == nullptr) return nullptr;
  for (char** argument = arguments + 1; *argument != nullptr; ++argument) {
    const std::string_view word = *argument;
    if (word == "--plugin") {
      if (*++argument == nullptr) return nullptr;
    } else if (word != "help" && !word.starts_with("--plugin=")) {
      return word.starts_with("-") ? nullptr : argument;
    }
  }
  return nullptr;
}

/// Returns the first argument that is an option of `meshorder-mpi order` only; empty if there is no such
/// argument.
std::string_view option_of_parts(char** arguments) {
  for (; *arguments != nullptr; ++arguments) {
    const std::string_view word = *arguments;
    const std::string_view name = word.substr(0, word.find('='));
    if (std::find(kOptionsOfParts.begin(), kOptionsOfParts.end(), name) != kOptionsOfParts.end()) return name;
  }
  return {};
}

bool is_of_lab(std::string_view word) {
  return std::any_of(kLabCommands.begin(), kLabCommands.end(),
                     [&](const LabCommand& command) { return command.name == word; });
}

/// Returns the path of a program beside this one. Empty if the system does not report where this program is:
/// a name without a folder would mean a file in the current folder.
std::filesystem::path beside_this_program(const char* name) {
  std::error_code code;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", code);
  return code ? std::filesystem::path() : self.parent_path() / name;
}

/// Executes the program. If that fails, reports why it is needed and returns the exit status.
int execute(const char* program, char** arguments, const std::string& need) {
  ::execv(beside_this_program(program).c_str(), arguments);
  return is_first_process() ? report_failure(need, kBadInput) : kBadInput;
}

int execute_mpi(char** arguments, const std::string& who, const std::string& remedy = "") {
  return execute(
      kMpi, arguments,
      who + " needs meshorder-mpi beside it, which a build with -DMESHORDER_MPI=ON makes" + remedy);
}

}  // namespace

std::optional<int> hand_over(char** arguments) noexcept {
  try {
    if (is_one_of_several())
      return execute_mpi(arguments, "started by mpirun, it", "; without mpirun it runs as one process");
    char** const word = subcommand(arguments);
    if (word == nullptr) return std::nullopt;
    if (is_of_lab(*word))
      return execute(kLab, arguments,
                     std::string(*word) + " is in the full build only, which ./run makes from the sources: " +
                         "it needs meshorder-lab beside this program");
    const std::string_view option = *word == std::string_view("order") ? option_of_parts(word) : "";
    if (option.empty()) return std::nullopt;
    return execute_mpi(arguments, std::string(option));
  } catch (const std::bad_alloc&) {
    return report_failure("out of memory", 1);
  } catch (const std::exception& error) {
    return report_failure(error.what(), 1);
  }
}

bool has_lab() {
  std::error_code none;
  return std::filesystem::exists(beside_this_program(kLab), none);
}

}  // namespace meshorder::command
