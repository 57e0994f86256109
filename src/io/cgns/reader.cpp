// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "io/cgns/reading.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

// Reads zones: points and sections of elements.

namespace meshorder::cgns {

void Reading::fail(const std::string& place, const std::string& what, const std::string& remedy) const {
  throw InputError(file, place.empty() ? what : place + ": " + what, remedy);
}

int Reading::bind(Node& node, Field field) {
  node.field = static_cast<int>(metadata->fields.size());
  std::string().swap(node.bytes);  // releases the memory, which an assignment would keep
  metadata->fields.push_back(std::move(field));
  return node.field;
}

std::vector<Index> Reading::rows_of(const Field& field) const {
  if (field.section >= 0) {
    return index_range(cells_of_section[field.section].first, cells_of_section[field.section].count);
  }
  if (field.list >= 0) return metadata->lists[field.list].members;
  const ZonePlaces& zone = zones[field.place];
  if (field.association == Association::cells) return zone.centred_cells;
  return index_range(zone.first_vertex, zone.vertices);
}

int Reading::zone_named(std::string_view path) const {
  path.remove_prefix(path.rfind('/') + 1);
  const auto found = std::find_if(metadata->zones.begin(), metadata->zones.end(),
                                  [&](const Zone& zone) { return zone.name == path; });
  return found == metadata->zones.end() ? -1 : static_cast<int>(found - metadata->zones.begin());
}

Values numbers_of(const Node& node) {
  if (node.type == "MT" || node.type == "C1") return std::vector<std::string>();
  return with_number_of_type(node.type, [&](auto zero) -> Values {
    std::vector<decltype(zero)> numbers(node.bytes.size() / sizeof(zero));
    if (!numbers.empty()) std::memcpy(numbers.data(), node.bytes.data(), numbers.size() * sizeof(zero));
    return numbers;
  });
}

std::vector<std::int64_t> whole_numbers(const Reading& reading, const Node& node, const std::string& path) {
  const Values values = numbers_of(node);
  if (!are_integers(values)) {
    reading.fail(path, fmt::format("has values of the type '{}'", node.type),
                 "whole numbers, I4 or I8, are expected");
  }
  return with_integers(
      values, [](const auto& numbers) { return std::vector<std::int64_t>(numbers.begin(), numbers.end()); });
}

namespace {

constexpr std::int64_t kMostDimensions = 3;

class MeshReader {
 public:
  explicit MeshReader(Reading& reading) : reading_(reading) {}

  void read() {
    Node& base = the_base();
    for (Node& node : base.children) {
      if (node.label == "Zone_t") read_zone(node, "/" + base.name + "/" + node.name);
    }
    if (reading_.zones.empty()) {
      reading_.fail("/" + base.name, "has no zones", "a mesh is a zone with sections of elements");
    }
    for (std::size_t z = 0; z < reading_.zones.size(); ++z) read_points(static_cast<int>(z));
    for (std::size_t z = 0; z < reading_.zones.size(); ++z) read_sections(static_cast<int>(z));
    if (reading_.polyhedra->polygon_count() > 0) reading_.metadata->polyhedra = reading_.polyhedra;
    Mesh& mesh = reading_.mesh;
    if (mesh.cell_blocks.size() < 2) mesh.cell_blocks.clear();
    mesh.dimension = physical_dimension_ < 3 ? 2 : 3;
    if (reading_.zones.size() < 2) return;
    std::vector<std::int32_t> zones;
    zones.reserve(mesh.cells.shapes.size());
    for (const Index s : reading_.metadata->section_of_cell)
      zones.push_back(reading_.metadata->sections[s].zone + 1);
    mesh.data.push_back(
        {.name = std::string(kZone), .association = Association::cells, .values = std::move(zones)});
  }

 private:
  Node& the_base() {
    Node& root = reading_.tree.root;
    Node* base = nullptr;
    for (Node& node : root.children) {
      if (node.label != "CGNSBase_t") continue;
      if (base != nullptr) {
        reading_.fail("", fmt::format("has two bases, '{}' and '{}'", base->name, node.name),
                      "give each a separate file");
      }
      base = &node;
    }
    if (base == nullptr) reading_.fail("", "has no base", "it may not be a CGNS file");
    const std::vector<std::int64_t> dimensions = whole_numbers(reading_, *base, "/" + base->name);
    if (dimensions.size() < 2 || dimensions[0] < 1 || dimensions[1] < dimensions[0] ||
        dimensions[1] > kMostDimensions) {
      reading_.fail("/" + base->name, "does not give the dimensions of its cells and points",
                    "two numbers from 1 to 3 are expected");
    }
    reading_.metadata->cell_dimension = static_cast<int>(dimensions[0]);
    physical_dimension_ = static_cast<int>(dimensions[1]);
    return *base;
  }

