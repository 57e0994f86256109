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

/// An axis-aligned box, by default empty.
struct Box {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  Point lower{kInfinity, kInfinity, kInfinity};
  Point upper{-kInfinity, -kInfinity, -kInfinity};

  /// Extends the box to contain x. Coordinates that are NaN are ignored.
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
  /// Returns the squared distance from x, 0 inside.
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

/// A tree of boxes over items that do not move. Each inner node halves its items on the axis along which
/// their centres extend furthest.
class BoxTree {
 public:
  /// Builds the tree over one box for each item. O(n log n).
  explicit BoxTree(std::span<const Box> boxes);

  /// Renumbers the items in the order of the tree, in which neighbours are adjacent, and returns their former
  /// numbers.
  std::vector<Index> renumber();

  /// Calls `visit(item)` for the items that may be nearest to x: those in leaves whose squared distance from
  /// x is at most `bound`. Each visit returns the new bound. Nearer boxes usually come first.
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

  /// Calls `visit(item)` for all items whose box meets the segment from a to b, and for some others nearby.
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

  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  static constexpr Index kInLeaf = 4;
  static constexpr double kAboveRounding = 1.0 + 1e-12;
  static constexpr int kDeepest = 64;  // halving 2³¹ items takes 31 levels

  struct Node {
    Box box;
    Index first = 0;  // a leaf's first item; an inner node's first child, which the second follows
    Index count = 0;  // number of a leaf's items; 0 for an inner node
  };

  std::vector<Node> nodes_;
  std::vector<Index> things_;
};

/// Moves to the front the `left` items whose centres have the smallest coordinates on one axis: that along
/// which the centres extend furthest. Among equal coordinates the lowest numbers come first. O(n).
void halve(std::span<Index> things, Index left, std::span<const Point> centers);

/// Orders items so that each run of `size` items is compact, by repeated halving at multiples of `size`.
/// O(n log n).
void sort_into_runs(std::span<Index> things, Index size, std::span<const Point> centers);

}  // namespace meshorder
