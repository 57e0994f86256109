// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/regions.hpp"

#include "kernels/elasticity.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace meshorder {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr Material kRubber{1e6, 0.45, 1000};
constexpr Material kSteelRegion{2e11, 0.3, 7850};

/// Two cubes of region 7, two of region −2 and one of none, with faces of region 5; sets likewise.
Mesh bar_of_regions() {
  Mesh mesh = test::tetrahedral_bar(5);
  mesh.data.clear();
  mesh.sets.clear();
  for (Index i = 0; i < 5; ++i)
    mesh.cells.push_back(Shape::triangle, std::vector<Index>{4 * i, 4 * i + 4, 4 * i + 5});
  DataArray regions{"region", Association::cells, 1, {}, {}, {}};
  std::vector<std::int32_t> values;
  mesh.sets = {
      {"axle", Association::cells, {}}, {"tyre", Association::cells, {}}, {"faces", Association::cells, {}}};
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const bool face = mesh.cells.shapes[c] == Shape::triangle;
    if (!face && c / 6 == 4) continue;
    regions.indices.push_back(c);
    values.push_back(face ? 5 : c / 6 < 2 ? 7 : -2);
    mesh.sets[face ? 2 : c / 6 < 2 ? 0 : 1].members.push_back(c);
  }
  regions.values = values;
  mesh.data.push_back(regions);
  return mesh;
}

void expect_materials(const Simplices& simplices, const SimplexMaterials& materials) {
  const Lame steel = Lame::from_young(2e11, 0.3);
  const Lame rubber = Lame::from_young(1e6, 0.45);
  ASSERT_EQ(simplices.size(), 30);
  ASSERT_EQ(materials.mu.size(), 32U);
  ASSERT_EQ(materials.lambda.size(), 32U);
  ASSERT_EQ(materials.densities.size(), 30U);
  for (Index s = 0; s < 32; ++s) {
    EXPECT_EQ(materials.mu[s], s < 12 ? steel.mu : rubber.mu);
    EXPECT_EQ(materials.lambda[s], s < 12 ? steel.lambda : rubber.lambda);
  }
  for (Index s = 0; s < 30; ++s) {
    EXPECT_EQ(materials.densities[s], s < 12 ? 7850 : s < 24 ? 1000 : 500);
  }
}

TEST(MaterialsByRegion, FollowValues) {
  const Mesh mesh = bar_of_regions();
  const Simplices simplices = cut_into_simplices(mesh);
  const Material soft{1e6, 0.45, 500};
  expect_materials(simplices, materials_by_region(simplices, grouping_by(mesh, "region"), soft,
                                                  {{"7", kSteelRegion}, {"-2", kRubber}}));
}

TEST(MaterialsByRegion, FollowSets) {
  const Mesh mesh = bar_of_regions();
  const Simplices simplices = cut_into_simplices(mesh);
  const Material soft{1e6, 0.45, 500};
  expect_materials(simplices, materials_by_region(simplices, grouping_by(mesh, "sets"), soft,
                                                  {{"tyre", kRubber}, {"axle", kSteelRegion}}));
}

/// The energy of only the simplices first … last − 1.
double energy_of_some(const RestShapes& rest, MaterialModel model, const Lame& lame, Index first, Index last,
                      const AlignedVector<double>& x) {
  Elasticity some{model, Tangent::exact, {}, {}, {}};
  for (Index s = 0; s < rest.batches() * kBatch; ++s) {
    some.mu.push_back(s >= first && s < last ? lame.mu : 0.0);
    some.lambda.push_back(s >= first && s < last ? lame.lambda : 0.0);
  }
  return elastic_energy(rest, some, x);
}

