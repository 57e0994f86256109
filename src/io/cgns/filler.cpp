// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "io/cgns/numbering.hpp"
#include "io/exact_values.hpp"
#include "mesh/values.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

// Fills the nodes of a file with the values of the mesh.

namespace meshorder::cgns {
namespace {

/// Writes numbers one after another into the values of a node.
template <class Number>
class NodeValues {
 public:
  NodeValues(Node& node, std::string type, std::size_t count) : bytes_(node.bytes) {
    node.type = std::move(type);
    node.dimensions = {static_cast<std::int64_t>(count)};
    bytes_.resize(count * sizeof(Number));
  }

  void push(Number number) {
    std::memcpy(bytes_.data() + at_, &number, sizeof(Number));
    at_ += sizeof(Number);
  }

 private:
  std::string& bytes_;
  std::size_t at_ = 0;
};

template <class Number>
void put(Node& node, std::string type, std::vector<std::int64_t> dimensions,
         const std::vector<std::int64_t>& numbers) {
  NodeValues<Number> values(node, std::move(type), numbers.size());
  for (const std::int64_t number : numbers) values.push(static_cast<Number>(number));
  node.dimensions = std::move(dimensions);
}

bool is_64_bits(std::string_view type) { return type == "I8" || type == "U8"; }

/// Puts whole numbers into a node, as I8 if `type` has 64 bits or a number does not fit 32 bits, else as I4.
void put_whole(Node& node, const std::string& type, std::vector<std::int64_t> dimensions,
               const std::vector<std::int64_t>& numbers) {
  if (is_64_bits(type) || !fit_32_bits(numbers)) {
    return put<std::int64_t>(node, "I8", std::move(dimensions), numbers);
  }
  put<std::int32_t>(node, "I4", std::move(dimensions), numbers);
}

/// Returns whether a type of CGNS represents each of the values exactly; always true for R8.
bool can_hold(std::string_view type, const Values& values) {
  return type == "R8" ||
         with_number_of_type(type, [&](auto zero) { return are_exact<decltype(zero)>(values); });
}

/// Returns the type in which values are written: the type in the file if it can hold all values, else a wider
/// type.
std::string written_type(const std::string& of_file, const Values& values) {
  if (can_hold(of_file, values)) return of_file;
  return !of_file.starts_with('R') && can_hold("I8", values) ? "I8" : "R8";
}

class Filler {
 public:
  Filler(Node& node, const Mesh& mesh, const CgnsMetadata& metadata, const Numbering& numbering)
      : node_(node), mesh_(mesh), metadata_(metadata), numbering_(numbering) {}

  void fill() {
    const Field& field = metadata_.fields[node_.field];
    switch (field.role) {
      case Field::Role::zone_size:
        return fill_size(field.place);
      case Field::Role::coordinate:
        return fill_coordinate(field);
      case Field::Role::range: {
        const std::int64_t first = numbering_.first_number(field.place);
        const std::int64_t count = std::ssize(numbering_.elements_of(field.place));
        return put_whole(node_, metadata_.sections[field.place].range_type, {2}, {first, first + count - 1});
      }
      case Field::Role::connectivity:
        return fill_connectivity(field.place);
      case Field::Role::offsets:
        return fill_offsets(field.place);
      case Field::Role::values:
        return fill_values(field);
      case Field::Role::list:
        return fill_list(metadata_.lists[field.place]);
      case Field::Role::parents:
        return fill_parents(metadata_.parents[field.place]);
    }
  }

 private:
  void fill_size(int z) {
    const Zone& zone = metadata_.zones[z];
    const std::int64_t cells = numbering_.is_whole() ? zone.cell_count : numbering_.centred_count(z);
    put_whole(node_, zone.number_type, {1, 3}, {numbering_.vertex_count(z), cells, 0});
  }

  void fill_coordinate(const Field& field) {
    const auto axis = static_cast<std::size_t>(field.axis);
    const Index count = numbering_.vertex_count(field.place);
    const auto coordinate = [&](Index v) { return mesh_.points[numbering_.vertex_at(field.place, v)][axis]; };
    bool is_single = field.type == "R4";
    for (Index v = 0; is_single && v < count; ++v) is_single = is_exact<float>(coordinate(v));
    const auto put_as = [&](auto zero) {
      NodeValues<decltype(zero)> values(node_, is_single ? "R4" : "R8", static_cast<std::size_t>(count));
      for (Index v = 0; v < count; ++v) values.push(static_cast<decltype(zero)>(coordinate(v)));
    };
    is_single ? put_as(float{}) : put_as(double{});
  }

  // ---- elements

  /// Returns whether a number precedes the members of each element in ElementConnectivity: its type in a
  /// mixed section; the number of its members in a section of polygons or polyhedra without offsets.
  static bool has_heads(const Section& section) {
    return section.type == kMixedElements || (section.is_of_polyhedra() && section.offset_type.empty());
  }

  /// Returns the corners of a polygon, the faces of a polyhedron or the vertices of another cell.
  [[nodiscard]] std::span<const Index> members_of(const Section& section, Index element) const {
    if (section.type == kPolygons) return metadata_.polyhedra->corners_of(element);
    if (section.type == kPolyhedra) return metadata_.polyhedra->faces_of(numbering_.polyhedron_of(element));
    return mesh_.cells[element];
  }

