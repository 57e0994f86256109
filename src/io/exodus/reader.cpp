// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "io/exodus/exodus.hpp"
#include "io/exodus/reading.hpp"
#include "io/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

// Reads a file: points, elements and their numbers, and the netCDF variables that are kept as they are.

namespace meshorder::exodus {

const Variable* Reading::take(const std::string& name) {
  const Variable* const variable = file.find(name);
  if (variable != nullptr) taken.insert(name);
  return variable;
}

std::vector<std::string> Reading::take_names(const std::string& name, std::size_t count) {
  const Variable* const variable = take(name);
  std::vector<std::string> names = variable == nullptr ? std::vector<std::string>() : file.texts(*variable);
  names.resize(count);
  return names;
}

void Reading::require_shape(const Variable& variable, const std::vector<std::size_t>& expected) const {
  const std::vector<std::size_t> shape = file.shape(variable);
  if (shape == expected) return;
  file.fail(fmt::format("{} has {} values, not {}", variable.name, fmt::join(shape, " × "),
                        fmt::join(expected, " × ")));
}

std::string Reading::add_array(DataArray array, MeshPart::ArrayRows rows) {
  part.arrays.push_back(std::move(rows));
  return add_named(part.mesh, std::move(array), arrays_);
}

std::string Reading::add_array(std::string name, Values values, const std::vector<std::size_t>& blocks) {
  DataArray array{.name = std::move(name), .association = Association::cells, .values = std::move(values)};
  std::size_t count = 0;
  for (const std::size_t b : blocks) count += size_of_block(b);
  const bool is_partial = count != static_cast<std::size_t>(elements);
  for (const std::size_t b : blocks) {
    const MeshRange own = own_of_block(b);
    for (Index c = own.first; is_partial && c < own.end; ++c)
      array.indices.push_back(c - part.ranges.cells.first);
  }
  return add_array(std::move(array), {is_partial});
}

std::string Reading::add_set(EntitySet set, MeshPart::SetRows rows) {
  part.sets.push_back(std::move(rows));
  return add_named(part.mesh, std::move(set), sets_);
}

const BlockRecord& Reading::block_of(Index cell) const {
  const auto behind = std::upper_bound(block_ends.begin(), block_ends.end(), cell);
  return metadata->blocks[static_cast<std::size_t>(behind - block_ends.begin()) - 1];
}

namespace {

/// Returns the smallest number that is given twice, if any.
std::optional<std::int64_t> given_twice(std::vector<std::int64_t> numbers) {
  std::sort(numbers.begin(), numbers.end());
  const auto twice = std::adjacent_find(numbers.begin(), numbers.end());
  return twice == numbers.end() ? std::nullopt : std::optional(*twice);
}

}  // namespace

std::vector<std::int64_t> read_ids(Reading& reading, const std::string& variable, std::size_t objects) {
  std::vector<std::int64_t> ids(objects);
  std::iota(ids.begin(), ids.end(), std::int64_t{1});
  const Variable* const found = reading.take(variable);
  if (found == nullptr) return ids;
  reading.require_shape(*found, {objects});
  std::vector<std::int64_t> given = reading.file.integers(*found);
  const std::optional<std::int64_t> twice = given_twice(given);
  if (!twice) return given;
  reading.notes.push_back(fmt::format("{} gives the id {} twice; the ids are now 1, 2, …", variable, *twice));
  return ids;
}

namespace {

Index checked_length(const NcInput& file, const std::string& dimension) {
  const std::size_t length = file.length(dimension);
  if (length > static_cast<std::size_t>(kMaxIndex))
    file.fail(fmt::format("{} is {}", dimension, length), "2,147,483,647 is the largest");
  return static_cast<Index>(length);
}

/// Throws InputError if a file has blocks or sets of edges or faces, which cannot be reordered.
void refuse_unknown_kinds(const NcInput& file) {
  constexpr std::array<std::pair<const char*, const char*>, 4> kKinds{{
      {"num_ed_blk", "blocks of edges"},
      {"num_fa_blk", "blocks of faces"},
      {"num_edge_sets", "sets of edges"},
      {"num_face_sets", "sets of faces"},
  }};
  for (const auto& [name, words] : kKinds) {
    if (const std::size_t length = file.length(name); length > 0)
      file.fail(fmt::format("has {} {}", length, words), "only blocks of elements are supported");
  }
}

template <std::size_t Size>
bool is_one_of(const std::string& name, const std::array<std::string_view, Size>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Leaves out the communication maps of a piece of a decomposed mesh (Nemesis): reordering would not update
/// the numbers in them.
void leave_out_decomposition(Reading& reading) {
  constexpr std::array<std::string_view, 9> kCommunication{"node_mapi",   "node_mapb",   "node_mape",
                                                           "elem_mapi",   "elem_mapb",   "n_comm_nids",
                                                           "n_comm_proc", "e_comm_eids", "e_comm_sids"};
  const auto& variables = reading.file.variables();
  if (std::none_of(variables.begin(), variables.end(),
                   [&](const Variable& variable) { return is_one_of(variable.name, kCommunication); })) {
    return;
  }
  reading.metadata->piece = reading.file.name();
  for (const Variable& variable : variables) {
    const std::string& name = variable.name;
    const bool is_known = name == "nem_ftype" || name.ends_with("_global") || name.ends_with("_n_stat") ||
                          name.ends_with("_e_stat") || name.find("_comm_") == 1 ||
                          is_one_of(name, kCommunication);
    if (is_known) reading.taken.insert(name);
  }
  reading.notes.emplace_back("is a piece of a decomposed mesh: its communication maps are left out");
}

/// Reads how many dimensions, nodes and elements a mesh has, and sets the ranges to read.
void read_counts(Reading& reading) {
  const NcInput& file = reading.file;
  reading.nodes = checked_length(file, "num_nodes");
  reading.elements = checked_length(file, "num_elem");
  const std::size_t dimension = file.length("num_dim");
  if (dimension < 1 || dimension > 3)
    file.fail(fmt::format("num_dim is {}", dimension), "1, 2 and 3 are possible");
  reading.metadata->coordinates = static_cast<int>(dimension);
  reading.part.mesh.dimension = dimension == 3 ? 3 : 2;
  reading.part.ranges = {{0, reading.nodes}, {0, reading.elements}};
  if (reading.is_whole()) return;
  const MeshRanges& wanted = *reading.ranges_wanted;
  if (wanted.vertices.end > reading.nodes || wanted.cells.end > reading.elements) {
    file.fail(fmt::format("has {} nodes and {} elements, fewer than where it was opened first", reading.nodes,
                          reading.elements),
              "all processes must see the same file, and no other process may write it");
  }
  reading.part.ranges = wanted;
}

void read_points(Reading& reading) {
  const NcInput& file = reading.file;
  constexpr std::array kNames{"coordx", "coordy", "coordz"};
  const auto nodes = static_cast<std::size_t>(reading.nodes);
  const auto dimension = static_cast<std::size_t>(reading.metadata->coordinates);
  const auto [first, count] = reading.rows(Association::vertices);
  const Variable* const all = reading.take("coord");
  reading.metadata->packs_coordinates = all != nullptr;
  if (all != nullptr) reading.require_shape(*all, {dimension, nodes});
  for (std::size_t k = 0; k < dimension && (all != nullptr || nodes > 0); ++k) {
    const Variable* const variable = all != nullptr ? all : reading.take(kNames[k]);
    if (variable == nullptr)
      file.fail(fmt::format("{} is missing", kNames[k]), "the points need coordinates");
    if (all == nullptr) reading.require_shape(*variable, {nodes});
    const std::vector<double> values =
        all != nullptr ? file.reals(*all, {k, first}, {1, count}) : file.reals(*variable, {first}, {count});
    reading.metadata->coordinate_type = variable->type;
    reading.part.mesh.points.resize(count);
    for (std::size_t v = 0; v < count; ++v) reading.part.mesh.points[v][k] = values[v];
  }
}

/// Appends to the mesh those elements of a block that are in the range.
void read_elements(Reading& reading, const Variable& connect, std::size_t b) {
  const NcInput& file = reading.file;
  const BlockRecord& block = reading.metadata->blocks[b];
  Cells& cells = reading.part.mesh.cells;
  const auto [first, elements] = reading.rows_of_block(b);
  const std::size_t begin = cells.vertices.size();
  const auto nodes = static_cast<std::size_t>(block.nodes);
  if (file.size(connect) > static_cast<std::size_t>(kMaxIndex) * 64)
    file.fail(connect.name + " is too large");
  cells.vertices.resize(begin + elements * nodes);
  file.read(connect, {first, 0}, {elements, nodes}, cells.vertices.data() + begin);
  const std::span<const int> order = file_order(block.shape, block.nodes);
  const auto count = static_cast<std::uint32_t>(reading.nodes);
  std::array<Index, 27> of_file{};
  for (std::size_t e = 0; e < elements; ++e) {
    Index* const row = cells.vertices.data() + begin + e * nodes;
    for (std::size_t k = 0; k < nodes; ++k) {
      // numbers below 1 become large, as the type is unsigned
      const std::uint32_t place = static_cast<std::uint32_t>(row[k]) - 1;
      if (place >= count) {
        file.fail(fmt::format("{}, element {}: node {} does not exist", connect.name, first + e + 1, row[k]),
                  fmt::format("the nodes are 1 to {}", count));
      }
      row[k] = static_cast<Index>(place);
    }
    if (order.empty()) continue;
    std::copy_n(row, nodes, of_file.begin());
    for (std::size_t k = 0; k < nodes; ++k) row[k] = of_file[static_cast<std::size_t>(order[k])];
  }
  cells.shapes.insert(cells.shapes.end(), elements, block.shape);
  for (std::size_t e = 0; e < elements; ++e)
    cells.offsets.push_back(cells.offsets.back() + static_cast<Offset>(nodes));
}

/// Reads the elements of all blocks.
void read_cells(Reading& reading) {
  const NcInput& file = reading.file;
  const std::vector<BlockRecord>& blocks = reading.metadata->blocks;
  Mesh& mesh = reading.part.mesh;
  std::size_t entries = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (blocks[b].nodes == 0) continue;
    (void)file.size(*file.find(fmt::format("connect{}", b + 1)));  // throws if the file is too small
    entries += reading.rows_of_block(b).count * static_cast<std::size_t>(blocks[b].nodes);
  }
  (void)file.claimed("the connectivity", entries, sizeof(Index));
  mesh.cells.reserve(reading.part.ranges.cells.size(), static_cast<Offset>(entries));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Variable* const connect = reading.take(fmt::format("connect{}", b + 1));
    if (blocks[b].nodes == 0) continue;
    if (reading.is_whole() && reading.block_ends[b] > 0) mesh.cell_blocks.push_back(reading.block_ends[b]);
    read_elements(reading, *connect, b);
  }
  if (!mesh.cell_blocks.empty()) mesh.cell_blocks.insert(mesh.cell_blocks.begin(), 0);
}

/// Values of the elements of some blocks, block by block.
struct ValuesOfBlocks {
  std::vector<double> values;
  std::vector<std::size_t> blocks;  ///< blocks of the values; all of them have elements
};

/// Reads the attributes of a block and appends them to `columns`, whose keys are names of arrays.
void read_attributes(Reading& reading, std::size_t b, std::map<std::string, ValuesOfBlocks>& columns) {
  const NcInput& file = reading.file;
  BlockRecord& block = reading.metadata->blocks[b];
  const std::string number = std::to_string(b + 1);
  const Variable* const variable = reading.take("attrib" + number);
  if (variable == nullptr) return;
  const std::size_t elements = reading.size_of_block(b);
  const auto [first, rows] = reading.rows_of_block(b);
  const std::vector<std::size_t> shape = file.shape(*variable);
  // a single attribute may lack the second dimension
  const std::size_t count = shape.size() == 1 ? 1 : shape.size() == 2 ? shape[1] : 0;
  if (count == 0 || shape[0] != elements)
    reading.require_shape(*variable, {elements, std::max<std::size_t>(count, 1)});
  block.names_attributes = file.find("attrib_name" + number) != nullptr;
  const std::vector<std::string> names = reading.take_names("attrib_name" + number, count);
  block.attribute_type = variable->type;
  std::vector<std::size_t> starts{first, 0};
  std::vector<std::size_t> counts{rows, count};
  starts.resize(shape.size());
  counts.resize(shape.size());
  const std::vector<double> values = file.reals(*variable, starts, counts);
  std::set<std::string> used;
  for (std::size_t k = 0; k < count; ++k) {
    std::string name(kAttribute);
    name += names[k].empty() || used.contains(names[k]) ? std::to_string(k + 1) : names[k];
    if (!used.insert(name.substr(kAttribute.size())).second) name += " of " + number;
    block.attributes.emplace_back(names[k], name);
    if (elements == 0) continue;
    ValuesOfBlocks& column = columns[name];
    column.blocks.push_back(b);
    for (std::size_t e = 0; e < rows; ++e) column.values.push_back(values[e * count + k]);
  }
}

/// Gives the cells labels: the blocks' ids, or the values of a property that holds labels.
void label_cells(Reading& reading) {
  ExodusMetadata& metadata = *reading.metadata;
  auto& names = metadata.block_properties;
  const auto property = std::find(names.begin(), names.end(), kLabelProperty);
  if (property != names.end()) {
    const auto place = static_cast<std::size_t>(property - names.begin());
    std::set<std::tuple<std::int64_t, Shape, int>> keys;
    bool tells_blocks = true;
    for (const BlockRecord& block : metadata.blocks) {
      tells_blocks = tells_blocks && (block.nodes == 0 ||
                                      keys.emplace(block.properties[place], block.shape, block.nodes).second);
    }
    if (tells_blocks) {
      for (BlockRecord& block : metadata.blocks) {
        block.label = block.properties[place];
        block.properties.erase(block.properties.begin() + static_cast<std::ptrdiff_t>(place));
      }
      names.erase(property);
    }
  }
  if (std::all_of(metadata.blocks.begin(), metadata.blocks.end(),
                  [](const BlockRecord& block) { return block.nodes == 0 || block.label == 0; })) {
    return;
  }
  std::vector<std::int64_t> labels;
  labels.reserve(reading.part.mesh.cells.shapes.size());
  for (std::size_t b = 0; b < metadata.blocks.size(); ++b)
    labels.insert(labels.end(), reading.rows_of_block(b).count, metadata.blocks[b].label);
  reading.add_array({.name = std::string(kLabel),
                     .association = Association::cells,
                     .values = label_values(std::move(labels))});
}

void name_blocks(Reading& reading) {
  for (std::size_t b = 0; b < reading.metadata->blocks.size(); ++b) {
    BlockRecord& block = reading.metadata->blocks[b];
    if (block.name.empty() || block.nodes == 0) continue;
    EntitySet set{block.name, Association::cells, {}};
    const MeshRange own = reading.own_of_block(b);
    (void)reading.file.claimed(block.name, static_cast<std::size_t>(own.size()), sizeof(Index));
    set.members = index_range(own.first - reading.part.ranges.cells.first, own.size());
    MeshPart::SetRows rows;
    if (!reading.is_whole()) {
      rows = {reading.block_ends[b + 1] - reading.block_ends[b],
              index_range(own.first - reading.block_ends[b], own.size())};
    }
    block.in_mesh = reading.add_set(std::move(set), std::move(rows));
  }
}

/// Fills in the record of block `b`, counted from 0. `connect`: the block's connectivity, null if there is
/// none.
void read_block(Reading& reading, std::size_t b, const Variable* connect) {
  const NcInput& file = reading.file;
  BlockRecord& block = reading.metadata->blocks[b];
  const std::vector<std::size_t> shape =
      connect == nullptr ? std::vector<std::size_t>{0, 0} : file.shape(*connect);
  block.type = connect == nullptr ? "" : file.text(*connect, "elem_type");
  const std::string number = std::to_string(b + 1);
  if (file.find("ebepecnt" + number) != nullptr || file.find("facconn" + number) != nullptr ||
      file.find("edgconn" + number) != nullptr || shape.size() != 2) {
    file.fail(fmt::format("block {} (id {}) has elements of type '{}'", b + 1, block.id, block.type),
              "only elements with a fixed number of nodes are supported");
  }
  if (shape[0] > static_cast<std::size_t>(reading.elements - reading.block_ends.back()))
    file.fail(fmt::format("connect{} has more elements than num_elem, {}, leaves", b + 1, reading.elements));
  reading.block_ends.push_back(reading.block_ends.back() + static_cast<Index>(shape[0]));
  if (shape[0] == 0) return;
  std::optional<Shape> found;
  if (shape[1] <= 1024)
    found = shape_of(block.type, static_cast<int>(shape[1]), reading.metadata->coordinates);
  if (!found) {
    file.fail(
        fmt::format("block {} (id {}) has elements of type '{}' with {} nodes", b + 1, block.id, block.type,
                    shape[1]),
        "spheres, bars, triangles, quadrilaterals, shells, tetrahedra, pyramids, wedges and hexahedra are "
        "supported");
  }
  block.shape = *found;
  block.nodes = static_cast<int>(shape[1]);
  block.connect_type = connect->type;
}

/// Reads the records of the blocks, but not the elements.
void read_blocks(Reading& reading) {
  const NcInput& file = reading.file;
  ExodusMetadata& metadata = *reading.metadata;
  std::vector<BlockRecord>& blocks = metadata.blocks;
  blocks.resize(file.count("num_el_blk"));
  metadata.block_properties = read_records(reading, "eb", blocks, metadata.names_blocks);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    blocks[b].label = blocks[b].id;
    read_block(reading, b, file.find(fmt::format("connect{}", b + 1)));
  }
  if (reading.block_ends.back() != reading.elements) {
    file.fail(fmt::format("num_elem is {}, but the blocks have {} elements", reading.elements,
                          reading.block_ends.back()));
  }
}

