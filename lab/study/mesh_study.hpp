// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"
#include "mesh/reorder.hpp"
#include "payoff/kernel_timing.hpp"

#include <functional>
#include <string_view>
#include <vector>

namespace meshorder {

/// A mesh with the orders of a study.
struct OrderedMesh {
  MeshRecord record;
  std::vector<Reordering> orders;  ///< as record.orders
};

struct MeshStudyOptions {
  OrderingOptions ordering = {};
  /// Empty: this machine's and the paper's. Times are predicted for the first.
  std::vector<NamedCaches> hierarchies = {};
  int threads = 0;      ///< that orders are computed with when their cost is timed; 0: all
  bool measure = true;  ///< time the kernels
  TimingOptions timing = {};
  /// Is told what is done, and which fraction of the time is over by then.
  std::function<void(std::string_view what, double fraction)> progress = {};
};

/// This machine's and the paper's, by the names that a study gives them.
std::vector<NamedCaches> hierarchies_of_studies();

/// How wide the bins of a span histogram are: the paper's 50 up to 200,000 vertices; above, n/4000, rounded
/// up to a multiple of 50, so that there are 4000 bins at most.
Index span_bin_width(Index vertices);

/// Computes the orders of a mesh, what each costs (the best of three where it takes less than a second; an
/// order that leaves all in its place costs nothing), its edge spans, the simulated misses of the kernels,
/// and their predicted and measured times. Of meshes of more than a million simplices reuse is estimated from
/// a sample of the lines. Changes nothing. A file's layout in blocks of cells is not kept, as in simulations.
/// `name`, `file` and `verdict` of the record are the caller's to fill. Misses and spans are the same on
/// every run. Throws InvalidArgument for unknown methods. O(size of the mesh · orders), the orders' costs and
/// the time that `timing` allows.
OrderedMesh study_mesh(const Mesh& mesh, const std::vector<StudyOrdering>& orderings,
                       const MeshStudyOptions& options = {});

}  // namespace meshorder
