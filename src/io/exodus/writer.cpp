// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/exact_values.hpp"
#include "io/exodus/exodus.hpp"
#include "io/exodus/library.hpp"
#include "io/exodus/writing.hpp"
#include "io/names.hpp"
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

// Writes a file: points, numbers, maps and the netCDF variables that are kept as they are. Other source files
// write blocks, sets and series.

namespace meshorder::exodus {
namespace {

constexpr std::size_t kLongestName = 255;

/// Returns a name without control characters and without blanks at its ends, cut to `kLongestName` bytes.
std::string held_name(const std::string& name) {
  return std::string(utf8_prefix(trimmed(plain_name(name)), kLongestName));
}

}  // namespace

const DataArray* Planning::take(std::string_view name, Association association) {
  const DataArray* const array = name.empty() ? nullptr : find_array(mesh, name, association);
  if (array == nullptr || are_texts(array->values)) return nullptr;
  placed.insert(array);
  return array;
}

const DataArray* Planning::take_column(std::string_view name, Association association) {
  const DataArray* const array = name.empty() ? nullptr : find_array(mesh, name, association);
  return array != nullptr && array->components == 1 ? take(name, association) : nullptr;
}

NcSink Writing::declare(const std::string& variable, NcType type, const std::vector<std::string>& dimensions,
                        std::vector<Attribute> attributes) {
  const auto kept = metadata.variable_attributes.find(variable);
  if (kept != metadata.variable_attributes.end())
    attributes.insert(attributes.end(), kept->second.begin(), kept->second.end());
  return file.variable(variable, type, dimensions, attributes);
}

void Writing::write_names(const std::string& variable, const std::string& count,
                          const std::vector<std::string>& names) {
  const NcSink sink = declare(variable, kChar, {count, "len_name"});
  const std::size_t length = metadata.name_length;
  std::string table(names.size() * length, '\0');
  for (std::size_t i = 0; i < names.size(); ++i)
    held_name(names[i]).copy(table.data() + i * length, length - 1);
  file.later([sink, table, rows = names.size(), length] { sink.bytes({rows, length}, table); });
}

void Writing::write_integers(const std::string& variable, const std::string& dimension,
                             std::vector<std::int64_t> values, const std::vector<Attribute>& attributes,
                             NcType type) {
  const bool is_narrow = type != kInt64 && fit_32_bits(values);
  const NcSink sink = declare(variable, is_narrow ? kInt : kInt64, {dimension}, attributes);
  file.later([sink, values = std::move(values)] { sink.list(values); });
}

void write_columns(Writing& writing, const std::string& variable, NcType type,
                   const std::vector<std::string>& dimensions, const Columns& columns, Index first,
                   Index count) {
  const std::size_t width = columns.size();
  writing.file.dimension({dimensions.back(), width});
  const NcSink sink = writing.declare(variable, type, dimensions);
  writing.file.later([sink, columns, first, count, width, &mesh = writing.mesh] {
    std::vector<double> table(static_cast<std::size_t>(count) * width);
    for (std::size_t k = 0; k < width; ++k) {
      const DataArray& array = *columns[k].array;
      const std::vector<double> values =
          column(array, 0, rows_by_item(array, item_count(mesh, array.association)), first, count, 0.0);
      for (std::size_t i = 0; i < values.size(); ++i) table[i * width + k] = values[i];
    }
    sink.part({0, 0}, {static_cast<std::size_t>(count), width}, table);
  });
}

NcType written_type(NcType of_file, const Values& values) {
  return can_hold(of_file, values) ? of_file : kDouble;
}

bool are_whole(const Values& values) {
  constexpr double kMost = 4503599627370496;  // 2^52
  return are_integers(values) || with_numbers(values, [](const auto& all) {
           return std::all_of(all.begin(), all.end(), [](double value) {
             return value == std::trunc(value) && std::abs(value) <= kMost;
           });
         });
}

std::vector<std::int64_t> whole_values(const Values& values) {
  return with_numbers(values,
                      [](const auto& all) { return std::vector<std::int64_t>(all.begin(), all.end()); });
}

namespace {

Attribute integer_attribute(std::string name, std::int32_t value) {
  return number_attribute(std::move(name), kInt, value);
}

/// Returns whether a file needs CDF-5: for 64-bit numbers of vertices or cells, or for variables of 4 GiB.
bool is_large(const Mesh& mesh) {
  constexpr std::size_t kMostBytes = 0xFFFFFFF0U;
  return mesh.cells.vertices.size() > kMostBytes / sizeof(std::int32_t) ||
         mesh.points.size() > kMostBytes / sizeof(double) || !fit_32_bits(mesh.vertex_ids) ||
         !fit_32_bits(mesh.cell_ids);
}

/// Returns the metadata of a new file, for a mesh of another format.
ExodusMetadata new_metadata(const Mesh& mesh) {
  constexpr float kVersion = 7.14F;
  ExodusMetadata result;
  result.storage = plain_storage(is_large(mesh));
  result.coordinates = mesh.dimension;
  result.attributes = {
      number_attribute("api_version", kFloat, kVersion), number_attribute("version", kFloat, kVersion),
      integer_attribute("floating_point_word_size", 8),  integer_attribute("file_size", 1),
      integer_attribute("maximum_name_length", 32),      integer_attribute("int64_status", 0),
      text_attribute("title", "written by meshorder")};
  constexpr std::size_t kLength = 33;
  std::string names(static_cast<std::size_t>(mesh.dimension) * kLength, '\0');
  for (std::size_t k = 0; k < static_cast<std::size_t>(mesh.dimension); ++k) names[k * kLength] = "xyz"[k];
  result.plain.push_back({"coor_names",
                          kChar,
                          {{"num_dim", static_cast<std::size_t>(mesh.dimension)}, {"len_string", kLength}},
                          {},
                          std::move(names)});
  return result;
}

void write_points(Writing& writing, int dimension) {
  const Mesh& mesh = writing.mesh;
  NcOutput& file = writing.file;
  if (mesh.points.empty()) return;
  const bool are_floats = writing.metadata.coordinate_type == kFloat && are_float_points(mesh.points);
  const NcType type = are_floats ? kFloat : kDouble;
  std::optional<NcSink> together;
  if (writing.metadata.packs_coordinates)
    together.emplace(writing.declare("coord", type, {"num_dim", "num_nodes"}));
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    const NcSink sink =
        together ? *together : writing.declare(std::string("coord") + "xyz" [k], type, { "num_nodes" });
    file.later([sink, k, &mesh, packed = together.has_value()] {
      in_parts(mesh.vertex_count(), [&](Index first, Index rows) {
        std::vector<double> values(static_cast<std::size_t>(rows));
        for (Index v = 0; v < rows; ++v) values[v] = mesh.points[first + v][k];
        const auto start = static_cast<std::size_t>(first);
        sink.part(packed ? std::vector{k, start} : std::vector{start},
                  packed ? std::vector{std::size_t{1}, values.size()} : std::vector{values.size()}, values);
      });
    });
  }
}

void write_numbers(Writing& writing, const char* variable, const char* dimension,
                   const std::vector<std::int64_t>& ids, std::size_t count, bool is_wanted) {
  if (count == 0 || (ids.empty() && !is_wanted)) return;
  std::vector<std::int64_t> numbers = ids;
  for (std::size_t i = 0; numbers.size() < count; ++i) numbers.push_back(static_cast<std::int64_t>(i) + 1);
  writing.write_integers(variable, dimension, std::move(numbers));
}

/// A named map as it is written.
struct MapPlan {
  std::int64_t id;
  std::string name;
  NcType type;
  const DataArray* array;
};

/// Returns whether a named map can hold an array: a whole number for each vertex or cell.
bool fits_map(const DataArray& array) {
  return array.is_dense() && array.components == 1 && are_whole(array.values);
}

/// Returns the maps of the file that the mesh came from, then the arrays "map NAME" and `kOriginal`.
std::vector<MapPlan> plan_maps(Writing& writing, Association association) {
  const bool on_vertices = association == Association::vertices;
  std::vector<MapPlan> plans;
  std::int64_t last = 0;
  for (const MapRecord& record : on_vertices ? writing.metadata.node_maps : writing.metadata.element_maps) {
    const DataArray* const array = find_array(writing.mesh, record.array, association);
    if (array == nullptr || !fits_map(*array)) continue;
    writing.placed.insert(array);
    plans.push_back({record.id, record.name, record.type, array});
    last = std::max(last, record.id);
  }
  for (const DataArray& array : writing.mesh.data) {
    const bool is_map = array.association == association &&
                        (array.name.starts_with(kMap) || array.name == kOriginal) && fits_map(array);
    if (!is_map || !writing.placed.insert(&array).second) continue;
    const std::size_t prefix = array.name == kOriginal ? 0 : kMap.size();
    plans.push_back({++last, array.name.substr(prefix), kInt, &array});
  }
  return plans;
}

void write_maps(Writing& writing, const std::string& of, const std::string& prefix,
                const std::string& dimension, const std::vector<MapPlan>& maps) {
  if (maps.empty()) return;
  const std::string count = "num_" + of + "_maps";
  writing.file.dimension({count, maps.size()});
  std::vector<std::int64_t> ids;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    ids.push_back(maps[m].id);
    if (row_count(*maps[m].array) == 0) continue;
    writing.write_integers(fmt::format("{}_map{}", of, m + 1), dimension, whole_values(maps[m].array->values),
                           {}, maps[m].type);
  }
  writing.write_integers(prefix + "_prop1", count, ids, {text_attribute("name", "ID")});
  writing.write_names(prefix + "ap_names", count, names_of(maps));
}

