// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/hdf5/session.hpp"
#include "io/xdmf/raw.hpp"
#include "io/xdmf/reading.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

// Reads Grids and their points, and keeps what the files hold besides the mesh.

namespace meshorder::xdmf {

std::vector<pugi::xml_node> items_of(pugi::xml_node element) {
  std::vector<pugi::xml_node> items;
  for (const pugi::xml_node child : element.children("DataItem")) items.push_back(child);
  return items;
}

std::string shortened(const std::string& text) { return text.substr(0, 60); }

pugi::xml_node Reading::item_of(pugi::xml_node element) const {
  const std::vector<pugi::xml_node> items = items_of(element);
  if (items.size() != 1) {
    throw document.error(element, fmt::format("the <{}> has {} DataItems", element.name(), items.size()),
                         "one is needed");
  }
  return items.front();
}

std::string Reading::next_set_name(Association association, const std::string& wanted, int part) {
  const int number = ++set_numbers_[{association, wanted, part}];
  return number == 1 ? wanted : fmt::format("{} ({})", wanted, number);
}

std::string Reading::add_set_of_grid(const std::string& wanted, const std::vector<Index>& cells_of_grid) {
  constexpr int kOfGrid = -1;
  while (true) {
    std::string name = next_set_name(Association::cells, wanted, kOfGrid);
    const bool is_new =
        known_sets_.try_emplace({Association::cells, name}, KnownSet{mesh.sets.size(), true, {}}).second;
    if (!is_new) continue;
    mesh.sets.push_back({name, Association::cells, cells_of_grid});
    return name;
  }
}

EntitySet& Reading::set_of(Field& field) {
  const std::string wanted = field.name;
  while (true) {
    field.name = next_set_name(field.association, wanted, field.part);
    const auto [found, is_new] =
        known_sets_.try_emplace({field.association, field.name}, KnownSet{mesh.sets.size(), false, {}});
    if (is_new) mesh.sets.push_back({field.name, field.association, {}});
    KnownSet& known = found->second;
    if (!known.is_grid && known.parts.insert(field.part).second) return mesh.sets[known.place];
  }
}

namespace {

constexpr int kDeepestGrid = 8;

/// Appends the uniform Grids of a Grid, or the Grid itself, to `grids`. Throws InputError for unsupported
/// Grids, such as structured Grids.
void collect(const Document& document, pugi::xml_node grid, int depth, int& series,
             std::vector<GridElement>& grids) {
  const std::string type = attribute(grid, "GridType", "Type");
  if (type.empty() || same_but_for_case(type, "Uniform")) {
    grids.push_back({grid});
    return;
  }
  if (depth == 0) throw document.error(grid, "the Grids are nested too deeply", "a file of XDMF nests two");
  std::vector<pugi::xml_node> inner;
  for (const pugi::xml_node child : document.children(grid)) {
    if (std::string_view(child.name()) == "Grid") inner.push_back(child);
  }
  const bool collection = same_but_for_case(type, "Collection");
  if (collection && same_but_for_case(attribute(grid, "CollectionType"), "Temporal")) {
    const int own_series = series++;
    for (std::size_t step = 0; step < inner.size(); ++step) {
      const std::size_t before = grids.size();
      collect(document, inner[step], depth - 1, series, grids);
      if (grids.size() != before + 1) {
        throw document.error(inner[step], "a time step holds several Grids",
                             "save the mesh as one Grid in each step");
      }
      grids.back().series = own_series;
      grids.back().step = static_cast<int>(step);
    }
    return;
  }
  if (!collection && !same_but_for_case(type, "Tree")) {
    throw document.error(grid, fmt::format("the GridType is '{}'", shortened(type)),
                         "uniform Grids and collections of time steps are supported");
  }
  if (inner.size() != 1) {
    throw document.error(grid, "a spatial collection holds several meshes, one for each part or process",
                         "merge them into one Grid first (in ParaView: Merge Blocks, then save)");
  }
  collect(document, inner.front(), depth - 1, series, grids);
}
/// Returns the uniform Grids in order. Throws InputError unless one <Domain> has Grids that `collect`
/// accepts.
std::vector<GridElement> grids_of(const Document& document) {
  const pugi::xml_node root = document.root();
  const pugi::xml_node domain = root.child("Domain");
  if (!domain) throw document.error(root, "there is no <Domain>", "the file may be cut short");
  if (domain.next_sibling("Domain")) {
    throw document.error(domain.next_sibling("Domain"), "the file has several <Domain>s",
                         "save each as a separate file");
  }
  std::vector<GridElement> grids;
  int series = 0;
  for (const pugi::xml_node child : document.children(domain)) {
    if (std::string_view(child.name()) == "Grid") collect(document, child, kDeepestGrid, series, grids);
  }
  if (grids.empty()) throw document.error(domain, "there is no <Grid>", "the file may be cut short");
  return grids;
}

class XdmfReader {
 public:
  XdmfReader(const FilePath& path, Notes& notes) : reading_(path, notes) {
    reading_.layout->stem = path.path().stem().string();
  }

