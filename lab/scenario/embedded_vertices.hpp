// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/simplices.hpp"
#include "lab/motion/integrator.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <span>
#include <vector>

namespace meshorder {

/// A vertex that no tetrahedron has as a corner, and the tetrahedron with which it moves: where it is at rest
/// is the corners' mean by these weights, which add up to 1.
struct Follower {
  Index vertex = 0;
  std::array<Index, 4> corners{};
  std::array<double, 4> weights{};
};

/// The nodes of edges, faces and interiors of the mesh's volume cells, each with the tetrahedron, of those
/// that its cells are cut into, that it lies deepest in; of several the first. `simplices` are the mesh's
/// tetrahedra. Vertices of no volume cell, and of flat ones alone, are left out. O(tetrahedra · nodes of a
/// cell).
std::vector<Follower> followers(const Mesh& mesh, const Simplices& simplices);

/// Takes the followers of a body, whose vertices rest at `rest`, to where its corners are, and gives them
/// their velocity. O(followers).
void carry(const std::vector<Follower>& followers, std::span<const Point> rest, MotionState& state);

}  // namespace meshorder