/// Returns whether nodal attributes can hold an array: a number for each vertex.
bool fits_nodal_attribute(const DataArray& array) {
  return array.is_dense() && array.components == 1 && !are_texts(array.values);
}

Columns plan_nodal_attributes(Writing& writing) {
  Columns columns;
  for (const auto& [name, of_mesh] : writing.metadata.nodal_attributes) {
    const DataArray* const array = find_array(writing.mesh, of_mesh, Association::vertices);
    if (array == nullptr || !fits_nodal_attribute(*array)) continue;
    writing.placed.insert(array);
    columns.push_back({name, array});
  }
  for (const DataArray& array : writing.mesh.data) {
    const bool is_attribute = array.association == Association::vertices &&
                              array.name.starts_with(kAttribute) && fits_nodal_attribute(array);
    if (!is_attribute || !writing.placed.insert(&array).second) continue;
    columns.push_back({array.name.substr(kAttribute.size()), &array});
  }
  return columns;
}

void write_nodal_attributes(Writing& writing, const Columns& columns) {
  if (columns.empty() || writing.mesh.points.empty()) return;
  const std::string count = "num_att_in_nblk";
  write_columns(writing, "nattrb", kDouble, {"num_nodes", count}, columns, 0, writing.mesh.vertex_count());
  writing.write_names("nattrib_name", count, names_of(columns));
}