  Mesh read() {
    for (const GridElement& grid : grids_of(reading_.document)) read_grid(grid);
    finish();
    return std::move(reading_.mesh);
  }

  /// See `find_raw`.
  std::optional<RawGrid> find() {
    for (const GridElement& grid : grids_of(reading_.document)) {
      if (!find_grid(grid)) return {};
    }
    if (reading_.data.files().size() != 1) return {};
    keep_rest(raw_.vertices, raw_.cells);
    if (!reading_.notes.empty()) return {};
    const std::string& data = reading_.data.files().begin()->first;
    return RawGrid{std::move(raw_), reading_.data.path_of(reading_.document.root(), data).string(),
                   with_data(reading_.layout)};
  }

 private:
  // ---- values that are not read

  /// Adds the datasets of a Grid. Returns false if their bytes cannot be read directly.
  bool find_grid(const GridElement& grid) {
    pugi::xml_node topology;
    pugi::xml_node geometry;
    std::vector<pugi::xml_node> attributes;
    for (const pugi::xml_node child : reading_.document.children(grid.element)) {
      const std::string_view name = child.name();
      if (name == "Attribute") attributes.push_back(child);
      if (name == "Set" || (name == "Topology" && topology) || (name == "Geometry" && geometry)) return false;
      if (name == "Topology") topology = child;
      if (name == "Geometry") geometry = child;
    }
    return topology && geometry && find_points(geometry) && find_cells(topology) &&
           std::all_of(attributes.begin(), attributes.end(),
                       [&](pugi::xml_node element) { return find_array(element); });
  }

  bool find_points(pugi::xml_node geometry) {
    const std::string type = attribute(geometry, "GeometryType", "Type");
    const bool is_flat = same_but_for_case(type, "XY");
    if ((!is_flat && !type.empty() && !same_but_for_case(type, "XYZ")) || items_of(geometry).size() != 1)
      return false;
    return find_values(reading_.item_of(geometry), Field::Role::points, Association::vertices,
                       is_flat ? 2 : 3);
  }

  bool find_cells(pugi::xml_node topology) {
    const TopologyType* const type = topology_type(attribute(topology, "TopologyType", "Type"));
    if (type == nullptr || type->nodes == 0 || vtk::may_be_reordered(static_cast<std::uint8_t>(type->vtk)) ||
        !topology.attribute("Order").empty() ||
        reading_.document.whole_number<int>(topology, "BaseOffset", 0) != 0 ||
        items_of(topology).size() != 1) {
      return false;
    }
    const bool is_first = raw_.parts.size() < 2;
    const bool is_found =
        find_values(reading_.item_of(topology), Field::Role::connectivity, Association::cells, type->nodes);
    if (!is_found || (!is_first && type->shape != raw_.shape)) return false;
    raw_.shape = type->shape;
    const std::string announced = attribute(topology, "NumberOfElements", "Dimensions");
    std::string_view rest = announced;
    const std::string_view cells = next_word(rest);
    std::int64_t count = 0;
    return cells.empty() || (parse_xml_number(cells, count) && count == raw_.cells);
  }

