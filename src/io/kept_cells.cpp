// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/kept_cells.hpp"

#include "base/parallel.hpp"
#include "base/text.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

namespace meshorder {
namespace {

/// A type of cells, and the number of cells of this type.
struct TypeCount {
  Shape shape;
  int vertices;
  Index count;

  [[nodiscard]] bool is(Shape other, int other_vertices) const {
    return shape == other && vertices == other_vertices;
  }
};

/// The types of some cells, in the order in which they first appear.
struct TypeCounts {
  std::vector<TypeCount> types;
  std::size_t last = 0;  ///< index in `types` of the type added last: the next cell mostly has this type

  void add(Shape shape, int vertices, Index count) {
    if (types.empty() || !types[last].is(shape, vertices)) {
      const auto found = std::find_if(types.begin(), types.end(),
                                      [&](const TypeCount& type) { return type.is(shape, vertices); });
      last = static_cast<std::size_t>(found - types.begin());
      if (found == types.end()) types.push_back({shape, vertices, 0});
    }
    types[last].count += count;
  }

  TypeCounts& operator+=(const TypeCounts& next) {
    for (const TypeCount& type : next.types) add(type.shape, type.vertices, type.count);
    return *this;
  }
};

/// Returns the types of the cells, in the order in which they first appear.
std::vector<TypeCount> counted_types(const Mesh& mesh) {
  constexpr Index kCellsAtOnce = 65536;
  return sum_over_chunks<TypeCounts>(mesh.cell_count(), kCellsAtOnce,
                                     [&](Index begin, Index end) {
                                       TypeCounts counts;
                                       for (Index c = begin; c < end; ++c)
                                         counts.add(mesh.cells.shapes[c], mesh.cells.vertex_count(c), 1);
                                       return counts;
                                     })
      .types;
}

int highest_dimension_of(const std::vector<TypeCount>& types) {
  int highest = -1;
  for (const TypeCount& type : types) highest = std::max(highest, dimension(type.shape));
  return highest;
}

/// Returns the types that a file leaves out because the format does not hold them; empty if the format lacks
/// a type of the highest dimension.
std::vector<TypeCount> types_left_out(const Mesh& mesh, const std::vector<TypeCount>& types,
                                      const Format& format) {
  const int highest = highest_dimension_of(types);
  std::vector<TypeCount> result;
  for (const TypeCount& type : types) {
    if (format.holds(mesh, type.shape, type.vertices)) continue;
    if (dimension(type.shape) == highest) return {};
    result.push_back(type);
  }
  return result;
}

/// Returns the positions of the cells whose types are not in `left_out`.
std::vector<Index> cells_but(const Mesh& mesh, const std::vector<TypeCount>& left_out) {
  std::vector<Index> kept;
  kept.reserve(mesh.cells.shapes.size());
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (std::none_of(left_out.begin(), left_out.end(), [&](const TypeCount& type) {
          return type.is(mesh.cells.shapes[c], mesh.cells.vertex_count(c));
        })) {
      kept.push_back(c);
    }
  }
  return kept;
}

/// Returns, for example, "1 line", "212 triangles" or "7 triangles of 6 vertices".
std::string in_words(const TypeCount& type) {
  constexpr std::array<std::string_view, kShapes> kPlurals{
      "vertices",  "lines",        "triangles", "quads",    "tetrahedra",      "pyramids", "wedges",
      "hexahedra", "point clouds", "polylines", "polygons", "triangle strips", "polyhedra"};
  const std::string_view plural = kPlurals[static_cast<std::size_t>(type.shape)];
  std::string name(type.count == 1 ? to_string(type.shape) : plural);
  std::replace(name.begin(), name.end(), '_', ' ');
  const bool linear = type.vertices == corners(type.shape, type.vertices);
  return fmt::format("{} {}{}", type.count, name,
                     linear ? "" : fmt::format(" of {} vertices", type.vertices));
}

/// Keeps the rows of kept cells in an array on cells; `place`: the new position of each cell, −1 if left out.
void keep_rows(DataArray& array, const std::vector<Index>& kept, const std::vector<Index>& place) {
  std::vector<Index> rows;
  if (array.is_dense()) {
    rows = kept;
  } else {
    std::vector<Index> indices;
    for (Index r = 0; r < index_size(array.indices); ++r) {
      if (place[array.indices[r]] < 0) continue;
      rows.push_back(r);
      indices.push_back(place[array.indices[r]]);
    }
    array.indices = std::move(indices);
  }
  array.values = rows_of_values(array.values, array.components, rows);
}

void keep_blocks(std::vector<Index>& blocks, const std::vector<Index>& kept) {
  std::vector<Index> result;
  for (const Index begin : blocks) {
    const auto first = static_cast<Index>(std::lower_bound(kept.begin(), kept.end(), begin) - kept.begin());
    if (first < index_size(kept) && (result.empty() || result.back() != first)) result.push_back(first);
  }
  blocks = std::move(result);
}

std::vector<Index> all_cells(const Mesh& mesh) { return index_range(0, mesh.cell_count()); }

// In the next functions, `types` are those of all cells of the mesh.

/// Returns the positions of the cells to be written in the format, ascending: all cells if the format lacks a
/// type of the highest dimension. Notes the cells left out, a line for each type. O(cells).
std::vector<Index> cells_for(const Mesh& mesh, const std::vector<TypeCount>& types, const Format& format,
                             Notes& notes) {
  const std::vector<TypeCount> left_out = types_left_out(mesh, types, format);
  for (const TypeCount& type : left_out) {
    notes.push_back(type.count == 1
                        ? fmt::format("{} is left out: {} cannot hold it", in_words(type), format.name)
                        : fmt::format("{} are left out: {} cannot hold them", in_words(type), format.name));
  }
  return left_out.empty() ? all_cells(mesh) : cells_but(mesh, left_out);
}

/// Returns why a file of the format cannot hold all cells of a mesh: a type that the format cannot hold, or a
/// conflict of types. Returns an empty text if the file can hold all cells. O(cells).
std::string fault_of_cells(const Mesh& mesh, std::vector<TypeCount> types, const Format& format) {
  std::erase_if(types, [&](const TypeCount& type) { return format.holds(mesh, type.shape, type.vertices); });
  // the message names a type of this dimension: types of lower dimension may be left out
  const int highest = highest_dimension_of(types);
  for (const TypeCount& type : types) {
    if (dimension(type.shape) < highest) continue;
    return fmt::format("{} cannot hold a cell of type {}", format.name, type_name(type.shape, type.vertices));
  }
  return format.conflict == nullptr ? "" : format.conflict(mesh);
}

/// Returns advice such as "write .msh or .vtu": formats that hold all cells of a mesh. O(cells · formats).
std::string advice_on_formats(const Mesh& mesh, const std::vector<TypeCount>& types) {
  std::vector<std::string_view> names;
  for (const Format& format : all_formats()) {
    if (fault_of_cells(mesh, types, format).empty()) names.push_back(format.extensions.front());
  }
  if (names.empty()) return "no format that meshorder writes holds all of its cells";
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("write {}{}{}", join(names), names.empty() ? "" : " or ", last);
}

}  // namespace

