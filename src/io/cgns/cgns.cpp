// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cgns/cgns.hpp"

#include "base/index.hpp"
#include "io/all_formats.hpp"
#include "io/cell_division.hpp"
#include "io/cgns/polyhedra_order.hpp"
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <type_traits>
#include <utility>

// Writes the nodes of a file, with the values that are in the mesh.

namespace meshorder::cgns {
namespace {

void move_positions(std::vector<Index>& positions, std::span<const Index> places) {
  for (Index& position : positions) {
    if (position >= 0) position = places[static_cast<std::size_t>(position)];
  }
}

/// Returns the values, one for each vertex or cell, at their new places; those of place −1 are left out.
std::vector<Index> moved_values(const std::vector<Index>& values, std::span<const Index> places) {
  std::vector<Index> result(values.size());
  Index kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (places[i] < 0) continue;
    result[static_cast<std::size_t>(places[i])] = values[i];
    ++kept;
  }
  result.resize(static_cast<std::size_t>(kept));
  return result;
}

void move_parents(Parents& parents, std::span<const Index> cells) {
  if (!parents.of_polygons) move_positions(parents.rows, cells);
  move_positions(parents.cells, cells);
}

/// Returns the members without repeated ones.
std::vector<Index> unique_members(const std::vector<Index>& members) {
  std::vector<Index> sorted = members;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) return members;
  std::set<Index> seen;
  std::vector<Index> result;
  for (const Index member : members) {
    if (seen.insert(member).second) result.push_back(member);
  }
  return result;
}

/// Returns whether a mesh still has the vertices, cells and types of cells that its metadata are of.
bool still_fits(const Mesh& mesh, const Metadata& metadata) {
  if (index_size(metadata.section_of_cell) != mesh.cell_count()) return false;
  if (!metadata.zone_of_vertex.empty() && index_size(metadata.zone_of_vertex) != mesh.vertex_count()) {
    return false;
  }
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const Section& section = metadata.sections[metadata.section_of_cell[c]];
    const ElementType* const type = element_type(section.type);
    const Shape shape = mesh.cells.shapes[c];
    const int nodes = mesh.cells.vertex_count(c);
    const bool fits = type != nullptr                  ? type->shape == shape && type->nodes == nodes
                      : section.type == kMixedElements ? element_type_of(shape, nodes) != nullptr
                                                       : true;
    if (!fits) return false;
  }
  return polyhedra_fit(mesh, metadata);
}

/// Gives the nodes of a file their values.
class Filler {
 public:
  Filler(const Mesh& mesh, const Metadata& metadata)
      : mesh_(mesh), metadata_(metadata), polyhedra_(metadata) {
    place_vertices();
    place_cells();
  }

  /// Whether the vertices of each zone follow those of the one before.
  [[nodiscard]] bool has_vertices_in_order() const {
    return std::is_sorted(metadata_.zone_of_vertex.begin(), metadata_.zone_of_vertex.end());
  }

  void fill(Node& node) {
    const Field& field = metadata_.fields[static_cast<std::size_t>(node.field)];
    switch (field.role) {
      case Field::Role::zone_size:
        return fill_size(node, field.place);
      case Field::Role::coordinate:
        return fill_coordinate(node, field);
      case Field::Role::range: {
        const std::int64_t first = first_numbers_[field.place];
        return put_whole(node, metadata_.sections[field.place].range_type, {2},
                         {first, first + element_count(field.place) - 1});
      }
      case Field::Role::connectivity:
        return fill_connectivity(node, field.place);
      case Field::Role::offsets:
        return fill_offsets(node, field.place);
      case Field::Role::values:
        return fill_values(node, field);
      case Field::Role::list:
        return fill_list(node, metadata_.lists[field.place]);
      case Field::Role::parents:
        return fill_parents(node, metadata_.parents[field.place]);
    }
  }

