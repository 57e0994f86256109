// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/elasticity.hpp"

#include "base/parallel.hpp"
#include "kernels/pass.hpp"
#include <meshorder/error.hpp>

#include <array>
#include <string>

namespace meshorder {
namespace {

ElasticKernels kernels_of(MaterialModel model) {
  switch (model) {
    case MaterialModel::corotational:
      return corotational_kernels();
    case MaterialModel::stvk:
      return stvk_kernels();
    case MaterialModel::neo_hookean:
      return neo_hookean_kernels();
  }
  throw InvalidArgument("elasticity: unknown material model");
}

/// The parameters of a batch, all equal, for a law with the same parameters everywhere.
struct UniformLame {
  alignas(64) std::array<double, kBatch> mu, lambda;

  explicit UniformLame(const Lame& lame) {
    mu.fill(lame.mu);
    lambda.fill(lame.lambda);
  }
};

void check(const RestShapes& rest, const Elasticity& elasticity) {
  if (elasticity.model != MaterialModel::stvk && rest.dimension != 3 && rest.count > 0) {
    throw InvalidArgument("elasticity: simplices of dimension " + std::to_string(rest.dimension) +
                          "; only Saint Venant–Kirchhoff works on simplices other than tetrahedra");
  }
  const auto lanes = static_cast<std::size_t>(rest.batches()) * kBatch;
  const std::size_t mus = elasticity.mu.size();
  if (mus != elasticity.lambda.size() || (mus != 0 && mus != lanes)) {
    throw InvalidArgument("elasticity: " + std::to_string(mus) + " values of mu and " +
                          std::to_string(elasticity.lambda.size()) + " of lambda; give 0 of each, or " +
                          std::to_string(lanes) + ", whole batches");
  }
}

void check_tangent(const RestShapes& rest, const Elasticity& elasticity) {
  if (elasticity.tangent == Tangent::approximate && elasticity.model != MaterialModel::corotational) {
    throw InvalidArgument("elasticity: only the corotational law has an approximate tangent");
  }
  if (elasticity.tangent == Tangent::projected && rest.dimension != 3 && rest.count > 0) {
    throw InvalidArgument(
        "elasticity: only tetrahedra have a projected tangent, not simplices of dimension " +
        std::to_string(rest.dimension));
  }
}

void check(const RestShapes& rest, const Stiffness& stiffness, Offset room) {
  const Offset corners = rest.dimension + 1;
  if (static_cast<Offset>(stiffness.map.blocks.size()) != rest.count * corners * corners) {
    throw InvalidArgument("elasticity: the assembly map belongs to other simplices");
  }
  if (static_cast<Offset>(stiffness.matrix.values.size()) < 9 * room) {
    throw InvalidArgument("elasticity: the matrix must have room for " + std::to_string(room) +
                          " blocks, including spare ones");
  }
}

/// Checks the arguments and returns a pass over all batches without outputs.
ElasticPass checked_pass(const RestShapes& rest, const Elasticity& elasticity, const UniformLame& uniform,
                         std::span<const double> positions) {
  check(rest, elasticity);
  ElasticPass pass{rest, elasticity.tangent};
  pass.positions = positions.data();
  pass.mu = uniform.mu.data();
  pass.lambda = uniform.lambda.data();
  if (!elasticity.mu.empty()) {
    pass.mu = elasticity.mu.data();
    pass.lambda = elasticity.lambda.data();
    pass.lame_stride = kBatch;
  }
  return pass;
}

/// Checks the arguments and returns a pass over all batches that adds forces, a stiffness matrix or both.
ElasticPass checked_pass(const RestShapes& rest, const Elasticity& elasticity, const UniformLame& uniform,
                         std::span<const double> positions, std::span<double> forces,
                         const Stiffness* stiffness) {
  ElasticPass pass = checked_pass(rest, elasticity, uniform, positions);
  if (stiffness) check_tangent(rest, elasticity);
  pass.forces = forces.empty() ? nullptr : forces.data();
  if (stiffness) {
    check(rest, *stiffness, stiffness->matrix.block_count());
    pass.values = stiffness->matrix.values.data();
    pass.blocks = stiffness->map.blocks.data();
    pass.scale = stiffness->scale;
  }
  return pass;
}

bool nothing_to_do(const ElasticPass& pass) { return pass.rest.count == 0 || (!pass.forces && !pass.values); }

}  // namespace

double elastic_energy(const RestShapes& rest, const Elasticity& elasticity,
                      std::span<const double> positions) {
  constexpr Index kBatchesOfAChunk = 512;
  const UniformLame uniform(elasticity.lame);
  const ElasticPass pass = checked_pass(rest, elasticity, uniform, positions);
  if (rest.count == 0) return 0.0;
  const ElasticKernels kernels = kernels_of(elasticity.model);
  return sum_over_chunks<double>(static_cast<Index>(rest.batches()), kBatchesOfAChunk,
                                 [&](Index begin, Index end) { return kernels.energy(pass, begin, end); });
}

void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness) {
  if (!forces.empty()) check_same_size(positions, forces, "add_elasticity");
  const UniformLame uniform(elasticity.lame);
  const ElasticPass pass = checked_pass(rest, elasticity, uniform, positions, forces, stiffness);
  if (!nothing_to_do(pass)) kernels_of(elasticity.model).add(pass);
}

void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness, const OwnedBatches& share,
                    const OwnedBlocks& boundary) {
  if (!forces.empty()) check_room(forces, share, "add_elasticity");
  const UniformLame uniform(elasticity.lame);
  ElasticPass pass = checked_pass(rest, elasticity, uniform, positions, forces, stiffness);
  if (stiffness) check(rest, *stiffness, boundary.room);
  pass.share = &share;
  pass.boundary_blocks = boundary.blocks.data();
  if (!nothing_to_do(pass)) kernels_of(elasticity.model).add(pass);
}

void add_elasticity_scalar(const RestShapes& rest, const Elasticity& elasticity,
                           std::span<const double> positions, std::span<double> forces,
                           const Stiffness* stiffness) {
  if (!forces.empty()) check_same_size(positions, forces, "add_elasticity");
  const UniformLame uniform(elasticity.lame);
  const ElasticPass pass = checked_pass(rest, elasticity, uniform, positions, forces, stiffness);
  if (!nothing_to_do(pass)) kernels_of(elasticity.model).add_one_by_one(pass);
}

}  // namespace meshorder