/// Returns a table of names with its rows lengthened to `length` bytes.
PlainVariable with_name_length(PlainVariable table, std::size_t length) {
  const std::size_t old = table.dimensions.back().length;
  if (table.type != kChar || old == 0 || length < old) return table;
  std::string rows;
  for (std::size_t at = 0; at < table.bytes.size(); at += old) {
    rows += table.bytes.substr(at, old);
    rows.append(length - old, '\0');
  }
  table.bytes = std::move(rows);
  table.dimensions.back().length = length;
  return table;
}

/// Writes the variables and dimensions that are kept as they are, and `time_whole`. New steps get zeros.
void write_plain(Writing& writing) {
  NcOutput& file = writing.file;
  for (const PlainVariable& of_file : writing.metadata.plain) {
    if (file.has_variable(of_file.name)) continue;
    const bool has_names = !of_file.dimensions.empty() && of_file.dimensions.back().name == "len_name";
    const PlainVariable variable =
        has_names ? with_name_length(of_file, writing.metadata.name_length) : of_file;
    std::vector<std::string> dimensions;
    std::vector<std::size_t> counts;
    bool fits = true;
    std::size_t bytes = size_of(variable.type);
    for (const Dimension& dimension : variable.dimensions) {
      fits = fits && file.dimension(dimension);
      dimensions.push_back(dimension.name);
      counts.push_back(dimension.name == "time_step" ? writing.steps : dimension.length);
      bytes *= counts.back();
    }
    if (!fits) {
      writing.notes.push_back(
          fmt::format("the variable {} is left out: its dimensions have other lengths now", variable.name));
      continue;
    }
    const NcSink sink = file.variable(variable.name, variable.type, dimensions, variable.attributes);
    std::string values = variable.bytes;
    values.resize(bytes, '\0');
    file.later([sink, counts, values = std::move(values)] { sink.bytes(counts, values); });
  }
  for (const Dimension& dimension : writing.metadata.dimensions) (void)file.dimension(dimension);
  if (writing.steps > 0 && !file.has_variable("time_whole")) {
    const NcSink sink = file.variable("time_whole", kDouble, {"time_step"});
    file.later([sink, steps = writing.steps] { sink.list(std::vector<double>(steps, 0)); });
  }
}

