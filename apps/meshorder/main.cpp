// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "hand_over.hpp"
#include "lab_commands.hpp"
#include "program.hpp"

#include <CLI/CLI.hpp>

#include <array>
#include <string>
#include <vector>

namespace {

using namespace meshorder::command;

struct Subcommand {
  const char* name;
  void (*add)(CLI::App& subcommand);
};

/// In the order of the help; there the subcommands of the laboratory and then `methods` follow.
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
