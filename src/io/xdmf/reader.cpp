// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/hdf5/session.hpp"
#include "io/vtk/vtk.hpp"
#include "io/xdmf/document.hpp"
#include "io/xdmf/xdmf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <type_traits>
#include <unordered_map>
#include <utility>

namespace meshorder::xdmf {
namespace {

using vtk::FileCells;

constexpr int kDeepestGrid = 8;

/// A uniform Grid and its place in a series of time steps.
struct GridElement {
  pugi::xml_node element;
  int series = -1;  ///< number of its temporal collection; −1: none
  int step = 0;
};

/// The cells of one Topology as the file has them.
struct Piece {
  FileCells cells;
  int base = 0;
};

std::string shortened(const std::string& text) { return text.substr(0, 60); }

std::vector<Index> all_of(Index first, Index count) {
  std::vector<Index> cells(static_cast<std::size_t>(count));
  std::iota(cells.begin(), cells.end(), first);
  return cells;
}

std::size_t count_of(const Values& values) {
  return std::visit([](const auto& numbers) { return numbers.size(); }, values);
}

bool is_integral(const Values& values) {
  return std::visit(
      [](const auto& numbers) {
        return std::is_integral_v<typename std::decay_t<decltype(numbers)>::value_type>;
      },
      values);
}

/// An array as it is put together from the parts of a mesh.
struct GrowingArray {
  DataArray array;
  std::vector<bool> has_row;  ///< cells: once there are several parts
};

class XdmfReader {
 public:
  XdmfReader(const FilePath& path, Notes& notes) : document_(path), data_(document_, path), notes_(notes) {
    layout_->stem = path.path().stem().string();
  }

  Mesh read() {
    const std::vector<GridElement> grids = grids_of_file();
    for (const GridElement& grid : grids) read_grid(grid);
    finish();
    return std::move(mesh_);
  }

 private:
  // ---- grids

  [[nodiscard]] std::vector<GridElement> grids_of_file() const {
    const pugi::xml_node root = document_.root();
    const pugi::xml_node domain = root.child("Domain");
    if (!domain) throw document_.error(root, "there is no <Domain>", "the file may be cut short");
    if (domain.next_sibling("Domain")) {
      throw document_.error(domain.next_sibling("Domain"), "the file has several <Domain>s",
                            "save each as a file of its own");
    }
    std::vector<GridElement> grids;
    int series = 0;
    for (const pugi::xml_node child : document_.children(domain)) {
      if (std::string_view(child.name()) == "Grid") collect(child, kDeepestGrid, series, grids);
    }
    if (grids.empty()) throw document_.error(domain, "there is no <Grid>", "the file may be cut short");
    return grids;
  }

  void collect(pugi::xml_node grid, int depth, int& series, std::vector<GridElement>& grids) const {
    const std::string type = attribute(grid, "GridType", "Type");
    if (type.empty() || same_but_for_case(type, "Uniform")) {
      grids.push_back({grid});
      return;
    }
    if (depth == 0)
      throw document_.error(grid, "the Grids are nested too deeply", "a file of XDMF nests two");
    std::vector<pugi::xml_node> inner;
    for (const pugi::xml_node child : document_.children(grid)) {
      if (std::string_view(child.name()) == "Grid") inner.push_back(child);
    }
    const bool collection = same_but_for_case(type, "Collection");
    if (collection && same_but_for_case(attribute(grid, "CollectionType"), "Temporal")) {
      const int own_series = series++;
      for (std::size_t step = 0; step < inner.size(); ++step) {
        const std::size_t before = grids.size();
        collect(inner[step], depth - 1, series, grids);
        if (grids.size() != before + 1) {
          throw document_.error(inner[step], "a time step holds several Grids",
                                "save the mesh as one Grid in each step");
        }
        grids.back().series = own_series;
        grids.back().step = static_cast<int>(step);
      }
      return;
    }
    if (!collection && !same_but_for_case(type, "Tree")) {
      throw document_.error(grid, fmt::format("the GridType is '{}'", shortened(type)),
                            "uniform Grids and collections of time steps are understood");
    }
    if (inner.size() != 1) {
      throw document_.error(grid, "a spatial collection holds several meshes, one for each part or process",
                            "merge them into one Grid before (in ParaView: Merge Blocks, then save)");
    }
    collect(inner.front(), depth - 1, series, grids);
  }

