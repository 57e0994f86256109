// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/xdmf/reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <unordered_map>
#include <utility>

// Reads Topologies. Two of them may hold the same cells.

namespace meshorder::xdmf {
namespace {

using vtk::FileCells;

std::span<const Index> vertices_of(const FileCells& cells, Index c) {
  const auto k = static_cast<std::size_t>(c);
  return {cells.vertices.data() + cells.offsets[k], cells.vertices.data() + cells.offsets[k + 1]};
}

std::vector<Index> sorted(std::span<const Index> vertices) {
  std::vector<Index> result(vertices.begin(), vertices.end());
  std::sort(result.begin(), result.end());
  return result;
}

std::size_t hash_of(const std::vector<Index>& vertices) {
  std::size_t hash = vertices.size();
  for (const Index v : vertices) {
    hash = (hash ^ static_cast<std::size_t>(v)) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 29U;
  }
  return hash;
}

/// Returns whether a Grid is one that `layout_of` added.
bool is_added(pugi::xml_node grid) {
  return !grid.find_child_by_attribute("Information", "Name", kAdded.data()).empty();
}

/// Returns a key of a Topology's cells: Topologies may read one array as cells of different types.
std::string key_of_cells(pugi::xml_node topology, const DataPlace& place, int base) {
  const TopologyType* const type = topology_type(attribute(topology, "TopologyType", "Type"));
  std::string key = fmt::format("{} {} {}", key_of(place), type == nullptr ? kMixed : type->number, base);
  if (type != nullptr && type->nodes == 0) {
    key += fmt::format(" {} {} {}", topology.attribute("NodesPerElement").value(),
                       attribute(topology, "NumberOfElements", "Dimensions"),
                       place.shape.empty() ? 0 : place.shape.back());
  }
  return key;
}

pugi::xml_node item_of_topology(const Reading& reading, pugi::xml_node topology) {
  const std::string type = attribute(topology, "TopologyType", "Type");
  if (type.empty())
    throw reading.document.error(topology, "the Topology has no TopologyType", "Triangle is one");
  const bool structured = type.find("MESH") != std::string::npos || type.find("Mesh") != std::string::npos ||
                          type.find("mesh") != std::string::npos;
  if (structured || same_but_for_case(type, "Polyhedron") ||
      (!same_but_for_case(type, "Mixed") && topology_type(type) == nullptr)) {
    throw reading.document.error(
        topology,
        fmt::format("the TopologyType is '{}'{}", shortened(type),
                    structured ? ", which is structured: its order is fixed by the grid" : ""),
        "types with fixed nodes are supported, from Polyvertex to Hexahedron_1331, and Mixed");
  }
  return reading.item_of(topology);
}

/// Returns the number of cells that a Topology announces, −1 if it announces none.
std::int64_t claimed_cells(const Document& document, pugi::xml_node topology) {
  const std::string text = attribute(topology, "NumberOfElements", "Dimensions");
  std::string_view rest = text;
  std::int64_t cells = -1;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    std::int64_t size = -1;
    if (!parse_xml_number(word, size) || size < 0 || size > kMaxIndex) {
      throw document.error(topology, fmt::format("NumberOfElements is '{}'", shortened(text)),
                           "a whole number up to 2147483647 is needed");
    }
    cells = cells < 0 ? size : cells;  // the first of several numbers is the number of cells
  }
  return cells;
}

/// Reads the cells of a mixed Topology; `counted`: whether cells of Polyvertex also have a count of points.
/// Returns false if the data are faulty near `numbers[at]`.
bool read_mixed(const std::vector<Index>& numbers, std::int64_t claimed, bool counted, FileCells& cells,
                std::size_t& at) {
  cells = {};
  std::size_t i = 0;
  while (i < numbers.size()) {
    at = i;
    const TopologyType* const type = topology_type(numbers[i++]);
    if (type == nullptr) return false;
    std::int64_t nodes = type->nodes;
    if (nodes == 0 && type->number == kPolyvertex && !counted) nodes = 1;  // as meshio writes these cells
    if (nodes == 0) {
      if (i == numbers.size()) return false;
      nodes = numbers[i++];
    }
    if (nodes <= 0 || std::cmp_greater(nodes, numbers.size() - i)) return false;
    cells.types.push_back(static_cast<std::uint8_t>(vtk_type(*type, nodes)));
    for (std::int64_t k = 0; k < nodes; ++k) {
      cells.vertices.push_back(numbers[i++]);
    }
    cells.offsets.push_back(static_cast<Offset>(cells.vertices.size()));
  }
  return claimed < 0 || claimed == static_cast<std::int64_t>(cells.types.size());
}

/// Subtracts `base` from the point numbers of cells. Throws InputError if a point does not exist.
void check_vertices(const Reading& reading, pugi::xml_node item, FileCells& cells, int base) {
  const Index count = reading.mesh.vertex_count();
  if (base == 0 && all_below(cells.vertices, count)) return;
  for (std::size_t i = 0; i < cells.vertices.size(); ++i) {
    const std::int64_t vertex = std::int64_t{cells.vertices[i]} - base;
    if (vertex < 0 || vertex >= count) {
      const auto cell = std::upper_bound(cells.offsets.begin(), cells.offsets.end(), static_cast<Offset>(i)) -
                        cells.offsets.begin() - 1;
      throw reading.document.error(
          item, fmt::format("cell {} (counted from 0) names a point that does not exist", cell),
          fmt::format("the Geometry has points {} to {}", base, count - 1 + base));
    }
    cells.vertices[i] = static_cast<Index>(vertex);
  }
}

/// Returns the cells of a Topology in file order, with points counted from 0.
FileCells cells_of(Reading& reading, pugi::xml_node topology, pugi::xml_node item, const DataPlace& place,
                   int base) {
  FileCells piece;
  std::vector<Index> numbers = reading.data.read_indices(place);
  const std::string type = attribute(topology, "TopologyType", "Type");
  const std::int64_t claimed = claimed_cells(reading.document, topology);
  if (same_but_for_case(type, "Mixed")) {
    std::size_t fault_at = 0;
    if (!read_mixed(numbers, claimed, true, piece, fault_at) &&
        (claimed < 0 || !read_mixed(numbers, claimed, false, piece, fault_at))) {
      throw reading.document.error(item, fmt::format("the mixed Topology is damaged near value {}", fault_at),
                                   claimed < 0 ? "each cell is the number of its type and its points"
                                               : fmt::format("NumberOfElements says {} cells", claimed));
    }
    check_vertices(reading, item, piece, base);
    return piece;
  }
  const TopologyType& known = *topology_type(type);
  std::int64_t nodes = known.nodes;
  if (nodes == 0) {
    nodes = reading.document.whole_number<std::int64_t>(topology, "NodesPerElement", 0);
    if (nodes <= 0 && place.shape.size() > 1) nodes = static_cast<std::int64_t>(place.shape.back());
    if (nodes <= 0 && claimed > 0) nodes = std::ssize(numbers) / claimed;
    if (nodes <= 0 && known.number == kPolyvertex) nodes = 1;
    if (nodes <= 0 || nodes > kMaxIndex) {
      throw reading.document.error(topology, fmt::format("the {} has no NodesPerElement", known.name),
                                   "it is needed");
    }
  }
  const std::int64_t entries = std::ssize(numbers);
  const std::int64_t cells = entries / nodes;
  if (entries % nodes != 0 || (claimed >= 0 && claimed != cells) || cells > kMaxIndex) {
    throw reading.document.error(
        item, fmt::format("the Topology has {} entries", entries),
        claimed >= 0 ? fmt::format("NumberOfElements announces {} cells of {} points", claimed, nodes)
                     : fmt::format("{} for each cell are needed", nodes));
  }
  piece.types.assign(static_cast<std::size_t>(cells), static_cast<std::uint8_t>(vtk_type(known, nodes)));
  resize_large(piece.offsets, static_cast<std::size_t>(cells) + 1);
  for (std::int64_t c = 0; c <= cells; ++c) piece.offsets[c] = c * nodes;
  piece.vertices = std::move(numbers);
  check_vertices(reading, item, piece, base);
  return piece;
}

/// Returns, for each cell of a piece, the mesh's cell with the same type and vertices; nullopt if a cell is
/// new.
std::optional<std::vector<Index>> known_cells(const Reading& reading, const FileCells& piece) {
  const Index count = index_size(piece.types);
  std::array<bool, 256> types{};
  for (const std::uint8_t type : reading.cells.types) types[type] = true;
  for (const std::uint8_t type : piece.types) {
    if (!types[type]) return {};
  }
  const auto is_same = [&](Index old, Index c) {
    return reading.cells.types[old] == piece.types[c] &&
           std::ranges::equal(vertices_of(reading.cells, old), vertices_of(piece, c));
  };
  bool in_place = count <= index_size(reading.cells.types);
  for (Index c = 0; c < count && in_place; ++c) in_place = is_same(c, c);
  if (in_place) return index_range(0, count);

  std::unordered_multimap<std::size_t, Index> places;
  places.reserve(reading.cells.types.size());
  for (Index c = 0; c < index_size(reading.cells.types); ++c)
    places.emplace(hash_of(sorted(vertices_of(reading.cells, c))), c);
  std::vector<Index> found;
  std::vector<bool> taken(reading.cells.types.size(), false);
  for (Index c = 0; c < count; ++c) {
    const std::vector<Index> wanted = sorted(vertices_of(piece, c));
    const auto [begin, end] = places.equal_range(hash_of(wanted));
    const auto place = std::find_if(begin, end, [&](const auto& candidate) {
      const auto old = static_cast<std::size_t>(candidate.second);
      return !taken[old] && reading.cells.types[old] == piece.types[c] &&
             sorted(vertices_of(reading.cells, candidate.second)) == wanted;
    });
    if (place == end) return {};
    taken[place->second] = true;
    found.push_back(place->second);
  }
  return found;
}

bool is_part(const Reading& reading, int part, const FileCells& piece) {
  const std::vector<Index>& rows = reading.rows[part];
  if (index_size(rows) != index_size(piece.types)) return false;
  for (Index c = 0; c < index_size(rows); ++c) {
    const auto old = static_cast<std::size_t>(rows[c]);
    if (reading.cells.types[old] != piece.types[c] ||
        !std::ranges::equal(vertices_of(reading.cells, static_cast<Index>(old)), vertices_of(piece, c))) {
      return false;
    }
  }
  return true;
}

/// Appends the cells of a piece to those of the mesh; returns the indices of the appended cells.
std::vector<Index> append(Reading& reading, pugi::xml_node topology, FileCells piece) {
  const Index first = index_size(reading.cells.types);
  const Index count = index_size(piece.types);
  if (std::int64_t{first} + count > kMaxIndex) {
    throw reading.document.error(topology, "the Grids have too many cells",
                                 "at most 2147483647 are possible");
  }
  if (count > 0) reading.mesh.cell_blocks.push_back(first);
  if (first == 0) {
    reading.cells = std::move(piece);
  } else {
    const Offset before = reading.cells.offsets.back();
    reading.cells.types.insert(reading.cells.types.end(), piece.types.begin(), piece.types.end());
    reading.cells.vertices.insert(reading.cells.vertices.end(), piece.vertices.begin(), piece.vertices.end());
    for (std::size_t c = 1; c < piece.offsets.size(); ++c)
      reading.cells.offsets.push_back(before + piece.offsets[c]);
  }
  if (reading.where_cells_are.empty()) reading.where_cells_are = topology;
  return index_range(first, count);
}

}  // namespace

