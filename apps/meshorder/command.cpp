// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"

#include "base/memory.hpp"
#include "base/text.hpp"
#include "confinement.hpp"
#include "io/stream/read_limits.hpp"

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace meshorder::command {
namespace {

/// Largest limit on threads that is given to TBB, which allocates memory for each thread.
constexpr int kMostThreads = 1024;

const std::map<std::string, int> kDimensionsByName{{"volume", 3}, {"surface", 2}, {"curve", 1}, {"point", 0}};

/// Returns a message: "-1 is not allowed, must be 0 or more".
std::string refusal(const std::string& text, const std::string& must) {
  return text + " is not allowed, must be " + must;
}

bool is_digits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Accepts whole numbers from `lowest` to `highest`. Refuses smaller numbers with the words `if_less`, larger
/// numbers with `if_more`.
CLI::Validator whole_number(std::uint64_t lowest, std::uint64_t highest, const std::string& if_less,
                            const std::string& if_more) {
  return {[=](const std::string& text) {
            const bool negative = text.starts_with('-');
            const std::string_view digits = std::string_view(text).substr(negative ? 1 : 0);
            if (!is_digits(digits)) return "'" + text + "' is not a whole number";
            std::uint64_t number = 0;
            const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
            const bool is_zero = error == std::errc() && number == 0;
            if (negative ? !is_zero || lowest > 0 : error == std::errc() && number < lowest)
              return refusal(text, if_less);
            return error != std::errc() || number > highest ? refusal(text, if_more) : std::string();
          },
          ""};
}

/// Returns the bytes of "4G", UINT64_MAX for "none", nullopt for 0 and other texts.
std::optional<std::uint64_t> limit_of(const std::string& text) {
  if (text == "none") return UINT64_MAX;
  const std::optional<std::uint64_t> size = parse_size(text);
  return size && *size > 0 ? size : std::nullopt;
}

}  // namespace

CLI::Validator positive() {
  return {[](const std::string& text) {
            char* end = nullptr;
            const double number = std::strtod(text.c_str(), &end);
            if (end == text.c_str() || *end != '\0') return "'" + text + "' is not a number";
            const bool allowed = number > 0 && std::isfinite(number);
            return allowed ? std::string() : refusal(text, "more than 0");
          },
          ""};
}

CLI::Validator whole_from(std::uint64_t lowest, std::uint64_t highest) {
  return whole_number(lowest, highest, std::to_string(lowest) + " or more",
                      std::to_string(highest) + " or less");
}

CLI::Validator in_range(int lowest, int highest) {
  const std::string range = "from " + std::to_string(lowest) + " to " + std::to_string(highest);
  return whole_number(static_cast<std::uint64_t>(lowest), static_cast<std::uint64_t>(highest), range, range);
}

MeshMethods order_named(const std::string& name) {
  MeshMethods order;
  const auto slash = name.find('/');
  order.vertices = name.substr(0, slash);
  constexpr std::array<std::string_view, 3> kOfBoth{"auto", "original", "scrambled"};
  const bool is_of_both = std::find(kOfBoth.begin(), kOfBoth.end(), order.vertices) != kOfBoth.end();
  order.elements = slash != std::string::npos ? name.substr(slash + 1)
                   : is_of_both               ? order.vertices
                                              : "lexmax";
  return order;
}

void add_common(CLI::App& subcommand, Common& common, const std::string& quiet) {
  subcommand.add_flag("--json", common.json, "Print one JSON object on stdout, with the warnings in `notes`");
  subcommand.add_flag("--quiet,-q", common.quiet, quiet);
  subcommand
      .add_option("--threads", common.threads,
                  "Maximum number of threads (0 = all). Orders and meshes are the same for any number")
      ->check(whole_from(0))
      ->capture_default_str();
}

void add_keeping_options(CLI::App& subcommand, Keeping& keeping) {
  subcommand
      .add_option_function<std::string>(
          "--only", [&keeping](const std::string& name) { keeping.dimension = kDimensionsByName.at(name); },
          "Keep only cells of this kind, and all vertices: volume, surface, curve or point")
      ->check(CLI::IsMember(kDimensionsByName))
      ->type_name("CELLS");
  subcommand.add_flag(
      "--strict", keeping.strict,
      "Fail if the output format cannot hold some cells, arrays, sets or ids. Without --strict these are\n"
      "left out and listed on stderr");
}

void add_seed_option(CLI::App& subcommand, std::uint64_t& seed) {
  subcommand
      .add_option("--seed", seed, "Seed of random orders, of METIS and of start vectors of the eigensolver")
      ->check(whole_from(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str();
}

void add_workload_option(CLI::App& subcommand, OrderOptions& options) {
  subcommand
      .add_option_function<std::string>(
          "--for", [&options](const std::string& use) { options.workload = parse_workload(use); },
          "Use or property for which `auto` chooses the order:\n" +
              join(kWorkloads, [](Workload use) { return to_string(use); }))
      ->type_name("USE")
      ->default_str(std::string(to_string(options.workload)));
}

void add_ordering_options(CLI::App& subcommand, OrderOptions& options) {
  add_workload_option(subcommand, options);
  add_seed_option(subcommand, options.seed);
  subcommand
      .add_option("--tolerance", options.tolerance,
                  "Residual of Fiedler vectors relative to lambda2; below 0.1, mesh orders hardly change")
      ->check(positive())
      ->capture_default_str();
}

CLI::Option* add_ids_option(CLI::App& subcommand, std::string& ids) {
  return subcommand
      .add_option(
          "--ids", ids,
          "Numbers of vertices and cells in the file. `renumber` sorts them along the new order. `keep`\n"
          "leaves each number with its vertex or cell; other files that use the numbers then stay valid.\n"
          "`attach` sorts them and adds the old ones as arrays `original`")
      ->check(CLI::IsMember({"renumber", "keep", "attach"}))
      ->capture_default_str();
}

void add_cache_option(CLI::App& subcommand, std::string& caches) {
  subcommand.add_option(
      "--cache", caches,
      "Caches for which misses are predicted: `this` for those of this machine, `paper` for those of the\n"
      "paper, or the sizes of the levels, such as 48K,1M,32M");
}

void add_reading_options(CLI::App& subcommand) {
  subcommand
      .add_option_function<std::string>(
          "--limit-memory", [](const std::string& text) { set_memory_limit(*limit_of(text)); },
          "Memory limit, such as 4G. It applies to the graph of the cells and to values that the file has\n"
          "in a short form: compressed, repeated or only counted. Files that need more are refused. `none`:\n"
          "no limit. Default: 256M plus 100 times the file's size, at most three quarters of the memory")
      ->check(CLI::Validator(
          [](std::string& text) {
            return limit_of(text) ? std::string() : "'" + text + "' is neither a size, such as 4G, nor none";
          },
          ""))
      ->type_name("SIZE");
  subcommand
      .add_option_function<std::vector<std::string>>(
          "--allow-includes-from",
          [](const std::vector<std::string>& folders) {
            for (const std::string& folder : folders) allow_includes_from(folder);
          },
          "Also read included files from this folder and its subfolders, not only from the folder of the\n"
          "mesh; may be repeated")
      ->check(CLI::ExistingDirectory)
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  subcommand.add_flag_callback(
      "--trust", trust_files,
      "Read CGNS, Exodus, MED, VTKHDF and XDMF files with all rights of this process. By default, a\n"
      "confined process reads them, because libraries parse them");
}

void with_threads(int threads, const std::function<void()>& work) {
  if (threads > 0) {
    // leaked on purpose: destroying global_control wakes a TBB worker at exit
    alignas(tbb::global_control) static std::array<std::byte, sizeof(tbb::global_control)> limit;
    new (limit.data()) tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                           static_cast<std::size_t>(std::min(threads, kMostThreads)));
  }
  work();
}

}  // namespace meshorder::command