TEST(MaterialsByRegion, GiveEachElementItsEnergy) {
  const Mesh mesh = bar_of_regions();
  const Simplices simplices = cut_into_simplices(mesh);
  const RestShapes rest = rest_shapes(simplices, mesh.points);
  AlignedVector<double> x = padded_positions(mesh.points);
  for (std::size_t i = 0; i < x.size(); i += kPaddedStride) x[i] *= 1.1;
  const SimplexMaterials materials =
      materials_by_region(simplices, grouping_by(mesh, "region"), kRubber, {{"7", kSteelRegion}});
  for (const MaterialModel model :
       {MaterialModel::corotational, MaterialModel::stvk, MaterialModel::neo_hookean}) {
    const double of_steel = energy_of_some(rest, model, Lame::from_young(2e11, 0.3), 0, 12, x);
    const double of_rubber = energy_of_some(rest, model, Lame::from_young(1e6, 0.45), 12, 30, x);
    EXPECT_GT(of_steel, 0.0);
    EXPECT_GT(of_rubber, 0.0);
    const double both = elastic_energy(rest, elasticity_of(materials, model, Tangent::exact), x);
    EXPECT_NEAR(both, of_steel + of_rubber, 1e-12 * both);
  }
}

TEST(MaterialsByRegion, AreUniformWithoutRegions) {
  const Mesh mesh = bar_of_regions();
  const SimplexMaterials materials =
      materials_by_region(cut_into_simplices(mesh), grouping_by(mesh, "region"), kRubber, {});
  EXPECT_TRUE(materials.mu.empty());
  EXPECT_EQ(materials.lame.mu, Lame::from_young(1e6, 0.45).mu);
  EXPECT_EQ(materials.densities, std::vector<double>{1000});
}

TEST(MaterialsByRegion, ListTheRegionsThatThereAre) {
  const Mesh mesh = bar_of_regions();
  const Simplices simplices = cut_into_simplices(mesh);
  const auto materials = [&](const char* by, const char* region) {
    return [&, by, region] {
      return materials_by_region(simplices, grouping_by(mesh, by), kRubber, {{region, kSteelRegion}});
    };
  };
  EXPECT_THAT(materials("region", "8"), ThrowsMessage<InvalidArgument>(HasSubstr(
                                            "no element is in a region '8' of 'region'; there are: -2, 7")));
  EXPECT_THAT(materials("sets", "axel"), ThrowsMessage<InvalidArgument>(HasSubstr("there are: axle, tyre")));
  // a region of faces alone has no element
  EXPECT_THAT(materials("sets", "faces"), ThrowsMessage<InvalidArgument>(HasSubstr("axle, tyre")));
}

TEST(MaterialsByRegion, RefuseWhatMakesNoSense) {
  Mesh mesh = bar_of_regions();
  const Simplices simplices = cut_into_simplices(mesh);
  const Grouping grouping = grouping_by(mesh, "region");
  EXPECT_THAT(
      [&] {
        return materials_by_region(simplices, grouping, kRubber, {{"7", kSteelRegion}, {"7", kRubber}});
      },
      ThrowsMessage<InvalidArgument>(HasSubstr("given twice")));
  EXPECT_THAT(
      [&] {
        return materials_by_region(simplices, grouping, kRubber, {{"7", {1e6, 0.5, 1}}});
      },
      ThrowsMessage<InvalidArgument>(HasSubstr("region '7': Poisson's ratio is 0.5;")));
  EXPECT_THROW(materials_by_region(cut_into_simplices(test::tetrahedral_bar(50)), grouping, kRubber, {}),
               InvalidArgument);
  mesh.data.push_back(
      {"part", Association::vertices, 1, std::vector<std::int32_t>(mesh.points.size(), 1), {}, {}});
  EXPECT_THROW(materials_by_region(simplices, grouping_by(mesh, "part"), kRubber, {}), InvalidArgument);
}

TEST(UniformMaterial, SaysWhatIsOutOfRange) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_THAT(
        [&] {
          return uniform_material({bad, 0.3, 1});
        },
        ThrowsMessage<InvalidArgument>(HasSubstr("Young's modulus")));
    EXPECT_THAT(
        [&] {
          return uniform_material({1, 0.3, bad});
        },
        ThrowsMessage<InvalidArgument>(HasSubstr("density")));
  }
  for (const double bad : {0.5, -1.0, 2.0, kNan, kInfinity, -kInfinity}) {
    EXPECT_THAT(
        [&] {
          return uniform_material({1, bad, 1});
        },
        ThrowsMessage<InvalidArgument>(HasSubstr("above -1 and below 0.5")));
  }
  EXPECT_NO_THROW(uniform_material({1, -0.99, 1}));
  EXPECT_NO_THROW(uniform_material({1, 0.4999, 1}));
}

}  // namespace
}  // namespace meshorder
