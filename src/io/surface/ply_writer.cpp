// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// PLY, the Stanford triangle format: Greg Turk, "The PLY Polygon File Format" (1994),
// https://paulbourke.net/dataformats/ply/, as text and binary in either byte order. Vertices, faces, edges
// and tetrahedra are supported with all their properties.
#include "io/all_formats.hpp"
#include "io/exact_values.hpp"
#include "io/names.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/surface/ply_parts.hpp"
#include "io/surface/surface_data.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <type_traits>
#include <utility>

namespace meshorder {
namespace {
using ply::Element;
using ply::Encoding;
using ply::Property;
using ply::Role;
using ply::Type;
using ply::TypeWord;

/// The source of a property's numbers.
struct ArraySource {
  const DataArray* array = nullptr;
  Index component = 0;        ///< component of the array, for a property that is not a list
  std::vector<Index> row_of;  ///< row of each vertex or cell, −1: none; empty: item i has row i
};

/// A property to be written; without a source, its numbers come from points, cells or the count of rows.
struct Column {
  Property property;
  std::vector<ArraySource> sources;  ///< several for a list whose lengths differ
};

/// An element to be written.
struct Table {
  Element element;
  std::vector<Index> items;  ///< its vertices or cells
  std::vector<Column> columns;
};

TypeWord word_of(const Values& values) {
  const std::size_t type = values.index();
  if (type >= ply::kTypeWords.size()) return {};
  return {std::string(ply::kTypeWords[type].front()), static_cast<Type>(type)};
}

/// Returns the type in which 64-bit integers, which PLY lacks, are written.
TypeWord word_for_wide(const Values& values) {
  const std::vector<double> numbers = as_reals(values);
  const bool fit = std::all_of(numbers.begin(), numbers.end(), [](double x) {
    return x >= std::numeric_limits<std::int32_t>::min() && x <= std::numeric_limits<std::int32_t>::max();
  });
  return fit ? TypeWord{"int", Type::int32} : TypeWord{"double", Type::float64};
}

TypeWord written_type(const Values& values) {
  const bool wide = std::holds_alternative<std::vector<std::int64_t>>(values) ||
                    std::holds_alternative<std::vector<std::uint64_t>>(values);
  return wide ? word_for_wide(values) : word_of(values);
}

ArraySource source_of(const Mesh& mesh, const DataArray& array, Index component) {
  return {&array, component, rows_by_item(array, item_count(mesh, array.association))};
}

Index row_in(const ArraySource& source, Index item) {
  return source.row_of.empty() ? item : source.row_of[item];
}

// ---- which elements, with which cells

Role usual_role(Shape shape) {
  return shape == Shape::tetrahedron ? Role::tetrahedra : shape == Shape::line ? Role::edges : Role::faces;
}

/// Returns whether the elements of the file fit the cells of the mesh, block by block.
bool elements_fit(const ply::PlyMetadata& metadata, const Mesh& mesh) {
  Index cell = 0;
  for (const Element& element : metadata.elements) {
    if (element.role == Role::vertices && element.count != mesh.vertex_count()) return false;
    if (!ply::holds_cells(element)) continue;
    if (element.count > mesh.cell_count() - cell) return false;
    for (const Index end = cell + element.count; cell < end; ++cell) {
      const Shape shape = mesh.cells.shapes[cell];
      const bool is_tetrahedron = shape == Shape::tetrahedron;
      if (is_tetrahedron != (element.role == Role::tetrahedra)) return false;
      if (element.role == Role::edges && shape != Shape::line) return false;
    }
  }
  return cell == mesh.cell_count();
}

std::vector<Table> tables_of_file(const ply::PlyMetadata& metadata) {
  std::vector<Table> tables;
  Index cell = 0;
  Index first_face = 0;
  for (const Element& element : metadata.elements) {
    if (!element.why_left_out.empty()) continue;
    Table& table = tables.emplace_back(Table{element, {}, {}});
    if (element.role == Role::other) continue;
    table.items.resize(element.count);
    const bool cells = ply::holds_cells(element);
    if (element.role == Role::faces) first_face = cell;
    const Index first = cells ? cell : element.role == Role::rows_of_faces ? first_face : 0;
    std::iota(table.items.begin(), table.items.end(), first);
    if (cells) cell += element.count;
  }
  return tables;
}

Property scalar(std::string name, TypeWord type) { return {std::move(name), std::move(type), false, {}}; }

std::vector<Property> usual_properties(Role role) {
  const TypeWord whole{"int", Type::int32};
  switch (role) {
    case Role::vertices: {
      const TypeWord real{"double", Type::float64};
      return {scalar("x", real), scalar("y", real), scalar("z", real)};
    }
    case Role::edges:
      return {scalar("vertex1", whole), scalar("vertex2", whole)};
    default:
      return {{"vertex_indices", whole, true, {"uchar", Type::uint8}}};
  }
}

std::vector<Table> usual_tables(const Mesh& mesh) {
  constexpr std::array<std::pair<Role, std::string_view>, 3> kCellElements{
      {{Role::faces, "face"}, {Role::edges, "edge"}, {Role::tetrahedra, "tetra"}}};
  std::vector<Table> tables;
  Table& vertices = tables.emplace_back();
  vertices.element = {"vertex", mesh.vertex_count(), usual_properties(Role::vertices), Role::vertices, ""};
  vertices.items.resize(mesh.points.size());
  std::iota(vertices.items.begin(), vertices.items.end(), 0);
  for (const auto& [role, name] : kCellElements) {
    Table table;
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      if (usual_role(mesh.cells.shapes[c]) == role) table.items.push_back(c);
    }
    if (table.items.empty()) continue;
    table.element = {std::string(name), index_size(table.items), usual_properties(role), role, ""};
    tables.push_back(std::move(table));
  }
  return tables;
}

// ---- which properties

/// Collects the columns of one table and the arrays that they use.
class Columns {
 public:
  Columns(const Mesh& mesh, Table& table, std::set<const DataArray*>& written, Notes& notes)
      : mesh_(mesh),
        table_(table),
        written_(written),
        notes_(notes),
        on_(table.element.role == Role::vertices ? Association::vertices : Association::cells),
        is_item_(item_count(mesh, on_), false) {
    for (const Index item : table.items) is_item_[item] = true;
  }