/// Reads labels, names and attributes of blocks.
void read_data_of_blocks(Reading& reading) {
  std::map<std::string, ValuesOfBlocks> attributes;
  for (std::size_t b = 0; b < reading.metadata->blocks.size(); ++b) read_attributes(reading, b, attributes);
  label_cells(reading);
  name_blocks(reading);
  for (auto& [name, column] : attributes) reading.add_array(name, std::move(column.values), column.blocks);
}

void read_nodal_attributes(Reading& reading) {
  const NcInput& file = reading.file;
  const Variable* const variable = reading.take("nattrb");
  if (variable == nullptr) return;
  const auto count = file.count("num_att_in_nblk");
  const auto [first, nodes] = reading.rows(Association::vertices);
  reading.require_shape(*variable, {static_cast<std::size_t>(reading.nodes), count});
  const std::vector<std::string> names = reading.take_names("nattrib_name", count);
  const std::vector<double> values = file.reals(*variable, {first, 0}, {nodes, count});
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<double> column(nodes);
    for (std::size_t v = 0; v < nodes; ++v) column[v] = values[v * count + k];
    const std::string name = names[k].empty() ? std::to_string(k + 1) : names[k];
    reading.metadata->nodal_attributes.emplace_back(
        names[k], reading.add_array({.name = std::string(kAttribute) + name, .values = std::move(column)}));
  }
}

