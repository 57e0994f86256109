// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cells/cell_arrays.hpp"

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "base/text.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <span>
#include <string>
#include <utility>

namespace meshorder {
namespace {

constexpr Offset kEntriesPerRange = 262144;  // entries that a thread takes at a time

/// VTK types that number their corners along the axes. Swapping two corners makes a pixel a quad, swapping
/// two pairs makes a voxel a hexahedron.
constexpr std::uint8_t kPixel = 8;
constexpr std::uint8_t kVoxel = 11;

Index checked_size(std::size_t size, const char* what) {
  if (size > static_cast<std::size_t>(kMaxIndex)) {
    throw TooLarge("cells: " + std::to_string(size) + " " + what + "; at most 2,147,483,647 are possible");
  }
  return static_cast<Index>(size);
}

/// Returns the numbers of a view minus `base`: a span of the view's array if no conversion is needed, else of
/// `own`. A conversion turns numbers below 0 or above kMaxIndex into −1.
std::span<const Index> narrowed(const IndexView& numbers, int base, std::vector<Index>& own) {
  if (numbers.bytes() == 4 && base == 0) {
    return {static_cast<const Index*>(numbers.data()), numbers.size()};
  }
  own.resize(numbers.size());
  with_type(numbers, [&](auto entries) {
    for_each_range(static_cast<Offset>(entries.size()), kEntriesPerRange, [&](Offset begin, Offset end) {
      for (Offset k = begin; k < end; ++k) {
        const std::uint64_t value = static_cast<std::uint64_t>(entries[k]) - static_cast<std::uint64_t>(base);
        own[k] = value <= static_cast<std::uint64_t>(kMaxIndex) ? static_cast<Index>(value) : Index{-1};
      }
    });
  });
  return own;
}

void check_base(int base) {
  if (base != 0 && base != 1) {
    throw InvalidArgument("cells: the base is " + std::to_string(base) + ", must be 0 or 1");
  }
}

/// Returns entry `k` of all cells as the caller gave it.
std::int64_t given_entry(const CellsView& view, std::size_t k) {
  if (view.is_mixed()) return view.vertices()[k];
  auto block = view.block_list().begin();
  for (; k >= block->vertices.size(); ++block) k -= block->vertices.size();
  return block->vertices[k];
}

/// Describes the fault of a number outside base … base + n − 1, with a remedy if the numbers seem to begin at
/// the other base.
std::string out_of_range(std::int64_t number, Offset n, int base) {
  if (n == 0) return ", but there are no vertices";
  std::string range = ", outside " + std::to_string(base) + " … " + std::to_string(n + base - 1);
  if (base == 0 && number == n) return range + "; if the numbers begin at 1, set the base to 1 or subtract 1";
  if (base == 1 && number == 0) return range + "; if the numbers begin at 0, set the base to 0";
  return range;
}

/// Throws InvalidArgument for the first cell with a vertex out of range.
void check_vertices(const CellArrays& cells, const CellsView& view) {
  std::atomic<bool> sound = true;
  const auto n = static_cast<std::uint32_t>(cells.vertex_count);
  for_each_range(static_cast<Offset>(cells.vertices.size()), kEntriesPerRange, [&](Offset begin, Offset end) {
    bool in_range = true;
    for (Offset k = begin; k < end; ++k)
      in_range = in_range && static_cast<std::uint32_t>(cells.vertices[k]) < n;
    if (!in_range) sound = false;
  });
  if (sound) return;
  const int base = view.base();
  for (Index c = 0; c < cells.size(); ++c) {
    for (Offset k = cells.offsets[c]; k < cells.offsets[c + 1]; ++k) {
      const std::int64_t number = given_entry(view, static_cast<std::size_t>(k));
      if (number >= base && number - base < cells.vertex_count) continue;
      throw InvalidArgument("cells: entry " + std::to_string(k - cells.offsets[c]) + " of cell " +
                            std::to_string(c) + " is " + std::to_string(number) +
                            out_of_range(number, cells.vertex_count, base));
    }
  }
}

/// Throws InvalidArgument for a shape that is not in the enumeration.
void check_shapes(const CellArrays& cells) {
  const auto unknown = std::find_if(cells.shapes.begin(), cells.shapes.end(),
                                    [](Shape shape) { return static_cast<int>(shape) >= kShapes; });
  if (unknown == cells.shapes.end()) return;
  throw InvalidArgument("cells: cell " + std::to_string(unknown - cells.shapes.begin()) + " has the shape " +
                        std::to_string(static_cast<int>(*unknown)) + ", which is not a value of Shape");
}

void check_corners(const CellArrays& cells) {
  for (Index c = 0; c < cells.size(); ++c) {
    const Offset count = cells.offsets[c + 1] - cells.offsets[c];
    const int least = cells.shapes.empty() ? 1 : std::max(1, corners(cells.shapes[c], 1));
    if (count >= least) continue;
    throw InvalidArgument(
        "cells: cell " + std::to_string(c) + " has " + std::to_string(count) + " vertices; a " +
        (cells.shapes.empty() ? std::string("cell") : std::string(to_string(cells.shapes[c]))) +
        " needs at least " + std::to_string(least));
  }
}

/// Throws InvalidArgument for the first block whose cells have an unusual number of vertices for their shape.
/// Does not check mixed cells, which may come from a file.
void check_widths(const CellsView& view) {
  constexpr std::size_t kNamed = 6;
  const std::span<const CellBlock> blocks = view.block_list();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const int width = blocks[b].vertices_per_cell;
    if (blocks[b].vertices.empty() || width == corners(blocks[b].shape, width)) continue;
    const std::set<int> usual = cell_widths(blocks[b].shape);
    if (usual.empty() || usual.contains(width)) continue;
    std::vector<int> first(std::min(kNamed, usual.size()));
    std::copy_n(usual.begin(), first.size(), first.begin());
    throw InvalidArgument("cells: the cells of block " + std::to_string(b) + " have " +
                          std::to_string(width) + " vertices; a " + std::string(to_string(blocks[b].shape)) +
                          " has " + join(first, [](int one) { return std::to_string(one); }) +
                          (usual.size() > kNamed ? ", …" : ""));
  }
}

void take_mixed(const CellsView& view, bool trusted, CellArrays& cells) {
  const Index count = checked_size(view.offsets().size() - 1, "cells");
  const IndexView offsets = view.offsets();
  if (offsets.bytes() == 8 && view.base() == 0) {
    cells.offsets = {static_cast<const Offset*>(offsets.data()), offsets.size()};
  } else {
    cells.own_offsets.resize(offsets.size());
    for (std::size_t c = 0; c < offsets.size(); ++c) {
      // unsigned: a faulty offset may be the least int64, which would overflow
      cells.own_offsets[c] = static_cast<Offset>(static_cast<std::uint64_t>(offsets[c]) -
                                                 static_cast<std::uint64_t>(view.base()));
    }
    cells.offsets = cells.own_offsets;
  }
  cells.vertices = narrowed(view.vertices(), view.base(), cells.own_vertices);
  if (!trusted) {
    if (cells.offsets.front() != 0 || cells.offsets.back() != static_cast<Offset>(cells.vertices.size())) {
      const std::size_t entries = cells.vertices.size();
      throw InvalidArgument("cells: the offsets go from " + std::to_string(offsets[0]) + " to " +
                            std::to_string(offsets[offsets.size() - 1]) + "; for " + std::to_string(entries) +
                            " entries they must go from " + std::to_string(view.base()) + " to " +
                            std::to_string(entries + static_cast<unsigned>(view.base())));
    }
    const auto descent = std::is_sorted_until(cells.offsets.begin(), cells.offsets.end());
    if (descent != cells.offsets.end()) {
      throw InvalidArgument("cells: offset " + std::to_string(descent - cells.offsets.begin()) +
                            " is less than the one before");
    }
  }
  cells.shapes = view.shapes();
  const std::span<const std::uint8_t> types = view.vtk_types();
  const std::size_t stated = types.empty() ? cells.shapes.size() : types.size();
  if (stated != 0 && stated != static_cast<std::size_t>(count)) {
    throw InvalidArgument("cells: " + std::to_string(stated) + " types for " + std::to_string(count) +
                          " cells");
  }
  bool along_axes = false;
  for (Index c = 0; c < count && !types.empty(); ++c) {
    const std::optional<Shape> shape = shape_of_vtk_type(types[c]);
    if (!shape) {
      throw InvalidArgument("cells: cell " + std::to_string(c) + " has the VTK type " +
                            std::to_string(types[c]) + ", which is not supported");
    }
    along_axes = along_axes || types[c] == kPixel || types[c] == kVoxel;
    cells.own_shapes.push_back(*shape);
  }
  if (!types.empty()) cells.shapes = cells.own_shapes;
  if (!along_axes) return;
  if (cells.own_vertices.empty()) cells.own_vertices.assign(cells.vertices.begin(), cells.vertices.end());
  for (Index c = 0; c < count; ++c) {
    const Offset size = cells.offsets[c + 1] - cells.offsets[c];
    Index* const own = cells.own_vertices.data() + cells.offsets[c];
    if ((types[c] == kPixel || types[c] == kVoxel) && size >= 4) std::swap(own[2], own[3]);
    if (types[c] == kVoxel && size >= 8) std::swap(own[6], own[7]);
  }
  cells.vertices = cells.own_vertices;
}

void take_blocks(const CellsView& view, CellArrays& cells) {
  const std::span<const CellBlock> blocks = view.block_list();
  std::size_t entries = 0;
  std::size_t count = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const int size = blocks[b].vertices_per_cell;
    if (size < 1 || blocks[b].vertices.size() % static_cast<std::size_t>(size) != 0) {
      throw InvalidArgument("cells: the " + std::to_string(blocks[b].vertices.size()) +
                            " vertices of block " + std::to_string(b) + " do not make cells of " +
                            std::to_string(size));
    }
    cells.block_starts.push_back(checked_size(count, "cells"));
    entries += blocks[b].vertices.size();
    count += blocks[b].vertices.size() / static_cast<std::size_t>(size);
  }
  if (blocks.size() <= 1) cells.block_starts.clear();
  checked_size(count, "cells");
  cells.own_offsets.reserve(count + 1);
  cells.own_offsets.push_back(0);
  cells.own_shapes.reserve(count);
  for (const CellBlock& block : blocks) {
    const Offset size = block.vertices_per_cell;
    const auto cells_here = static_cast<Offset>(block.vertices.size()) / size;
    for (Offset c = 0; c < cells_here; ++c) cells.own_offsets.push_back(cells.own_offsets.back() + size);
    cells.own_shapes.insert(cells.own_shapes.end(), static_cast<std::size_t>(cells_here), block.shape);
  }
  if (blocks.size() == 1) {
    cells.vertices = narrowed(blocks[0].vertices, view.base(), cells.own_vertices);
  } else {
    cells.own_vertices.reserve(entries);
    std::vector<Index> own;
    for (const CellBlock& block : blocks) {
      const std::span<const Index> numbers = narrowed(block.vertices, view.base(), own);
      cells.own_vertices.insert(cells.own_vertices.end(), numbers.begin(), numbers.end());
    }
    cells.vertices = cells.own_vertices;
  }
  cells.offsets = cells.own_offsets;
  cells.shapes = cells.own_shapes;
}

}  // namespace