  void collect() {
    for (const DataArray& array : mesh_.data) arrays_.emplace(array.name, &array);
    for (const Property& property : table_.element.properties) {
      if (property.why_left_out.empty()) add_known(property);
    }
    if (table_.element.role == Role::rows_of_faces) return;
    for (const SurfaceVector* vector : {&kNormal, &kColor, &kTexture}) add_vector(*vector);
    for (const DataArray& array : mesh_.data) {
      const bool is_other = array.association == on_ && !is_used(array) && !is_of_rows(array);
      if (is_other && rows_inside(array) > 0) add_other(array);
    }
  }

 private:
  /// Counts the rows of the array that belong to items of this table.
  [[nodiscard]] Index rows_inside(const DataArray& array) const {
    if (array.is_dense()) return index_size(table_.items);
    return static_cast<Index>(
        std::count_if(array.indices.begin(), array.indices.end(), [&](Index row) { return is_item_[row]; }));
  }

  /// Returns whether the array belongs to an element whose rows go with the faces.
  [[nodiscard]] bool is_of_rows(const DataArray& array) const {
    const auto* metadata = dynamic_cast<const ply::PlyMetadata*>(mesh_.format_metadata.get());
    return metadata != nullptr &&
           std::any_of(metadata->elements.begin(), metadata->elements.end(), [&](const Element& element) {
             return element.role == Role::rows_of_faces && array.name.starts_with(element.name + ".");
           });
  }

  [[nodiscard]] bool is_used(const DataArray& array) const { return used_.contains(&array); }

  void use(const DataArray& array) {
    used_.insert(&array);
    written_.insert(&array);
  }

  [[nodiscard]] bool is_taken(const std::string& name) const { return names_.contains(name); }

  void add_column(Column column) {
    names_.insert(column.property.name);
    table_.columns.push_back(std::move(column));
  }