  /// Returns whether a node has anything to write: sections and lists may have lost all their cells.
  [[nodiscard]] bool is_gone(const Field& field) const {
    switch (field.role) {
      case Field::Role::connectivity:
        return element_count(field.place) == 0;
      case Field::Role::values:
        return find_array(mesh_, field.array, field.association) == nullptr;
      case Field::Role::list:
        return metadata_.lists[field.place].members.empty();
      default:
        return false;
    }
  }

 private:
  void place_vertices() {
    const std::size_t zones = metadata_.zones.size();
    vertices_of_zone_.resize(zones);
    if (metadata_.zone_of_vertex.empty()) return;
    number_of_vertex_.resize(mesh_.points.size());
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      auto& vertices = vertices_of_zone_[metadata_.zone_of_vertex[v]];
      vertices.push_back(v);
      number_of_vertex_[v] = index_size(vertices);
    }
  }

  void place_cells() {
    cells_of_section_.resize(metadata_.sections.size());
    rank_of_cell_.resize(mesh_.cells.shapes.size());
    for (Index c = 0; c < mesh_.cell_count(); ++c) {
      auto& cells = cells_of_section_[metadata_.section_of_cell[c]];
      rank_of_cell_[c] = index_size(cells);
      cells.push_back(c);
    }
    for (Index p = 0; p < index_size(metadata_.cell_of_polygon); ++p) {
      if (const Index c = metadata_.cell_of_polygon[p]; c >= 0) rank_of_cell_[c] = polyhedra_.rank_of(p);
    }
    bool is_whole = true;
    for (std::size_t s = 0; s < cells_of_section_.size(); ++s) {
      is_whole = is_whole && element_count(static_cast<int>(s)) == metadata_.sections[s].count;
    }
    std::vector<std::int64_t> next(metadata_.zones.size(), 1);
    counts_.resize(metadata_.zones.size());
    for (std::size_t s = 0; s < cells_of_section_.size(); ++s) {
      const Section& section = metadata_.sections[s];
      first_numbers_.push_back(is_whole ? section.first : next[section.zone]);
      next[section.zone] += element_count(static_cast<int>(s));
      for (const Index c : cells_of_section_[s]) {
        if (dimension(mesh_.cells.shapes[c]) == metadata_.cell_dimension) ++counts_[section.zone];
      }
    }
    is_whole_ = is_whole;
  }

  /// Returns the number of elements that a section has in the file: polygons between cells are no cells.
  [[nodiscard]] Index element_count(int s) const {
    return metadata_.sections[s].type == kPolygons ? index_size(polyhedra_.polygons_of(s))
                                                   : index_size(cells_of_section_[s]);
  }

  [[nodiscard]] Index vertex_count(int zone) const {
    return metadata_.zone_of_vertex.empty() ? mesh_.vertex_count() : index_size(vertices_of_zone_[zone]);
  }

  [[nodiscard]] Index vertex_at(int zone, Index number) const {
    return metadata_.zone_of_vertex.empty() ? number : vertices_of_zone_[zone][number];
  }

  [[nodiscard]] Index number_of_vertex(Index v) const {
    return number_of_vertex_.empty() ? v + 1 : number_of_vertex_[v];
  }

  [[nodiscard]] std::int64_t number_of_cell(Index c) const {
    return first_numbers_[metadata_.section_of_cell[c]] + rank_of_cell_[c];
  }

  // ---- numbers of a type

  template <class Number>
  static void put(Node& node, std::string type, std::vector<std::int64_t> dimensions,
                  const std::vector<Number>& numbers) {
    node.type = std::move(type);
    node.dimensions = std::move(dimensions);
    node.bytes.resize(numbers.size() * sizeof(Number));
    if (!numbers.empty()) std::memcpy(node.bytes.data(), numbers.data(), node.bytes.size());
  }

  /// Puts whole numbers of 32 bits where the type has so many and all fit, else of 64.
  static void put_whole(Node& node, const std::string& type, std::vector<std::int64_t> dimensions,
                        const std::vector<std::int64_t>& numbers) {
    const bool fit = std::all_of(numbers.begin(), numbers.end(),
                                 [](std::int64_t number) { return std::in_range<std::int32_t>(number); });
    if (!fit || type == "I8" || type == "U8") return put(node, "I8", std::move(dimensions), numbers);
    put(node, "I4", std::move(dimensions), std::vector<std::int32_t>(numbers.begin(), numbers.end()));
  }

  // ---- the mesh

  void fill_size(Node& node, int z) const {
    const Zone& zone = metadata_.zones[z];
    put_whole(node, zone.number_type, {1, 3}, {vertex_count(z), is_whole_ ? zone.cell_count : counts_[z], 0});
  }

  template <class Number>
  void put_coordinate(Node& node, const Field& field) const {
    const Index count = vertex_count(field.place);
    std::vector<Number> values(static_cast<std::size_t>(count));
    const auto axis = static_cast<std::size_t>(field.axis);
    for (Index v = 0; v < count; ++v) {
      values[v] = static_cast<Number>(mesh_.points[vertex_at(field.place, v)][axis]);
    }
    put(node, field.type, {count}, values);
  }

  void fill_coordinate(Node& node, const Field& field) const {
    if (field.type == "R4") return put_coordinate<float>(node, field);
    put_coordinate<double>(node, field);
  }

  template <class Number>
  void put_connectivity(Node& node, int s, const std::string& type) const {
    const bool is_mixed = metadata_.sections[s].type == kMixedElements;
    std::vector<Number> numbers;
    std::size_t size = 0;
    for (const Index c : cells_of_section_[s]) {
      size += static_cast<std::size_t>(mesh_.cells.vertex_count(c)) + (is_mixed ? 1 : 0);
    }
    numbers.resize(size);
    std::size_t at = 0;
    for (const Index c : cells_of_section_[s]) {
      const std::span<const Index> cell = mesh_.cells[c];
      const auto nodes = static_cast<int>(cell.size());
      const std::span<const int> order = file_order(mesh_.cells.shapes[c], nodes);
      if (is_mixed) {
        numbers[at++] = static_cast<Number>(element_type_of(mesh_.cells.shapes[c], nodes)->number);
      }
      for (std::size_t k = 0; k < cell.size(); ++k) {
        numbers[at + (order.empty() ? k : static_cast<std::size_t>(order[k]))] =
            static_cast<Number>(number_of_vertex(cell[k]));
      }
      at += cell.size();
    }
    put(node, type, {static_cast<std::int64_t>(size)}, numbers);
  }

  void fill_connectivity(Node& node, int s) const {
    const Section& section = metadata_.sections[s];
    if (section.type == kPolygons || section.type == kPolyhedra) {
      const std::vector<std::int64_t> numbers =
          section.type == kPolygons
              ? polyhedra_.corner_numbers(s, [&](Index v) { return std::int64_t{number_of_vertex(v)}; })
              : polyhedra_.face_numbers(s, cells_of_section_[s], first_numbers_);
      return put_whole(node, section.number_type, {std::ssize(numbers)}, numbers);
    }
    if (metadata_.sections[s].number_type == "I8") return put_connectivity<std::int64_t>(node, s, "I8");
    put_connectivity<std::int32_t>(node, s, "I4");
  }

  [[nodiscard]] std::vector<std::int64_t> offsets_of(int s) const {
    if (metadata_.sections[s].type != kMixedElements) return polyhedra_.offsets(s, cells_of_section_[s]);
    std::vector<std::int64_t> offsets{0};
    for (const Index c : cells_of_section_[s]) {
      offsets.push_back(offsets.back() + mesh_.cells.vertex_count(c) + 1);
    }
    return offsets;
  }

  void fill_offsets(Node& node, int s) const {
    const std::vector<std::int64_t> offsets = offsets_of(s);
    put_whole(node, metadata_.sections[s].offset_type, {std::ssize(offsets)}, offsets);
  }

  // ---- what belongs to it

  /// Returns the vertices or cells that have values in a node.
  [[nodiscard]] std::vector<Index> rows_of(const Field& field) const {
    if (field.section >= 0) return cells_of_section_[field.section];
    if (field.list >= 0) return metadata_.lists[field.list].members;
    std::vector<Index> rows;
    if (field.association == Association::vertices) {
      const Index count = vertex_count(field.place);
      rows.reserve(static_cast<std::size_t>(count));
      for (Index v = 0; v < count; ++v) rows.push_back(vertex_at(field.place, v));
      return rows;
    }
    for (std::size_t s = 0; s < cells_of_section_.size(); ++s) {
      if (metadata_.sections[s].zone != field.place) continue;
      for (const Index c : cells_of_section_[s]) {
        if (dimension(mesh_.cells.shapes[c]) == metadata_.cell_dimension) rows.push_back(c);
      }
    }
    return rows;
  }

  template <class Number, class Old>
  static void put_values(Node& node, const std::string& type, const std::vector<Old>& values,
                         const std::vector<Index>& rows, const std::vector<Index>& table, const Field& field,
                         Index components) {
    std::vector<Number> numbers(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Index row = table.empty() ? rows[i] : table[rows[i]];
      if constexpr (std::is_arithmetic_v<Old>) {
        if (row >= 0) {
          numbers[i] =
              static_cast<Number>(values[static_cast<std::size_t>(row) * components + field.component]);
          continue;
        }
      }
      if constexpr (std::is_floating_point_v<Number>) numbers[i] = std::numeric_limits<Number>::quiet_NaN();
    }
    put(node, type, {static_cast<std::int64_t>(rows.size())}, numbers);
  }

  void fill_values(Node& node, const Field& field) const {
    const DataArray& array = *find_array(mesh_, field.array, field.association);
    const std::vector<Index> rows = rows_of(field);
    std::vector<Index> table;
    if (!array.is_dense()) {
      table.assign(
          field.association == Association::vertices ? mesh_.points.size() : mesh_.cells.shapes.size(), -1);
      for (Index row = 0; row < index_size(array.indices); ++row) table[array.indices[row]] = row;
    }
    std::visit(
        [&](const auto& values) {
          const auto put_as = [&](auto zero) {
            put_values<decltype(zero)>(node, field.type, values, rows, table, field, array.components);
          };
          if (field.type == "R4") return put_as(float{});
          if (field.type == "I4") return put_as(std::int32_t{});
          if (field.type == "U4") return put_as(std::uint32_t{});
          if (field.type == "I8") return put_as(std::int64_t{});
          if (field.type == "U8") return put_as(std::uint64_t{});
          put_as(double{});
        },
        array.values);
  }

  void fill_list(Node& node, const PointList& list) const {
    std::vector<std::int64_t> numbers;
    numbers.reserve(list.members.size());
    for (const Index member : list.members) {
      numbers.push_back(list.association == Association::vertices ? number_of_vertex(member)
                                                                  : number_of_cell(member));
    }
    if (list.is_range) {
      const auto [first, last] = std::minmax_element(numbers.begin(), numbers.end());
      if (*last - *first + 1 == static_cast<std::int64_t>(numbers.size())) {
        return put_whole(node, list.number_type, {1, 2}, {*first, *last});
      }
      node.label = "IndexArray_t";
      node.name = node.name == "ElementRange" ? "ElementList" : "PointList";
    }
    put_whole(node, list.number_type, {1, static_cast<std::int64_t>(numbers.size())}, numbers);
  }

  void fill_parents(Node& node, const Parents& parents) const {
    std::vector<Index> row_of_rank(static_cast<std::size_t>(element_count(parents.section)));
    for (Index row = 0; row < index_size(parents.rows); ++row) {
      const Index of_row = parents.rows[row];
      const Index rank = of_row < 0            ? -1
                         : parents.of_polygons ? polyhedra_.rank_of(of_row)
                                               : rank_of_cell_[of_row];
      if (rank >= 0) row_of_rank[rank] = row;
    }
    const auto number_of_parent = [&](Index cell) -> std::int64_t {
      if (cell < 0) return 0;
      return parents.from_one ? rank_of_cell_[cell] + 1 : number_of_cell(cell);
    };
    std::vector<std::int64_t> numbers;
    const std::size_t rows = parents.rows.size();
    for (std::size_t from = 0; from < parents.cells.size(); from += rows) {
      for (const Index row : row_of_rank) {
        numbers.push_back(number_of_parent(parents.cells[from + static_cast<std::size_t>(row)]));
      }
    }
    for (std::size_t from = 0; from < parents.rest.size(); from += rows) {
      for (const Index row : row_of_rank)
        numbers.push_back(parents.rest[from + static_cast<std::size_t>(row)]);
    }
    put_whole(node, parents.number_type,
              {static_cast<std::int64_t>(row_of_rank.size()), static_cast<std::int64_t>(parents.columns)},
              numbers);
  }

  const Mesh& mesh_;
  const Metadata& metadata_;
  PolyhedraOrder polyhedra_;
  std::vector<std::vector<Index>> vertices_of_zone_;
  std::vector<Index> number_of_vertex_;  ///< in its zone; empty for one zone
  std::vector<std::vector<Index>> cells_of_section_;
  std::vector<Index> rank_of_cell_;
  std::vector<std::int64_t> first_numbers_;
  std::vector<std::int64_t> counts_;  ///< of cells with values at their centres, by zone
  bool is_whole_ = true;
};