/// Returns the integers of the nodes or elements to read; the variable has one for each node or element of
/// the mesh.
std::vector<std::int64_t> numbers_of(const Reading& reading, const Variable& variable, Association of) {
  reading.require_shape(variable, {static_cast<std::size_t>(reading.count(of))});
  const auto [first, count] = reading.rows(of);
  return reading.file.integers(variable, {first}, {count});
}

/// Returns the numbers of nodes or elements; empty if the file has none. If a whole mesh is read, also empty
/// if the numbers are 1, 2, …, or if one is repeated, which adds a note.
std::vector<std::int64_t> read_numbers(Reading& reading, const std::string& name, Association of,
                                       bool& is_there) {
  const Variable* const variable = reading.take(name);
  is_there = variable != nullptr;
  if (variable == nullptr) return {};
  std::vector<std::int64_t> numbers = numbers_of(reading, *variable, of);
  if (!reading.is_whole()) return numbers;
  bool plain = true;
  for (std::size_t i = 0; i < numbers.size() && plain; ++i)
    plain = numbers[i] == static_cast<std::int64_t>(i) + 1;
  if (plain) return {};
  const std::optional<std::int64_t> twice = given_twice(numbers);
  if (!twice) return numbers;
  reading.notes.push_back(note_of_number_twice(name, *twice));
  is_there = false;
  return {};
}

