// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab.hpp"
#include "lab_commands.hpp"
#include "program.hpp"

#include <CLI/CLI.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace {

using namespace meshorder::command;

/// The functions that add the subcommands, in the order of kLabCommands.
constexpr std::array kAdders{add_simulate, add_reproduce, add_report, add_models};
static_assert(kAdders.size() == kLabCommands.size());

void describe(CLI::App& app, std::vector<std::string>& /*arguments*/) {
  app.description("The laboratory of meshorder. `meshorder` runs this program for these subcommands.");
  for (std::size_t i = 0; i < kLabCommands.size(); ++i)
    kAdders[i](*app.add_subcommand(kLabCommands[i].name, kLabCommands[i].description));
  add_serve_steps(*app.add_subcommand("serve-steps"));
}

}  // namespace

int main(int argc, char** argv) { return run_program({describe}, argc, argv); }