/// Takes over the members of sets that are not those of their lists any more, and marks lists whose members
/// are others now.
void take_sets(const Mesh& mesh, Metadata& metadata) {
  for (PointList& list : metadata.lists) {
    if (list.set.empty()) continue;
    const auto set = std::find_if(mesh.sets.begin(), mesh.sets.end(), [&](const EntitySet& one) {
      return one.name == list.set && one.association == list.association;
    });
    if (set == mesh.sets.end()) {
      list.members.clear();
      continue;
    }
    if (unique_members(list.members) == set->members) continue;
    // only those of its zone: conditions belong to one
    list.members.clear();
    for (const Index member : set->members) {
      const Index zone = list.association == Association::cells
                             ? metadata.sections[metadata.section_of_cell[member]].zone
                         : metadata.zone_of_vertex.empty() ? 0
                                                           : metadata.zone_of_vertex[member];
      if (zone == list.zone) list.members.push_back(member);
    }
    list.is_shortened = true;
  }
}

/// Removes the nodes that have nothing to write any more: sections without cells, conditions and solutions
/// without members, arrays that the mesh has not. Notes data that belonged to a list by its order.
class Pruner {
 public:
  Pruner(const Metadata& metadata, const Filler& filler, Notes& notes)
      : metadata_(metadata), filler_(filler), notes_(notes) {}