/// Reads the named maps of nodes or elements.
void read_named_maps(Reading& reading, const std::string& word, const char* prefix, Association of,
                     std::vector<MapRecord>& maps) {
  const std::size_t number = reading.file.count("num_" + word + "_maps");
  const std::vector<std::int64_t> ids = read_ids(reading, std::string(prefix) + "_prop1", number);
  const std::vector<std::string> names = reading.take_names(std::string(prefix) + "ap_names", number);
  for (std::size_t m = 0; m < number; ++m) {
    const Variable* const variable = reading.take(fmt::format("{}_map{}", word, m + 1));
    if (variable == nullptr) continue;
    const std::string name = names[m].empty() ? std::to_string(ids[m]) : names[m];
    DataArray array{.name = name == kOriginal ? name : std::string(kMap) + name,
                    .association = of,
                    .values = label_values(numbers_of(reading, *variable, of))};
    maps.push_back({ids[m], names[m], reading.add_array(std::move(array)), variable->type});
  }
}

void read_maps(Reading& reading) {
  constexpr const char* kNodeNumbers = "node_num_map";
  constexpr const char* kElementNumbers = "elem_num_map";
  ExodusMetadata& metadata = *reading.metadata;
  MeshPart& part = reading.part;
  part.mesh.vertex_ids =
      read_numbers(reading, kNodeNumbers, Association::vertices, metadata.has_node_numbers);
  part.mesh.cell_ids =
      read_numbers(reading, kElementNumbers, Association::cells, metadata.has_element_numbers);
  if (metadata.has_node_numbers) part.vertex_ids = kNodeNumbers;
  if (metadata.has_element_numbers) part.cell_ids = kElementNumbers;
  if (reading.take("elem_map") != nullptr) {
    reading.notes.emplace_back("the order map of elements, elem_map, is left out: the new order replaces it");
  }
  read_named_maps(reading, "node", "nm", Association::vertices, metadata.node_maps);
  read_named_maps(reading, "elem", "em", Association::cells, metadata.element_maps);
}