  void read_grid(const GridElement& grid) {
    const std::vector<pugi::xml_node> children = document_.children(grid.element);
    const auto only = [&](std::string_view name) {
      pugi::xml_node found;
      for (const pugi::xml_node child : children) {
        if (child.name() != name) continue;
        if (found)
          throw document_.error(child, fmt::format("a Grid has a second <{}>", name), "one is needed");
        found = child;
      }
      if (!found) {
        throw document_.error(grid.element, fmt::format("the Grid has no <{}>", name),
                              "each Grid has its own or includes that of another");
      }
      return found;
    };
    const pugi::xml_node topology = only("Topology");
    read_points(grid, only("Geometry"));
    const int part = read_topology(grid, topology);
    for (const pugi::xml_node child : children) {
      const std::string_view name = child.name();
      if (name == "Attribute") read_attribute(grid, part, child);
      if (name == "Set") read_set(part, child);
    }
  }

  /// Returns the DataItems of an element.
  static std::vector<pugi::xml_node> items_of(pugi::xml_node element) {
    std::vector<pugi::xml_node> items;
    for (const pugi::xml_node child : element.children("DataItem")) items.push_back(child);
    return items;
  }

  [[nodiscard]] pugi::xml_node item_of(pugi::xml_node element) const {
    const std::vector<pugi::xml_node> items = items_of(element);
    if (items.size() != 1) {
      throw document_.error(element, fmt::format("the <{}> has {} DataItems", element.name(), items.size()),
                            "one is needed");
    }
    return items.front();
  }

  // ---- points

  /// Returns the coordinates that a Geometry has; `fields` receives where they are.
  std::vector<Point> points_of(pugi::xml_node geometry, std::vector<Field>& fields, int& dimension) {
    std::string type = attribute(geometry, "GeometryType", "Type");
    if (type.empty()) type = "XYZ";
    const bool separate = same_but_for_case(type, "X_Y_Z") || same_but_for_case(type, "X_Y");
    if (!separate && !same_but_for_case(type, "XYZ") && !same_but_for_case(type, "XY")) {
      throw document_.error(geometry, fmt::format("the GeometryType is '{}'", shortened(type)),
                            "XYZ, XY, X_Y_Z and X_Y are understood; other Grids are structured");
    }
    dimension = same_but_for_case(type, "XY") || same_but_for_case(type, "X_Y") ? 2 : 3;
    const std::vector<pugi::xml_node> items = items_of(geometry);
    const std::size_t needed = separate ? static_cast<std::size_t>(dimension) : 1;
    if (items.size() != needed) {
      throw document_.error(geometry, fmt::format("the Geometry has {} DataItems", items.size()),
                            fmt::format("{} are needed for {}", needed, type));
    }
    std::vector<Point> points;
    const std::size_t width = separate ? 1 : static_cast<std::size_t>(dimension);
    for (std::size_t i = 0; i < items.size(); ++i) {
      Field field{Field::Role::points, data_.place_of(items[i])};
      field.axis = separate ? static_cast<int>(i) : -1;
      const Values values = data_.read(field.place);
      const std::size_t count = count_of(values) / width;
      if (count_of(values) % width != 0 || (i > 0 && count != points.size())) {
        throw document_.error(items[i], fmt::format("the Geometry has {} values", count_of(values)),
                              fmt::format("{} for each point are needed", dimension));
      }
      if (count > static_cast<std::size_t>(kMaxIndex)) {
        throw document_.error(items[i], "the Grid has too many points", "at most 2147483647 are possible");
      }
      points.resize(count);
      std::visit(
          [&](const auto& numbers) {
            using Number = typename std::decay_t<decltype(numbers)>::value_type;
            if constexpr (std::is_arithmetic_v<Number>) {
              for (std::size_t p = 0; p < count; ++p) {
                for (std::size_t k = 0; k < width; ++k) {
                  const auto x = static_cast<double>(numbers[p * width + k]);
                  if (!std::isfinite(x)) {
                    throw document_.error(
                        items[i],
                        fmt::format("point {} (counted from 0) has a coordinate that is not finite", p),
                        "finite numbers are needed");
                  }
                  points[p][separate ? i : k] = x;
                }
              }
            }
          },
          values);
      fields.push_back(std::move(field));
    }
    return points;
  }

  void read_points(const GridElement& grid, pugi::xml_node geometry) {
    std::string key;
    for (const pugi::xml_node item : items_of(geometry)) key += key_of(data_.place_of(item)) + "\n";
    if (!known_geometries_.insert(key).second) return;
    std::vector<Field> fields;
    int dimension = 3;
    std::vector<Point> points = points_of(geometry, fields, dimension);
    const bool first = known_geometries_.size() == 1;
    if (first) {
      mesh_.points = std::move(points);
      mesh_.dimension = dimension;
    } else if (points != mesh_.points) {
      if (grid.series < 0 || points.size() != mesh_.points.size()) {
        throw document_.error(
            geometry, "the Grid has other points than the first",
            "several meshes in one file are not understood: save each as a file of its own");
      }
      return add_moved_points(grid, fields, std::move(points), dimension);
    }
    layout_->fields.insert(layout_->fields.end(), fields.begin(), fields.end());
  }