  void prune(Node& node) const {
    std::erase_if(node.children, [&](const Node& child) { return is_gone(child); });
    if (const Node* const list = shortened_list(node)) {
      const auto before = node.children.size();
      std::erase_if(node.children, [&](const Node& child) {
        return child.label == "BCDataSet_t" || child.label == "InwardNormalList_t" ||
               child.name == "InwardNormalList" || child.name == "PointListDonor" ||
               child.name == "CellListDonor";
      });
      if (node.children.size() != before) {
        notes_.push_back(fmt::format("the data of '{}' are left out: its {} has other members now", node.name,
                                     list->name));
      }
    }
    for (Node& child : node.children) prune(child);
  }

 private:
  [[nodiscard]] bool has_gone_field(const Node& node) const {
    return node.field >= 0 && filler_.is_gone(metadata_.fields[static_cast<std::size_t>(node.field)]);
  }

  [[nodiscard]] bool is_gone(const Node& node) const {
    if (has_gone_field(node)) return true;
    return std::any_of(node.children.begin(), node.children.end(), [&](const Node& child) {
      if (!has_gone_field(child)) return false;
      const Field::Role role = metadata_.fields[static_cast<std::size_t>(child.field)].role;
      return role == Field::Role::connectivity || role == Field::Role::list;
    });
  }

