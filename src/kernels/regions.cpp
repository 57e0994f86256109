// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/regions.hpp"

#include <meshorder/error.hpp>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace meshorder {
namespace {

[[noreturn]] void refuse(const std::string& whose, const std::string& what, double value,
                         const std::string& remedy) {
  throw InvalidArgument(fmt::format("material{}: {} is {}; {}", whose, what, value, remedy));
}

/// Throws InvalidArgument for numbers out of range. `whose` is empty or " of region 'steel'".
void check(const Material& material, const std::string& whose) {
  if (!(material.young > 0.0) || !std::isfinite(material.young)) {
    refuse(whose, "Young's modulus", material.young, "it must be positive, in Pa");
  }
  if (!(material.poisson > -1.0 && material.poisson < 0.5)) {
    refuse(whose, "Poisson's ratio", material.poisson, "it must be above -1 and below 0.5");
  }
  if (!(material.density > 0.0) || !std::isfinite(material.density)) {
    refuse(whose, "the density", material.density, "it must be positive, in kg/m³");
  }
}

std::string name_of(const Grouping& grouping, std::size_t group) {
  return grouping.names.empty() ? std::to_string(grouping.values[group]) : grouping.names[group];
}

/// Returns for every group whether it has a simplex.
std::vector<bool> groups_with_simplices(const Simplices& simplices, const Grouping& grouping) {
  std::vector<bool> has(static_cast<std::size_t>(grouping.count()), false);
  for (const Index cell : simplices.cells) has[grouping.of_cells[cell]] = true;
  return has;
}

/// Returns the group with simplices whose name (or value, if groups have no names) is `region`, if any.
std::optional<std::size_t> find_group(const Grouping& grouping, const std::vector<bool>& has,
                                      const std::string& region) {
  for (std::size_t group = 0; group < grouping.values.size(); ++group) {
    if (has[group] && name_of(grouping, group) == region) return group;
  }
  return std::nullopt;
}

std::string list_of_regions(const Grouping& grouping, const std::vector<bool>& has) {
  // enough names to recognise a misspelt one
  constexpr int kListed = 20;
  std::string list;
  int listed = 0;
  for (std::size_t group = 0; group < grouping.values.size(); ++group) {
    if (!has[group]) continue;
    if (listed++ == kListed) return list + ", …";
    list += (list.empty() ? "" : ", ") + name_of(grouping, group);
  }
  return list.empty() ? "there are none" : "there are: " + list;
}

void check(const Simplices& simplices, const Grouping& grouping) {
  if (grouping.association != Association::cells) {
    throw InvalidArgument("materials: '" + grouping.name +
                          "' groups vertices; give an array or sets on cells");
  }
  const Offset corners = simplices.dimension + 1;
  if (static_cast<Offset>(simplices.cells.size()) * corners !=
      static_cast<Offset>(simplices.vertices.size())) {
    throw InvalidArgument("materials: the simplices do not say which cells they were cut out of");
  }
  const auto last = std::max_element(simplices.cells.begin(), simplices.cells.end());
  if (last != simplices.cells.end() && *last >= index_size(grouping.of_cells)) {
    throw InvalidArgument("materials: the grouping belongs to a mesh of " +
                          std::to_string(grouping.of_cells.size()) + " cells, not to this one");
  }
}

/// Returns the material of each group; the last group has the cells that belong to no group of the grouping.
std::vector<Material> materials_of_groups(const Grouping& grouping, const std::vector<bool>& has,
                                          const Material& elsewhere,
                                          const std::vector<RegionMaterial>& regions) {
  check(elsewhere, "");
  std::vector<Material> materials(static_cast<std::size_t>(grouping.count()), elsewhere);
  std::vector<bool> given(materials.size(), false);
  for (const RegionMaterial& region : regions) {
    check(region.material, " of region '" + region.region + "'");
    const std::optional<std::size_t> group = find_group(grouping, has, region.region);
    if (!group) {
      throw InvalidArgument("materials: no element is in a region '" + region.region + "' of '" +
                            grouping.name + "'; " + list_of_regions(grouping, has));
    }
    if (given[*group]) {
      throw InvalidArgument("materials: region '" + region.region + "' is given twice");
    }
    given[*group] = true;
    materials[*group] = region.material;
  }
  return materials;
}

}  // namespace

SimplexMaterials uniform_material(const Material& material) {
  check(material, "");
  return {Lame::from_young(material.young, material.poisson), {}, {}, {material.density}};
}

SimplexMaterials materials_by_region(const Simplices& simplices, const Grouping& grouping,
                                     const Material& elsewhere, const std::vector<RegionMaterial>& regions) {
  check(simplices, grouping);
  const std::vector<Material> materials =
      materials_of_groups(grouping, groups_with_simplices(simplices, grouping), elsewhere, regions);
  SimplexMaterials result = uniform_material(elsewhere);
  if (regions.empty() || simplices.cells.empty()) return result;
  const std::size_t batches = (simplices.cells.size() + kBatch - 1) / kBatch;
  result.mu.reserve(batches * kBatch);
  result.lambda.reserve(batches * kBatch);
  result.densities.clear();
  result.densities.reserve(simplices.cells.size());
  for (const Index cell : simplices.cells) {
    const Material& material = materials[grouping.of_cells[cell]];
    const Lame lame = Lame::from_young(material.young, material.poisson);
    result.mu.push_back(lame.mu);
    result.lambda.push_back(lame.lambda);
    result.densities.push_back(material.density);
  }
  result.mu.resize(batches * kBatch, result.mu.back());
  result.lambda.resize(batches * kBatch, result.lambda.back());
  return result;
}

Elasticity elasticity_of(SimplexMaterials materials, MaterialModel model, Tangent tangent) {
  return {model, tangent, materials.lame, std::move(materials.mu), std::move(materials.lambda)};
}

}  // namespace meshorder
