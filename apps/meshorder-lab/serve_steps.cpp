// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "lab.hpp"
#include "lab/study/stepper.hpp"

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>

namespace meshorder::command {

void add_serve_steps(CLI::App& subcommand) {
  subcommand.description("Serve a study: read tasks on standard input and simulate them");
  subcommand.group("");  // for `reproduce` only: not shown in the help
  const auto arguments = std::make_shared<Common>();
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback(
      [arguments] { with_threads(arguments->threads, [] { serve_steps(std::cin, std::cout); }); });
}

}  // namespace meshorder::command
