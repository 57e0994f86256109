// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/hdf5/session.hpp"
#include "io/labels.hpp"
#include "io/med/med.hpp"
#include "io/stream/id_map.hpp"
#include "io/wedges.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <variant>

// Reads a file: the mesh, its numbers and names, and the pairs of equivalences.

namespace meshorder::med {

Reading::Reading(const FilePath& path, Notes& warnings) : file(hdf5::File::open(path)), notes(warnings) {}

void Reading::fail(const std::string& path, const std::string& what, const std::string& remedy) const {
  throw InputError(file.name(), fmt::format("'{}' {}", path, what), remedy);
}

std::string Reading::add_array(DataArray array) {
  std::vector<Index>& items = array.indices;
  if (!std::is_sorted(items.begin(), items.end())) {
    std::vector<Index> rows = index_range(0, index_size(items));
    std::sort(rows.begin(), rows.end(), [&](Index a, Index b) { return items[a] < items[b]; });
    array.values = rows_of_values(array.values, array.components, rows);
    std::sort(items.begin(), items.end());
  }
  make_dense(array, item_count(mesh, array.association));
  return add_named(mesh, std::move(array), arrays_);
}

std::string utf8(std::string text) {
  if (is_utf8(text)) return text;
  std::string result;
  for (const char c : text) {
    const auto one = static_cast<unsigned char>(c);
    if (one < 0x80) {
      result += static_cast<char>(one);
    } else {
      result += static_cast<char>(0xC0U | (one >> 6U));
      result += static_cast<char>(0x80U | (one & 0x3FU));
    }
  }
  return result;
}

namespace {

constexpr std::string_view kCutCells = "cut them into cells with a fixed number of nodes first";

/// Returns whether the group of a step has nodes or cells of the mesh.
bool has_mesh(const hdf5::File& file, const std::string& step) {
  return file.has(step + "/NOE/COO") || !file.names(step + "/MAI").empty();
}

void check_version(const Reading& reading) {
  const auto major = reading.file.integer_attribute("/INFOS_GENERALES", "MAJ");
  if (major && *major < 3) {
    throw InputError(reading.file.name(), fmt::format("is of version {} of MED", *major),
                     "write it in version 3 or 4 with medimport of the MED library");
  }
}

/// Finds the mesh and its step.
void find_mesh(Reading& reading) {
  const hdf5::File& file = reading.file;
  check_version(reading);
  std::vector<std::string> meshes;
  std::vector<std::string> structured;
  for (const std::string& name : file.names("/ENS_MAA")) {
    const bool is_structured = file.integer_attribute("/ENS_MAA/" + name, "TYP").value_or(0) == 1;
    (is_structured ? structured : meshes).push_back(name);
  }
  if (meshes.empty() && !structured.empty()) {
    reading.fail("/ENS_MAA/" + structured.front(), "is structured",
                 "its order is fixed by the grid; nothing to reorder");
  }
  if (meshes.empty()) {
    throw InputError(file.name(), "has no mesh", "a file of MED has its meshes in the group ENS_MAA");
  }
  if (meshes.size() > 1) {
    throw InputError(file.name(), fmt::format("has {} meshes: {}", meshes.size(), fmt::join(meshes, ", ")),
                     "save each in a separate file");
  }
  MedLayout& layout = *reading.layout;
  layout.mesh = meshes.front();
  if (!structured.empty()) {
    reading.notes.push_back(fmt::format("the mesh '{}' is read; structured ones stay as they are: {}",
                                        layout.mesh, fmt::join(structured, ", ")));
  }
  const std::string mesh = layout.mesh_path();
  std::vector<std::string> steps;
  for (const std::string& name : file.names(mesh)) {
    if (has_mesh(file, fmt::format("{}/{}", mesh, name))) steps.push_back(name);
  }
  if (steps.empty()) reading.fail(mesh, "has no nodes");
  if (steps.size() > 1) {
    reading.fail(mesh, fmt::format("changes over {} steps", steps.size()),
                 "save one of its steps in a separate file");
  }
  layout.step = steps.front();
}

/// Refuses meshes described by faces or edges, and pieces of a larger mesh.
void refuse_unknown_kinds(const Reading& reading) {
  const MedLayout& layout = *reading.layout;
  const std::string step = layout.step_path();
  for (const auto& [group, words] : {std::pair{"FAC", "faces"}, std::pair{"ARE", "edges"}}) {
    if (reading.file.names(step + "/" + group).empty()) continue;
    reading.fail(step + "/" + group, fmt::format("describes its cells by {}", words),
                 "write the cells by their nodes");
  }
  for (const std::string& joints : {"/JNT/" + layout.mesh, layout.mesh_path() + "/JNT"}) {
    if (reading.file.names(joints).empty()) continue;
    reading.fail(joints, "says that the mesh is a piece of a larger one",
                 "order the whole mesh before it is divided");
  }
}

/// Returns the number of rows of `width` values in a dataset.
Index row_count_of(const Reading& reading, const std::string& path, std::size_t width) {
  const std::uint64_t size = reading.file.info(path).size();
  if (size % width != 0) {
    reading.fail(path, fmt::format("has {} values, which do not make rows of {}", size, width));
  }
  if (size / width > static_cast<std::uint64_t>(kMaxIndex)) {
    reading.fail(path, fmt::format("has {} rows", size / width), "at most 2,147,483,647 are possible");
  }
  return static_cast<Index>(size / width);
}

void read_points(Reading& reading) {
  MedLayout& layout = *reading.layout;
  Mesh& mesh = reading.mesh;
  const auto axes = reading.file.integer_attribute(layout.mesh_path(), "ESP").value_or(3);
  if (axes < 1 || axes > 3) {
    reading.fail(layout.mesh_path(), fmt::format("has points of {} coordinates", axes),
                 "1, 2 and 3 are possible");
  }
  layout.axes = static_cast<int>(axes);
  mesh.dimension = axes == 3 ? 3 : 2;
  const std::string path = layout.path_of(nullptr) + "/COO";
  const auto width = static_cast<std::size_t>(axes);
  const Index count = row_count_of(reading, path, width);
  reading.take(path);
  const Values values = reading.file.read(path);
  resize_large(mesh.points, static_cast<std::size_t>(count));
  reading.ranges[nullptr] = {0, count};
  with_numbers(values, [&](const auto& numbers) {
    for (std::size_t k = 0; k < width; ++k) {
      const auto* const axis = numbers.data() + k * mesh.points.size();
      for (std::size_t v = 0; v < mesh.points.size(); ++v) mesh.points[v][k] = static_cast<double>(axis[v]);
    }
  });
}

/// Throws for a group of unsupported cells.
[[noreturn]] void fail_at_type(const Reading& reading, const std::string& path, const std::string& name) {
  if (name == "POG" || name == "POG2") reading.fail(path, "has polygons", std::string(kCutCells));
  if (name == "POE") reading.fail(path, "has polyhedra", std::string(kCutCells));
  if (name == "O12") reading.fail(path, "has hexagonal prisms", "cut them into wedges first");
  reading.fail(
      path, "has cells of an unknown type",
      "points, lines, triangles, quadrilaterals, tetrahedra, pyramids, wedges and hexahedra of first "
      "and second order are supported");
}

/// Appends the cells of a type, with the nodes in the file's order.
void read_cells(Reading& reading, const GeometryType& type) {
  const std::string group = reading.layout->path_of(&type);
  const std::string path = group + "/NOD";
  if (!reading.file.has(path) && reading.file.has(group + "/DES")) {
    reading.fail(group, "describes its cells by faces and edges", "write the cells by their nodes");
  }
  const std::string profile = reading.file.text_attribute(group, "PFL").value_or(std::string(kNoProfile));
  if (!profile.empty() && profile != kNoProfile) {
    reading.fail(group, fmt::format("has only the cells of the profile '{}'", profile),
                 "save the mesh as one that does not change");
  }
  const auto nodes = static_cast<std::size_t>(type.nodes);
  const Index count = row_count_of(reading, path, nodes);
  reading.take(path);
  Cells& cells = reading.mesh.cells;
  const Index first = cells.size();
  if (count > kMaxIndex - first) {
    reading.fail(path, "has too many cells", "a mesh has at most 2,147,483,647 cells");
  }
  const std::vector<Index> numbers = reading.file.read_indices(path);
  const auto last = static_cast<std::uint32_t>(reading.mesh.vertex_count());
  const std::size_t begin = cells.vertices.size();
  const auto rows = static_cast<std::size_t>(count);
  resize_large(cells.vertices, begin + rows * nodes);
  for (std::size_t k = 0; k < nodes; ++k) {
    const Index* const column = numbers.data() + k * rows;
    Index* const target = cells.vertices.data() + begin + k;
    for (std::size_t c = 0; c < rows; ++c) {
      // numbers below 1 become large, as the type is unsigned
      const std::uint32_t place = static_cast<std::uint32_t>(column[c]) - 1;
      if (place >= last) {
        reading.fail(path, fmt::format("names node {} in cell {}, which does not exist", column[c], c + 1),
                     fmt::format("the nodes are 1 to {}", last));
      }
      target[c * nodes] = static_cast<Index>(place);
    }
  }
  cells.shapes.insert(cells.shapes.end(), rows, type.shape);
  reserve_large(cells.offsets, cells.offsets.size() + rows);
  for (Offset end = cells.offsets.back() + type.nodes; cells.offsets.size() <= cells.shapes.size();
       end += type.nodes) {
    cells.offsets.push_back(end);
  }
  if (count > 0) reading.mesh.cell_blocks.push_back(first);
  reading.ranges[&type] = {first, count};
}

/// Puts the nodes of a cell in the order of a Mesh.
void turn(std::span<Index> cell, std::span<const int> order) {
  std::array<Index, 27> of_file{};
  std::copy(cell.begin(), cell.end(), of_file.begin());
  for (std::size_t k = 0; k < cell.size(); ++k) cell[static_cast<std::size_t>(order[k])] = of_file[k];
}

/// Puts the nodes of all cells in the order of a Mesh. Some programs write that order into the file: if
/// nearly all volumes are positive in the file's order, the nodes stay.
void turn_cells(Reading& reading) {
  Mesh& mesh = reading.mesh;
  WedgeVote vote(mesh.points);
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const std::span<const Index> cell = std::as_const(mesh.cells)[c];
    const Shape shape = mesh.cells.shapes[c];
    vote.add(shape, cell.first(static_cast<std::size_t>(corners(shape, static_cast<int>(cell.size())))));
  }
  reading.layout->in_mesh_order = vote.sign_of_volumes() > 0;
  if (reading.layout->in_mesh_order) {
    reading.notes.push_back(
        "the nodes of volumes have the sequence of meshio, not that of the MED library; MED files keep it");
    return;
  }
  for (const auto& [type, range] : reading.ranges) {
    if (type == nullptr || mesh_order(*type).empty()) continue;
    for (Index c = range.first; c < range.first + range.count; ++c) turn(mesh.cells[c], mesh_order(*type));
  }
}

void read_all_cells(Reading& reading) {
  const std::string path = reading.layout->cells_path();
  for (const std::string& name : reading.file.names(path)) {
    if (geometry_type(name) == nullptr) fail_at_type(reading, fmt::format("{}/{}", path, name), name);
  }
  for (const GeometryType& type : geometry_types()) {
    if (reading.file.has(reading.layout->path_of(&type))) read_cells(reading, type);
  }
  turn_cells(reading);
}

/// Returns the whole numbers of a dataset; throws if their count is not `rows`.
std::vector<std::int64_t> read_numbers(Reading& reading, const std::string& path, Index rows) {
  reading.take(path);
  const Values values = reading.file.read(path);
  std::vector<std::int64_t> result;
  with_integers(values, [&](const auto& numbers) { result.assign(numbers.begin(), numbers.end()); });
  if (index_size(result) != rows) {
    reading.fail(path, fmt::format("has {} whole numbers, not {}", result.size(), rows));
  }
  return result;
}

bool are_unique(std::vector<std::int64_t> numbers) {
  // most files give the numbers in order
  const auto descends = [](std::int64_t number, std::int64_t next) { return number >= next; };
  if (std::adjacent_find(numbers.begin(), numbers.end(), descends) == numbers.end()) return true;
  std::sort(numbers.begin(), numbers.end());
  return std::adjacent_find(numbers.begin(), numbers.end()) == numbers.end();
}

/// Appends the values of consecutive vertices or cells to an array.
void append(DataArray& array, Values values, Index first) {
  std::vector<Index>& items = array.indices;
  const std::size_t before = items.size();
  items.resize(before + size_of(values));
  std::iota(items.begin() + static_cast<std::ptrdiff_t>(before), items.end(), first);
  if (before == 0) {
    array.values = std::move(values);
  } else {
    append_values(array.values, std::move(values));
  }
}

/// Reads the data, besides coordinates and nodes, of vertices or of cells of each type.
class ItemReader {
 public:
  ItemReader(Reading& reading, Association association) : reading_(reading), association_(association) {}