  [[nodiscard]] bool is_geometry(const Property& property) const {
    switch (table_.element.role) {
      case Role::vertices:
        return ply::coordinate_of(property) >= 0;
      case Role::edges:
        return ply::end_of(property) >= 0;
      case Role::rows_of_faces:
        return false;
      default:
        return ply::is_corner_list(property);
    }
  }

  /// Adds a property that the file had, with the arrays of its name.
  void add_known(const Property& property) {
    Column column{property, {}};
    if (property.numbers_rows) return add_column(std::move(column));
    if (is_geometry(property)) return add_column(widened(std::move(column)));
    const auto [first, last] = arrays_.equal_range(ply::array_name(table_.element, property));
    for (auto found = first; found != last; ++found) {
      const DataArray& array = *found->second;
      const bool fits = array.association == on_ && rows_inside(array) > 0 &&
                        word_of(array.values).type == property.type.type && array.values.index() < 8 &&
                        (property.is_list || covers_table(array));
      if (!fits || (!property.is_list && !column.sources.empty())) continue;
      column.sources.push_back(source_of(mesh_, array, 0));
      use(array);
    }
    // only a list can be empty everywhere; other properties without an array were removed
    if (property.is_list || !column.sources.empty() || table_.items.empty()) {
      add_column(std::move(column));
    }
  }

  [[nodiscard]] bool covers_table(const DataArray& array) const {
    return array.components == 1 && rows_inside(array) == index_size(table_.items);
  }

  /// Widens the types in the list of a cell's vertices if they cannot hold every vertex or list length.
  [[nodiscard]] Column widened(Column column) const {
    if (table_.element.role == Role::vertices) return column;
    const auto holds = [&](const TypeWord& type, std::int64_t number) {
      return ply::with_type(type.type, [&]<class T>(T) {
        return number <= static_cast<std::int64_t>(std::numeric_limits<T>::max());
      });
    };
    const TypeWord whole{"int", Type::int32};
    if (!holds(column.property.type, mesh_.vertex_count() - 1)) column.property.type = whole;
    if (!column.property.is_list) return column;
    for (const Index cell : table_.items) {
      if (!holds(column.property.count_type, mesh_.cells.vertex_count(cell)))
        column.property.count_type = whole;
    }
    return column;
  }

  /// Adds a normal, colour or texture coordinates: one property for each component, with the usual names.
  void add_vector(const SurfaceVector& vector) {
    const GatheredVector gathered = gather(mesh_, vector, on_);
    if (gathered.from.size() != 1 || is_used(*gathered.from[0]) || table_.items.empty()) return;
    const DataArray& array = *gathered.from[0];
    for (const std::string_view component : vector.components) {
      if (is_taken(std::string(component))) return;
    }
    TypeWord type = written_type(array.values);
    // colours in whole numbers from 0 to 255 are usually bytes
    const bool bytes = &vector == &kColor && gathered.integers &&
                       std::all_of(gathered.values.begin(), gathered.values.end(),
                                   [](double x) { return x >= 0 && x <= 255; });
    if (bytes) type = {"uchar", Type::uint8};
    for (Index k = 0; k < array.components; ++k) {
      add_column({scalar(std::string(vector.components[k]), type), {source_of(mesh_, array, k)}});
    }
    use(array);
  }

  /// Adds any other array as a property of its name, a list if the array has several components or gaps.
  void add_other(const DataArray& array) {
    if (std::holds_alternative<std::vector<std::string>>(array.values)) return;
    const std::string name = plain_name(array.name.empty() ? "unnamed" : array.name, " ");
    const Property as_scalar = scalar(name, {});
    const bool reserved = is_geometry(as_scalar) || ply::is_corner_list({name, {}, true, {}});
    if (reserved || is_taken(name)) return;
    if (name != array.name) note(fmt::format("the array '{}' is written as '{}'", array.name, name));
    Property property = scalar(name, written_type(array.values));
    property.is_list = !covers_table(array);
    if (property.is_list && ply::is_integer(property.type.type) && property.type.type != Type::uint8 &&
        property.type.type != Type::int8) {
      property.type = {"double", Type::float64};  // lists of whole numbers are taken for indices
      note(fmt::format("the array '{}' is written as real numbers", array.name));
    }
    if (property.type.type == Type::float64 && !are_exact<double>(array.values)) {
      note(fmt::format("the array '{}' loses digits: PLY has no whole numbers of 64 bits", array.name));
    }
    property.count_type =
        array.components <= 255 ? TypeWord{"uchar", Type::uint8} : TypeWord{"int", Type::int32};
    add_column({property, {source_of(mesh_, array, 0)}});
    use(array);
  }

