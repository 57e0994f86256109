// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/geometry/box_tree.hpp"

#include <cmath>
#include <numeric>

namespace meshorder {

void halve(std::span<Index> things, Index left, std::span<const Point> centers) {
  Box box;
  for (const Index thing : things) box.include(centers[thing]);
  int axis = 0;
  for (int c = 1; c < 3; ++c) {
    if (box.upper[c] - box.lower[c] > box.upper[axis] - box.lower[axis]) axis = c;
  }
  std::nth_element(things.begin(), things.begin() + left, things.end(), [&](Index a, Index b) {
    return centers[a][axis] < centers[b][axis] || (centers[a][axis] == centers[b][axis] && a < b);
  });
}

void sort_into_runs(std::span<Index> things, Index size, std::span<const Point> centers) {
  const Index runs = (index_size(things) + size - 1) / size;
  if (runs < 2) return;
  const Index left = runs / 2 * size;
  halve(things, left, centers);
  sort_into_runs(things.subspan(0, left), size, centers);
  sort_into_runs(things.subspan(left), size, centers);
}

/// Tests the axes of the box, and their cross products with the segment, as separating axes.
bool Box::meets_segment(const Point& a, const Point& b) const {
  constexpr double kSlack = 1e-12;  // far above rounding errors, so that no box is missed
  Point half{};
  Point way{};
  Point from_center{};
  double scale = 0.0;
  for (int c = 0; c < 3; ++c) {
    half[c] = 0.5 * (upper[c] - lower[c]);
    way[c] = 0.5 * (b[c] - a[c]);
    from_center[c] = 0.5 * (a[c] + b[c]) - 0.5 * (lower[c] + upper[c]);
    scale = std::max({scale, std::abs(lower[c]), std::abs(upper[c]), std::abs(a[c]), std::abs(b[c])});
  }
  for (int c = 0; c < 3; ++c) {
    if (std::abs(from_center[c]) > half[c] + std::abs(way[c]) + kSlack * scale) return false;
  }
  for (int c = 0; c < 3; ++c) {
    const int d = (c + 1) % 3;
    const int e = (c + 2) % 3;
    const double apart = std::abs(way[d] * from_center[e] - way[e] * from_center[d]);
    const double reach = half[d] * std::abs(way[e]) + half[e] * std::abs(way[d]);
    if (apart > reach + kSlack * scale * (std::abs(way[d]) + std::abs(way[e]))) return false;
  }
  return true;
}

BoxTree::BoxTree(std::span<const Box> boxes) : things_(boxes.size()) {
  std::iota(things_.begin(), things_.end(), Index{0});
  if (boxes.empty()) return;
  std::vector<Point> centers(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    centers[i] = scaled(0.5, plus_scaled(boxes[i].lower, 1.0, boxes[i].upper));
  // children come after their parents: one pass builds the nodes; a second pass, from the end, builds the
  // boxes
  nodes_.push_back({Box{}, 0, index_size(boxes)});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node node = nodes_[n];
    if (node.count <= kInLeaf) continue;
    const Index left = node.count / 2;
    halve(std::span(things_).subspan(node.first, node.count), left, centers);
    nodes_[n].first = index_size(nodes_);
    nodes_[n].count = 0;
    nodes_.push_back({Box{}, node.first, left});
    nodes_.push_back({Box{}, node.first + left, node.count - left});
  }
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    for (Index i = 0; i < node.count; ++i) {
      node.box.include(boxes[things_[node.first + i]].lower);
      node.box.include(boxes[things_[node.first + i]].upper);
    }
    for (Index child = node.first; node.count == 0 && child < node.first + 2; ++child) {
      node.box.include(nodes_[child].box.lower);
      node.box.include(nodes_[child].box.upper);
    }
  }
}

std::vector<Index> BoxTree::renumber() {
  std::vector<Index> order = things_;
  std::iota(things_.begin(), things_.end(), Index{0});
  return order;
}

std::size_t BoxTree::bytes() const {
  return nodes_.capacity() * sizeof(Node) + things_.capacity() * sizeof(Index);
}

}  // namespace meshorder