/// Returns whether a dimension counts nodes, elements or entries of a set. If so, variables with this
/// dimension depend on the order of the mesh.
bool is_of_nodes_or_elements(const Reading& reading, const Dimension& dimension) {
  constexpr std::array<std::string_view, 6> kWhole{"num_nodes", "num_elem", "num_edge",
                                                   "num_face",  "num_node", "num_elements"};
  constexpr std::array<std::string_view, 9> kNumbered{"num_el_in_blk", "num_nod_per_el", "num_att_in_blk",
                                                      "num_nod_ns",    "num_df_ns",      "num_side_ss",
                                                      "num_df_ss",     "num_ele_els",    "num_df_els"};
  constexpr std::array<std::string_view, 7> kFixed{"len_string", "len_line", "len_name",  "four",
                                                   "num_dim",    "num_info", "num_qa_rec"};
  const std::string& name = dimension.name;
  if (is_one_of(name, kWhole)) return true;
  const auto is_numbered = [&](std::string_view begin) {
    return name.size() > begin.size() && name.starts_with(begin) &&
           std::isdigit(static_cast<unsigned char>(name[begin.size()])) != 0;
  };
  if (std::any_of(kNumbered.begin(), kNumbered.end(), is_numbered)) return true;
  if (dimension.unlimited || is_one_of(name, kFixed)) return false;
  if (name.ends_with("_var") || name.ends_with("_sets") || name == "num_el_blk") return false;
  // the dimension may count nodes or elements under another name
  return dimension.length == static_cast<std::size_t>(reading.nodes) ||
         dimension.length == static_cast<std::size_t>(reading.elements);
}

