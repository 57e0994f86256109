// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/motion/mass.hpp"

#include "base/parallel.hpp"

#include <algorithm>

namespace meshorder {
namespace {

double mass_of(Offset simplex, const RestShapes& rest, std::span<const double> densities) {
  return (densities.size() == 1 ? densities.front() : densities[simplex]) * rest.volume(simplex);
}

}  // namespace

std::vector<double> lumped_masses(const RestShapes& rest, std::span<const double> densities,
                                  Index vertex_count) {
  const Index corners = rest.dimension + 1;
  std::vector<double> masses(vertex_count, 0.0);
  for (Offset s = 0; s < rest.count; ++s) {
    const double share = mass_of(s, rest, densities) / corners;
    for (Index a = 0; a < corners; ++a) masses[rest.vertex(s, a)] += share;
  }
  return masses;
}

MassMatrix mass_matrix(Mass kind, const RestShapes& rest, std::span<const double> densities,
                       const AssemblyMap& map, const BlockCsr& pattern) {
  const Index corners = rest.dimension + 1;
  MassMatrix mass;
  mass.vertices = lumped_masses(rest, densities, pattern.size());
  if (kind == Mass::lumped) return mass;
  mass.blocks.assign(pattern.block_count(), 0.0);
  for (Offset s = 0; s < rest.count; ++s) {
    const double whole = mass_of(s, rest, densities);
    for (Index a = 0; a < corners; ++a) {
      for (Index b = 0; b < corners; ++b) {
        // ∫ φ_a φ_b = V (1 + δ_ab) / (D + 1)(D + 2)
        const double share = whole * (a == b ? 2 : 1) / (corners * (corners + 1));
        mass.blocks[map.blocks[corners * (corners * s + a) + b]] += share;
      }
    }
  }
  return mass;
}

void multiply(const MassMatrix& mass, const BlockCsr& pattern, std::span<const double> x,
              std::span<double> y) {
  constexpr Index kChunk = 4096;  // rows
  for_each_chunk(pattern.size(), kChunk, [&](Index, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) {
      double* const q = y.data() + Offset{3} * v;
      if (mass.blocks.empty()) {
        for (int c = 0; c < 3; ++c) q[c] = mass.vertices[v] * x[Offset{3} * v + c];
        continue;
      }
      std::fill(q, q + 3, 0.0);
      for (Offset k = pattern.offsets[v]; k < pattern.offsets[v + 1]; ++k) {
        const double* const p = x.data() + Offset{3} * pattern.columns[k];
        for (int c = 0; c < 3; ++c) q[c] += mass.blocks[k] * p[c];
      }
    }
  });
}

void set_rows(const MassMatrix& mass, double factor, Index begin_row, Index end_row, BlockCsr& matrix) {
  std::fill(matrix.values.begin() + 9 * matrix.offsets[begin_row],
            matrix.values.begin() + 9 * matrix.offsets[end_row], 0.0);
  const auto set = [&](Offset block, double m) {
    for (const int i : {0, 4, 8}) matrix.values[9 * block + i] = factor * m;
  };
  for (Index v = begin_row; v < end_row; ++v) {
    if (mass.blocks.empty()) {
      set(matrix.find(v, v), mass.vertices[v]);
      continue;
    }
    for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) set(k, mass.blocks[k]);
  }
}

}  // namespace meshorder