  bool find_array(pugi::xml_node element) {
    std::string center = attribute(element, "Center");
    if (center.empty()) center = "Node";
    if (same_but_for_case(attribute(element, "ItemType"), "FiniteElementFunction") ||
        items_of(element).size() != 1 || element.attribute("Name").empty()) {
      return false;
    }
    const pugi::xml_node item = reading_.item_of(element);
    if (same_but_for_case(center, "Grid"))  // a value of the whole Grid is kept as it is
      return reading_.data.place_of(item).format != DataPlace::Format::binary;
    const bool on_vertices = same_but_for_case(center, "Node");
    if (!on_vertices && !same_but_for_case(center, "Cell")) return false;
    return find_values(item, Field::Role::data, on_vertices ? Association::vertices : Association::cells, 0);
  }

  /// Adds the dataset of a DataItem as rows of `components` numbers; 0: the number of values per
  /// point or cell. The first call must be for the points, the second for the topology; other Grids must
  /// name the same datasets. Returns false if the bytes of the dataset cannot be read directly.
  bool find_values(pugi::xml_node item, Field::Role role, Association association, Index components) {
    constexpr std::size_t kLastReal = 1;
    constexpr std::size_t kInt32 = 6;
    DataPlace place = reading_.data.place_of(item);
    if (place.format != DataPlace::Format::hdf) return false;
    const auto count = static_cast<std::int64_t>(place.count());
    if (count == 0) return false;
    if (components == 0) {
      const std::int64_t rows = association == Association::vertices ? raw_.vertices : raw_.cells;
      if (count % rows != 0 || count / rows > kMaxIndex) return false;
      components = static_cast<Index>(count / rows);
    }
    const std::int64_t rows = count / components;
    if (count % components != 0 || rows > kMaxIndex) return false;
    const auto known = std::find(raw_.names.begin(), raw_.names.end(), place.dataset);
    if (known != raw_.names.end()) {
      const FilePart& part = raw_.parts[known - raw_.names.begin()];
      return part.role == role && part.association == association;
    }
    FilePart part{role, association, static_cast<std::uint8_t>(place.alternative), components, rows};
    // accept only one mesh, with real coordinates and indices of 32 bits or more
    if (role == Field::Role::points) {
      if (!raw_.parts.empty() || place.alternative > kLastReal) return false;
      raw_.vertices = rows;
    } else if (role == Field::Role::connectivity) {
      if (raw_.parts.size() != 1 || place.alternative < kInt32) return false;
      raw_.cells = rows;
      raw_.nodes = components;
      raw_.entries = part.rows = count;
      part.components = 1;
    }
    const std::optional<std::uint64_t> byte =
        reading_.data.files().at(place.file).place_of_values(place.dataset);
    if (!byte) return false;
    part.number = raw_.names.size();
    part.at = static_cast<std::int64_t>(*byte);
    part.stored = part.size();
    raw_.parts.push_back(part);
    raw_.names.push_back(place.dataset);
    Field& field = reading_.layout->fields.emplace_back(Field{role, std::move(place)});
    field.association = association;
    return true;
  }

  // ---- Grids

  void read_grid(const GridElement& grid) {
    const std::vector<pugi::xml_node> children = reading_.document.children(grid.element);
    const auto only = [&](std::string_view name) {
      pugi::xml_node found;
      for (const pugi::xml_node child : children) {
        if (child.name() != name) continue;
        if (found)
          throw reading_.document.error(child, fmt::format("a Grid has a second <{}>", name),
                                        "one is needed");
        found = child;
      }
      if (!found) {
        throw reading_.document.error(grid.element, fmt::format("the Grid has no <{}>", name),
                                      "each Grid has its own or includes that of another");
      }
      return found;
    };
    const pugi::xml_node topology = only("Topology");
    read_points(grid, only("Geometry"));
    const int part = topologies_.read(grid, topology);
    for (const pugi::xml_node child : children) {
      const std::string_view name = child.name();
      if (name == "Attribute") arrays_.read_attribute(grid, part, child);
      if (name == "Set") arrays_.read_set(part, child);
    }
  }

