// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"
#include "mesh/reorder.hpp"
#include "payoff/kernel_timing.hpp"

#include <functional>
#include <string_view>
#include <vector>

namespace meshorder {

/// A mesh record with the orders that it describes.
struct OrderedMesh {
  MeshRecord record;
  std::vector<MeshOrder> orders;  ///< in the sequence of record.orders
  Steadiness steadiness;          ///< of the machine while kernels were timed
};

struct MeshStudyOptions {
  OrderOptions ordering = {};
  /// Cache hierarchies to simulate; empty: this machine's and the paper's. Times are predicted for the first.
  std::vector<NamedCaches> hierarchies = {};
  int threads = 0;      ///< for computing the orders, whose cost is timed; 0: all
  bool measure = true;  ///< time the kernels
  TimingOptions timing = {};
  /// Called as each stage begins, with the fraction of the time that has passed.
  std::function<void(std::string_view what, double fraction)> progress = {};
};

/// Returns this machine's caches and the paper's, with their names in a study.
std::vector<NamedCaches> hierarchies_of_studies();

/// Returns the width of the bins of a span histogram: the paper's 50 up to 200,000 vertices; above, a 4000th
/// of the vertices rounded up to a multiple of 50, so that there are at most 4000 bins.
Index span_bin_width(Index vertices);

/// Computes the orders of a mesh and, for each: its cost (the best of three if it takes less than a second; 0
/// for an order that moves nothing), its edge spans, the simulated misses of the kernels, and their predicted
/// and measured times. Above a million simplices, reuse is estimated from a sample of the lines. Cell blocks
/// of the file are ignored, as in simulations. The caller fills in the record's `name`, `file`, `verdict` and
/// `gain`. Misses and spans are the same on every run. Throws InvalidArgument for unknown methods. Takes
/// O(size of the mesh · orders), the costs of the orders, and the time that `timing` allows.
OrderedMesh study_mesh(const Mesh& mesh, const std::vector<OrderingSpec>& orderings,
                       const MeshStudyOptions& options = {});

}  // namespace meshorder
