// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/material.hpp"
#include "kernels/simplices.hpp"
#include "mesh/groups.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// The material of a part of a body.
struct Material {
  double young = 1e6;       ///< Young's modulus E > 0, Pa
  double poisson = 0.45;    ///< Poisson's ratio, −1 < ν < ½
  double density = 1000.0;  ///< ρ > 0, kg/m³
};

/// The material of one region: of the set of cells called `region`, or of the cells with that value ("7").
struct RegionMaterial {
  std::string region;
  Material material;
};

/// The materials of all simplices, in the form that Elasticity takes.
struct SimplexMaterials {
  Lame lame;                         ///< parameters of all simplices, if `mu` and `lambda` are empty
  AlignedVector<double> mu, lambda;  ///< parameters of each simplex, padded to whole batches
  std::vector<double> densities;     ///< one entry for all simplices, or one for each
};

/// Returns one material for all simplices. Throws InvalidArgument, which states the valid range, for numbers
/// that are out of range or not finite.
SimplexMaterials uniform_material(const Material& material);

/// Returns the materials of simplices whose cells are grouped: the materials of `regions` in the cells of
/// these regions, `elsewhere` in all other cells. Throws InvalidArgument for numbers out of range, simplices
/// that do not name their cells, a grouping of vertices or of another mesh, a region given twice, and a
/// region without simplices; the message then lists regions that have some. O(simplices + regions · groups).
SimplexMaterials materials_by_region(const Simplices& simplices, const Grouping& grouping,
                                     const Material& elsewhere, const std::vector<RegionMaterial>& regions);

/// Returns the elastic law of a body of these materials.
Elasticity elasticity_of(SimplexMaterials materials, MaterialModel model, Tangent tangent);

}  // namespace meshorder
