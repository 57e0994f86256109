// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

namespace meshorder {

/// An axis-aligned box; by default one that contains nothing.
struct Box {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  Point lower{kInfinity, kInfinity, kInfinity};
  Point upper{-kInfinity, -kInfinity, -kInfinity};

  /// Grows it to contain x. Coordinates that are NaN are passed over.
  void include(const Point& x) {
    for (int c = 0; c < 3; ++c) {
      lower[c] = std::min(lower[c], x[c]);
      upper[c] = std::max(upper[c], x[c]);
    }
  }
  [[nodiscard]] bool contains(const Point& x) const {
    bool result = true;
    for (int c = 0; c < 3; ++c) result = result && lower[c] <= x[c] && x[c] <= upper[c];
    return result;
  }
  /// The square of the distance from x, 0 within.
  [[nodiscard]] double squared_distance(const Point& x) const {
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double outside = std::max({lower[c] - x[c], 0.0, x[c] - upper[c]});
      sum += outside * outside;
    }
    return sum;
  }
  [[nodiscard]] bool meets_segment(const Point& a, const Point& b) const;
};

/// A tree of boxes over things at rest: halved by count along the longest axis of their centres.
class BoxTree {
 public:
  /// One box for each thing. O(n log n).
  explicit BoxTree(std::span<const Box> boxes);

  /// Numbers the things in the order of the tree from now on, in which neighbours stand side by side, and
  /// returns which they were.
  std::vector<Index> renumber();

  /// Calls `visit(thing)` for the things that may be nearest to x: those whose box is nearer than the square
  /// root of the bound, which is what the last visit returned. Nearer boxes come first as a rule.
  template <class Visit>
  void visit_nearest(const Point& x, Visit visit, double bound = Box::kInfinity) const {
    struct Open {
      Index node;
      double distance;
    };
    std::array<Open, kDeepest> open{};
    int depth = 0;
    const auto distance = [&](Index node) { return nodes_[node].box.squared_distance(x); };
    if (!nodes_.empty()) open[depth++] = {0, distance(0)};
    while (depth > 0) {
      const Open next = open[--depth];
      if (!(next.distance <= kAboveRounding * bound)) continue;
      const Node& node = nodes_[next.node];
      if (node.count > 0) {
        for (Index i = node.first; i < node.first + node.count; ++i) bound = visit(things_[i]);
        continue;
      }
      Open nearer{node.first, distance(node.first)};
      Open further{node.first + 1, distance(node.first + 1)};
      if (further.distance < nearer.distance) std::swap(nearer, further);
      open[depth++] = further;
      open[depth++] = nearer;
    }
  }

  /// Calls `visit(thing)` for all things whose box the segment from a to b meets, or nearly.
  template <class Visit>
  void visit_on_segment(const Point& a, const Point& b, Visit visit) const {
    std::array<Index, kDeepest> open{};
    int depth = 0;
    if (!nodes_.empty()) open[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[open[--depth]];
      if (!node.box.meets_segment(a, b)) continue;
      if (node.count > 0) {
        for (Index i = node.first; i < node.first + node.count; ++i) visit(things_[i]);
        continue;
      }
      open[depth++] = node.first + 1;
      open[depth++] = node.first;
    }
  }

  /// Memory held.
  [[nodiscard]] std::size_t bytes() const;

 private:
  static constexpr Index kInLeaf = 4;
  static constexpr double kAboveRounding = 1.0 + 1e-12;
  static constexpr int kDeepest = 64;  // halving 2³¹ things takes 31 levels

  struct Node {
    Box box;
    Index first = 0;  // of the things of a leaf; of the two children of another node
    Index count = 0;  // things of a leaf; 0 for another node
  };

  std::vector<Node> nodes_;
  std::vector<Index> things_;
};

/// Puts the `left` things with the least coordinates first, along the longest axis of the centres of all;
/// equal ones by their number. O(n).
void halve(std::span<Index> things, Index left, std::span<const Point> centers);

/// Orders things so that each run of `size` is compact: halves them again and again at multiples of `size`.
/// O(n log n).
void sort_into_runs(std::span<Index> things, Index size, std::span<const Point> centers);

}  // namespace meshorder