  [[nodiscard]] const Node* shortened_list(const Node& node) const {
    for (const Node& child : node.children) {
      if (child.field < 0) continue;
      const Field& field = metadata_.fields[static_cast<std::size_t>(child.field)];
      if (field.role == Field::Role::list && metadata_.lists[field.place].is_shortened) return &child;
    }
    return nullptr;
  }

  const Metadata& metadata_;
  const Filler& filler_;
  Notes& notes_;
};

bool holds(const Mesh& mesh, Shape shape, int vertices) {
  const ElementType* const type = element_type_of(shape, vertices);
  constexpr int kLastOfSecondOrder = 21;
  const Metadata* const own = own_metadata(mesh);
  if (type == nullptr) return own != nullptr && shape == Shape::polygon && !own->cell_of_polygon.empty();
  return type->number <= kLastOfSecondOrder || own != nullptr;
}

/// Cells of lower dimensions, with which sets name boundaries, follow the others.
Permutation places(const Mesh& mesh, std::vector<Index>& blocks) {
  return places_by_division(divide_cells(mesh, true), blocks);
}

}  // namespace

const Metadata* own_metadata(const Mesh& mesh) {
  return dynamic_cast<const Metadata*>(mesh.format_metadata.get());
}

std::shared_ptr<const FormatMetadata> Metadata::moved(std::span<const Index> vertices,
                                                      std::span<const Index> cells) const {
  auto result = std::make_shared<Metadata>(*this);
  for (PointList& list : result->lists) {
    const std::span<const Index> places = list.association == Association::vertices ? vertices : cells;
    if (places.empty()) continue;
    move_positions(list.members, places);
    list.is_shortened = std::erase(list.members, Index{-1}) > 0 || list.is_shortened;
  }
  if (!cells.empty()) {
    result->section_of_cell = moved_values(section_of_cell, cells);
    move_positions(result->cell_of_polygon, cells);
    move_positions(result->cell_of_polyhedron, cells);
    for (Parents& of_section : result->parents) move_parents(of_section, cells);
  }
  if (!vertices.empty() && polyhedra != nullptr) {
    if (vertex_places.empty()) {
      result->vertex_places.assign(vertices.begin(), vertices.end());
    } else {
      move_positions(result->vertex_places, vertices);
    }
  }
  if (!vertices.empty() && !zone_of_vertex.empty()) {
    result->zone_of_vertex = moved_values(zone_of_vertex, vertices);
  }
  return result;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const Metadata* const own = own_metadata(mesh);
  std::shared_ptr<Metadata> metadata;
  if (own != nullptr && still_fits(mesh, *own)) {
    metadata = std::make_shared<Metadata>(*own);
    take_sets(mesh, *metadata);
  } else {
    metadata = layout_of(mesh);
    note_metadata_unsupported(mesh, "CGNS", notes);
  }
  add_missing(mesh, *metadata, notes);
  note_ids_unsupported(mesh, "CGNS", notes);
  Filler filler(mesh, *metadata);
  if (!filler.has_vertices_in_order()) {
    notes.push_back(
        "the vertices are written zone by zone, so that their places in the file are others than those of "
        "the "
        "maps; --group-by zone keeps zones together");
  }
  Tree tree = *metadata->tree;
  Pruner(*metadata, filler, notes).prune(tree.root);
  write_tree(tree, path, [&](Node& node) { filler.fill(node); });
}

}  // namespace meshorder::cgns

namespace meshorder {

Format cgns_format() {
  return {.name = "CGNS",
          .extensions = {".cgns"},
          .groups_cells_by_type = false,
          .read = cgns::read,
          .write = cgns::write,
          .holds = cgns::holds,
          .places = cgns::places,
          .first_number = 1};
}

}  // namespace meshorder
