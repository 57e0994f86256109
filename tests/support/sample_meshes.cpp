// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/sample_meshes.hpp"

#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "ordering/moved.hpp"
#include "ordering/order_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace meshorder::test {
namespace {

Point irregular_point(Index v) { return {v + 0.1, std::sin(v * 12.9898) / 3, std::cos(v * 78.233) * 1e-3}; }

void attach_everything(Mesh& mesh) {
  for (const Association association : {Association::vertices, Association::cells}) {
    const Index n = association == Association::vertices ? mesh.vertex_count() : mesh.cell_count();
    std::vector<std::int32_t> labels(n);
    std::vector<double> temperatures(n);
    std::vector<double> stresses(3 * static_cast<std::size_t>(n));
    for (Index i = 0; i < n; ++i) {
      labels[i] = i % 3 + 1;
      temperatures[i] = std::sqrt(i + 2.0);
    }
    for (std::size_t i = 0; i < stresses.size(); ++i) stresses[i] = 1.0 / (static_cast<double>(i) + 3.0);
    mesh.data.push_back({std::string(kLabel), association, 1, labels, {}, {}});
    mesh.data.push_back({"temperature", association, 1, temperatures, {}, {}});
    mesh.data.push_back({"stress", association, 3, stresses, {}, {}});
    EntitySet ends{association == Association::vertices ? "fixed" : "part", association, {0}};
    if (n > 1) ends.members.push_back(n - 1);
    mesh.sets.push_back(std::move(ends));
  }
}

}  // namespace

Mesh cells_of_type(Shape shape, int vertices_per_cell, Index copies) {
  Mesh mesh;
  for (Index c = 0; c < copies; ++c) {
    std::vector<Index> vertices(vertices_per_cell);
    std::iota(vertices.begin(), vertices.end(), c * vertices_per_cell);
    mesh.cells.push_back(shape, vertices);
  }
  for (Index v = 0; v < copies * vertices_per_cell; ++v) mesh.points.push_back(irregular_point(v));
  attach_everything(mesh);
  return mesh;
}

Mesh triangles_and_line(Index triangles) {
  Mesh mesh = cells_of_type(Shape::triangle, 3, triangles);
  mesh.data.clear();
  mesh.sets.clear();
  mesh.cells.push_back(Shape::line, std::vector<Index>{0, 1});
  return mesh;
}

Mesh tetrahedral_bar(Index n) {
  Mesh mesh;
  for (Index i = 0; i <= n; ++i) {
    for (const double y : {0.0, 1.0}) {
      for (const double z : {0.0, 1.0}) mesh.points.push_back({1.0 * i, y, z});
    }
  }
  // Kuhn's six tetrahedra around the diagonal from corner 0 to corner 7 of a cube
  const std::array<std::array<Index, 4>, 6> kuhn{
      {{0, 4, 6, 7}, {0, 6, 2, 7}, {0, 2, 3, 7}, {0, 3, 1, 7}, {0, 1, 5, 7}, {0, 5, 4, 7}}};
  for (Index i = 0; i < n; ++i) {
    for (std::array<Index, 4> tetrahedron : kuhn) {
      for (Index& v : tetrahedron) v += 4 * i;
      mesh.cells.push_back(Shape::tetrahedron, tetrahedron);
    }
  }
  attach_everything(mesh);
  return mesh;
}

Mesh mixed_mesh() {
  Mesh mesh;
  Index next = 0;
  for (int round = 0; round < 3; ++round) {
    for (const auto& [shape, count] : common_types()) {
      std::vector<Index> vertices(count);
      std::iota(vertices.begin(), vertices.end(), next);
      mesh.cells.push_back(shape, vertices);
      next += count / 2;  // the next cell shares vertices with this one
    }
  }
  const Index last = *std::max_element(mesh.cells.vertices.begin(), mesh.cells.vertices.end());
  for (Index v = 0; v <= last; ++v) mesh.points.push_back(irregular_point(v));
  attach_everything(mesh);
  return mesh;
}

CellTypes linear_types() {
  return {{Shape::vertex, 1},      {Shape::line, 2},    {Shape::triangle, 3}, {Shape::quad, 4},
          {Shape::tetrahedron, 4}, {Shape::pyramid, 5}, {Shape::wedge, 6},    {Shape::hexahedron, 8}};
}

CellTypes quadratic_types() {
  return {{Shape::line, 3},         {Shape::triangle, 6},   {Shape::quad, 8},   {Shape::quad, 9},
          {Shape::tetrahedron, 10}, {Shape::pyramid, 13},   {Shape::wedge, 15}, {Shape::wedge, 18},
          {Shape::hexahedron, 20},  {Shape::hexahedron, 27}};
}

CellTypes common_types(const CellTypes& more) {
  CellTypes types = linear_types();
  for (const CellTypes& others : {quadratic_types(), more})
    types.insert(types.end(), others.begin(), others.end());
  return types;
}

Permutation shuffled(Index n, std::uint64_t seed) {
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  std::mt19937_64 random(seed);
  std::shuffle(order.begin(), order.end(), random);
  return Permutation::from_new_to_old(std::move(order));
}

Permutation shuffled_cells(const Mesh& mesh, std::uint64_t seed) {
  return permutation_within_classes(slot_classes(cell_arrays(mesh)),
                                    shuffled(mesh.cell_count(), seed).new_to_old());
}

Mesh sorted_members(Mesh mesh) {
  for (EntitySet& set : mesh.sets) std::sort(set.members.begin(), set.members.end());
  for (DataArray& array : mesh.data) {
    std::vector<Index> order(array.indices.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return array.indices[a] < array.indices[b]; });
    if (order.empty()) continue;
    const Permutation sorting = Permutation::from_new_to_old(order);
    array.indices = moved(sorting, array.indices);
    std::visit(
        [&](auto& values) { values = moved(sorting, values, static_cast<std::size_t>(array.components)); },
        array.values);
  }
  return mesh;
}

void expect_same(const Mesh& actual, const Mesh& expected) {
  EXPECT_EQ(actual.points, expected.points);
  EXPECT_EQ(actual.dimension, expected.dimension);
  EXPECT_EQ(actual.cells.shapes, expected.cells.shapes);
  EXPECT_EQ(actual.cells.offsets, expected.cells.offsets);
  EXPECT_EQ(actual.cells.vertices, expected.cells.vertices);
  ASSERT_EQ(actual.data.size(), expected.data.size());
  for (std::size_t i = 0; i < expected.data.size(); ++i) {
    EXPECT_EQ(actual.data[i], expected.data[i]) << "array " << expected.data[i].name;
  }
  ASSERT_EQ(actual.sets.size(), expected.sets.size());
  for (std::size_t i = 0; i < expected.sets.size(); ++i) {
    EXPECT_EQ(actual.sets[i], expected.sets[i]) << "set " << expected.sets[i].name;
  }
  EXPECT_EQ(actual.vertex_ids, expected.vertex_ids);
  EXPECT_EQ(actual.cell_ids, expected.cell_ids);
  EXPECT_EQ(actual.cell_blocks, expected.cell_blocks);
}

}  // namespace meshorder::test
