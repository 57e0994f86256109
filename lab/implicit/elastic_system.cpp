// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/implicit/elastic_system.hpp"

#include "base/parallel.hpp"
#include "graph/incidence.hpp"
#include "kernels/positions.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace meshorder {
namespace {

CsrGraph graph_of(const Simplices& simplices, Index vertex_count) {
  Incidence incidence;
  incidence.vertex_count = vertex_count;
  incidence.vertices = simplices.vertices;
  incidence.offsets.resize(simplices.size() + 1);
  for (Offset s = 0; s <= simplices.size(); ++s) incidence.offsets[s] = (simplices.dimension + 1) * s;
  return joined_vertices(incidence);
}

void check_masses(const RestShapes& rest, const MassMatrix& mass) {
  for (Offset s = 0; s < rest.count; ++s) {
    for (Index a = 0; a <= rest.dimension; ++a) {
      const Index v = rest.vertex(s, a);
      if (mass.vertices[v] > 0.0) continue;
      throw InvalidArgument("vertex " + std::to_string(v) +
                            " has no mass: all tetrahedra at it are flat; remove them from the mesh");
    }
  }
}

}  // namespace

ElasticSystem::ElasticSystem(std::span<const Point> points, const Body& body, Mass mass)
    : elasticity_(body.elasticity) {
  if (body.simplices.dimension != 3 || body.simplices.vertices.empty()) {
    throw InvalidArgument(
        "a body of tetrahedra is needed (or of cells that can be cut into them: pyramids, wedges, "
        "hexahedra); the mesh has no volume cells");
  }
  const auto count = static_cast<std::size_t>(body.simplices.size());
  if (body.densities.size() != 1 && body.densities.size() != count) {
    throw InvalidArgument("densities: one, or one for each of the " + std::to_string(count) + " tetrahedra");
  }
  rest_ = rest_shapes(body.simplices, points);
  matrix_ = zero_block_csr(graph_of(body.simplices, index_size(points)));
  map_ = assembly_map(rest_, matrix_);
  mass_ = mass_matrix(mass, rest_, body.densities, map_, matrix_);
  check_masses(rest_, mass_);

  const Index parts = std::max(1, thread_count());
  const std::vector<Index> bounds = balanced_ranges(matrix_.offsets, parts);
  std::vector<OwnedBatches> batches = owned_batches(rest_.vertices, rest_.dimension + 1, bounds);
  for (Index part = 0; part < parts; ++part) {
    OwnedBlocks blocks = owned_blocks(rest_, map_, matrix_, batches[part], part);
    shares_.push_back({std::move(batches[part]), std::move(blocks)});
  }
  matrix_.values.resize(9 * static_cast<std::size_t>(shares_.back().blocks.room), 0.0);
  // allocated last: positions allocated next are then at a distance from the forces (see kApart)
  forces_ = padded_zeros(shares_.back().batches.room);
}

void ElasticSystem::assemble(std::span<const double> positions, Tangent tangent, double mass_factor,
                             double stiffness_factor, const BlockCsr* added) {
  // only during this assembly: elasticity() keeps the body's own tangent
  const Tangent given = std::exchange(elasticity_.tangent, tangent);
  const Stiffness stiffness{map_, matrix_, stiffness_factor};
  for_each_part(index_size(shares_), [&](Index part) {
    const Share& share = shares_[part];
    const Index begin = share.batches.begin;
    const Index end = share.batches.end;
    std::fill(forces_.begin() + Offset{kPaddedStride} * begin, forces_.begin() + Offset{kPaddedStride} * end,
              0.0);
    set_rows(mass_, mass_factor, begin, end, matrix_);
    if (added != nullptr) {
      for (Offset i = 9 * matrix_.offsets[begin]; i < 9 * matrix_.offsets[end]; ++i) {
        matrix_.values[i] += added->values[i];
      }
    }
    add_elasticity(rest_, elasticity_, positions, forces_, &stiffness, share.batches, share.blocks);
  });
  elasticity_.tangent = given;
}

void ElasticSystem::compute_forces(std::span<const double> positions) {
  for_each_part(index_size(shares_), [&](Index part) {
    const Share& share = shares_[part];
    std::fill(forces_.begin() + Offset{kPaddedStride} * share.batches.begin,
              forces_.begin() + Offset{kPaddedStride} * share.batches.end, 0.0);
    add_elasticity(rest_, elasticity_, positions, forces_, nullptr, share.batches, share.blocks);
  });
}

std::size_t ElasticSystem::bytes() const {
  const auto of = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  std::size_t sum = of(rest_.vertices) + of(rest_.geometry) + of(elasticity_.mu) + of(elasticity_.lambda) +
                    of(matrix_.offsets) + of(matrix_.columns) + of(matrix_.values) + of(map_.blocks) +
                    of(mass_.vertices) + of(mass_.blocks) + of(forces_);
  for (const Share& share : shares_) {
    sum += of(share.batches.batches) + of(share.batches.boundary) + of(share.batches.targets) +
           of(share.blocks.blocks);
  }
  return sum;
}

}  // namespace meshorder