  /// Adds a note once, even if it concerns several elements.
  void note(const std::string& text) {
    if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
  }

  const Mesh& mesh_;
  Table& table_;
  std::set<const DataArray*>& written_;
  Notes& notes_;
  Association on_;
  std::vector<bool> is_item_;
  std::multimap<std::string_view, const DataArray*> arrays_;  // arrays of the mesh, by name
  std::set<const DataArray*> used_;
  std::set<std::string> names_;  // names of the columns
};

// ---- writing

void write_property(OutputFile& out, const Property& property) {
  out.print("property ");
  if (property.is_list) out.print("list {} ", property.count_type.word);
  out.print("{} {}\n", property.type.word, property.name);
}

void write_header(OutputFile& out, Encoding encoding, const ply::PlyMetadata* metadata,
                  const std::vector<Table>& tables) {
  constexpr std::array<std::string_view, 3> kNames{"ascii", "binary_little_endian", "binary_big_endian"};
  out.print("ply\nformat {} 1.0\n", kNames[static_cast<std::size_t>(encoding)]);
  if (metadata) {
    for (const std::string& comment : metadata->comments) out.print("{}\n", comment);
  }
  for (const Table& table : tables) {
    out.print("element {} {}\n", table.element.name, table.element.count);
    if (table.element.role == Role::other) {
      for (const Property& property : table.element.properties) write_property(out, property);
    }
    for (const Column& column : table.columns) write_property(out, column.property);
  }
  out.write("end_header\n");
}

/// Writes the body's numbers in the encoding; blanks separate the numbers of a text line.
class NumberWriter {
 public:
  NumberWriter(Text& out, Encoding encoding) : out_(out), encoding_(encoding) {}

  template <class T>
  void number(Type type, T value) {
    ply::with_type(type, [&](auto zero) { put(static_cast<decltype(zero)>(value)); });
  }

  /// Writes a coordinate; text keeps all digits, whatever the type.
  void coordinate(Type type, double value) {
    if (encoding_ == Encoding::ascii) return put(value);
    if (type == Type::float32) rounded_ = rounded_ || static_cast<double>(static_cast<float>(value)) != value;
    number(type, value);
  }

  void end_line() {
    if (encoding_ == Encoding::ascii) out_.write("\n");
    at_start_ = true;
  }

  [[nodiscard]] bool rounded() const { return rounded_; }

 private:
  template <class T>
  void put(T value) {
    if (encoding_ == Encoding::ascii) {
      const std::string_view before = at_start_ ? "" : " ";
      at_start_ = false;
      out_.number(before, value);
    } else {
      out_.binary(value, encoding_ == Encoding::big_endian ? std::endian::big : std::endian::little);
    }
  }