void keep_cells_at(Mesh& mesh, const std::vector<Index>& kept, Notes& notes) {
  if (index_size(kept) == mesh.cell_count()) return;
  std::vector<Index> place(mesh.cells.shapes.size(), -1);
  for (Index k = 0; k < index_size(kept); ++k) place[kept[k]] = k;

  Cells cells;
  for (const Index c : kept) cells.push_back(mesh.cells.shapes[c], mesh.cells[c]);
  mesh.cells = std::move(cells);
  keep_blocks(mesh.cell_blocks, kept);
  if (!mesh.cell_ids.empty()) {
    std::vector<std::int64_t> ids;
    ids.reserve(kept.size());
    for (const Index c : kept) ids.push_back(mesh.cell_ids[c]);
    mesh.cell_ids = std::move(ids);
  }
  if (mesh.format_metadata) {
    if (auto metadata = mesh.format_metadata->moved({}, place)) mesh.format_metadata = std::move(metadata);
  }

  std::erase_if(mesh.data, [&](DataArray& array) {
    if (array.association == Association::vertices) return false;
    const bool dense = array.is_dense();
    keep_rows(array, kept, place);
    const bool gone = !dense && array.indices.empty();
    if (gone) notes.push_back(fmt::format("the array '{}' is left out with all its cells", array.name));
    return gone;
  });
  std::erase_if(mesh.sets, [&](EntitySet& set) {
    if (set.association == Association::vertices || set.members.empty()) return false;
    std::erase_if(set.members, [&](Index member) { return place[member] < 0; });
    for (Index& member : set.members) member = place[member];
    if (set.members.empty()) {
      notes.push_back(fmt::format("the set '{}' is left out with all its cells", set.name));
    }
    return set.members.empty();
  });
}

std::vector<Index> cells_to_write(const Mesh& mesh, const FilePath& path, const Format& format, bool strict,
                                  Notes& notes) {
  const std::vector<TypeCount> types = counted_types(mesh);
  std::vector<Index> kept = strict ? all_cells(mesh) : cells_for(mesh, types, format, notes);
  std::string fault;
  if (index_size(kept) == mesh.cell_count()) {
    fault = fault_of_cells(mesh, types, format);
  } else if (format.conflict != nullptr) {  // the format holds the type of each kept cell
    Mesh part = mesh;
    Notes ignored;
    keep_cells_at(part, kept, ignored);
    fault = fault_of_cells(part, counted_types(part), format);
  }
  if (!fault.empty()) throw InputError(path.string(), fault, advice_on_formats(mesh, types));
  return kept;
}

std::vector<Index> keep_dimension(Mesh& mesh, int wanted, Notes& notes) {
  constexpr std::array<std::string_view, 4> kNames{"points", "curves", "surfaces", "volumes"};
  std::vector<Index> kept = all_cells(mesh);
  if (wanted < 0) return kept;
  std::erase_if(kept, [&](Index c) { return dimension(mesh.cells.shapes[c]) != wanted; });
  if (kept.empty())
    throw InvalidArgument(fmt::format("the mesh has no {}", kNames[static_cast<std::size_t>(wanted)]));
  keep_cells_at(mesh, kept, notes);
  return kept;
}

inline namespace v0_3 {

std::vector<Index> keep_cells(Mesh& mesh, const KeepOptions& options) {
  if (options.dimension < -1 || options.dimension > 3) {
    throw InvalidArgument(
        fmt::format("keep_cells: the dimension is {}; it must be 0 to 3, or −1 for all", options.dimension));
  }
  check_mesh(mesh);
  const Format* const format = options.format.empty() ? nullptr : &format_named(options.format);
  Notes notes;
  std::vector<Index> kept = keep_dimension(mesh, options.dimension, notes);
  if (format != nullptr) {
    const std::vector<Index> held = cells_for(mesh, counted_types(mesh), *format, notes);
    keep_cells_at(mesh, held, notes);
    std::vector<Index> positions;
    positions.reserve(held.size());
    for (const Index c : held) positions.push_back(kept[c]);
    kept = std::move(positions);
  }
  if (options.notes != nullptr) options.notes->insert(options.notes->end(), notes.begin(), notes.end());
  return kept;
}

}  // namespace v0_3
}  // namespace meshorder
