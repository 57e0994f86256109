// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "lab_commands.hpp"
#include "program.hpp"
#include "standard_streams.hpp"

#include <CLI/CLI.hpp>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace meshorder::command;

constexpr const char* kMpi = "meshorder-mpi";
constexpr const char* kLab = "meshorder-lab";

constexpr std::array<std::string_view, 6> kOptionsOfParts{"--parts",     "--pieces",  "--ghosts",
                                                          "--partition", "--balance", "--interface"};

/// Returns the word that names the subcommand; null if there is none, or if another option than --plugin
/// precedes it.
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

/// Executes the program. If that fails, the first process reports `need`; returns the exit status.
int execute(const char* program, char** arguments, const std::string& need) {
  ::execv(beside_this_program(program).c_str(), arguments);
  return is_first_process() ? report_failure(need, kBadInput) : kBadInput;
}

int execute_mpi(char** arguments, const std::string& who, const std::string& remedy = "") {
  return execute(
      kMpi, arguments,
      who + " needs meshorder-mpi beside it, which a build with -DMESHORDER_MPI=ON makes" + remedy);
}

/// If another program beside this one does the work, executes that program with the same arguments and does
/// not return: `meshorder-mpi` if `mpirun` or `srun` started several processes of this program together, or
/// if `order` has an option of parts; `meshorder-lab` for a subcommand of the laboratory.
///
/// @param arguments  those of `main`
/// @return exit status if the other program cannot be executed; nothing if this program does the work
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
    return report_failure("out of memory", kOwnFailure);
  } catch (const std::exception& error) {
    return report_failure(error.what(), kOwnFailure);
  }
}

/// Returns whether `meshorder-lab` is beside this program.
bool has_lab() {
  std::error_code none;
  return std::filesystem::exists(beside_this_program(kLab), none);
}

struct Subcommand {
  const char* name;
  void (*add)(CLI::App& subcommand);
};

/// The first subcommands of the help, in its order; those of the laboratory and `methods` follow.
constexpr std::array kSubcommands{
    Subcommand{"order", add_order},
    Subcommand{"apply", add_apply},
    Subcommand{"info", add_info},
    Subcommand{"compare", add_compare},
    Subcommand{"try", add_try},
    Subcommand{"openfoam", add_openfoam},
    Subcommand{"calibrate", add_calibrate},
};

constexpr const char* kDescription =
    "Reorders the vertices and elements of a simulation mesh, with all data in its file, so that\n"
    "simulations on it run faster.\n\n"
    "  meshorder order  dragon.veg -o ordered.veg   order by the method chosen for the mesh\n"
    "  meshorder info   dragon.veg                  say whether its order is good, and what it holds\n"
    "  meshorder compare dragon.veg                 run kernels in many orders, and name the best\n"
    "  meshorder try wing.su2 -- SU2_CFD wing.cfg {} your own program in several orders\n"
    "  meshorder openfoam cavity                    order the cells of an OpenFOAM case\n"
    "  meshorder calibrate                          measure this machine, so that info can predict times\n";

constexpr const char* kDescriptionOfLab =
    "  meshorder simulate falling --mesh dragon.veg simulate an elastic body and time it\n"
    "  meshorder reproduce -o results               the paper's study on this machine, as a page\n"
    "  meshorder report dragon.veg                  mesh, orders and kernels as a page for the browser\n";

void describe(CLI::App& app, std::vector<std::string>& arguments) {
  take_program_to_try(arguments);
  const bool lab = has_lab();
  app.description(std::string(kDescription) + (lab ? kDescriptionOfLab : ""));
  for (const auto& [name, add] : kSubcommands) add(*app.add_subcommand(name));
  for (const auto& [name, description] : kLabCommands) {
    if (lab) app.add_subcommand(name, description);
  }
  add_methods(*app.add_subcommand("methods"));
}

}  // namespace

int main(int argc, char** argv) { return run_program({describe, hand_over}, argc, argv); }
