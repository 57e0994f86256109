// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include "lab/motion/integrator.hpp"
#include "lab/scenario/fingerprint.hpp"
#include "lab/scenario/scenario.hpp"
#include "mesh/reorder.hpp"

#include <memory>
#include <vector>

namespace meshorder {

/// A scenario with its mesh, ready to be stepped.
struct Simulation {
  Scenario scenario;
  Mesh mesh;         ///< at rest, scaled and in the order that is simulated
  Reordering order;  ///< how it came from the mesh's own order
  Offset tetrahedra = 0;
  std::unique_ptr<Integrator> body;
  std::vector<Index> vertices;  ///< those of volume cells, rising
  Fingerprint fingerprint;
  Notes notes;               ///< what deserves a word
  double order_seconds = 0;  ///< the vertex graph, both orders, moving the mesh
  double setup_seconds = 0;  ///< the body
};

/// Throws Error unless the mesh has cells of volume; `file` is named.
void require_volume_cells(const Mesh& mesh, const std::string& file);

/// Scales and places a mesh as the scenario says, puts it in the order that it names, finds the vertices that
/// it means and makes the body of the mesh's volume cells, which are cut into tetrahedra. `file` is the
/// mesh's, for errors. Throws Error, which names the file and the place in it, for what the mesh has not;
/// InvalidArgument for unknown orders. O(size of the mesh), and the order's cost.
Simulation set_up(Scenario scenario, Mesh mesh, const std::string& file,
                  const OrderingOptions& ordering = {});

/// The same in an order that is there already; those that the scenario names do not count. Throws
/// InvalidArgument when the order is of another mesh.
Simulation set_up(Scenario scenario, Mesh mesh, const std::string& file, Reordering order);

}  // namespace meshorder