/// Keeps attributes, and all other variables and dimensions unless they depend on the order of the mesh.
void keep_others(Reading& reading) {
  const NcInput& file = reading.file;
  ExodusMetadata& metadata = *reading.metadata;
  std::vector<std::string> lost;
  std::set<int> used;
  for (const Variable& variable : file.variables()) {
    if (reading.taken.contains(variable.name)) {
      used.insert(variable.dimensions.begin(), variable.dimensions.end());
      std::vector<Attribute> attributes = file.attributes(&variable, lost);
      std::erase_if(attributes, [](const Attribute& attribute) {
        return attribute.name == "elem_type" || attribute.name == "name" || attribute.name == "_FillValue";
      });
      if (!attributes.empty()) metadata.variable_attributes.emplace(variable.name, std::move(attributes));
      continue;
    }
    std::vector<Dimension> dimensions;
    for (const int place : variable.dimensions)
      dimensions.push_back(file.dimensions()[static_cast<std::size_t>(place)]);
    const bool moves = std::any_of(dimensions.begin(), dimensions.end(), [&](const Dimension& dimension) {
      return is_of_nodes_or_elements(reading, dimension);
    });
    if (moves || size_of(variable.type) == 0) {
      reading.notes.push_back(fmt::format(
          "the variable {} is left out: it {}", variable.name,
          moves ? "belongs to nodes or elements in an unknown way" : "has no numbers or characters"));
      continue;
    }
    metadata.plain.push_back({variable.name, variable.type, std::move(dimensions),
                              file.attributes(&variable, lost), file.bytes(variable)});
  }
  for (std::size_t place = 0; place < file.dimensions().size(); ++place) {
    const Dimension& dimension = file.dimensions()[place];
    if (!used.contains(static_cast<int>(place)) && !is_of_nodes_or_elements(reading, dimension))
      metadata.dimensions.push_back(dimension);
  }
  metadata.attributes = file.attributes(nullptr, lost);
  for (const std::string& name : lost)
    reading.notes.push_back(fmt::format("the attribute {} is left out", name));
}

