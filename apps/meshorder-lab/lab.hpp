// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
}  // namespace CLI

namespace meshorder::command {

// Each function adds the options of a subcommand, which runs once all arguments are parsed.
void add_models(CLI::App& subcommand);
void add_simulate(CLI::App& subcommand);
void add_reproduce(CLI::App& subcommand);
void add_serve_steps(CLI::App& subcommand);
void add_report(CLI::App& subcommand);

}  // namespace meshorder::command