  /// Keeps the points of a time step in which they have moved as an array.
  void add_moved_points(const GridElement& grid, std::vector<Field>& fields, std::vector<Point> points,
                        int dimension) {
    if (fields.size() != 1) {
      throw document_.error(grid.element, "points that move are given axis by axis", "write them as XYZ");
    }
    DataArray array;
    array.name = unused_name(fmt::format("points step {}", grid.step), Association::vertices);
    array.components = dimension;
    std::vector<double> values;
    values.reserve(points.size() * static_cast<std::size_t>(dimension));
    for (const Point& point : points) values.insert(values.end(), point.begin(), point.begin() + dimension);
    array.values = std::move(values);
    Field& field = layout_->fields.emplace_back(fields.front());
    field.role = Field::Role::array;
    field.name = array.name;
    arrays_.push_back({std::move(array), {}});
  }

  // ---- cells

  /// Returns the number of the part that a Topology is.
  int read_topology(const GridElement& grid, pugi::xml_node topology) {
    if (!topology.attribute("Order").empty()) {
      throw document_.error(topology, "the Topology has an Order of nodes of its own", "write it without");
    }
    const pugi::xml_node item = item_of_topology(topology);
    Field field{Field::Role::topology, data_.place_of(item)};
    const std::string key = key_of(field.place);
    if (const auto known = known_topologies_.find(key); known != known_topologies_.end())
      return known->second;
    field.base = topology.attribute("BaseOffset").as_int(0);
    field.part = part_of(grid, topology, piece_of(topology, item, field.place, field.base));
    known_topologies_.emplace(key, field.part);
    layout_->fields.push_back(field);
    return field.part;
  }

  [[nodiscard]] pugi::xml_node item_of_topology(pugi::xml_node topology) const {
    const std::string type = attribute(topology, "TopologyType", "Type");
    if (type.empty()) throw document_.error(topology, "the Topology has no TopologyType", "Triangle is one");
    const bool structured = type.find("MESH") != std::string::npos ||
                            type.find("Mesh") != std::string::npos || type.find("mesh") != std::string::npos;
    if (structured || same_but_for_case(type, "Polyhedron") ||
        (!same_but_for_case(type, "Mixed") && topology_type(type) == nullptr)) {
      throw document_.error(
          topology,
          fmt::format("the TopologyType is '{}'{}", shortened(type),
                      structured ? ", which is structured: its order is its grid's" : ""),
          "types with fixed nodes are understood, from Polyvertex to Hexahedron_1331, and Mixed");
    }
    return item_of(topology);
  }

  Piece piece_of(pugi::xml_node topology, pugi::xml_node item, const DataPlace& place, int base) {
    Piece piece;
    piece.base = base;
    std::vector<Index> numbers = data_.read_indices(place);
    const std::string type = attribute(topology, "TopologyType", "Type");
    const std::int64_t claimed = claimed_cells(topology);
    if (same_but_for_case(type, "Mixed")) {
      if (!read_mixed(numbers, claimed, true, piece.cells) &&
          (claimed < 0 || !read_mixed(numbers, claimed, false, piece.cells))) {
        throw document_.error(item, fmt::format("the mixed Topology is damaged near value {}", fault_at_),
                              claimed < 0 ? "each cell is the number of its type and its points"
                                          : fmt::format("NumberOfElements says {} cells", claimed));
      }
      check_vertices(item, piece.cells, base);
      return piece;
    }
    const TopologyType& known = *topology_type(type);
    std::int64_t nodes = known.nodes;
    if (nodes == 0) {
      nodes = topology.attribute("NodesPerElement").as_llong(0);
      if (nodes <= 0 && place.shape.size() > 1) nodes = static_cast<std::int64_t>(place.shape.back());
      if (nodes <= 0 && claimed > 0) nodes = std::ssize(numbers) / claimed;
      if (nodes <= 0 && known.number == kPolyvertex) nodes = 1;
      if (nodes <= 0 || nodes > kMaxIndex) {
        throw document_.error(topology, fmt::format("the {} has no NodesPerElement", known.name),
                              "it is needed");
      }
    }
    const std::int64_t entries = std::ssize(numbers);
    const std::int64_t cells = entries / nodes;
    if (entries % nodes != 0 || (claimed >= 0 && claimed != cells) || cells > kMaxIndex) {
      throw document_.error(item, fmt::format("the Topology has {} entries", entries),
                            claimed >= 0 ? fmt::format("{} cells of {} points are announced", claimed, nodes)
                                         : fmt::format("{} for each cell are needed", nodes));
    }
    piece.cells.types.assign(static_cast<std::size_t>(cells),
                             static_cast<std::uint8_t>(vtk_type(known, nodes)));
    piece.cells.offsets.resize(static_cast<std::size_t>(cells) + 1);
    for (std::int64_t c = 0; c <= cells; ++c) piece.cells.offsets[static_cast<std::size_t>(c)] = c * nodes;
    piece.cells.vertices = std::move(numbers);
    check_vertices(item, piece.cells, base);
    return piece;
  }

