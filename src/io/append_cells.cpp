// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/append_cells.hpp"

#include "base/memory.hpp"

#include <cstddef>

namespace meshorder {

void append_cells(Cells& cells, Shape shape, int nodes, Index count) {
  const Index first = cells.size();
  const Offset begin = cells.offsets.back();
  cells.shapes.resize(static_cast<std::size_t>(Offset{first} + count), shape);
  resize_large(cells.offsets, static_cast<std::size_t>(Offset{first} + count + 1));
  for (Offset c = 1; c <= count; ++c) cells.offsets[static_cast<std::size_t>(first + c)] = begin + c * nodes;
  resize_large(cells.vertices, static_cast<std::size_t>(begin + Offset{count} * nodes));
}

}  // namespace meshorder
