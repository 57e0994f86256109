// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "kernels/assembly.hpp"
#include "kernels/elasticity.hpp"
#include "lab/motion/mass.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Simplices, their elastic law and their densities.
struct Body {
  Simplices simplices;  ///< tetrahedra
  Elasticity elasticity;
  std::vector<double> densities;  ///< kg/m³: one, or one for each simplex
};

/// The mass, forces and matrix of an elastic body, assembled by all threads in the order of vertices and
/// simplices: each thread adds to its own rows (see owned_batches). Results have the same bits for any number
/// of threads.
class ElasticSystem {
 public:
  /// Throws InvalidArgument for a body that is not of tetrahedra, for a wrong number of densities, and for a
  /// tetrahedron at a vertex without mass. O(simplices · log degree).
  ElasticSystem(std::span<const Point> points, const Body& body, Mass mass);

  /// Computes forces() = −∂E/∂x at the positions (see padded_positions), and matrix() = mass_factor M +
  /// stiffness_factor K + `added`, which has the same pattern or is null. O(simplices).
  void assemble(std::span<const double> positions, Tangent tangent, double mass_factor,
                double stiffness_factor, const BlockCsr* added = nullptr);
  /// Computes only the forces. O(simplices).
  void compute_forces(std::span<const double> positions);

  [[nodiscard]] const BlockCsr& matrix() const noexcept { return matrix_; }
  [[nodiscard]] BlockCsr& matrix() noexcept { return matrix_; }
  [[nodiscard]] std::span<const double> forces() const noexcept { return forces_; }  ///< 4 a vertex
  [[nodiscard]] const MassMatrix& mass() const noexcept { return mass_; }
  [[nodiscard]] const RestShapes& rest() const noexcept { return rest_; }
  [[nodiscard]] const Elasticity& elasticity() const noexcept { return elasticity_; }
  [[nodiscard]] Index vertex_count() const noexcept { return matrix_.size(); }

  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Share {
    OwnedBatches batches;
    OwnedBlocks blocks;
  };

  RestShapes rest_;
  Elasticity elasticity_;
  BlockCsr matrix_;
  AssemblyMap map_;
  MassMatrix mass_;
  AlignedVector<double> forces_;
  std::vector<Share> shares_;
};

}  // namespace meshorder