  /// Returns the number of cells that a Topology announces, −1 if it does not.
  [[nodiscard]] std::int64_t claimed_cells(pugi::xml_node topology) const {
    const std::string text = attribute(topology, "NumberOfElements", "Dimensions");
    std::string_view rest = text;
    std::int64_t cells = -1;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      std::int64_t size = -1;
      std::from_chars(word.data(), word.data() + word.size(), size);
      if (size < 0 || size > kMaxIndex) {
        throw document_.error(topology, fmt::format("NumberOfElements is '{}'", shortened(text)),
                              "a whole number up to 2147483647 is needed");
      }
      cells = cells < 0 ? size : cells;  // the first of several is that of the cells
    }
    return cells;
  }

  /// Appends the cells of a mixed Topology; `counted`: points have a count, too. Returns false for a fault,
  /// at `fault_at_`.
  bool read_mixed(const std::vector<Index>& numbers, std::int64_t claimed, bool counted, FileCells& cells) {
    cells = {};
    std::size_t i = 0;
    while (i < numbers.size()) {
      fault_at_ = i;
      const TopologyType* const type = topology_type(numbers[i++]);
      if (type == nullptr) return false;
      std::int64_t nodes = type->nodes;
      if (nodes == 0 && type->number == kPolyvertex && !counted) nodes = 1;  // as meshio writes them
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

  void check_vertices(pugi::xml_node item, FileCells& cells, int base) const {
    const Index count = mesh_.vertex_count();
    for (std::size_t i = 0; i < cells.vertices.size(); ++i) {
      const std::int64_t vertex = std::int64_t{cells.vertices[i]} - base;
      if (vertex < 0 || vertex >= count) {
        const auto cell =
            std::upper_bound(cells.offsets.begin(), cells.offsets.end(), static_cast<Offset>(i)) -
            cells.offsets.begin() - 1;
        throw document_.error(item,
                              fmt::format("cell {} (counted from 0) names a point that does not exist", cell),
                              fmt::format("the Geometry has points {} to {}", base, count - 1 + base));
      }
      cells.vertices[i] = static_cast<Index>(vertex);
    }
  }

  static std::span<const Index> vertices_of(const FileCells& cells, Index c) {
    const auto k = static_cast<std::size_t>(c);
    return {cells.vertices.data() + cells.offsets[k], cells.vertices.data() + cells.offsets[k + 1]};
  }

  static std::vector<Index> sorted(std::span<const Index> vertices) {
    std::vector<Index> result(vertices.begin(), vertices.end());
    std::sort(result.begin(), result.end());
    return result;
  }

  static std::size_t hash_of(const std::vector<Index>& vertices) {
    std::size_t hash = vertices.size();
    for (const Index v : vertices) {
      hash = (hash ^ static_cast<std::size_t>(v)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29U;
    }
    return hash;
  }

  /// Returns the cells before that have the same types and vertices as those of a piece; none if one is new.
  [[nodiscard]] std::optional<std::vector<Index>> known_cells(const Piece& piece) const {
    const Index count = index_size(piece.cells.types);
    std::array<bool, 256> types{};
    for (const std::uint8_t type : cells_.types) types[type] = true;
    for (const std::uint8_t type : piece.cells.types) {
      if (!types[type]) return {};
    }
    const auto is_same = [&](Index old, Index c) {
      return cells_.types[static_cast<std::size_t>(old)] == piece.cells.types[static_cast<std::size_t>(c)] &&
             std::ranges::equal(vertices_of(cells_, old), vertices_of(piece.cells, c));
    };
    bool in_place = count <= index_size(cells_.types);
    for (Index c = 0; c < count && in_place; ++c) in_place = is_same(c, c);
    if (in_place) return all_of(0, count);

    std::unordered_multimap<std::size_t, Index> places;
    places.reserve(cells_.types.size());
    for (Index c = 0; c < index_size(cells_.types); ++c)
      places.emplace(hash_of(sorted(vertices_of(cells_, c))), c);
    std::vector<Index> found;
    std::vector<bool> taken(cells_.types.size(), false);
    for (Index c = 0; c < count; ++c) {
      const std::vector<Index> wanted = sorted(vertices_of(piece.cells, c));
      const auto [begin, end] = places.equal_range(hash_of(wanted));
      const auto place = std::find_if(begin, end, [&](const auto& candidate) {
        const auto old = static_cast<std::size_t>(candidate.second);
        return !taken[old] && cells_.types[old] == piece.cells.types[static_cast<std::size_t>(c)] &&
               sorted(vertices_of(cells_, candidate.second)) == wanted;
      });
      if (place == end) return {};
      taken[static_cast<std::size_t>(place->second)] = true;
      found.push_back(place->second);
    }
    return found;
  }

  /// Adds the cells of a piece as a part, or finds the part that has them; returns its number.
  int part_of(const GridElement& grid, pugi::xml_node topology, Piece piece) {
    if (grid.series >= 0) {
      // the mesh of a series may be written again in each step
      const auto known = series_parts_.find(grid.series);
      if (known != series_parts_.end()) {
        if (is_part(known->second, piece)) return known->second;
        throw document_.error(topology, fmt::format("the cells change in time step {}", grid.step),
                              "a series needs one mesh for all steps: save each mesh as a file of its own");
      }
      if (!layout_->parts.empty() && is_part(0, piece)) return series_parts_[grid.series] = 0;
    }
    const auto number = static_cast<int>(layout_->parts.size());
    if (grid.series >= 0) series_parts_[grid.series] = number;
    Part part;
    part.name = grid.element.attribute("Name").value();
    if (part.name.empty()) part.name = fmt::format("grid {}", number);
    std::vector<Index> rows;
    if (auto known = number == 0 ? std::nullopt : known_cells(piece)) {
      part.has_own_cells = false;
      rows = std::move(*known);
      part.is_ascending = std::is_sorted(rows.begin(), rows.end());
    } else {
      rows = append(topology, std::move(piece));
    }
    if (number > 0) {
      part.set = unused_set_name(part.name);
      mesh_.sets.push_back({part.set, Association::cells, rows});
    }
    layout_->parts.push_back(part);
    rows_.push_back(std::move(rows));
    return number;
  }

  [[nodiscard]] bool is_part(int part, const Piece& piece) const {
    const std::vector<Index>& rows = rows_[static_cast<std::size_t>(part)];
    if (index_size(rows) != index_size(piece.cells.types)) return false;
    for (Index c = 0; c < index_size(rows); ++c) {
      const auto old = static_cast<std::size_t>(rows[static_cast<std::size_t>(c)]);
      if (cells_.types[old] != piece.cells.types[static_cast<std::size_t>(c)] ||
          !std::ranges::equal(vertices_of(cells_, static_cast<Index>(old)), vertices_of(piece.cells, c))) {
        return false;
      }
    }
    return true;
  }

  std::vector<Index> append(pugi::xml_node topology, Piece piece) {
    const Index first = index_size(cells_.types);
    const Index count = index_size(piece.cells.types);
    if (std::int64_t{first} + count > kMaxIndex) {
      throw document_.error(topology, "the Grids have too many cells", "at most 2147483647 are possible");
    }
    if (count > 0) mesh_.cell_blocks.push_back(first);
    if (first == 0) {
      cells_ = std::move(piece.cells);
    } else {
      const Offset before = cells_.offsets.back();
      cells_.types.insert(cells_.types.end(), piece.cells.types.begin(), piece.cells.types.end());
      cells_.vertices.insert(cells_.vertices.end(), piece.cells.vertices.begin(), piece.cells.vertices.end());
      for (std::size_t c = 1; c < piece.cells.offsets.size(); ++c)
        cells_.offsets.push_back(before + piece.cells.offsets[c]);
    }
    if (where_cells_are_.empty()) where_cells_are_ = topology;
    return all_of(first, count);
  }

  [[nodiscard]] std::string unused_set_name(const std::string& wanted) const {
    std::string name = wanted;
    for (int k = 2; std::any_of(
             mesh_.sets.begin(), mesh_.sets.end(),
             [&](const EntitySet& set) { return set.association == Association::cells && set.name == name; });
         ++k) {
      name = fmt::format("{} ({})", wanted, k);
    }
    return name;
  }

  // ---- arrays and sets

  [[nodiscard]] std::string unused_name(const std::string& wanted, Association association) const {
    std::string name = wanted;
    for (int k = 2; array_named(name, association) != nullptr; ++k) name = fmt::format("{} ({})", wanted, k);
    return name;
  }

  [[nodiscard]] const GrowingArray* array_named(const std::string& name, Association association) const {
    const auto found = std::find_if(arrays_.begin(), arrays_.end(), [&](const GrowingArray& growing) {
      return growing.array.association == association && growing.array.name == name;
    });
    return found == arrays_.end() ? nullptr : &*found;
  }

  [[nodiscard]] std::string name_of(pugi::xml_node element) const {
    std::string name = element.attribute("Name").value();
    if (name.empty())
      throw document_.error(element, fmt::format("the <{}> has no Name", element.name()), "it is needed");
    return name;
  }

  void read_attribute(const GridElement& grid, int part, pugi::xml_node element) {
    const std::string name = name_of(element);
    std::string center = attribute(element, "Center");
    const std::string kind = attribute(element, "ItemType");
    if (same_but_for_case(kind, "FiniteElementFunction") || items_of(element).size() > 1) {
      throw document_.error(
          element,
          fmt::format("the attribute '{}' is a finite element function by its degrees of freedom", name),
          "write its values at points or cells (in FEniCS: write, not write_checkpoint)");
    }
    if (center.empty()) center = "Node";
    if (same_but_for_case(center, "Grid")) return read_of_grid(item_of(element), name);
    const bool on_vertices = same_but_for_case(center, "Node");
    if (!on_vertices && !same_but_for_case(center, "Cell")) {
      throw document_.error(element, fmt::format("the attribute '{}' is on each {}", name, shortened(center)),
                            "attributes of Node, Cell and Grid can be moved with the mesh");
    }
    Field field{Field::Role::array, data_.place_of(item_of(element))};
    field.part = on_vertices ? 0 : part;
    field.association = on_vertices ? Association::vertices : Association::cells;
    const std::string key = fmt::format("{} {} {}", key_of(field.place), field.part, on_vertices);
    if (!known_arrays_.insert(key + name).second) return;

    DataArray array;
    array.association = field.association;
    array.values = data_.read(field.place);
    const Index rows = on_vertices ? mesh_.vertex_count() : index_size(rows_[static_cast<std::size_t>(part)]);
    const std::size_t values = count_of(array.values);
    if (rows == 0 ? values != 0 : (values == 0 || values % static_cast<std::size_t>(rows) != 0)) {
      throw document_.error(element, fmt::format("the attribute '{}' has {} values", name, values),
                            fmt::format("the Grid has {} {}", rows, on_vertices ? "points" : "cells"));
    }
    if (rows == 0) return;
    array.components = static_cast<Index>(values / static_cast<std::size_t>(rows));
    array.name = name;
    if (is_label(field, array)) take_label(field, array);
    pending_.push_back({std::move(field), std::move(array), grid});
  }

  void read_of_grid(pugi::xml_node item, const std::string& name) {
    const DataPlace place = data_.place_of(item);  // opens its file, which is kept
    if (place.format == DataPlace::Format::binary) {
      throw document_.error(item, fmt::format("the attribute '{}' of the Grid is in a binary file", name),
                            "write it as XML or HDF");
    }
    layout_->words.push_back(fmt::format("the attribute '{}' of the whole grid", name));
  }

  /// Whether an array is the labels of cells: tags of FEniCSx or FEniCS, or an array of that name.
  [[nodiscard]] bool is_label(const Field& field, const DataArray& array) const {
    if (array.association == Association::vertices || array.components != 1 || !is_integral(array.values)) {
      return false;
    }
    const std::string& dataset = field.place.dataset;
    return array.name == kLabel ||
           (field.part > 0 &&
            (array.name == layout_->parts[static_cast<std::size_t>(field.part)].name ||
             dataset.starts_with("/MeshTags/") || dataset.starts_with("/MeshValueCollection/")));
  }

  /// Makes an array the labels of its cells, unless one of them has a label.
  void take_label(const Field& field, DataArray& array) {
    const std::vector<Index>& rows = rows_[static_cast<std::size_t>(field.part)];
    if (labelled_.size() < cells_.types.size()) labelled_.resize(cells_.types.size(), false);
    const auto has_label = [&](Index c) { return labelled_[static_cast<std::size_t>(c)]; };
    if (std::any_of(rows.begin(), rows.end(), has_label)) return;
    for (const Index c : rows) labelled_[static_cast<std::size_t>(c)] = true;
    array.name = kLabel;
  }

  void read_set(int part, pugi::xml_node element) {
    const std::string name = name_of(element);
    const std::string type = attribute(element, "SetType", "Type");
    const bool on_vertices = same_but_for_case(type, "Node");
    if (!on_vertices && !same_but_for_case(type, "Cell")) {
      throw document_.error(element, fmt::format("the set '{}' is of the type '{}'", name, shortened(type)),
                            "sets of Node and Cell can be moved with the mesh");
    }
    if (element.child("Attribute")) {
      throw document_.error(element, fmt::format("the set '{}' has attributes of its own", name),
                            "attributes of Grids can be moved with the mesh");
    }
    const pugi::xml_node item = item_of(element);
    Field field{Field::Role::set, data_.place_of(item)};
    field.part = on_vertices ? 0 : part;
    field.association = on_vertices ? Association::vertices : Association::cells;
    field.name = name;
    if (!known_arrays_.insert(fmt::format("{} {} set", key_of(field.place), field.part) + name).second)
      return;
    const std::vector<Index> members = data_.read_indices(field.place);
    const std::vector<Index>& rows = rows_[static_cast<std::size_t>(part)];
    const Index count = on_vertices ? mesh_.vertex_count() : index_size(rows);
    std::vector<bool> taken(static_cast<std::size_t>(count), false);
    EntitySet& set = set_of(field);
    for (const Index member : members) {
      if (member < 0 || member >= count || taken[static_cast<std::size_t>(member)]) {
        throw document_.error(item,
                              fmt::format("the set '{}' names {}{}", name, member,
                                          member >= 0 && member < count ? " twice" : ""),
                              fmt::format("the Grid has {} to {}", 0, count - 1));
      }
      taken[static_cast<std::size_t>(member)] = true;
      set.members.push_back(on_vertices ? static_cast<Index>(member)
                                        : rows[static_cast<std::size_t>(member)]);
    }
    layout_->fields.push_back(field);
  }

  /// Returns the set that a field is a part of; renames the field if another one of its part has that name.
  EntitySet& set_of(Field& field) {
    const std::string wanted = field.name;
    for (int k = 2;; ++k) {
      const auto found = std::find_if(mesh_.sets.begin(), mesh_.sets.end(), [&](const EntitySet& set) {
        return set.association == field.association && set.name == field.name;
      });
      if (found == mesh_.sets.end()) {
        return mesh_.sets.emplace_back(EntitySet{field.name, field.association, {}});
      }
      const bool is_grid = std::any_of(layout_->parts.begin(), layout_->parts.end(), [&](const Part& part) {
        return field.association == Association::cells && part.set == field.name;
      });
      const bool of_part =
          std::any_of(layout_->fields.begin(), layout_->fields.end(), [&](const Field& other) {
            return other.role == Field::Role::set && other.association == field.association &&
                   other.name == field.name && other.part == field.part;
          });
      if (!is_grid && !of_part) return *found;
      field.name = fmt::format("{} ({})", wanted, k);
    }
  }

  // ---- the mesh

  /// An array that waits for its name: with the step of its series where there are several.
  struct Pending {
    Field field;
    DataArray array;
    GridElement grid;
  };

  void finish() {
    layout_->inward_wedges = vtk::take_cells(
        mesh_, std::move(cells_),
        [&](const std::string& what, const std::string& remedy) {
          return document_.error(where_cells_are_, what, remedy);
        },
        notes_);
    if (mesh_.cell_blocks.size() == 1) mesh_.cell_blocks.clear();
    name_pending();
    for (GrowingArray& growing : arrays_) {
      finish_array(growing);
      vtk::add_array(mesh_, std::move(growing.array));
    }
    keep_rest();
    mesh_.format_metadata = layout_;
  }

  void name_pending() {
    std::map<std::tuple<std::string, Association, int>, int> counts;
    for (const Pending& pending : pending_)
      ++counts[{pending.array.name, pending.array.association, pending.grid.series}];
    for (Pending& pending : pending_) {
      const bool in_series = pending.grid.series >= 0 &&
                             counts[{pending.array.name, pending.array.association, pending.grid.series}] > 1;
      if (in_series) pending.array.name += fmt::format(" step {}", pending.grid.step);
      pending.field.name = add(std::move(pending.array), pending.field.part);
      layout_->fields.push_back(std::move(pending.field));
    }
  }

  /// Adds an array, or the rows of a part to the array of its name; returns the name that it gets.
  std::string add(DataArray array, int part) {
    if (array.association == Association::vertices) {
      array.name = unused_name(array.name, array.association);
      arrays_.push_back({std::move(array), {}});
      return arrays_.back().array.name;
    }
    const std::vector<Index>& rows = rows_[static_cast<std::size_t>(part)];
    auto found = std::find_if(arrays_.begin(), arrays_.end(), [&](const GrowingArray& growing) {
      return growing.array.association == Association::cells && growing.array.name == array.name;
    });
    if (found != arrays_.end() && array.name == kLabel &&
        found->array.values.index() != array.values.index()) {
      found->array.values = vtk::integers_of<std::int64_t>(found->array.values);
      array.values = vtk::integers_of<std::int64_t>(array.values);
    }
    if (found == arrays_.end() || !append_rows(*found, array, rows)) {
      array.name = unused_name(array.name, array.association);
      if (index_size(rows) != mesh_.cell_count() || !std::is_sorted(rows.begin(), rows.end()))
        array.indices = rows;
      arrays_.push_back({std::move(array), {}});
      return arrays_.back().array.name;
    }
    return array.name;
  }

  /// Appends the rows of an array of the same type for cells that have none; else returns false.
  bool append_rows(GrowingArray& growing, DataArray& array, const std::vector<Index>& rows) const {
    DataArray& all = growing.array;
    if (all.is_dense() || all.components != array.components || all.values.index() != array.values.index())
      return false;
    if (growing.has_row.empty()) {
      growing.has_row.assign(mesh_.cells.shapes.size(), false);
      for (const Index c : all.indices) growing.has_row[static_cast<std::size_t>(c)] = true;
    }
    if (std::any_of(rows.begin(), rows.end(),
                    [&](Index c) { return growing.has_row[static_cast<std::size_t>(c)]; }))
      return false;
    for (const Index c : rows) growing.has_row[static_cast<std::size_t>(c)] = true;
    all.indices.insert(all.indices.end(), rows.begin(), rows.end());
    std::visit(
        [&](auto& values) {
          const auto& more = std::get<std::decay_t<decltype(values)>>(array.values);
          values.insert(values.end(), more.begin(), more.end());
        },
        all.values);
    return true;
  }

  /// Makes an array that has a row for every cell a full one.
  void finish_array(GrowingArray& growing) const {
    DataArray& array = growing.array;
    if (array.is_dense() || index_size(array.indices) != mesh_.cell_count()) return;
    if (!std::is_sorted(array.indices.begin(), array.indices.end())) {
      std::visit(
          [&](auto& values) {
            auto sorted_values = values;
            const auto width = static_cast<std::size_t>(array.components);
            for (std::size_t r = 0; r < array.indices.size(); ++r) {
              std::copy_n(values.begin() + static_cast<Offset>(r * width), width,
                          sorted_values.begin() +
                              static_cast<Offset>(static_cast<std::size_t>(array.indices[r]) * width));
            }
            values = std::move(sorted_values);
          },
          array.values);
    }
    array.indices.clear();
  }

  /// Keeps what the files have beside the mesh for the writer.
  void keep_rest() {
    std::vector<std::size_t> items;
    std::map<std::string, std::set<std::string>> datasets;
    for (const Field& field : layout_->fields) {
      if (field.place.format == DataPlace::Format::hdf) {
        datasets[field.place.file].insert(field.place.dataset);
      } else {
        items.push_back(field.place.item);
      }
    }
    layout_->xml = document_.without_values(items);
    for (const auto& [name, file] : data_.files()) {
      note_other_datasets(name, file, datasets[name]);
      layout_->hdf5[name] = file.without_values(datasets[name]);
    }
    const std::size_t times = document_.root().select_nodes("//Time").size();
    if (times > 0) layout_->words.push_back(fmt::format("the times of {} steps", times));
    if (const std::size_t facts = document_.root().select_nodes("//Information").size(); facts > 0) {
      layout_->words.push_back(fmt::format("{} <Information> elements", facts));
    }
  }

  /// Notes datasets that the XML does not name, but that have as many rows as the mesh.
  void note_other_datasets(const std::string& name, const hdf5::File& file,
                           const std::set<std::string>& named) {
    std::vector<std::string> others;
    for (const auto& [path, rows] : file.datasets()) {
      const bool of_mesh =
          std::cmp_equal(rows, mesh_.vertex_count()) || std::cmp_equal(rows, mesh_.cell_count());
      if (rows > 1 && of_mesh && !named.contains(path)) others.push_back(path);
    }
    if (others.empty()) return;
    notes_.push_back(
        fmt::format("{} is kept as it is{}: the XML does not name it, but it has as many rows as the mesh "
                    "has points or cells",
                    others.front() + " in " + name,
                    others.size() > 1 ? fmt::format(" (likewise {} others)", others.size() - 1) : ""));
  }

  Document document_;
  DataReader data_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<Layout> layout_ = std::make_shared<Layout>();
  FileCells cells_;
  std::vector<std::vector<Index>> rows_;  // cells of each part, in the order of the file
  std::vector<GrowingArray> arrays_;
  std::vector<Pending> pending_;
  std::vector<bool> labelled_;  // of cells
  std::set<std::string> known_geometries_;
  std::map<std::string, int> known_topologies_;  // parts by key
  std::map<int, int> series_parts_;
  std::set<std::string> known_arrays_;
  pugi::xml_node where_cells_are_;
  std::size_t fault_at_ = 0;
};

}  // namespace

Mesh read(const FilePath& path, Notes& notes) {
  const hdf5::Session session;
  Mesh mesh = XdmfReader(path, notes).read();
  session.require_no_fault(path.string());
  return mesh;
}

}  // namespace meshorder::xdmf
