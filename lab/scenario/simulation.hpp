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

/// A scenario with its mesh, ready to be simulated.
struct Simulation {
  Scenario scenario;
  Mesh mesh;        ///< at rest, scaled, in the simulated order
  MeshOrder order;  ///< from the mesh's own order to the simulated one
  Offset tetrahedra = 0;
  std::unique_ptr<Integrator> body;
  std::vector<Index> vertices;  ///< the vertices of volume cells, ascending
  Fingerprint fingerprint;
  Notes notes;               ///< warnings: what was dropped, repaired or looks wrong
  double order_seconds = 0;  ///< for the vertex graph, both orders and moving the mesh
  double setup_seconds = 0;  ///< for the body
};

/// Makes the fluid of a scenario. Simulation::mesh has the particles at the start, without cells; the order
/// is the identity. Throws as the constructors of `Fluid` do.
Simulation set_up_fluid(Scenario scenario, const OrderOptions& ordering = {});

Mesh mesh_at_start(const Scenario& scenario);

/// Throws Error, which names `file`, if the mesh has no volume cells or has polyhedra.
void require_volume_cells(const Mesh& mesh, const std::string& file);

/// Scales, places and orders a mesh as the scenario says, finds the vertices of its loads and makes the body
/// from the mesh's volume cells, cut into tetrahedra. `file` is the mesh's path, for errors. Throws Error for
/// a mesh that cannot be simulated, and for sets, labels or regions that the mesh lacks (with the path in the
/// scenario's file); InvalidArgument for unknown methods. Takes O(size of the mesh), and the cost of the
/// order.
Simulation set_up(Scenario scenario, Mesh mesh, const std::string& file, const OrderOptions& ordering = {});

/// Does the same with a given order. Throws InvalidArgument if the order is of another mesh.
Simulation set_up(Scenario scenario, Mesh mesh, const std::string& file, MeshOrder order);

}  // namespace meshorder