std::optional<Shape> shape_of_vtk_type(int type) {
  switch (type) {
    case 1:
      return Shape::vertex;
    case 2:
      return Shape::poly_vertex;
    case 3:
    case 21:
    case 35:
    case 68:
    case 75:
      return Shape::line;
    case 4:
      return Shape::polyline;
    case 5:
    case 22:
    case 34:
    case 69:
    case 76:
      return Shape::triangle;
    case 6:
      return Shape::triangle_strip;
    case 7:
      return Shape::polygon;
    case kPixel:
    case 9:
    case 23:
    case 28:
    case 30:
    case 70:
    case 77:
      return Shape::quad;
    case 10:
    case 24:
    case 71:
    case 78:
      return Shape::tetrahedron;
    case kVoxel:
    case 12:
    case 25:
    case 29:
    case 33:
    case 72:
    case 79:
      return Shape::hexahedron;
    case 13:
    case 26:
    case 31:
    case 32:
    case 73:
    case 80:
      return Shape::wedge;
    case 14:
    case 27:
    case 37:
    case 74:
    case 81:
      return Shape::pyramid;
    case 15:  // prisms of five and six sides
    case 16:
    case 42:
      return Shape::polyhedron;
    default:
      return std::nullopt;
  }
}

std::size_t vertex_count_of(const MeshView& mesh) {
  const std::size_t points = mesh.points.size();
  if (mesh.vertex_count == 0) {
    if (points == 0 && mesh.cells.size() > 0)
      throw InvalidArgument("cells: neither points nor vertex_count are given");
    return points;
  }
  if (points != 0 && points != mesh.vertex_count) {
    throw InvalidArgument("points: there are " + std::to_string(points) + ", but vertex_count is " +
                          std::to_string(mesh.vertex_count));
  }
  return mesh.vertex_count;
}

