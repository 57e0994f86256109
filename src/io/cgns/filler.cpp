// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cgns/filler.hpp"

#include "base/index.hpp"
#include "io/exact_values.hpp"
#include "mesh/values.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace meshorder::cgns {

Filler::Filler(const Mesh& mesh, const CgnsMetadata& metadata)
    : mesh_(mesh), metadata_(metadata), polyhedra_(metadata) {
  place_vertices();
  place_cells();
}

bool Filler::has_vertices_in_order() const {
  return std::is_sorted(metadata_.zone_of_vertex.begin(), metadata_.zone_of_vertex.end());
}

void Filler::fill(Node& node) {
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

bool Filler::is_gone(const Field& field) const {
  switch (field.role) {
    case Field::Role::connectivity:
      return element_count(field.place) == 0;
    case Field::Role::values:
      return field.has_left || find_array(mesh_, field.array, field.association) == nullptr;
    case Field::Role::list:
      return metadata_.lists[field.place].members.empty();
    default:
      return false;
  }
}

void Filler::place_vertices() {
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

void Filler::place_cells() {
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

Index Filler::element_count(int s) const {
  return metadata_.sections[s].type == kPolygons ? index_size(polyhedra_.polygons_of(s))
                                                 : index_size(cells_of_section_[s]);
}

Index Filler::vertex_count(int zone) const {
  return metadata_.zone_of_vertex.empty() ? mesh_.vertex_count() : index_size(vertices_of_zone_[zone]);
}

Index Filler::vertex_at(int zone, Index number) const {
  return metadata_.zone_of_vertex.empty() ? number : vertices_of_zone_[zone][number];
}

Index Filler::number_of_vertex(Index v) const {
  return number_of_vertex_.empty() ? v + 1 : number_of_vertex_[v];
}

std::int64_t Filler::number_of_cell(Index c) const {
  return first_numbers_[metadata_.section_of_cell[c]] + rank_of_cell_[c];
}

// ---- numbers of a type

namespace {

/// Writes numbers one by one into the values of a node; numbers that are not written are 0.
template <class Number>
class NodeValues {
 public:
  NodeValues(Node& node, std::string type, std::size_t count) : bytes_(node.bytes) {
    node.type = std::move(type);
    node.dimensions = {static_cast<std::int64_t>(count)};
    bytes_.resize(count * sizeof(Number));
  }

  void put(std::size_t place, Number number) {
    std::memcpy(bytes_.data() + place * sizeof(Number), &number, sizeof(Number));
  }

 private:
  std::string& bytes_;
};

}  // namespace

template <class Number>
void Filler::put(Node& node, std::string type, std::vector<std::int64_t> dimensions,
                 const std::vector<Number>& numbers) {
  node.type = std::move(type);
  node.dimensions = std::move(dimensions);
  node.bytes.resize(numbers.size() * sizeof(Number));
  if (!numbers.empty()) std::memcpy(node.bytes.data(), numbers.data(), node.bytes.size());
}

void Filler::put_whole(Node& node, const std::string& type, std::vector<std::int64_t> dimensions,
                       const std::vector<std::int64_t>& numbers) {
  if (!fit_32_bits(numbers) || type == "I8" || type == "U8")
    return put(node, "I8", std::move(dimensions), numbers);
  put(node, "I4", std::move(dimensions), std::vector<std::int32_t>(numbers.begin(), numbers.end()));
}

// ---- the mesh

void Filler::fill_size(Node& node, int z) const {
  const Zone& zone = metadata_.zones[z];
  put_whole(node, zone.number_type, {1, 3}, {vertex_count(z), is_whole_ ? zone.cell_count : counts_[z], 0});
}

template <class Number>
void Filler::put_coordinate(Node& node, const std::string& type, const Field& field) const {
  const Index count = vertex_count(field.place);
  NodeValues<Number> values(node, type, static_cast<std::size_t>(count));
  const auto axis = static_cast<std::size_t>(field.axis);
  for (Index v = 0; v < count; ++v) {
    values.put(static_cast<std::size_t>(v),
               static_cast<Number>(mesh_.points[vertex_at(field.place, v)][axis]));
  }
}

void Filler::fill_coordinate(Node& node, const Field& field) const {
  bool is_single = field.type == "R4";
  const auto axis = static_cast<std::size_t>(field.axis);
  for (Index v = 0; is_single && v < vertex_count(field.place); ++v) {
    is_single = is_exact<float>(mesh_.points[vertex_at(field.place, v)][axis]);
  }
  if (is_single) return put_coordinate<float>(node, "R4", field);
  put_coordinate<double>(node, "R8", field);
}

template <class Number>
void Filler::put_connectivity(Node& node, int s, const std::string& type) const {
  const bool is_mixed = metadata_.sections[s].type == kMixedElements;
  std::size_t size = 0;
  for (const Index c : cells_of_section_[s]) {
    size += static_cast<std::size_t>(mesh_.cells.vertex_count(c)) + (is_mixed ? 1 : 0);
  }
  NodeValues<Number> numbers(node, type, size);
  std::size_t at = 0;
  for (const Index c : cells_of_section_[s]) {
    const std::span<const Index> cell = mesh_.cells[c];
    const auto nodes = static_cast<int>(cell.size());
    const std::span<const int> order = file_order(mesh_.cells.shapes[c], nodes);
    if (is_mixed) {
      numbers.put(at++, static_cast<Number>(element_type_of(mesh_.cells.shapes[c], nodes)->number));
    }
    for (std::size_t k = 0; k < cell.size(); ++k) {
      numbers.put(at + (order.empty() ? k : static_cast<std::size_t>(order[k])),
                  static_cast<Number>(number_of_vertex(cell[k])));
    }
    at += cell.size();
  }
}

void Filler::fill_connectivity(Node& node, int s) const {
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

std::vector<std::int64_t> Filler::offsets_of(int s) const {
  if (metadata_.sections[s].type != kMixedElements) return polyhedra_.offsets(s, cells_of_section_[s]);
  std::vector<std::int64_t> offsets{0};
  for (const Index c : cells_of_section_[s]) {
    offsets.push_back(offsets.back() + mesh_.cells.vertex_count(c) + 1);
  }
  return offsets;
}

void Filler::fill_offsets(Node& node, int s) const {
  const std::vector<std::int64_t> offsets = offsets_of(s);
  put_whole(node, metadata_.sections[s].offset_type, {std::ssize(offsets)}, offsets);
}

// ---- values, lists and parents

std::vector<Index> Filler::rows_of(const Field& field) const {
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
void Filler::put_values(Node& node, const std::string& type, const std::vector<Old>& values,
                        const std::vector<Index>& rows, const std::vector<Index>& table, const Field& field,
                        Index components) {
  NodeValues<Number> numbers(node, type, rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Index row = table.empty() ? rows[i] : table[rows[i]];
    if constexpr (std::is_arithmetic_v<Old>) {
      if (row >= 0) {
        numbers.put(
            i, static_cast<Number>(values[static_cast<std::size_t>(row) * components + field.component]));
        continue;
      }
    }
    if constexpr (std::is_floating_point_v<Number>) {
      numbers.put(i, std::numeric_limits<Number>::quiet_NaN());
    }
  }
}

namespace {

/// Returns whether a type of CGNS represents each of the values exactly; always true for R8.
bool can_hold(std::string_view type, const Values& values) {
  if (type == "R4") return are_exact<float>(values);
  if (type == "B1") return are_exact<std::uint8_t>(values);
  if (type == "I4") return are_exact<std::int32_t>(values);
  if (type == "U4") return are_exact<std::uint32_t>(values);
  if (type == "I8") return are_exact<std::int64_t>(values);
  if (type == "U8") return are_exact<std::uint64_t>(values);
  return type == "R8";
}

/// Returns the type in which values are written: the type in the file if it can hold all values, else a wider
/// type.
std::string written_type(const std::string& of_file, const Values& values) {
  if (can_hold(of_file, values)) return of_file;
  return !of_file.starts_with('R') && can_hold("I8", values) ? "I8" : "R8";
}

}  // namespace

void Filler::fill_values(Node& node, const Field& field) const {
  const DataArray& array = *find_array(mesh_, field.array, field.association);
  const std::string type = written_type(field.type, array.values);
  const std::vector<Index> rows = rows_of(field);
  const std::vector<Index> table = rows_by_item(array, item_count(mesh_, field.association));
  std::visit(
      [&](const auto& values) {
        const auto put_as = [&](auto zero) {
          put_values<decltype(zero)>(node, type, values, rows, table, field, array.components);
        };
        if (type == "R4") return put_as(float{});
        if (type == "B1") return put_as(std::uint8_t{});
        if (type == "I4") return put_as(std::int32_t{});
        if (type == "U4") return put_as(std::uint32_t{});
        if (type == "I8") return put_as(std::int64_t{});
        if (type == "U8") return put_as(std::uint64_t{});
        put_as(double{});
      },
      array.values);
}

void Filler::fill_list(Node& node, const PointList& list) const {
  std::vector<std::int64_t> numbers;
  numbers.reserve(list.members.size());
  for (const Index member : list.members) {
    numbers.push_back(list.association == Association::vertices ? number_of_vertex(member)
                                                                : number_of_cell(member));
  }
  if (list.is_range) {
    const auto [first, last] = std::minmax_element(numbers.begin(), numbers.end());
    const bool in_order = !list.orders_data || std::is_sorted(numbers.begin(), numbers.end());
    if (in_order && *last - *first + 1 == static_cast<std::int64_t>(numbers.size())) {
      return put_whole(node, list.number_type, {1, 2}, {*first, *last});
    }
    node.label = "IndexArray_t";
    node.name = node.name == "ElementRange" ? "ElementList" : "PointList";
  }
  put_whole(node, list.number_type, {1, static_cast<std::int64_t>(numbers.size())}, numbers);
}

void Filler::fill_parents(Node& node, const Parents& parents) const {
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
    for (const Index row : row_of_rank) numbers.push_back(parents.rest[from + static_cast<std::size_t>(row)]);
  }
  put_whole(node, parents.number_type,
            {static_cast<std::int64_t>(row_of_rank.size()), static_cast<std::int64_t>(parents.columns)},
            numbers);
}

}  // namespace meshorder::cgns