  void read_zone(Node& node, const std::string& path) {
    const Node* const type = node.child_of_label("ZoneType_t");
    if (type == nullptr || type->text() == "Structured") {
      reading_.fail(path, "is a structured zone; its order is fixed by the grid",
                    "convert it to an unstructured zone to reorder it");
    }
    const std::vector<std::int64_t> size = whole_numbers(reading_, node, path);
    const bool fits = size.size() == 3 && size[0] >= 0 && size[1] >= 0 && size[0] <= kMaxIndex;
    if (!fits) {
      reading_.fail(path, "does not give the numbers of its vertices and cells",
                    "three numbers are expected, below 2,147,483,648");
    }
    if (size[2] > 0) {
      reading_.notes.push_back(fmt::format(
          "the zone '{}' begins with its {} boundary vertices; the file written does not record this",
          node.name, size[2]));
    }
    const auto z = static_cast<int>(reading_.zones.size());
    reading_.metadata->zones.push_back({node.name, node.type, size[1]});
    reading_.bind(node, {.role = Field::Role::zone_size, .place = z});
    ZonePlaces zone{.node = &node, .path = path};
    zone.vertices = static_cast<Index>(size[0]);
    reading_.zones.push_back(std::move(zone));
  }

  // ---- points

  void read_points(int z) {
    ZonePlaces& zone = reading_.zones[z];
    Mesh& mesh = reading_.mesh;
    zone.first_vertex = mesh.vertex_count();
    Node* grid = zone.node->child("GridCoordinates");
    if (grid == nullptr) grid = zone.node->child_of_label("GridCoordinates_t");
    if (grid == nullptr || grid->label != "GridCoordinates_t") {
      reading_.fail(zone.path, "has no coordinates", "a node GridCoordinates is expected");
    }
    if (std::int64_t{mesh.vertex_count()} + zone.vertices > kMaxIndex) {
      reading_.fail("", "has more than 2,147,483,647 vertices", "split the mesh");
    }
    const std::string path = zone.path + "/" + grid->name;
    for (int k = 0; k < physical_dimension_; ++k) {
      const std::string name = std::string("Coordinate") + "XYZ"[k];
      const std::string axis_path = fmt::format("{}/{}", path, name);
      Node* const axis = grid->child(name);
      if (axis == nullptr) reading_.fail(path, "has no " + name, "save the file with Cartesian coordinates");
      if (axis->type != "R4" && axis->type != "R8") {
        reading_.fail(axis_path, "is of the type '" + axis->type + "'", "R4 or R8 is expected");
      }
      if (axis->size() != static_cast<std::uint64_t>(zone.vertices)) {
        reading_.fail(axis_path, fmt::format("has {} values for {} vertices", axis->size(), zone.vertices),
                      "ghost vertices (Rind_t) are not supported");
      }
      mesh.points.resize(zone.first_vertex + axis->size(), Point{0, 0, 0});
      with_numbers(numbers_of(*axis), [&](const auto& values) {
        Point* const points = mesh.points.data() + zone.first_vertex;
        for (std::size_t v = 0; v < values.size(); ++v) points[v][k] = static_cast<double>(values[v]);
      });
      reading_.bind(*axis, {.role = Field::Role::coordinate, .place = z, .axis = k, .type = axis->type});
    }
    auto& zones = reading_.metadata->zone_of_vertex;
    if (reading_.zones.size() > 1) zones.resize(mesh.points.size(), z);
  }

  // ---- sections

  FoundSection found_section(Node& node, int z, const std::string& path) {
    const std::vector<std::int64_t> type = whole_numbers(reading_, node, path);
    Node* const range = node.child("ElementRange");
    const std::vector<std::int64_t> numbers = range == nullptr
                                                  ? std::vector<std::int64_t>()
                                                  : whole_numbers(reading_, *range, path + "/ElementRange");
    if (type.empty() || numbers.size() != 2 || numbers[0] < 1 || numbers[1] < numbers[0] ||
        numbers[1] - numbers[0] >= kMaxIndex) {
      reading_.fail(path, "does not give its type and the range of its elements");
    }
    FoundSection found{&node, node.child("ElementConnectivity"), path, {}};
    if (found.connectivity == nullptr) reading_.fail(path, "has no ElementConnectivity");
    found.section.zone = z;
    found.section.name = node.name;
    found.section.type = static_cast<int>(std::clamp<std::int64_t>(type[0], -1, 1000));
    found.section.first = numbers[0];
    found.section.count = static_cast<Index>(numbers[1] - numbers[0] + 1);
    found.section.range_type = range->type;
    if (type.size() > 1 && type[1] != 0) {
      reading_.notes.push_back(fmt::format(
          "the section '{}' begins with its {} boundary elements; the file written does not record this",
          node.name, type[1]));
      constexpr std::size_t kSecond = 1;
      const std::size_t width = size_of_type(node.type);
      std::fill_n(node.bytes.begin() + static_cast<std::ptrdiff_t>(kSecond * width), width, '\0');
    }
    return found;
  }