int TopologyReader::read(const GridElement& grid, pugi::xml_node topology) {
  if (!topology.attribute("Order").empty()) {
    throw reading_.document.error(topology, "the Topology has an Order of nodes of its own",
                                  "write it without");
  }
  const pugi::xml_node item = item_of_topology(reading_, topology);
  Field field{Field::Role::connectivity, reading_.data.place_of(item)};
  field.base = reading_.document.whole_number<int>(topology, "BaseOffset", 0);
  const std::string key = key_of_cells(topology, field.place, field.base);
  std::vector<Field>& fields = reading_.layout->fields;
  if (const auto known = known_topologies_.find(key); known != known_topologies_.end()) {
    Field& same = fields[known->second];
    same.place.repeat(field.place);
    return same.part;
  }
  field.part = part_of(grid, topology, cells_of(reading_, topology, item, field.place, field.base));
  known_topologies_.emplace(key, fields.size());
  fields.push_back(field);
  return field.part;
}

int TopologyReader::part_of(const GridElement& grid, pugi::xml_node topology, vtk::FileCells piece) {
  if (grid.series >= 0) {
    // the mesh of a series may be written again in each step
    const auto known = series_parts_.find(grid.series);
    if (known != series_parts_.end()) {
      if (is_part(reading_, known->second, piece)) return known->second;
      throw reading_.document.error(
          topology, fmt::format("the cells change in time step {}", grid.step),
          "a series needs one mesh for all steps: save each mesh as a separate file");
    }
    if (!reading_.layout->parts.empty() && is_part(reading_, 0, piece)) return series_parts_[grid.series] = 0;
  }
  const auto number = static_cast<int>(reading_.layout->parts.size());
  if (grid.series >= 0) series_parts_[grid.series] = number;
  TopologyPart part;
  part.grid = reading_.document.number(grid.element);
  part.name = grid.element.attribute("Name").value();
  if (part.name.empty()) part.name = fmt::format("grid {}", number);
  std::vector<Index> rows;
  if (auto known = number == 0 ? std::nullopt : known_cells(reading_, piece)) {
    part.has_own_cells = false;
    rows = std::move(*known);
    part.is_ascending = std::is_sorted(rows.begin(), rows.end());
  } else {
    rows = append(reading_, topology, std::move(piece));
  }
  if (number > 0 && part.has_own_cells && is_added(grid.element)) part.below = below_of(part.name);
  if (number > 0 && part.below == 0) part.set = reading_.add_set_of_grid(part.name, rows);
  reading_.layout->parts.push_back(part);
  reading_.rows.push_back(std::move(rows));
  return number;
}

}  // namespace meshorder::xdmf
