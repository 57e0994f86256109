// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/memory.hpp"
#include "io/exact_values.hpp"
#include "io/gmsh/gmsh.hpp"
#include "io/names.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

// Data of nodes and elements: the sections $NodeData, $ElementData and $ElementNodeData.

namespace meshorder::gmsh {
namespace {

constexpr std::int64_t kMostComponents = 1 << 20;
constexpr double kExact = 9007199254740992.0;  // 2^53: whole numbers up to here are exact as double

/// Returns a text without the quotes around it, if it has some.
std::string unquoted(std::string_view text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

/// Reads the tags of a view, up to its values.
View read_view_head(NumberReader& source, std::string_view section) {
  View view;
  view.section = section;
  view.association = section == "NodeData" ? Association::vertices : Association::cells;
  const auto count = [&](const std::string& what, std::int64_t bytes) {
    return source.checked_count(source.text_integer("the number of " + what), what, bytes);
  };
  const Index strings = count("string tags", 1);
  (void)source.scanner.raw_line();
  for (Index i = 0; i < strings; ++i) view.strings.emplace_back(source.scanner.rest_of_line());
  view.array = view.strings.empty() ? std::string(section) : unquoted(view.strings.front());
  view.reals.resize(count("real tags", 2));
  for (double& value : view.reals) value = source.text_real("a real tag");
  view.integers.resize(count("integer tags", 2));
  if (view.integers.size() < 3) {
    source.fail(fmt::format("${} has {} integer tags", section, view.integers.size()),
                "step, components and number of entries are needed");
  }
  for (std::size_t i = 0; i < view.integers.size(); ++i) {
    const std::int64_t value = source.text_integer("an integer tag");
    if (i == 1 && (value < 1 || value > kMostComponents)) {
      source.fail(fmt::format("the number of components is {}", value), "1, 3 and 9 are usual");
    }
    if (!std::in_range<std::int32_t>(value)) {
      source.fail("an integer tag is " + std::to_string(value), "it is too large");
    }
    view.integers[i] = static_cast<std::int32_t>(value);
  }
  source.begin_binary();
  return view;
}

/// Returns the number of nodes in the entry of cell c by the rule `per`; `fixed`: the number by
/// PerElement::fixed.
int nodes_of_entry(const Mesh& mesh, Index c, PerElement per, int fixed) {
  const int vertices = mesh.cells.vertex_count(c);
  switch (per) {
    case PerElement::one:
      return 1;
    case PerElement::each_node:
      return vertices;
    case PerElement::each_corner:
      return corners(mesh.cells.shapes[c], vertices);
    case PerElement::fixed:
      break;
  }
  return fixed;
}

/// The entries of a section in the order of the file; entry i has nodes[i] × components values.
struct Entries {
  std::vector<Index> rows;  ///< vertex or cell of each entry
  std::vector<int> nodes;   ///< number of nodes of each entry; empty if each has one
  std::vector<double> values;
};

/// Finds the rule for the number of nodes of an entry and stores it in `view`; fails if no rule fits.
void find_rule(const ReadContext& reading, const Entries& entries, View& view) {
  if (entries.nodes.empty()) return;
  for (const PerElement per : {PerElement::each_node, PerElement::each_corner, PerElement::fixed}) {
    bool fits = true;
    for (std::size_t i = 0; i < entries.rows.size() && fits; ++i) {
      fits = entries.nodes[i] == nodes_of_entry(reading.mesh, entries.rows[i], per, entries.nodes.front());
    }
    if (!fits) continue;
    view.per = per;
    view.nodes = entries.nodes.front();
    return;
  }
  reading.source.fail("$ElementNodeData gives elements other numbers of nodes than they have",
                      "give values for all nodes or for the corners");
}

Entries read_entries(ReadContext& reading, const View& view) {
  NumberReader& source = reading.source;
  const bool per_node = view.section == "ElementNodeData";
  const std::int64_t components = view.integers[1];
  const std::int64_t fields = 1 + (per_node ? 1 : 0);
  const Index count = source.checked_count(view.integers[2], "the number of entries",
                                           source.binary ? 4 * fields + (per_node ? 0 : 8 * components)
                                                         : 2 * (fields + (per_node ? 0 : components)));
  const IdMap& places = view.association == Association::vertices ? reading.nodes : reading.elements;
  Entries entries;
  reserve_large(entries.rows, static_cast<std::size_t>(count));
  if (!per_node) reserve_large(entries.values, static_cast<std::size_t>(count * components));
  for (Index i = 0; i < count; ++i) {
    const std::int64_t id = source.binary ? source.int32("the number of an entry") : source.int64("an entry");
    const Index place = places.find(id);
    if (place < 0) {
      const bool of_nodes = view.association == Association::vertices;
      source.fail(fmt::format("${} names {} {}, which the file does not have", view.section,
                              of_nodes ? "node" : "element", id),
                  "give values only for existing nodes and elements");
    }
    entries.rows.push_back(place);
    std::int64_t nodes = 1;
    if (per_node) {
      nodes = source.checked_count(source.int32("the number of nodes of an entry"),
                                   "the number of nodes of an entry", (source.binary ? 8 : 2) * components);
      entries.nodes.push_back(static_cast<int>(nodes));
    }
    for (std::int64_t k = 0; k < nodes * components; ++k) entries.values.push_back(source.real("a value"));
  }
  return entries;
}

/// Returns the values of the entries as rows of one width, padded with 0; sets `width` to this width.
std::vector<double> even_rows(const ReadContext& reading, Entries& entries, const View& view, Index& width) {
  const int components = view.integers[1];
  int most = 1;
  int least = entries.nodes.empty() ? 1 : entries.nodes.front();
  for (const int nodes : entries.nodes) {
    most = std::max(most, nodes);
    least = std::min(least, nodes);
  }
  width = most * components;
  if (entries.nodes.empty() || most == least) return std::move(entries.values);
  const std::size_t total = entries.rows.size() * static_cast<std::size_t>(width);
  if (total > 1024 * entries.values.size() + 4096) {
    reading.source.fail("an entry of $" + view.section + " has " + std::to_string(most) + " nodes",
                        "the file may be damaged");
  }
  std::vector<double> values(total, 0.0);
  std::size_t from = 0;
  for (std::size_t i = 0; i < entries.rows.size(); ++i) {
    const std::size_t length = static_cast<std::size_t>(entries.nodes[i]) * components;
    std::copy_n(entries.values.begin() + static_cast<Offset>(from), length,
                values.begin() + static_cast<Offset>(i * width));
    from += length;
  }
  return values;
}

/// Converts labels, which data sections hold as real numbers, back to integers if they are whole.
void restore_labels(DataArray& array) {
  const auto* values = std::get_if<std::vector<double>>(&array.values);
  if (array.name != kLabel || array.components != 1 || !values) return;
  double greatest = 0;
  for (const double value : *values) {
    if (std::trunc(value) != value) return;  // also true for NaN
    greatest = std::max(greatest, std::abs(value));
  }
  if (greatest < 2147483648.0) {
    array.values = Values(std::vector<std::int32_t>(values->begin(), values->end()));
  } else if (greatest <= kExact) {
    array.values = Values(std::vector<std::int64_t>(values->begin(), values->end()));
  }
}

/// Returns the smallest number of components, at least `components`, that Gmsh allows; 0 if it allows no such
/// number.
Index gmsh_components(Index components) {
  for (const Index known : {1, 3, 9}) {
    if (components <= known) return known;
  }
  return 0;
}

/// Keeps the array names of a mesh distinct.
class ArrayNames {
 public:
  explicit ArrayNames(const Mesh& mesh) {
    for (const DataArray& array : mesh.data) ++uses_[{array.association, array.name}];
  }

  /// Gives an array the name `name` or, if another array has it, "NAME (2)", "NAME (3)" …
  void rename(DataArray& array, const std::string& name) {
    --uses_[{array.association, array.name}];
    array.name = name;
    int& last = last_numbers_[{array.association, name}];
    for (int k = std::max(last, 1) + 1; uses_[{array.association, array.name}] > 0; ++k) {
      array.name = fmt::format("{} ({})", name, k);
      last = k;
    }
    ++uses_[{array.association, array.name}];
  }

 private:
  using Name = std::pair<Association, std::string>;
  std::map<Name, int> uses_;
  std::map<Name, int> last_numbers_;
};

}  // namespace

void check_distinct(const NumberReader& source, std::vector<Index> rows, std::string_view section) {
  // most files give the rows in order
  const auto descends = [](Index row, Index next) { return row >= next; };
  if (std::adjacent_find(rows.begin(), rows.end(), descends) == rows.end()) return;
  std::sort(rows.begin(), rows.end());
  if (std::adjacent_find(rows.begin(), rows.end()) != rows.end()) {
    source.fail("$" + std::string(section) + " gives the same node or element twice",
                "each can have one value");
  }
}

void read_view(ReadContext& reading, std::string_view section) {
  View view = read_view_head(reading.source, section);
  Entries entries = read_entries(reading, view);
  check_distinct(reading.source, entries.rows, section);
  find_rule(reading, entries, view);
  DataArray array;
  array.name = *view.array;
  array.association = view.association;
  std::vector<double> values = even_rows(reading, entries, view, array.components);
  view.width = array.components;
  expect_end(reading, section);
  reading.metadata.sections.push_back({SectionKind::view, view.section, "", reading.metadata.views.size()});
  reading.view_arrays.push_back(reading.mesh.data.size());
  if (entries.rows.empty()) {  // an array without indices would have values everywhere
    view.array.reset();
  } else {
    array.indices = std::move(entries.rows);
    array.values = std::move(values);
    make_dense(array, item_count(reading.mesh, array.association));
    reading.mesh.data.push_back(std::move(array));
  }
  reading.metadata.views.push_back(std::move(view));
}

void name_views(ReadContext& reading) {
  auto& views = reading.metadata.views;
  std::map<std::pair<std::string, std::string>, int> steps;
  for (const View& view : views) {
    if (view.array) ++steps[{view.section, *view.array}];
  }
  ArrayNames names(reading.mesh);
  for (std::size_t i = 0; i < views.size(); ++i) {
    View& view = views[i];
    if (!view.array) continue;
    DataArray& array = reading.mesh.data[reading.view_arrays[i]];
    std::string name = *view.array;
    if (steps.at({view.section, name}) > 1) name += " step " + std::to_string(view.integers[0]);
    names.rename(array, name);
    restore_labels(array);
    view.array = array.name;
  }
}

std::string name_in_quotes(std::string_view name) {
  std::string result = plain_name(name);
  std::replace(result.begin(), result.end(), '"', '\'');
  return result;
}

namespace {

/// Returns whether a view can hold an array.
bool has_place(const DataArray& array) {
  return !are_texts(array.values) && gmsh_components(array.components) > 0;
}

/// Returns the number of components of a view for an array; `has_place(array)` must be true. Notes changes.
Index components_of_view(const DataArray& array, Notes& notes) {
  const Index components = gmsh_components(array.components);
  if (components != array.components) {
    notes.push_back("the array '" + array.name +
                    "' is filled up with zeros: Gmsh's data have 1, 3 or 9 components");
  }
  if (!are_exact<double>(array.values)) {
    notes.push_back("the array '" + array.name + "' loses digits: Gmsh's data are real numbers of 53 bits");
  }
  return components;
}

}  // namespace

void refit_views(GmshMetadata& layout, const NamedParts& parts, Notes& notes) {
  for (MshSection& section : layout.sections) {
    if (section.kind != SectionKind::view) continue;
    View& view = layout.views[section.view];
    const DataArray* const array = view.array ? parts.array(*view.array, view.association) : nullptr;
    if (array == nullptr || (array->components == view.width && !are_texts(array->values))) continue;
    if (!has_place(*array)) {
      view.array.reset();
      continue;
    }
    view.width = array->components;
    view.integers[1] = components_of_view(*array, notes);
    if (view.per == PerElement::one) continue;
    view.per = PerElement::one;
    view.section = section.name = "ElementData";
  }
}

void add_view(GmshMetadata& layout, const DataArray& array, Notes& notes) {
  if (!has_place(array)) return note_array_unsupported(array, "Gmsh", notes);
  const Index components = components_of_view(array, notes);
  View view;
  view.section = array.association == Association::vertices ? "NodeData" : "ElementData";
  view.association = array.association;
  view.array = array.name;
  const std::string name = name_in_quotes(array.name);
  note_renamed_array(array, name, notes);
  view.strings = {'"' + name + '"'};
  view.reals = {0.0};
  view.integers = {0, components, 0};
  layout.sections.push_back({SectionKind::view, view.section, "", layout.views.size()});
  layout.views.push_back(std::move(view));
}

void write_view(NumberWriter& sink, const WriteContext& output, const View& view) {
  const Mesh& mesh = output.mesh;
  const DataArray* array = view.array ? output.parts.array(*view.array, view.association) : nullptr;
  const Index rows = array ? row_count(*array) : 0;
  const Index components = view.integers[1];

  sink.out.print("{}\n", view.strings.size());
  for (const std::string& line : view.strings) sink.out.print("{}\n", line);
  sink.out.print("{}\n", view.reals.size());
  for (const double value : view.reals) sink.out.print("{}\n", value);
  sink.out.print("{}\n", view.integers.size());
  for (std::size_t i = 0; i < view.integers.size(); ++i) sink.text_line(i == 2 ? rows : view.integers[i]);
  if (!array) return;

  const auto width = static_cast<std::size_t>(array->components);
  with_numbers(array->values, [&](const auto& values) {
    write_rows(sink, rows, [&](RowWriter& to, Index row) {
      const Index place = array->is_dense() ? row : array->indices[row];
      const bool of_nodes = view.association == Association::vertices;
      to.int32(of_nodes ? output.node_id(place) : output.cell_id(place));
      int nodes = 1;
      if (view.per != PerElement::one) {
        nodes = nodes_of_entry(mesh, place, view.per, view.nodes);
        to.int32(nodes);
      }
      to.all<double>(static_cast<std::size_t>(nodes) * components, [&](std::size_t k) {
        return k < width ? static_cast<double>(values[row * width + k]) : 0.0;
      });
    });
  });
}

}  // namespace meshorder::gmsh