/// Returns the length of the longest name, at most `kLongestName`. Adds a note for each name that changes.
std::size_t longest_of(const Writing& writing, const std::vector<std::string>& names) {
  std::size_t longest = 0;
  for (const std::string& name : names) {
    longest = std::max(longest, std::min(name.size(), kLongestName));
    if (const std::string held = held_name(name); held != name)
      writing.notes.push_back(fmt::format("the name '{}' is written as '{}'", name, held));
  }
  return longest;
}

/// Writes the attributes of the file. Raises maximum_name_length to the longest name.
void write_attributes_of_file(Writing& writing, std::size_t longest) {
  for (Attribute attribute : writing.metadata.attributes) {
    if (attribute.name == "maximum_name_length" && attribute.type == kInt && attribute.count == 1) {
      std::int32_t length = 0;
      std::memcpy(&length, attribute.bytes.data(), sizeof(length));
      attribute = integer_attribute(attribute.name, std::max(length, static_cast<std::int32_t>(longest)));
    }
    writing.file.attribute(attribute);
  }
}

}  // namespace

std::vector<std::string> ExodusMetadata::contents() const {
  std::vector<std::string> result;
  const auto count = [&](std::size_t number, std::string_view one, std::string_view many) {
    if (number > 0) result.push_back(fmt::format("{} {}", number, number == 1 ? one : many));
  };
  for (const PlainVariable& variable : plain) {
    const std::size_t rows = variable.dimensions.empty() ? 1 : variable.dimensions.front().length;
    if (variable.name == "qa_records") {
      count(rows, "QA record", "QA records");
    } else if (variable.name == "info_records") {
      count(rows, "info record", "info records");
    } else if (variable.name == "time_whole") {
      if (rows > 1) result.push_back(fmt::format("the times of {} steps", rows));
    } else if (variable.name == "name_glo_var") {
      count(rows, "global variable", "global variables");
    } else if (variable.name != "coor_names" && variable.name != "vals_glo_var") {
      result.push_back("the variable " + variable.name);
    }
  }
  count(block_properties.size(), "property of blocks", "properties of blocks");
  for (std::size_t kind = 0; kind < sets.size(); ++kind) {
    if (sets[kind].properties.empty()) continue;
    result.push_back(fmt::format("{} properties of {}s", sets[kind].properties.size(),
                                 kSetKinds[kind].word.substr(0, kSetKinds[kind].word.size() - 1)));
  }
  return result;
}