  void read_sections(int z) {
    ZonePlaces& zone = reading_.zones[z];
    std::vector<FoundSection> found;
    for (Node& node : zone.node->children) {
      if (node.label == "Elements_t") found.push_back(found_section(node, z, zone.path + "/" + node.name));
    }
    std::sort(found.begin(), found.end(),
              [](const FoundSection& a, const FoundSection& b) { return a.section.first < b.section.first; });
    for (std::size_t s = 0; s < found.size(); ++s) {
      if (s > 0 && found[s].section.first <= found[s - 1].last()) {
        reading_.fail(found[s].path,
                      fmt::format("its elements {} to {} have numbers of '{}'", found[s].section.first,
                                  found[s].last(), found[s - 1].section.name),
                      "element numbers are unique in a zone");
      }
    }
    if (std::any_of(found.begin(), found.end(),
                    [](const FoundSection& one) { return one.section.is_of_polyhedra(); })) {
      if (listed_.empty()) listed_ = listed_elements(reading_);
      read_polyhedra(reading_, zone, found, listed_[z]);
    }
    zone.first_section = static_cast<int>(reading_.metadata->sections.size());
    zone.section_count = static_cast<int>(found.size());
    for (FoundSection& one : found) read_section(zone, one);
  }

  void read_section(ZonePlaces& zone, FoundSection& found) {
    Mesh& mesh = reading_.mesh;
    CgnsMetadata& metadata = *reading_.metadata;
    const auto s = static_cast<int>(metadata.sections.size());
    const bool is_of_polyhedra = found.section.is_of_polyhedra();
    if (std::int64_t{mesh.cell_count()} + found.section.count > kMaxIndex) {
      reading_.fail("", "has more than 2,147,483,647 elements", "split the mesh");
    }
    const Index first = mesh.cell_count();
    found.section.number_type = found.connectivity->type;
    if (is_of_polyhedra) {
      append_cells(reading_, found);
    } else {
      const std::string path = found.path + "/ElementConnectivity";
      with_whole_numbers(reading_, *found.connectivity, path,
                         [&](const auto& numbers) { add_elements(zone, found, numbers, path); });
    }
    reading_.bind(*found.connectivity, {.role = Field::Role::connectivity, .place = s});
    reading_.bind(*found.node->child("ElementRange"), {.role = Field::Role::range, .place = s});
    if (Node* const offsets = found.node->child("ElementStartOffset")) {
      if (found.section.type == kMixedElements || is_of_polyhedra) {
        found.section.offset_type = offsets->type;
        reading_.bind(*offsets, {.role = Field::Role::offsets, .place = s});
      }
    }
    reading_.cells_of_section.push_back({first, mesh.cell_count() - first});
    if (mesh.cell_count() > first) mesh.cell_blocks.push_back(first);
    metadata.section_of_cell.resize(mesh.cells.shapes.size(), s);
    for (Index c = first; c < mesh.cell_count(); ++c) {
      if (dimension(mesh.cells.shapes[c]) == metadata.cell_dimension) zone.centred_cells.push_back(c);
    }
    metadata.sections.push_back(std::move(found.section));
  }