  void read(const GeometryType* type) {
    const std::string group = reading_.layout->path_of(type);
    const auto [first, count] = range_in(reading_.ranges, type);
    if (count == 0) return;
    Items& items = reading_.layout->items[type];
    const hdf5::File& file = reading_.file;
    if (file.has(group + "/NUM")) {
      std::vector<std::int64_t> numbers = read_numbers(reading_, group + "/NUM", count);
      items.has_numbers = are_unique(numbers);
      if (items.has_numbers) {
        append(numbers_, std::move(numbers), first);
      } else {
        reading_.notes.push_back(fmt::format("'{}/NUM' gives a number twice and is left out", group));
      }
    }
    if (file.has(group + "/GLB")) {
      append(global_numbers_, read_numbers(reading_, group + "/GLB", count), first);
    }
    if ((items.has_families = file.has(group + "/FAM"))) {
      append(families_, read_numbers(reading_, group + "/FAM", count), first);
    }
    if (file.has(group + "/NOM")) {
      reading_.take(group + "/NOM");
      std::vector<std::string> names = file.read_texts(group + "/NOM");
      for (std::string& name : names) name = utf8(std::move(name));
      if (index_size(names) != count) {
        reading_.fail(group + "/NOM", fmt::format("has {} names, not {}", names.size(), count));
      }
      append(names_, std::move(names), first);
    }
  }

