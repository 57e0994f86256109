// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "metrics/cache.hpp"
#include "payoff/mesh_comparison.hpp"
#include <meshorder/layouts.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace meshorder::command {

/// A comparison with the further data of its report.
struct ComparisonReport : MeshComparison {
  std::string file = {};
  std::string size = {};                       ///< in words
  Caches caches = {};                          ///< caches for which misses are predicted
  std::vector<GpuLayout> gpu_layouts = {};     ///< for which additions on a graphics processor are counted
  std::vector<std::vector<GpuCost>> gpu = {};  ///< of each order in each layout; empty without layouts
};

/// Prints the best order, the command that makes it, and the speedup of each order over the file's own.
void print_comparison(const Console& console, const ComparisonReport& comparison);

/// Prints costs and spans, predicted misses, and the times of kernels for each number of threads.
void print_comparison_details(Console& console, const ComparisonReport& comparison);

/// Returns the keys that docs/json.md lists, except those that describe the file.
nlohmann::ordered_json to_json(const ComparisonReport& comparison);

}  // namespace meshorder::command