  /// Appends the cells of a section of standard elements.
  template <class Number>
  void add_elements(const ZonePlaces& zone, const FoundSection& found, const std::vector<Number>& numbers,
                    const std::string& path) {
    const bool is_mixed = found.section.type == kMixedElements;
    const ElementType* type = element_type(found.section.type);
    const auto count = static_cast<std::size_t>(found.section.count);
    if (!is_mixed) {
      if (type == nullptr) {
        reading_.fail(found.path, fmt::format("has elements of the unknown type {}", found.section.type),
                      "the types are those of ElementType_t");
      }
      if (numbers.size() != count * static_cast<std::size_t>(type->nodes)) {
        reading_.fail(path, fmt::format("has {} numbers for {} elements of {} nodes", numbers.size(), count,
                                        type->nodes));
      }
      Cells& cells = reading_.mesh.cells;
      cells.reserve(static_cast<Offset>(cells.shapes.size() + count),
                    static_cast<Offset>(cells.vertices.size() + numbers.size()));
    }
    std::size_t at = 0;
    for (std::size_t e = 0; e < count; ++e) {
      const auto place = [&] { return fmt::format("{}, element {}", path, e + 1); };
      if (is_mixed) {
        if (at >= numbers.size()) reading_.fail(path, fmt::format("has {} of {} elements", e, count));
        type = element_type(static_cast<std::int64_t>(numbers[at]));
        if (type == nullptr || element_type_of(type->shape, type->nodes) != type) {
          reading_.fail(
              place(), fmt::format("has the unknown type {}", numbers[at]),
              "the types are those of ElementType_t, polygons and polyhedra in sections of their own");
        }
        ++at;
        if (numbers.size() - at < static_cast<std::size_t>(type->nodes)) {
          reading_.fail(place(), "has too few nodes");
        }
      }
      add_cell(zone, *type, numbers.data() + at, place);
      at += static_cast<std::size_t>(type->nodes);
    }
    if (at != numbers.size()) {
      reading_.fail(path,
                    fmt::format("has {} numbers more than its {} elements need", numbers.size() - at, count));
    }
  }

  /// Appends a cell, given by its vertex numbers in the order of the file.
  template <class Number, class Place>
  void add_cell(const ZonePlaces& zone, const ElementType& type, const Number* numbers, const Place& place) {
    const std::span<const int> order = file_order(type.shape, type.nodes);
    cell_.resize(static_cast<std::size_t>(type.nodes));
    for (std::size_t k = 0; k < cell_.size(); ++k) {
      cell_[k] =
          reading_.vertex_of(numbers[order.empty() ? k : static_cast<std::size_t>(order[k])], zone, place);
    }
    reading_.mesh.cells.push_back(type.shape, cell_);
  }

  Reading& reading_;
  int physical_dimension_ = 3;
  std::vector<NumberRanges> listed_;  ///< see `listed_elements`
  std::vector<Index> cell_;
};

/// Makes each listed range of boundary elements a block: its elements then stay together in a new order and
/// can be written as a range.
void keep_ranges(Reading& reading) {
  Mesh& mesh = reading.mesh;
  std::vector<Index> starts = mesh.cell_blocks;
  if (starts.empty()) starts.push_back(0);
  for (const PointList& list : reading.metadata->lists) {
    if (!list.is_range || list.association == Association::vertices) continue;
    if (dimension(mesh.cells.shapes[list.members.front()]) == reading.metadata->cell_dimension) continue;
    starts.push_back(list.members.front());
    if (list.members.back() + 1 < mesh.cell_count()) starts.push_back(list.members.back() + 1);
  }
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  if (starts.size() > 1) mesh.cell_blocks = std::move(starts);
}

/// Returns the version number in a node, 0 if its type is not R4.
float version_of(const Node& node) {
  float version = 0;
  if (node.type == "R4" && node.bytes.size() >= sizeof version) {
    std::memcpy(&version, node.bytes.data(), sizeof version);
  }
  return version;
}

/// Fails for element types whose numbers had another meaning in version 3.0: those between PYRA_5 (12) and
/// NGON_n (22).
void refuse_types_of_version_30(const Reading& reading, const Node& node, const std::string& path) {
  std::int32_t type = 0;
  if (node.label == "Elements_t" && node.type == "I4" && node.bytes.size() >= sizeof type) {
    std::memcpy(&type, node.bytes.data(), sizeof type);
    if (type > 12 && type < 22) {
      reading.fail(path, "uses an element type number of CGNS 3.0, which means another type since 3.1",
                   "update the file with `cgnsupdate IN OUT`");
    }
  }
  for (const Node& child : node.children) refuse_types_of_version_30(reading, child, path + "/" + child.name);
}

}  // namespace

Mesh read(const FilePath& path, Notes& notes) {
  Reading reading(path, notes);
  reading.tree = read_tree(path);
  const Node* const version = reading.tree.root.child_of_label("CGNSLibraryVersion_t");
  if (version == nullptr) {
    reading.fail("", "does not give the version of CGNS", "it may not be a CGNS file");
  }
  if (version_of(*version) > 2.95F && version_of(*version) < 3.05F) {
    refuse_types_of_version_30(reading, reading.tree.root, "");
  }
  MeshReader(reading).read();
  read_attachments(reading);
  keep_ranges(reading);
  add_arrays(reading);
  reading.metadata->tree = std::make_shared<const Tree>(std::move(reading.tree));
  reading.mesh.format_metadata = reading.metadata;
  return std::move(reading.mesh);
}

}  // namespace meshorder::cgns