  // ---- points

  /// Returns the coordinates of a Geometry; `fields` receives the fields that describe them.
  std::vector<Point> points_of(pugi::xml_node geometry, std::vector<Field>& fields, int& dimension) {
    std::string type = attribute(geometry, "GeometryType", "Type");
    if (type.empty()) type = "XYZ";
    const bool separate = same_but_for_case(type, "X_Y_Z") || same_but_for_case(type, "X_Y");
    if (!separate && !same_but_for_case(type, "XYZ") && !same_but_for_case(type, "XY")) {
      throw reading_.document.error(geometry, fmt::format("the GeometryType is '{}'", shortened(type)),
                                    "XYZ, XY, X_Y_Z and X_Y are supported; other Grids are structured");
    }
    dimension = same_but_for_case(type, "XY") || same_but_for_case(type, "X_Y") ? 2 : 3;
    const std::vector<pugi::xml_node> items = items_of(geometry);
    const std::size_t needed = separate ? static_cast<std::size_t>(dimension) : 1;
    if (items.size() != needed) {
      throw reading_.document.error(geometry, fmt::format("the Geometry has {} DataItems", items.size()),
                                    fmt::format("{} are needed for {}", needed, type));
    }
    std::vector<Point> points;
    const std::size_t width = separate ? 1 : static_cast<std::size_t>(dimension);
    for (std::size_t i = 0; i < items.size(); ++i) {
      Field field{Field::Role::points, reading_.data.place_of(items[i])};
      field.axis = separate ? static_cast<int>(i) : -1;
      const Values values = reading_.data.read(field.place);
      const std::size_t count = size_of(values) / width;
      if (size_of(values) % width != 0 || (i > 0 && count != points.size())) {
        throw reading_.document.error(items[i], fmt::format("the Geometry has {} values", size_of(values)),
                                      fmt::format("{} for each point are needed", dimension));
      }
      if (count > static_cast<std::size_t>(kMaxIndex)) {
        throw reading_.document.error(items[i], "the Grid has too many points",
                                      "at most 2147483647 are possible");
      }
      resize_large(points, count);
      with_numbers(values, [&](const auto& numbers) {
        for (std::size_t k = 0; k < numbers.size(); ++k) {
          const auto x = static_cast<double>(numbers[k]);
          if (!std::isfinite(x)) {
            throw reading_.document.error(
                items[i],
                fmt::format("point {} (counted from 0) has a coordinate that is not finite", k / width),
                "finite numbers are needed");
          }
          points[k / width][separate ? i : k % width] = x;
        }
      });
      fields.push_back(std::move(field));
    }
    return points;
  }

  void read_points(const GridElement& grid, pugi::xml_node geometry) {
    std::string key;
    for (const pugi::xml_node item : items_of(geometry)) key += key_of(reading_.data.place_of(item)) + "\n";
    std::vector<Field>& known_fields = reading_.layout->fields;
    const auto [known, is_new] = known_geometries_.try_emplace(key, known_fields.size());
    if (!is_new) {
      std::size_t field = known->second;
      for (const pugi::xml_node item : items_of(geometry))
        known_fields[field++].place.repeat(reading_.data.place_of(item));
      return;
    }
    std::vector<Field> fields;
    int dimension = 3;
    std::vector<Point> points = points_of(geometry, fields, dimension);
    const bool first = known_geometries_.size() == 1;
    if (first) {
      reading_.mesh.points = std::move(points);
      reading_.mesh.dimension = dimension;
    } else if (points != reading_.mesh.points) {
      if (grid.series < 0 || points.size() != reading_.mesh.points.size()) {
        throw reading_.document.error(
            geometry, "the Grid has other points than the first",
            "several meshes in one file are not supported: save each as a separate file");
      }
      return arrays_.add_moved_points(grid, fields, std::move(points), dimension);
    }
    known_fields.insert(known_fields.end(), fields.begin(), fields.end());
  }

