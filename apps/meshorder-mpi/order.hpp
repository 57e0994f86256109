// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
}  // namespace CLI

namespace meshorder::command {

/// Adds the options of `order`. It runs on all ranks once all arguments are parsed. If a rank fails, it
/// throws SharedError on all ranks.
///
/// @param is_started_as_rank  whether a launcher started this process, even if it started no other process
void add_distributed_order(CLI::App& subcommand, const distributed::Communicator& communicator,
                           bool is_started_as_rank);

}  // namespace meshorder::command
