// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"

#include <tbb/global_control.h>

#include <optional>

namespace meshorder::command {

void add_common(CLI::App& subcommand, Common& common) {
  subcommand.add_flag("--json", common.json, "One JSON object on stdout, the log on stderr");
  subcommand.add_flag("--quiet,-q", common.quiet, "Neither log nor progress");
  subcommand
      .add_option("--threads", common.threads, "Threads at most; 0 takes all. Results do not depend on it")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

void with_threads(int threads, const std::function<void()>& work) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  work();
}

}  // namespace meshorder::command