  Text& out_;
  Encoding encoding_;
  bool at_start_ = true;
  bool rounded_ = false;
};

/// Writes `count` numbers of the array from entry `first` on.
void write_values(NumberWriter& to, Type type, const DataArray& array, Offset first, Index count) {
  with_numbers(array.values, [&](const auto& values) {
    for (Index k = 0; k < count; ++k) to.number(type, values[first + k]);
  });
}

void write_attached(NumberWriter& to, const Column& column, Index item) {
  const Property& property = column.property;
  for (const ArraySource& source : column.sources) {
    const Index row = row_in(source, item);
    if (row < 0) continue;
    const Offset first = static_cast<Offset>(row) * source.array->components;
    if (!property.is_list) {
      return write_values(to, property.type.type, *source.array, first + source.component, 1);
    }
    to.number(property.count_type.type, source.array->components);
    return write_values(to, property.type.type, *source.array, first, source.array->components);
  }
  to.number(property.count_type.type, 0);  // an empty list
}

void write_corners(NumberWriter& to, const Property& property, std::span<const Index> corners) {
  to.number(property.count_type.type, index_size(corners));
  for (const Index v : corners) to.number(property.type.type, v);
}

void write_item(NumberWriter& to, const Mesh& mesh, const Table& table, Index item) {
  for (const Column& column : table.columns) {
    const Property& property = column.property;
    const Role role = table.element.role;
    if (role == Role::vertices && ply::coordinate_of(property) >= 0) {
      to.coordinate(property.type.type, mesh.points[item][ply::coordinate_of(property)]);
    } else if (role == Role::edges && ply::end_of(property) >= 0) {
      to.number(property.type.type, mesh.cells[item][ply::end_of(property)]);
    } else if (ply::holds_cells(table.element) && role != Role::edges && ply::is_corner_list(property)) {
      write_corners(to, property, mesh.cells[item]);
    } else if (property.numbers_rows) {
      to.number(property.type.type, item - table.items.front());
    } else {
      write_attached(to, column, item);
    }
  }
  to.end_line();
}

/// Returns whether PLY holds a cell. Other readers expect only faces; a mesh from PLY keeps all its cells.
bool ply_holds(const Mesh& mesh, Shape shape, int vertices) {
  if (shape == Shape::polygon) return vertices >= 3;
  if (vertices != corners(shape, 0)) return false;
  return dimension(shape) == 2 ||
         (mesh.format == "ply" && (dimension(shape) < 2 || shape == Shape::tetrahedron));
}

/// Notes the elements and properties that are not written, and why.
void note_left_out(const ply::PlyMetadata& metadata, Notes& notes) {
  for (const Element& element : metadata.elements) {
    if (!element.why_left_out.empty())
      notes.push_back(fmt::format("not written: the element '{}': {}", element.name, element.why_left_out));
    for (const Property& property : element.properties) {
      if (property.why_left_out.empty()) continue;
      notes.push_back(fmt::format("not written: the property '{}' of the element {}, which {}", property.name,
                                  element.name, property.why_left_out));
    }
  }
}

void note_losses(const Mesh& mesh, const std::set<const DataArray*>& written, Notes& notes) {
  for (const DataArray& array : mesh.data) {
    if (!written.contains(&array)) note_array_unsupported(array, "PLY", notes);
  }
  for (const EntitySet& set : mesh.sets) note_set_unsupported(set, "PLY", notes);
  note_ids_unsupported(mesh, "PLY", notes);
}

void write_ply(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const auto* metadata = dynamic_cast<const ply::PlyMetadata*>(mesh.format_metadata.get());
  const bool as_file = metadata && elements_fit(*metadata, mesh);
  std::vector<Table> tables = as_file ? tables_of_file(*metadata) : usual_tables(mesh);
  std::set<const DataArray*> written;
  for (Table& table : tables) {
    if (table.element.role != Role::other) Columns(mesh, table, written, notes).collect();
  }

  const Encoding encoding = metadata ? metadata->encoding : Encoding::little_endian;
  OutputFile out(path);
  write_header(out, encoding, metadata, tables);
  std::atomic<bool> rounded = false;
  for (const Table& table : tables) {
    if (table.element.role == Role::other) out.write(table.element.content);
    write_row_ranges(out, index_size(table.items), [&](Text& text, Index begin, Index end) {
      NumberWriter to(text, encoding);
      for (Index i = begin; i < end; ++i) write_item(to, mesh, table, table.items[i]);
      if (to.rounded()) rounded = true;
    });
  }
  out.commit();
  if (rounded) notes.emplace_back("coordinates are rounded to 32 bits, as the file has them");
  note_losses(mesh, written, notes);
  if (as_file) {
    note_left_out(*metadata, notes);
  } else {
    note_metadata_unsupported(mesh, "PLY", notes);
  }
}

}  // namespace

Format ply_format() { return {"PLY", {".ply"}, false, ply::read, write_ply, ply_holds}; }

}  // namespace meshorder