CellArrays cell_arrays(const CellsView& view, std::size_t vertex_count, Check check) {
  CellArrays cells;
  cells.vertex_count = checked_size(vertex_count, "vertices");
  check_base(view.base());
  if (view.is_mixed()) {
    take_mixed(view, check == Check::none, cells);
  } else {
    if (!view.vertices().empty())
      throw InvalidArgument(
          "cells: vertices without offsets; m cells have m + 1 offsets, the first of them 0");
    take_blocks(view, cells);
  }
  if (check != Check::none) {
    check_shapes(cells);
    check_corners(cells);
    check_widths(view);
    check_vertices(cells, view);
  }
  poll();
  return cells;
}

template <class Wanted>
CellSelection::CellSelection(const CellArrays& cells, Wanted wanted) : all_(cells.incidence()) {
  Index count = 0;
  for (Index c = 0; c < cells.size(); ++c) count += wanted(c) ? 1 : 0;
  is_all_ = count == cells.size();
  if (is_all_) return;
  own_.vertex_count = cells.vertex_count;
  numbers_.reserve(static_cast<std::size_t>(count));
  for (Index c = 0; c < cells.size(); ++c) {
    if (!wanted(c)) continue;
    numbers_.push_back(c);
    const auto vertices = all_[c];
    own_.vertices.insert(own_.vertices.end(), vertices.begin(), vertices.end());
    own_.offsets.push_back(static_cast<Offset>(own_.vertices.size()));
  }
}

int uniform_width(const CellArrays& cells, const char* caller) {
  if (cells.size() == 0) return 0;
  const Offset width = cells.offsets[1];
  for (Index c = 0; c < cells.size(); ++c) {
    const bool other_shape = !cells.shapes.empty() && cells.shapes[c] != cells.shapes[0];
    if (cells.offsets[c + 1] - cells.offsets[c] == width && !other_shape) continue;
    throw InvalidArgument(std::string(caller) + ": cell " + std::to_string(c) +
                          " is of another type than cell 0; pass the cells of each type separately");
  }
  return static_cast<int>(width);
}

namespace {

int highest_dimension(const CellArrays& cells) {
  int highest = -1;
  for (Index c = 0; c < cells.size() && highest < 3; ++c) highest = std::max(highest, cells.dimension_of(c));
  return highest;
}

}  // namespace

CellSelection CellSelection::elements(const CellArrays& cells) {
  const int highest = highest_dimension(cells);
  return {cells, [&](Index c) { return cells.dimension_of(c) == highest; }};
}

CellSelection CellSelection::lower_dimensional(const CellArrays& cells) {
  const int highest = highest_dimension(cells);
  return {cells, [&](Index c) { return cells.dimension_of(c) < highest; }};
}

}  // namespace meshorder