namespace {

/// Writes a mesh to a path, on disk or in a store, or to a file that the caller then moves to its path.
template <class Target>
void write_to(const Target& target, const Mesh& mesh, Notes& notes) {
  const ExodusMetadata* const own = own_metadata(mesh);
  ExodusMetadata metadata = own != nullptr ? *own : new_metadata(mesh);
  NcOutput file(target, metadata.storage);
  Writing writing(mesh, metadata, file, notes);

  // plan the outputs for each part of the mesh
  plan_blocks(writing, own != nullptr);
  const std::vector<const EntitySet*> element_sets = name_blocks(writing);
  std::vector<Columns> attributes;
  for (const BlockPlan& block : writing.blocks) attributes.push_back(attributes_of(writing, block));
  const std::vector<MapPlan> node_maps = plan_maps(writing, Association::vertices);
  const std::vector<MapPlan> element_maps = plan_maps(writing, Association::cells);
  const Columns nodal_attributes = plan_nodal_attributes(writing);
  const auto sets = plan_sets(writing, element_sets);
  const std::vector<SeriesPlan> nodal = plan_series(writing, Association::vertices);
  const std::vector<SeriesPlan> elemental = plan_series(writing, Association::cells);
  const auto has_values = [](const SeriesPlan& series) { return !series.arrays.empty(); };
  const bool needs_step = std::any_of(nodal.begin(), nodal.end(), has_values) ||
                          std::any_of(elemental.begin(), elemental.end(), has_values);
  writing.steps = std::max<std::size_t>(metadata.steps, needs_step ? 1 : 0);

  std::vector<std::string> names = names_of(writing.blocks);
  for (const Columns& columns : attributes) add_names(columns, names);
  add_names(nodal_attributes, names);
  for (std::size_t kind = 0; kind < sets.size(); ++kind) {
    if (sets[kind].empty()) continue;
    add_names(sets[kind], names);
    const std::vector<std::string>& variables = metadata.sets[kind].variables;
    names.insert(names.end(), variables.begin(), variables.end());
  }
  for (const auto* maps : {&node_maps, &element_maps}) add_names(*maps, names);
  for (const auto* series : {&nodal, &elemental}) add_names(*series, names);
  const std::size_t longest = longest_of(writing, names);
  metadata.name_length = std::max(metadata.name_length, longest + 1);  // with a zero byte

  // declare the dimensions and variables
  const int dimension = coordinates_of(mesh.points, metadata.coordinates);
  write_attributes_of_file(writing, longest);
  file.dimension({"time_step", writing.steps, metadata.steps_unlimited || writing.steps == 0});
  file.dimension({"len_name", metadata.name_length});
  file.dimension({"num_dim", static_cast<std::size_t>(dimension)});
  // netCDF reads a length of 0 as unlimited
  if (!mesh.points.empty()) file.dimension({"num_nodes", mesh.points.size()});
  if (!mesh.cells.shapes.empty()) file.dimension({"num_elem", mesh.cells.shapes.size()});
  file.dimension({"num_el_blk", writing.blocks.size()});
  write_points(writing, dimension);
  write_blocks(writing, attributes);
  write_numbers(writing, "node_num_map", "num_nodes", mesh.vertex_ids, mesh.points.size(),
                metadata.has_node_numbers);
  write_numbers(writing, "elem_num_map", "num_elem", mesh.cell_ids, mesh.cells.shapes.size(),
                metadata.has_element_numbers);
  write_maps(writing, "node", "nm", "num_nodes", node_maps);
  write_maps(writing, "elem", "em", "num_elem", element_maps);
  write_nodal_attributes(writing, nodal_attributes);
  write_sets(writing, sets);
  write_nodal(writing, nodal);
  write_elemental(writing, elemental);
  write_plain(writing);
  if (own == nullptr) note_metadata_unsupported(mesh, "Exodus", notes);
  file.finish();
}

bool holds(const Mesh& mesh, Shape shape, int vertices) {
  if (!type_of(shape, vertices).empty()) return true;
  const ExodusMetadata* const own = own_metadata(mesh);
  return own != nullptr && std::any_of(own->blocks.begin(), own->blocks.end(), [&](const BlockRecord& block) {
           return block.shape == shape && block.nodes == vertices;
         });
}

/// Returns why a piece of a decomposed mesh cannot be written (its maps would become wrong); else empty.
std::string conflict(const Mesh& mesh) {
  const ExodusMetadata* const own = own_metadata(mesh);
  if (own == nullptr || own->piece.empty()) return {};
  return "Exodus cannot hold " + own->piece +
         " in another order, as it is a piece of a decomposed mesh: order the whole mesh before it is "
         "decomposed";
}

}  // namespace

void write(const Mesh& mesh, const FilePath& path, Notes& notes) { write_to(path, mesh, notes); }

void write(const Mesh& mesh, const UnfinishedFile& to, Notes& notes) { write_to(to, mesh, notes); }

}  // namespace meshorder::exodus

namespace meshorder {

Format exodus_format() {
  return {.name = "Exodus",
          .extensions = {kExodusExtensions.begin(), kExodusExtensions.end()},
          .groups_cells_by_type = false,
          .read = exodus::read,
          .write = exodus::write,
          .holds = exodus::holds,
          .conflict = exodus::conflict,
          .places = exodus::places,
          .first_number = 1,
          .has_numbers = true,
          .library = "netCDF",
          .load_library = exodus::load_library};
}

}  // namespace meshorder