  void finish() {
    if (!numbers_.indices.empty()) make_ids();
    add_array(std::string(kNames), std::move(names_));
    add_array(std::string(kGlobalNumbers), std::move(global_numbers_));
    const bool any = with_integers(families_.values, [](const auto& families) {
      return std::any_of(families.begin(), families.end(), [](auto family) { return family != 0; });
    });
    if (any) add_array(reading_.layout->families_array, std::move(families_));
  }

 private:
  /// Makes the ids from the numbers of the file. Cells of types without numbers get 1, 2, … for each type.
  void make_ids() {
    Mesh& mesh = reading_.mesh;
    const auto& numbers = std::get<std::vector<std::int64_t>>(numbers_.values);
    if (association_ == Association::vertices) {
      IdMap ids;
      for (const std::int64_t number : numbers) ids.add(number);
      mesh.vertex_ids = ids.ids_unless_from(1);
      return;
    }
    mesh.cell_ids.resize(mesh.cells.shapes.size());
    for (const auto& [type, range] : reading_.ranges) {
      if (type == nullptr) continue;
      const auto begin = mesh.cell_ids.begin() + range.first;
      std::iota(begin, begin + range.count, std::int64_t{1});
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) mesh.cell_ids[numbers_.indices[i]] = numbers[i];
  }

