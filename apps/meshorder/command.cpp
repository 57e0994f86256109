// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"

#include "base/text.hpp"

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

/// Refuses numbers for which `accepts` is false; what is not a number is left to the option's own type.
template <class Accepts>
CLI::Validator number_check(Accepts accepts, const std::string& message) {
  return {[accepts, message](const std::string& text) {
            char* end = nullptr;
            const double number = std::strtod(text.c_str(), &end);
            const bool is_number = end != text.c_str() && *end == '\0';
            return is_number && !accepts(number) ? message + ", not " + text : std::string();
          },
          ""};
}

}  // namespace

CLI::Validator not_negative() {
  return number_check([](double number) { return number >= 0; }, "must be 0 or more");
}

CLI::Validator positive() {
  return number_check([](double number) { return number > 0; }, "must be more than 0");
}

CLI::Validator in_range(int lowest, int highest) {
  return number_check([=](double number) { return number >= lowest && number <= highest; },
                      "must be from " + std::to_string(lowest) + " to " + std::to_string(highest));
}

OrderNames order_named(const std::string& name) {
  OrderNames order;
  const auto slash = name.find('/');
  order.vertices = name.substr(0, slash);
  const bool plain = order.vertices == "original" || order.vertices == "scrambled";
  order.elements = slash != std::string::npos ? name.substr(slash + 1) : plain ? order.vertices : "lexmax";
  return order;
}

void add_common(CLI::App& subcommand, Common& common) {
  subcommand.add_flag("--json", common.json, "Print one JSON object on stdout; notes go to stderr");
  subcommand.add_flag("--quiet,-q", common.quiet, "No warnings and no progress bar");
  subcommand
      .add_option("--threads", common.threads,
                  "Maximum number of threads (0 = all). The output is the same for any number")
      ->check(not_negative())
      ->capture_default_str();
}

void add_keeping_options(CLI::App& subcommand, Keeping& keeping) {
  constexpr std::array<std::pair<std::string_view, int>, 4> kDimensions{
      {{"volume", 3}, {"surface", 2}, {"curve", 1}, {"point", 0}}};
  subcommand
      .add_option_function<std::string>(
          "--only",
          [&keeping, kDimensions](const std::string& name) {
            for (const auto& [known, dimension] : kDimensions) {
              if (name == known) keeping.dimension = dimension;
            }
          },
          "Keep only these cells, with all vertices: volume, surface, curve or point")
      ->check(CLI::IsMember(std::vector<std::string>{"volume", "surface", "curve", "point"}))
      ->type_name("CELLS");
  subcommand.add_flag(
      "--strict", keeping.strict,
      "Fail rather than leave out cells, arrays, sets or ids that the output format has no place\n"
      "for; without it they are named on stderr");
}

void add_ordering_options(CLI::App& subcommand, OrderOptions& options) {
  subcommand
      .add_option_function<std::string>(
          "--for", [&options](const std::string& use) { options.workload = parse_workload(use); },
          "Which kernel the order should be best for, if `auto` chooses it:\n" +
              join(kWorkloads, [](Workload use) { return to_string(use); }))
      ->type_name("KERNEL")
      ->default_str(std::string(to_string(options.workload)));
  subcommand.add_option("--seed", options.seed, "Seed of random orders, of METIS and of start vectors")
      ->check(not_negative())
      ->capture_default_str();
  subcommand
      .add_option("--tolerance", options.tolerance,
                  "Residual of Fiedler vectors relative to lambda2; below 0.1 the order hardly changes")
      ->check(positive())
      ->capture_default_str();
}

CLI::Option* add_ids_option(CLI::App& subcommand, std::string& ids) {
  return subcommand
      .add_option("--ids", ids,
                  "Numbers that the file gives its vertices and cells: `renumber` sorts them along the new\n"
                  "order; `keep` leaves each with its vertex or cell, so that other files that name it stay\n"
                  "valid; `attach` sorts them, and adds the old ones as arrays `original`")
      ->check(CLI::IsMember({"renumber", "keep", "attach"}))
      ->capture_default_str();
}

void add_cache_option(CLI::App& subcommand, std::string& caches) {
  subcommand.add_option(
      "--cache", caches,
      "Caches to predict misses for: this (machine), paper, or the sizes of the levels, such as\n"
      "48K,1M,32M");
}

void with_threads(int threads, const std::function<void()>& work) {
  if (threads > 0) {
    // leaked on purpose: destroying global_control wakes a TBB worker at exit
    alignas(tbb::global_control) static std::array<std::byte, sizeof(tbb::global_control)> limit;
    new (limit.data())
        tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  work();
}

}  // namespace meshorder::command
