// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cells/cell_arrays.hpp"

namespace meshorder {
namespace {

constexpr int kHighestOrder = 10;

/// Adds the numbers of vertices of prisms whose base has `base` vertices: 2 to 11 layers of `base` vertices.
void add_prisms(int base, std::set<int>& widths) {
  for (int p = 1; p <= kHighestOrder; ++p) widths.insert((p + 1) * base);
}

/// Adds the numbers of vertices of cells that have the order `p` in at least one direction.
void add_order(Shape shape, int p, std::set<int>& widths) {
  const int triangle = (p + 1) * (p + 2) / 2;
  switch (shape) {
    case Shape::triangle:
      widths.insert({triangle, 3 * p});
      return;
    case Shape::quad:
      widths.insert(4 * p);
      add_prisms(p + 1, widths);
      return;
    case Shape::tetrahedron:
      widths.insert({triangle * (p + 3) / 3, 6 * p - 2});
      return;
    case Shape::pyramid:
      widths.insert({triangle * (2 * p + 3) / 3, 8 * p - 3});
      return;
    case Shape::wedge:
      widths.insert(9 * p - 3);
      add_prisms(triangle, widths);
      return;
    case Shape::hexahedron:
      widths.insert(12 * p - 4);
      for (int q = 1; q <= p; ++q) add_prisms((p + 1) * (q + 1), widths);
      return;
    default:
      return;
  }
}

/// Returns other vertex counts that are in use, for example of cells with one more vertex inside.
std::set<int> others(Shape shape) {
  switch (shape) {
    case Shape::vertex:
      return {1};
    case Shape::triangle:
      return {7, 13};
    case Shape::quad:
      return {5};
    case Shape::tetrahedron:
      return {8, 11, 14, 15};
    case Shape::pyramid:
      return {18, 19};
    case Shape::wedge:
      return {16, 20, 21};
    case Shape::hexahedron:
      return {9, 26};
    default:
      return {};
  }
}

}  // namespace

std::set<int> cell_widths(Shape shape) {
  std::set<int> widths = others(shape);
  for (int p = 1; p <= kHighestOrder; ++p) add_order(shape, p, widths);
  return widths;
}

}  // namespace meshorder
