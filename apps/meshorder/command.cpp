// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"

#include <tbb/global_control.h>

#include <array>
#include <cstddef>
#include <new>
#include <string>

namespace meshorder::command {

OrderNames order_named(const std::string& name) {
  OrderNames order;
  const auto slash = name.find('/');
  order.vertices = name.substr(0, slash);
  const bool plain = order.vertices == "original" || order.vertices == "scrambled";
  order.elements = slash != std::string::npos ? name.substr(slash + 1) : plain ? order.vertices : "lexmax";
  return order;
}

void add_common(CLI::App& subcommand, Common& common) {
  subcommand.add_flag("--json", common.json, "One JSON object on stdout, the log on stderr");
  subcommand.add_flag("--quiet,-q", common.quiet, "Neither log nor progress");
  subcommand
      .add_option("--threads", common.threads, "Threads at most; 0 takes all. Results do not depend on it")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

void add_ordering_options(CLI::App& subcommand, OrderingOptions& options) {
  std::string uses;
  for (const Workload use : kWorkloads) uses += (uses.empty() ? "" : "|") + std::string(name(use));
  subcommand
      .add_option_function<std::string>(
          "--for", [&options](const std::string& use) { options.use = parse_workload(use); },
          "The hot loop that `auto` shall choose the order for: " + uses)
      ->type_name("USE")
      ->default_str(std::string(name(options.use)));
  subcommand.add_option("--seed", options.seed, "Seed of random orders, METIS and start vectors")
      ->capture_default_str();
  subcommand
      .add_option("--tolerance", options.tolerance,
                  "Residual of Fiedler vectors, relative to lambda2; the order settles at 0.1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void with_threads(int threads, const std::function<void()>& work) {
  if (threads > 0) {
    // in a place of its own, so that it never ends: when a limit ends, TBB starts a thread though nothing is
    // left to do
    alignas(tbb::global_control) static std::array<std::byte, sizeof(tbb::global_control)> limit;
    new (limit.data())
        tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  work();
}

}  // namespace meshorder::command
