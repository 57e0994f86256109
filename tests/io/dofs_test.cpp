// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The C++ example of docs/dofs.md; tests/command/test_docs.py checks that both are the same.
#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace mo = meshorder;

namespace {

TEST(Dofs, FollowTheVertices) {
  const mo::test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "mesh.vtu";
  const mo::Mesh before = mo::test::tetrahedral_bar(6);
  mo::write_mesh(before, path);
  std::vector<double> u(3 * before.points.size());
  std::iota(u.begin(), u.end(), 0.5);

  // [docs/dofs.md
  mo::Mesh mesh = mo::read_mesh(path);
  const mo::Permutation vertices = mo::reorder(mesh).vertices.permutation;
  const auto old_to_new = vertices.old_to_new();

  // three numbers a vertex, node-major, follow the vertices
  std::vector<double> u_new(u.size());
  vertices.move(u, u_new, 3);

  // the number of a degree of freedom
  const auto node_major = [&](mo::Index v, int c) { return 3 * mo::Offset{old_to_new[v]} + c; };
  const auto field_major = [&](mo::Index v, int c) {
    return mo::Offset{vertices.size()} * c + old_to_new[v];
  };
  // docs/dofs.md]

  std::vector<mo::Offset> all(u.size());
  std::iota(all.begin(), all.end(), mo::Offset{0});
  for (const bool by_node : {true, false}) {
    std::vector<mo::Offset> numbers;
    for (mo::Index v = 0; v < before.vertex_count(); ++v) {
      for (int c = 0; c < 3; ++c) {
        numbers.push_back(by_node ? node_major(v, c) : field_major(v, c));
        EXPECT_TRUE(!by_node || u_new[numbers.back()] == u[3 * v + c]);
        const mo::Offset place = by_node ? numbers.back() / 3 : numbers.back() % before.vertex_count();
        EXPECT_EQ(mesh.points[place], before.points[v]);
      }
    }
    std::sort(numbers.begin(), numbers.end());
    EXPECT_EQ(numbers, all);
  }
}

}  // namespace