  /// Calls `put` with each number of ElementConnectivity.
  template <class Put>
  void visit_numbers(int s, const Put& put) const {
    const Section& section = metadata_.sections[s];
    const bool is_mixed = section.type == kMixedElements;
    for (const Index element : numbering_.elements_of(s)) {
      const std::span<const Index> members = members_of(section, element);
      const auto size = static_cast<int>(members.size());
      if (has_heads(section)) {
        put(is_mixed ? element_type_of(mesh_.cells.shapes[element], size)->number : size);
      }
      if (section.type == kPolygons) {
        for (const Index corner : members) put(numbering_.number_of_vertex(metadata_.vertex_at(corner)));
      } else if (section.type == kPolyhedra) {
        for (const Index face : members) {
          const std::int64_t number = numbering_.number_of_polygon(Polyhedra::polygon_of(face));
          put(face < 0 ? -number : number);
        }
      } else {
        const std::span<const int> order = file_order(mesh_.cells.shapes[element], size);
        for (std::size_t k = 0; k < members.size(); ++k) {
          put(numbering_.number_of_vertex(members[order.empty() ? k : static_cast<std::size_t>(order[k])]));
        }
      }
    }
  }

  void fill_connectivity(int s) {
    const Section& section = metadata_.sections[s];
    std::size_t size = 0;
    for (const Index element : numbering_.elements_of(s)) size += size_of(section, element);
    bool is_wide = section.number_type == "I8";
    if (section.is_of_polyhedra() && !is_wide) {
      is_wide = section.number_type == "U8";
      visit_numbers(s,
                    [&](std::int64_t number) { is_wide = is_wide || !std::in_range<std::int32_t>(number); });
    }
    const auto put_as = [&](auto zero) {
      NodeValues<decltype(zero)> numbers(node_, is_wide ? "I8" : "I4", size);
      visit_numbers(s, [&](std::int64_t number) { numbers.push(static_cast<decltype(zero)>(number)); });
    };
    is_wide ? put_as(std::int64_t{}) : put_as(std::int32_t{});
  }

  /// Returns how many numbers an element has in ElementConnectivity.
  [[nodiscard]] std::size_t size_of(const Section& section, Index element) const {
    return members_of(section, element).size() + (has_heads(section) ? 1 : 0);
  }

  void fill_offsets(int s) {
    const Section& section = metadata_.sections[s];
    std::vector<std::int64_t> offsets{0};
    for (const Index element : numbering_.elements_of(s)) {
      offsets.push_back(offsets.back() + static_cast<std::int64_t>(size_of(section, element)));
    }
    put_whole(node_, section.offset_type, {std::ssize(offsets)}, offsets);
  }

  // ---- values, lists and parents

  void fill_values(const Field& field) {
    const DataArray& array = *find_array(mesh_, field.array, field.association);
    const std::string type = written_type(field.type, array.values);
    const std::vector<Index> rows = numbering_.rows_of(field);
    const std::vector<Index> table = rows_by_item(array, item_count(mesh_, field.association));
    with_numbers(array.values, [&](const auto& values) {
      with_number_of_type(type, [&](auto zero) {
        using Number = decltype(zero);
        NodeValues<Number> numbers(node_, type, rows.size());
        for (const Index item : rows) {
          const Index row = table.empty() ? item : table[item];
          numbers.push(row < 0
                           ? missing_value<Number>()
                           : static_cast<Number>(
                                 values[static_cast<std::size_t>(row) * array.components + field.component]));
        }
      });
    });
  }

  void fill_list(const PointList& list) {
    std::vector<std::int64_t> numbers;
    numbers.reserve(list.members.size());
    for (const Index member : list.members) {
      numbers.push_back(list.association == Association::vertices ? numbering_.number_of_vertex(member)
                                                                  : numbering_.number_of_cell(member));
    }
    if (list.is_range) {
      const auto [first, last] = std::minmax_element(numbers.begin(), numbers.end());
      const bool in_order = !list.orders_data || std::is_sorted(numbers.begin(), numbers.end());
      if (in_order && *last - *first + 1 == std::ssize(numbers)) {
        return put_whole(node_, list.number_type, {1, 2}, {*first, *last});
      }
      node_.label = "IndexArray_t";
      node_.name = node_.name == "ElementRange" ? "ElementList" : "PointList";
    }
    put_whole(node_, list.number_type, {1, std::ssize(numbers)}, numbers);
  }

  void fill_parents(const Parents& parents) {
    std::vector<Index> row_of_rank(numbering_.elements_of(parents.section).size());
    for (Index row = 0; row < index_size(parents.rows); ++row) {
      const Index of_row = parents.rows[row];
      const Index rank = of_row < 0            ? -1
                         : parents.of_polygons ? numbering_.rank_of_polygon(of_row)
                                               : numbering_.rank_of_cell(of_row);
      if (rank >= 0) row_of_rank[rank] = row;
    }
    const auto number_of_parent = [&](Index cell) -> std::int64_t {
      if (cell < 0) return 0;
      return parents.from_one ? numbering_.rank_of_cell(cell) + 1 : numbering_.number_of_cell(cell);
    };
    std::vector<std::int64_t> numbers;
    const std::size_t rows = parents.rows.size();
    for (std::size_t from = 0; from < parents.cells.size(); from += rows) {
      for (const Index row : row_of_rank) numbers.push_back(number_of_parent(parents.cells[from + row]));
    }
    for (std::size_t from = 0; from < parents.rest.size(); from += rows) {
      for (const Index row : row_of_rank) numbers.push_back(parents.rest[from + row]);
    }
    put_whole(node_, parents.number_type,
              {std::ssize(row_of_rank), static_cast<std::int64_t>(parents.columns)}, numbers);
  }

  Node& node_;
  const Mesh& mesh_;
  const CgnsMetadata& metadata_;
  const Numbering& numbering_;
};

}  // namespace

void fill(Node& node, const Mesh& mesh, const CgnsMetadata& metadata, const Numbering& numbering) {
  Filler(node, mesh, metadata, numbering).fill();
}

}  // namespace meshorder::cgns
