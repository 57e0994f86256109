// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "kernels/assembly.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

enum class Mass : std::uint8_t {
  lumped,      ///< a quarter of each tetrahedron's mass on each of its corners
  consistent,  ///< ∫ρ φ_a φ_b: a matrix with the pattern of the stiffness matrix
};

template <>
struct EnumNames<Mass> {
  static constexpr std::string_view kind = "mass";
  static constexpr std::array names{std::pair{Mass::lumped, "lumped"},
                                    std::pair{Mass::consistent, "consistent"}};
};

/// Returns the lumped masses of `vertex_count` vertices, kg. `densities` holds one density (kg/m³), or one
/// for each simplex. O(simplices).
std::vector<double> lumped_masses(const RestShapes& rest, std::span<const double> densities,
                                  Index vertex_count);

/// The mass matrix of simplices. Each 3×3 block is a multiple m I of the identity.
struct MassMatrix {
  std::vector<double> vertices;  ///< the mass of each vertex, kg: the sum of its row
  std::vector<double> blocks;    ///< consistent: m of each block of the pattern; lumped: empty
};

/// Returns the mass matrix. `densities` is as in lumped_masses; `map` lists blocks of `pattern`.
/// O(simplices).
MassMatrix mass_matrix(Mass kind, const RestShapes& rest, std::span<const double> densities,
                       const AssemblyMap& map, const BlockCsr& pattern);

/// Computes y = M x, 3 doubles for each vertex. O(vertices), or O(blocks) for a consistent matrix.
void multiply(const MassMatrix& mass, const BlockCsr& pattern, std::span<const double> x,
              std::span<double> y);

/// Sets rows begin_row … end_row − 1 of `matrix` to those of factor · M, with zeros where M has no entries.
void set_rows(const MassMatrix& mass, double factor, Index begin_row, Index end_row, BlockCsr& matrix);

}  // namespace meshorder