  // ---- the mesh

  void finish() {
    reading_.layout->inward_wedges = vtk::take_cells(
        reading_.mesh, reading_.cells,
        [&](const std::string& what, const std::string& remedy) {
          return reading_.document.error(reading_.where_cells_are, what, remedy);
        },
        reading_.notes);
    if (reading_.mesh.cell_blocks.size() == 1) reading_.mesh.cell_blocks.clear();
    arrays_.finish();
    check_elements();
    keep_rest(reading_.mesh.vertex_count(), reading_.mesh.cell_count());
    reading_.mesh.format_metadata = reading_.layout;
  }

  /// Throws if references make one element part of two Grids with different cells.
  void check_elements() const {
    std::set<std::size_t> items;
    const auto check = [&](std::size_t named_by) {
      if (items.insert(named_by).second) return;
      const pugi::xml_node element = reading_.document.item(named_by).parent();
      throw reading_.document.error(
          element, fmt::format("the <{}> is referred to by a Grid with other cells", element.name()),
          "write it twice, in each of the Grids");
    };
    for (const Field& field : reading_.layout->fields) {
      check(field.place.named_by);
      for (const DataPlace::Repeat& repeat : field.place.repeats) check(repeat.named_by);
    }
  }

  /// Keeps for the writer what the files hold besides the mesh.
  void keep_rest(std::int64_t vertices, std::int64_t cells) {
    std::vector<std::size_t> items;
    std::map<std::string, std::set<std::string>> datasets;
    for (const Field& field : reading_.layout->fields) {
      if (field.place.format == DataPlace::Format::hdf) {
        datasets[field.place.file].insert(field.place.dataset);
      } else {
        items.push_back(field.place.item);
      }
    }
    reading_.layout->xml = reading_.document.take_values_out(std::move(items));
    for (const auto& [name, file] : reading_.data.files()) {
      note_other_datasets(name, file, datasets[name], {vertices, cells});
      reading_.layout->hdf5[name] = file.without_values(datasets[name]);
    }
    const std::size_t times = reading_.document.root().select_nodes("//Time").size();
    if (times > 0) reading_.layout->words.push_back(fmt::format("the times of {} steps", times));
    if (const std::size_t facts = reading_.document.root().select_nodes("//Information").size(); facts > 0) {
      reading_.layout->words.push_back(fmt::format("{} <Information> elements", facts));
    }
  }

  /// Notes datasets that the XML does not name, but that have as many rows as the mesh has points or cells.
  void note_other_datasets(const std::string& name, const hdf5::File& file,
                           const std::set<std::string>& named, std::array<std::int64_t, 2> counts) {
    std::vector<std::string> others;
    for (const auto& [path, rows] : file.datasets()) {
      const bool of_mesh = std::cmp_equal(rows, counts[0]) || std::cmp_equal(rows, counts[1]);
      if (rows > 1 && of_mesh && !named.contains(path)) others.push_back(path);
    }
    if (others.empty()) return;
    std::string more;
    if (others.size() > 1) more = fmt::format(" (likewise {} more)", others.size() - 1);
    reading_.notes.push_back(
        fmt::format("{} is kept as it is{}: the XML does not name it, but it has as many rows as the mesh "
                    "has points or cells",
                    others.front() + " in " + name, more));
  }

  Reading reading_;
  FileLayout raw_;
  TopologyReader topologies_{reading_};
  ArrayReader arrays_{reading_};
  std::map<std::string, std::size_t> known_geometries_;  // index of a geometry's first field, by key
};

}  // namespace

std::optional<RawGrid> find_raw(const FilePath& path) {
  Notes notes;
  return hdf5::read_whole(path.string(), [&] { return XdmfReader(path, notes).find(); });
}

Mesh read(const FilePath& path, Notes& notes) {
  return hdf5::read_whole(path.string(), [&] { return XdmfReader(path, notes).read(); });
}

}  // namespace meshorder::xdmf
