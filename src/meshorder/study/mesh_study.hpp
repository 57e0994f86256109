// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh/mesh_ordering.hpp>
#include <meshorder/study/kernel_timing.hpp>
#include <meshorder/study/results.hpp>

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
  std::vector<NamedCaches> hierarchies;  ///< empty: this machine's and the paper's
  bool measure = true;                   ///< time the kernels
  TimingOptions timing = {};
  /// Is told what is done, and which fraction of the time is over by then.
  std::function<void(std::string_view what, double fraction)> progress = {};
};

/// Computes the orders of a mesh, what each costs (the best of three where it takes less than a second), its
/// edge spans, the simulated misses of the kernels, and their predicted and measured times. Of meshes of more
/// than a million simplices reuse is estimated from a sample of the lines. Changes nothing. `name` and `file`
/// of the record are the caller's to fill. Misses and spans are the same on every run.
OrderedMesh study_mesh(const Mesh& mesh, const std::vector<StudyOrdering>& orderings,
                       const MeshStudyOptions& options = {});

}  // namespace meshorder