/// Reads the number of steps; 0 if no variable has values at steps.
void read_steps(Reading& reading) {
  const auto& dimensions = reading.file.dimensions();
  const auto found = std::find_if(dimensions.begin(), dimensions.end(),
                                  [](const Dimension& dimension) { return dimension.name == "time_step"; });
  if (found == dimensions.end()) return;
  const auto place = static_cast<int>(found - dimensions.begin());
  const auto& variables = reading.file.variables();
  const bool used = std::any_of(variables.begin(), variables.end(), [&](const Variable& variable) {
    return !variable.dimensions.empty() && variable.dimensions.front() == place;
  });
  reading.metadata->steps = used ? found->length : 0;
  reading.metadata->steps_unlimited = found->unlimited;
}

/// Reads the sizes of the mesh and its blocks, but no values.
void read_header(Reading& reading) {
  ExodusMetadata& metadata = *reading.metadata;
  metadata.storage = reading.file.storage();
  const std::size_t given = std::max(reading.file.length("len_name"), reading.file.length("len_string"));
  metadata.name_length = std::clamp<std::size_t>(given, 33, 1024);
  read_steps(reading);
  if (reading.file.find("connect1") == nullptr && reading.file.length("num_elem") == 0)
    reading.file.fail("has no blocks of elements", "it may be a netCDF file other than Exodus");
  refuse_unknown_kinds(reading.file);
  leave_out_decomposition(reading);
  read_counts(reading);
  read_blocks(reading);
}

/// Reads all data of points and cells: attributes, numbers, maps, sets, variables and others.
void read_data(Reading& reading) {
  read_data_of_blocks(reading);
  read_maps(reading);
  read_nodal_attributes(reading);
  read_sets(reading);
  read_nodal(reading);
  read_elemental(reading);
  keep_others(reading);
  reading.part.mesh.format_metadata = reading.metadata;
}

void require_finite_points(const Reading& reading) {
  const std::vector<Point>& points = reading.part.mesh.points;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (std::all_of(points[v].begin(), points[v].end(), [](double x) { return std::isfinite(x); })) continue;
    reading.file.fail(fmt::format("vertex {} has a coordinate that is not finite",
                                  static_cast<std::size_t>(reading.part.ranges.vertices.first) + v));
  }
}

}  // namespace

Mesh read(const FilePath& path, Notes& notes) {
  Reading reading(path, nullptr, notes);
  read_header(reading);
  read_points(reading);
  read_cells(reading);
  read_data(reading);
  return std::move(reading.part.mesh);
}

Header read_header(const FilePath& path) {
  Notes ignored;
  Reading reading(path, nullptr, ignored);
  read_header(reading);
  return {reading.nodes,
          reading.elements,
          reading.metadata->blocks,
          reading.block_ends,
          reading.take_names("name_elem_var", reading.file.count("num_elem_var")),
          !reading.metadata->piece.empty()};
}

MeshPart read_part(const FilePath& path, const MeshRanges& ranges, PartContent content, Notes& notes) {
  Reading reading(path, &ranges, notes);
  read_header(reading);
  read_points(reading);
  read_cells(reading);
  require_finite_points(reading);
  if (content == PartContent::all) read_data(reading);
  return std::move(reading.part);
}

}  // namespace meshorder::exodus