  void add_array(std::string name, DataArray array) {
    if (array.indices.empty()) return;
    array.name = std::move(name);
    array.association = association_;
    if (auto* const numbers = std::get_if<std::vector<std::int64_t>>(&array.values)) {
      array.values = label_values(std::move(*numbers));
    }
    reading_.add_array(std::move(array));
  }

  Reading& reading_;
  Association association_;
  DataArray numbers_;
  DataArray global_numbers_;
  DataArray families_;
  DataArray names_;
};

void read_items(Reading& reading) {
  ItemReader vertices(reading, Association::vertices);
  vertices.read(nullptr);
  vertices.finish();
  ItemReader cells(reading, Association::cells);
  // read types in the order of the cells
  for (const GeometryType& type : geometry_types()) cells.read(&type);
  cells.finish();
}

void read_equivalence(Reading& reading, const std::string& group) {
  const std::string name = group.substr(group.rfind('/') + 1);
  const GeometryType* const type = name.starts_with("MAI.") ? geometry_type(name.substr(4)) : nullptr;
  if (name != "NOE" && type == nullptr) {
    reading.fail(group, "pairs items that are neither nodes nor cells",
                 "only pairs of nodes or of cells are supported");
  }
  Equivalence equivalence{group + "/COR", type};
  const Index pairs = row_count_of(reading, equivalence.dataset, 2);
  reading.take(equivalence.dataset);
  const auto [first, count] = range_in(reading.ranges, type);
  equivalence.members = reading.file.read_indices(equivalence.dataset);
  for (Index& member : equivalence.members) {
    if (member < 1 || member > count) {
      reading.fail(equivalence.dataset, fmt::format("names item {}, which does not exist", member),
                   fmt::format("there are {}", count));
    }
    member += first - 1;
  }
  if (pairs > 0) reading.layout->equivalences.push_back(std::move(equivalence));
}

void read_equivalences(Reading& reading) {
  const hdf5::File& file = reading.file;
  const std::string root = "/EQS/" + reading.layout->mesh;
  const std::vector<std::string> names = file.names(root);
  for (const std::string& name : names) {
    for (const std::string& step : file.names(fmt::format("{}/{}", root, name))) {
      const std::string group = fmt::format("{}/{}/{}", root, name, step);
      for (const std::string& items : file.names(group))
        read_equivalence(reading, fmt::format("{}/{}", group, items));
    }
  }
  if (!names.empty())
    reading.layout->words.push_back(fmt::format("the equivalences {}", fmt::join(names, ", ")));
}

/// Notes the datasets of the mesh that are not supported and stay as they are.
void note_others(Reading& reading) {
  const std::string step = reading.layout->step_path() + "/";
  for (const auto& [path, rows] : reading.file.datasets()) {
    if (!path.starts_with(step) || reading.taken.contains(path)) continue;
    // numbers that are not unique were left out
    if (path.ends_with("/NUM")) {
      reading.take(path);
      continue;
    }
    reading.notes.push_back(fmt::format("'{}' is not supported and stays as it is in MED files", path));
  }
}

void read_description(Reading& reading) {
  const std::string text = reading.file.text_attribute(reading.layout->mesh_path(), "DES").value_or("");
  if (!text.empty() && text.find_first_not_of(' ') != std::string::npos) {
    reading.layout->words.push_back(fmt::format("the description '{}'", utf8(text)));
  }
}

Mesh read_all(const FilePath& path, Notes& notes) {
  Reading reading(path, notes);
  find_mesh(reading);
  refuse_unknown_kinds(reading);
  read_points(reading);
  read_all_cells(reading);
  read_description(reading);
  const std::string fields = "/CHA/" + std::string(kLabel);
  if (reading.file.has(fields)) reading.layout->families_array = kFamilies;
  read_items(reading);
  read_families(reading);
  read_fields(reading);
  read_equivalences(reading);
  note_others(reading);
  MedLayout& layout = *reading.layout;
  std::set<std::string> changing = std::move(reading.taken);
  for (const std::string& group :
       {std::string("/CHA"), std::string("/PROFILS"), layout.cells_path(),
        layout.families_path(Association::vertices), layout.families_path(Association::cells)}) {
    changing.insert(group + "/");
  }
  layout.file = std::make_shared<const std::string>(reading.file.without_values(changing, H5_ITER_NATIVE));
  reading.mesh.format_metadata = reading.layout;
  return std::move(reading.mesh);
}

}  // namespace

Mesh read(const FilePath& path, Notes& notes) {
  return hdf5::read_whole(path.string(), [&] { return read_all(path, notes); });
}

}  // namespace meshorder::med
