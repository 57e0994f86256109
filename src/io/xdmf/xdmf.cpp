// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/xdmf/xdmf.hpp"

#include "base/checksum.hpp"
#include "base/index.hpp"
#include "base/large_pages.hpp"
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/hdf5/session.hpp"
#include "io/stream/output_file.hpp"
#include "io/unsupported.hpp"
#include "io/vtk/vtk.hpp"
#include "io/xdmf/document.hpp"
#include "io/xdmf/raw.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <type_traits>
#include <utility>

namespace meshorder::xdmf {
namespace {

using Format = DataPlace::Format;

constexpr std::string_view kSetName = "set:";

bool is_text(const Values& values) { return std::holds_alternative<std::vector<std::string>>(values); }

std::size_t size_of(const Values& values) {
  return std::visit([](const auto& numbers) { return numbers.size(); }, values);
}

/// Returns what stands for a value that an array does not give.
template <class Number>
Number nothing() {
  if constexpr (std::is_floating_point_v<Number>) return std::numeric_limits<Number>::quiet_NaN();
  return Number{};
}

bool is_identity(const std::vector<Index>& rows, Index count) {
  if (index_size(rows) != count) return false;
  for (Index i = 0; i < count; ++i) {
    if (rows[static_cast<std::size_t>(i)] != i) return false;
  }
  return true;
}

/// Returns the name of an AttributeType for values of so many components.
std::string_view attribute_type(Index components) {
  switch (components) {
    case 1:
      return "Scalar";
    case 2:
    case 3:
      return "Vector";
    case 6:
      return "Tensor6";
    case 9:
      return "Tensor";
    default:
      return "Matrix";
  }
}

/// Sets the one of two attributes that is there, else adds the first.
void set_either(pugi::xml_node element, const char* name, const char* other, const std::string& value) {
  set_attribute(element, element.attribute(other) && !element.attribute(name) ? other : name, value);
}

/// An HDF5 file that is being written.
struct Hdf5Output {
  std::string name;  ///< in the new XML
  std::unique_ptr<OutputFile> out;
  std::unique_ptr<hdf5::File> file;
  std::set<std::string> datasets;
  int next_array = 0;  ///< lowest number that an array without a name of its own may have
};

class XdmfWriter {
 public:
  /// `rows`: the cells of each part.
  XdmfWriter(const Mesh& mesh, const Layout& layout, std::vector<std::vector<Index>> rows,
             const FilePath& path, Notes& notes)
      : mesh_(mesh),
        layout_(layout),
        path_(path),
        stem_(path.path().stem().string()),
        notes_(notes),
        rows_(std::move(rows)) {
    parse(xml_, layout.xml);
    items_ = elements_named(xml_, "DataItem");
    grids_ = elements_named(xml_, "Grid");
  }

  void write() {
    OutputFile xml(path_);
    open_files();
    for (const Field& field : layout_.fields) write_field(field);
    remove_gone();
    add_others();
    rename_files();
    mark_files(mark_of_mesh());
    for (auto& [name, output] : files_) finish(output);

    put_xml([&](std::string_view part) { xml.write(part); });
    std::vector<OutputFile> all;
    all.reserve(1 + files_.size() + binaries_.size());
    all.push_back(std::move(xml));
    for (auto& [name, output] : files_) all.push_back(std::move(*output.out));
    for (OutputFile& binary : binaries_) all.push_back(std::move(binary));
    OutputFile::commit_all(all);
  }

  /// See the function of that name.
  std::string write_without_values(const std::filesystem::path& data, const std::string& mark) {
    const auto& [old_name, bytes] = *layout_.hdf5.begin();
    Hdf5Output output;
    output.name = new_name(old_name);
    const std::string name = path_.beside(output.name).string();
    if (!std::ofstream(data, std::ios::binary).write(bytes.data(), std::ssize(bytes)).flush())
      throw InputError(name, "cannot be written", "the disk may be full");
    output.file = std::make_unique<hdf5::File>(hdf5::File::change(data, name));
    hdf5::File& file = *files_.emplace(old_name, std::move(output)).first->second.file;
    for (const Field& field : layout_.fields) {
      file.give_room(field.place.dataset);
      if (field.role == Field::Role::topology) announce_cells_of(field);
    }
    rename_files();
    mark_files(mark);
    file.close();
    std::string xml;
    put_xml([&](std::string_view part) { xml += part; });
    return xml;
  }

  /// Returns the name of the file that takes the place of one of the old XML: both named after their .xdmf.
  [[nodiscard]] std::string new_name(const std::string& old_name) const {
    const std::filesystem::path old(old_name);
    const std::string extension = old.extension().empty() ? ".h5" : old.extension().string();
    std::string rest = old.stem().string();
    if (layout_.hdf5.size() == 1) {
      rest.clear();
    } else if (rest.starts_with(layout_.stem)) {
      rest.erase(0, layout_.stem.size());
    } else {
      rest.insert(0, "_");
    }
    std::string name = stem_ + rest + extension;
    const auto is_taken = [&] {
      return std::any_of(files_.begin(), files_.end(),
                         [&](const auto& file) { return file.second.name == name; });
    };
    for (int k = 2; is_taken(); ++k) name = fmt::format("{}{}_{}{}", stem_, rest, k, extension);
    return name;
  }

 private:
  // ---- files

  void open_files() {
    for (const auto& [old_name, bytes] : layout_.hdf5) {
      Hdf5Output output;
      output.name = new_name(old_name);
      const FilePath target = path_.beside(output.name);
      output.out = std::make_unique<OutputFile>(target);
      if (target.store() != nullptr) {
        output.file = std::make_unique<hdf5::File>(hdf5::File::in_memory(bytes, target.string()));
      } else {
        output.out->write(bytes);
        output.out->close();
        output.file =
            std::make_unique<hdf5::File>(hdf5::File::change(output.out->temporary(), target.string()));
      }
      for (const auto& [path, rows] : output.file->datasets()) output.datasets.insert(path);
      files_.emplace(old_name, std::move(output));
    }
  }

  void finish(Hdf5Output& output) const {
    if (path_.store() != nullptr) {
      output.out->write(output.file->bytes());
    } else {
      output.file->close();
    }
    output.file.reset();
  }

  void rename_files() {
    for (pugi::xml_node item : elements_named(xml_, "DataItem")) {
      const std::string format = attribute(item, "Format");
      if (!format.starts_with('H') && !format.starts_with('h')) continue;
      const auto [file, dataset] = split_hdf5_name(item.text().get());
      const auto output = files_.find(file);
      if (output == files_.end()) continue;
      set_text(item, output->second.name + ":" + dataset);
      const auto shape = shapes_.find(output->second.name + ":" + dataset);
      if (shape != shapes_.end()) set_shape(item, shape->second);
    }
  }

  [[nodiscard]] std::string mark_of_mesh() const {
    Checksum sum;
    if (files_.empty()) return {};
    sum.add_all(mesh_.points);
    for (const std::vector<Index>& cells : rows_) {
      for (const Index c : cells) sum.add_all(mesh_.cells[c]);
    }
    return mark_of(sum.value());
  }

  /// Marks the files as those of one mesh.
  void mark_files(const std::string& mark) {
    pugi::xml_node root = xml_.document_element();
    root.remove_child(root.find_child(is_mark));
    if (files_.empty()) return;
    pugi::xml_node instruction = root.prepend_child(pugi::node_pi);
    if (!instruction.set_name(kMark) || !instruction.set_value(mark.c_str())) throw std::bad_alloc();
    for (auto& [name, output] : files_) output.file->set_attribute("/", kMark, mark);
  }

  void put_xml(const TakeText& take) const {
    if (layout_.is_made) return print_indented(xml_, take);
    print(xml_, std::string_view(layout_.xml).substr(0, layout_.xml.find("<Xdmf")), take);
  }

  // ---- values of one DataItem

  static void set_shape(pugi::xml_node item, const std::vector<std::uint64_t>& shape) {
    std::string text;
    for (const std::uint64_t n : shape) text += (text.empty() ? "" : " ") + std::to_string(n);
    set_attribute(item, "Dimensions", text);
  }

  static void set_number_type(pugi::xml_node item, std::size_t alternative) {
    const auto [name, precision] = number_type_of(alternative);
    set_either(item, "NumberType", "DataType", name);
    set_attribute(item, "Precision", std::to_string(precision));
  }

  /// Returns the shape of values at a place, in rows of so many components: the old one if it fits.
  std::vector<std::uint64_t> shape_at(const DataPlace& place, std::size_t count, std::size_t components) {
    std::vector<std::uint64_t> shape = place.shape;
    if (hdf5::DatasetInfo{shape, 0}.size() == count && !layout_.is_made) return shape;
    shape = {count / components};
    if (components > 1) shape.push_back(components);
    set_shape(items_[place.item], shape);
    if (place.format == Format::hdf) shapes_[files_.at(place.file).name + ":" + place.dataset] = shape;
    return shape;
  }

  /// Writes values to a place in their own number type: rows of so many components.
  void put(const DataPlace& place, const Values& values, std::size_t components) {
    pugi::xml_node item = items_[place.item];
    const std::vector<std::uint64_t> shape = shape_at(place, size_of(values), components);
    const bool same_type = values.index() == place.alternative;
    if (!same_type || layout_.is_made) set_number_type(item, values.index());
    switch (place.format) {
      case Format::xml:
        set_text(item, text_of_values(values, components));
        return;
      case Format::hdf:
        if (!same_type) files_.at(place.file).file->remove(place.dataset);
        files_.at(place.file).file->write(place.dataset, values, shape);
        return name_dataset(place);
      case Format::binary:
        put_binary(item, place, values);
    }
  }

  /// Writes indices to a place in the number type that it has, unless that is too narrow.
  void put_indices(const DataPlace& place, std::span<const Index> indices, std::size_t components) {
    constexpr std::size_t kInt32 = 6;
    if (place.format != Format::hdf || place.alternative < kInt32) {
      const Values values = values_as(std::max(place.alternative, kInt32), [&](auto& numbers) {
        using Number = typename std::decay_t<decltype(numbers)>::value_type;
        if constexpr (std::is_integral_v<Number>) {
          numbers.reserve(indices.size());
          for (const Index index : indices) numbers.push_back(static_cast<Number>(index));
        }
      });
      return put(place, values, components);
    }
    if (layout_.is_made) set_number_type(items_[place.item], place.alternative);
    files_.at(place.file).file->write(place.dataset, indices, shape_at(place, indices.size(), components));
    name_dataset(place);
  }

  /// Writes the name of a dataset that a made layout does not have yet; `rename_files` replaces its file.
  void name_dataset(const DataPlace& place) {
    files_.at(place.file).datasets.insert(place.dataset);
    if (layout_.is_made) set_text(items_[place.item], place.file + ":" + place.dataset);
  }

  void put_binary(pugi::xml_node item, const DataPlace& place, const Values& values) {
    const std::string name = fmt::format("{}{}.bin", stem_, binaries_.size());
    OutputFile& out = binaries_.emplace_back(path_.beside(name));
    std::visit(
        [&](const auto& numbers) {
          using Number = typename std::decay_t<decltype(numbers)>::value_type;
          if constexpr (std::is_arithmetic_v<Number>) {
            for (const Number number : numbers) out.binary(number, place.order);
          }
        },
        values);
    item.remove_attribute("Seek");
    set_text(item, name);
  }

  static std::string text_of_values(const Values& values, std::size_t components) {
    constexpr std::size_t kMostCharacters = 32;  // of a number and what follows it
    constexpr std::size_t kUsualCharacters = 20;
    std::string text;
    std::visit(
        [&](const auto& numbers) {
          using Number = typename std::decay_t<decltype(numbers)>::value_type;
          if constexpr (std::is_arithmetic_v<Number>) {
            resize_large(text, kUsualCharacters * numbers.size() + kMostCharacters);
            char* at = text.data();
            *at++ = '\n';
            std::size_t in_row = 0;
            for (const Number number : numbers) {
              const auto used = static_cast<std::size_t>(at - text.data());
              if (text.size() - used < kMostCharacters) {
                text.resize(text.size() + text.size() / 4 + kMostCharacters);
                at = text.data() + used;
              }
              if constexpr (std::is_integral_v<Number>) {
                at = std::to_chars(at, at + kMostCharacters, number).ptr;
              } else {
                at = fmt::format_to(at, FMT_COMPILE("{}"), number);
              }
              const bool ends_row = ++in_row == components;
              *at++ = ends_row ? '\n' : ' ';
              if (ends_row) in_row = 0;
            }
            text.resize(static_cast<std::size_t>(at - text.data()));
          }
        },
        values);
    return text;
  }

  // ---- fields of the layout

  /// Returns the Topology, Geometry, Attribute or Set whose values a field is.
  [[nodiscard]] pugi::xml_node element_of(const Field& field) const {
    return items_[field.place.named_by].parent();
  }

  void write_field(const Field& field) {
    switch (field.role) {
      case Field::Role::points:
        return write_points(field);
      case Field::Role::topology:
        return write_topology(field);
      case Field::Role::array:
        return write_array(field);
      case Field::Role::set:
        return write_set(field);
    }
  }

  void write_points(const Field& field) {
    const auto width = static_cast<std::size_t>(field.axis >= 0 ? 1 : dimension_of(field));
    const auto coordinate = [&](std::size_t v, std::size_t k) {
      return mesh_.points[v][field.axis >= 0 ? static_cast<std::size_t>(field.axis) : k];
    };
    const std::size_t count = mesh_.points.size() * width;
    constexpr std::size_t kFloatAlternative = 1;
    const bool floats = field.place.alternative == kFloatAlternative && are_floats();
    const Values values = values_as(floats ? kFloatAlternative : 0, [&](auto& numbers) {
      using Number = typename std::decay_t<decltype(numbers)>::value_type;
      if constexpr (std::is_floating_point_v<Number>) {
        numbers.resize(count);
        for (std::size_t v = 0; v < mesh_.points.size(); ++v) {
          for (std::size_t k = 0; k < width; ++k)
            numbers[v * width + k] = static_cast<Number>(coordinate(v, k));
        }
      }
    });
    put(field.place, values, width);
  }

  [[nodiscard]] int dimension_of(const Field& field) const {
    const std::string type = attribute(element_of(field), "GeometryType", "Type");
    return type == "XY" || type == "xy" ? 2 : 3;
  }

  [[nodiscard]] bool are_floats() const {
    return std::all_of(mesh_.points.begin(), mesh_.points.end(), [](const Point& point) {
      return std::all_of(point.begin(), point.end(),
                         [](double x) { return double{static_cast<float>(x)} == x; });
    });
  }

  void write_topology(const Field& field) {
    const std::vector<Index>& rows = rows_[static_cast<std::size_t>(field.part)];
    pugi::xml_node topology = element_of(field);
    const bool was_mixed = attribute(topology, "TopologyType", "Type") == "Mixed";
    const TopologyType* const type = was_mixed ? nullptr : common_type(rows);
    const auto nodes =
        type == nullptr ? std::size_t{1} : static_cast<std::size_t>(mesh_.cells.vertex_count(rows.front()));
    if (!was_mixed && !rows.empty()) {
      const std::string name = attribute(topology, "TopologyType", "Type");
      if (type == nullptr || topology_type(name) != type) {
        set_either(topology, "TopologyType", "Type", std::string(type == nullptr ? "Mixed" : type->name));
      }
      if (type != nullptr && (layout_.is_made || type->nodes == 0)) {
        set_attribute(topology, "NodesPerElement", std::to_string(nodes));
      }
    }
    announce_cells(topology, rows.size());
    for (const std::size_t item : field.also_named_by) announce_cells(items_[item].parent(), rows.size());
    if (type != nullptr && field.base == 0 && is_identity(rows, mesh_.cell_count()) &&
        !is_turned(rows.front())) {
      return put_indices(field.place, mesh_.cells.vertices, nodes);
    }
    put_indices(field.place, numbers_of(rows, type == nullptr, field.base), nodes);
  }

  /// Says how many cells, of a type with so many nodes, the Topology of a field has.
  void announce_cells_of(const Field& field) const {
    const pugi::xml_node topology = element_of(field);
    const auto nodes =
        static_cast<std::uint64_t>(topology_type(attribute(topology, "TopologyType", "Type"))->nodes);
    announce_cells(topology, hdf5::DatasetInfo{field.place.shape, 0}.size() / nodes);
  }

  /// Says how many cells a Topology has.
  void announce_cells(pugi::xml_node topology, std::uint64_t cells) const {
    if (layout_.is_made || topology.attribute("NumberOfElements")) {
      set_attribute(topology, "NumberOfElements", std::to_string(cells));
    } else if (topology.attribute("Dimensions")) {
      set_attribute(topology, "Dimensions", std::to_string(cells));
    }
  }

  /// Whether the cell is a linear wedge that the file has the other way round.
  [[nodiscard]] bool is_turned(Index c) const {
    constexpr int kCorners = 6;
    return !layout_.inward_wedges && mesh_.cells.shapes[c] == Shape::wedge &&
           mesh_.cells.vertex_count(c) == kCorners;
  }

  /// Returns the type of all these cells, null if they have several.
  [[nodiscard]] const TopologyType* common_type(const std::vector<Index>& rows) const {
    if (rows.empty()) return nullptr;
    const Shape shape = mesh_.cells.shapes[rows.front()];
    const int vertices = mesh_.cells.vertex_count(rows.front());
    const bool common = std::all_of(rows.begin(), rows.end(), [&](Index c) {
      return mesh_.cells.shapes[c] == shape && mesh_.cells.vertex_count(c) == vertices;
    });
    return common ? topology_type_of(shape, vertices) : nullptr;
  }

  /// Returns the entries of a Topology.
  [[nodiscard]] std::vector<Index> numbers_of(const std::vector<Index>& rows, bool mixed, int base) const {
    constexpr std::array<std::size_t, 6> kTurned{0, 2, 1, 3, 5, 4};
    std::size_t size = 0;
    for (const Index c : rows)
      size += static_cast<std::size_t>(mesh_.cells.vertex_count(c)) + (mixed ? 2 : 0);
    std::vector<Index> numbers;
    numbers.reserve(size);
    for (const Index c : rows) {
      const auto cell = mesh_.cells[c];
      if (mixed) {
        const TopologyType& type = *topology_type_of(mesh_.cells.shapes[c], static_cast<int>(cell.size()));
        numbers.push_back(type.number);
        if (type.nodes == 0) numbers.push_back(static_cast<Index>(cell.size()));
      }
      if (is_turned(c)) {
        for (const std::size_t k : kTurned) numbers.push_back(cell[k] + base);
      } else {
        for (const Index v : cell) numbers.push_back(v + base);
      }
    }
    return numbers;
  }

  void write_array(const Field& field) {
    const DataArray* array = find_array(mesh_, field.name, field.association);
    std::optional<DataArray> made;
    if (array == nullptr) {
      made = marks_named(field.name, field.association);
      array = made ? &*made : nullptr;
    }
    if (array == nullptr || is_text(array->values)) return remove_element(field);
    const std::optional<Values> values = values_of(*array, field.association, field.part);
    put(field.place, values ? *values : array->values, static_cast<std::size_t>(array->components));
  }

  void write_set(const Field& field) {
    const auto set = std::find_if(mesh_.sets.begin(), mesh_.sets.end(), [&](const EntitySet& candidate) {
      return candidate.association == field.association && candidate.name == field.name;
    });
    if (set == mesh_.sets.end()) return remove_element(field);
    const bool on_cells = field.association == Association::cells;
    std::vector<Index> place;
    if (on_cells) place = places_in(rows_[static_cast<std::size_t>(field.part)]);
    std::vector<Index> numbers;
    for (const Index member : set->members) {
      const Index row = on_cells ? place[static_cast<std::size_t>(member)] : member;
      if (row >= 0) numbers.push_back(row);
    }
    put_indices(field.place, numbers, 1);
  }

  /// Marks the Attribute or the Set of a field that the mesh has no longer; see `remove_gone`.
  void remove_element(const Field& field) {
    const bool is_hdf = field.place.format == Format::hdf;
    if (is_hdf) gone_datasets_.insert(field.place.file + ":" + field.place.dataset);
    if (!is_hdf || field.place.named_by != field.place.item) gone_.push_back(element_of(field));
  }

  /// Removes what the mesh has no longer, also where several time steps name one dataset.
  void remove_gone() {
    for (const pugi::xml_node item : gone_datasets_.empty() ? std::vector<pugi::xml_node>() : items_) {
      const auto [file, dataset] = split_hdf5_name(item.text().get());
      if (!gone_datasets_.contains(fmt::format("{}:{}", file, dataset))) continue;
      const std::string_view name = item.parent().name();
      gone_.push_back(name == "Attribute" || name == "Set" ? item.parent() : item);
    }
    for (const std::string& name : gone_datasets_) {
      const auto [file, dataset] = split_hdf5_name(name);
      files_.at(file).file->remove(dataset);
    }
    for (pugi::xml_node element : gone_) element.parent().remove_child(element);
  }

  /// Returns the row of each cell in a part, −1 for those of other parts.
  [[nodiscard]] std::vector<Index> places_in(const std::vector<Index>& rows) const {
    std::vector<Index> place(mesh_.cells.shapes.size(), -1);
    for (Index r = 0; r < index_size(rows); ++r)
      place[static_cast<std::size_t>(rows[static_cast<std::size_t>(r)])] = r;
    return place;
  }

  /// Returns the values of an array for all vertices or for the cells of a part; none if they are those of
  /// the array. Rows that the array does not give are noted.
  std::optional<Values> values_of(const DataArray& array, Association association, int part) {
    const bool on_vertices = association == Association::vertices;
    const Index count = on_vertices ? mesh_.vertex_count() : mesh_.cell_count();
    std::vector<Index> all;
    if (on_vertices && array.is_dense()) return {};
    if (on_vertices) all = index_range(0, count);
    const std::vector<Index>& rows = on_vertices ? all : rows_[static_cast<std::size_t>(part)];
    if (array.is_dense() && is_identity(rows, count)) return {};
    std::vector<Index> row_of;  // of the array, by vertex or cell
    if (!array.is_dense()) {
      row_of.assign(static_cast<std::size_t>(count), -1);
      for (Index r = 0; r < index_size(array.indices); ++r) {
        row_of[static_cast<std::size_t>(array.indices[static_cast<std::size_t>(r)])] = r;
      }
    }
    const auto width = static_cast<std::size_t>(array.components);
    bool filled = false;
    Values result = values_as(array.values.index(), [&](auto& numbers) {
      using Number = typename std::decay_t<decltype(numbers)>::value_type;
      const auto& values = std::get<std::decay_t<decltype(numbers)>>(array.values);
      numbers.reserve(rows.size() * width);
      for (const Index item : rows) {
        const Index row = row_of.empty() ? item : row_of[static_cast<std::size_t>(item)];
        if (row < 0) {
          numbers.insert(numbers.end(), width, nothing<Number>());
          filled = true;
        } else {
          const auto first = values.begin() + static_cast<Offset>(static_cast<std::size_t>(row) * width);
          numbers.insert(numbers.end(), first, first + static_cast<Offset>(width));
        }
      }
    });
    if (filled) note_filled(array);
    return result;
  }

  void note_filled(const DataArray& array) {
    const bool real = array.values.index() <= 1;
    const std::string note = fmt::format("the array '{}' is given for some {}; the others get {}", array.name,
                                         to_string(array.association), real ? "NaN" : "0");
    if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
  }

  // ---- what the layout has no place for

  /// Returns the array of marks that stands for a set, by the name of the array.
  [[nodiscard]] std::optional<DataArray> marks_named(const std::string& name, Association association) const {
    if (!name.starts_with(kSetName)) return {};
    for (const EntitySet& set : mesh_.sets) {
      if (set.association == association && kSetName.size() + set.name.size() == name.size() &&
          name.ends_with(set.name)) {
        return marks_of(set);
      }
    }
    return {};
  }

  [[nodiscard]] DataArray marks_of(const EntitySet& set) const {
    const Index count = set.association == Association::vertices ? mesh_.vertex_count() : mesh_.cell_count();
    return {.name = std::string(kSetName) + set.name,
            .association = set.association,
            .values = vtk::marks_of(set, count)};
  }

  void add_others() {
    for (const Field& field : layout_.fields) {
      if (field.role == Field::Role::array) names_.emplace(field.association, field.name);
    }
    const std::set<std::pair<Association, std::string>> covered = names_;
    for (const DataArray& array : mesh_.data) {
      if (!covered.contains({array.association, array.name})) add_array(array);
    }
    for (const EntitySet& set : mesh_.sets) {
      if (has_place(set) || covered.contains({set.association, std::string(kSetName) + set.name})) continue;
      const DataArray marks = marks_of(set);
      notes_.push_back(fmt::format("the set '{}' of {} is written as the array '{}'", set.name,
                                   to_string(set.association), marks.name));
      add_array(marks);
    }
    add_ids(mesh_.vertex_ids, "vertex_id", Association::vertices);
    add_ids(mesh_.cell_ids, "cell_id", Association::cells);
  }

  [[nodiscard]] bool has_place(const EntitySet& set) const {
    if (layout_.is_made) return false;
    const bool is_part = set.association == Association::cells &&
                         std::any_of(layout_.parts.begin(), layout_.parts.end(), [&](const Part& part) {
                           return part.set == set.name && !part.set.empty();
                         });
    return is_part || std::any_of(layout_.fields.begin(), layout_.fields.end(), [&](const Field& field) {
             return field.role == Field::Role::set && field.association == set.association &&
                    field.name == set.name;
           });
  }

  void add_ids(const std::vector<std::int64_t>& ids, const char* name, Association association) {
    if (ids.empty()) return;
    notes_.push_back(
        fmt::format("the ids of {} are written as the array '{}'", to_string(association), name));
    add_array({.name = name, .association = association, .values = ids});
  }

  /// Returns a name that no other attribute has.
  std::string unused_name(const DataArray& array) {
    const std::string wanted = array.name.empty() ? "array" : array.name;
    const std::string clean = meshorder::xml_text(wanted);
    std::string name = clean;
    for (int k = 2; !names_.emplace(array.association, name).second; ++k)
      name = fmt::format("{}_{}", clean, k);
    if (name != array.name) {
      notes_.push_back(fmt::format("the array '{}' on {} is written as '{}'", array.name,
                                   to_string(array.association), name));
    }
    return name;
  }

  void add_array(const DataArray& array) {
    if (is_text(array.values)) return note_array_unsupported(array, "XDMF", notes_);
    if (!array.component_names.empty()) {
      notes_.push_back(fmt::format(
          "the names of the components of '{}' are not written: XDMF has no place for them", array.name));
    }
    const std::string name = unused_name(array);
    if (array.association == Association::vertices) {
      const std::optional<Values> values = values_of(array, array.association, 0);
      add_attribute(0, array, name, values ? *values : array.values);
      return;
    }
    for (std::size_t p = 0; p < rows_.size(); ++p) {
      if (!layout_.parts[p].has_own_cells || rows_[p].empty() || !has_rows(array, rows_[p])) continue;
      const auto part = static_cast<int>(p);
      const std::optional<Values> values = values_of(array, array.association, part);
      const bool is_label = name == kLabel && part > 0;
      add_attribute(part, array, is_label ? layout_.parts[p].name : name, values ? *values : array.values);
    }
  }

  [[nodiscard]] bool has_rows(const DataArray& array, const std::vector<Index>& cells) const {
    if (array.is_dense()) return true;
    const std::vector<Index> place = places_in(cells);
    return std::any_of(array.indices.begin(), array.indices.end(),
                       [&](Index c) { return place[static_cast<std::size_t>(c)] >= 0; });
  }

  void add_attribute(int part, const DataArray& array, const std::string& name, const Values& values) {
    pugi::xml_node element = grid_of(part).append_child("Attribute");
    set_attribute(element, "Name", name);
    set_attribute(element, "AttributeType", std::string(attribute_type(array.components)));
    set_attribute(element, "Center", array.association == Association::vertices ? "Node" : "Cell");
    pugi::xml_node item = element.append_child("DataItem");
    const auto components = static_cast<std::size_t>(array.components);
    std::vector<std::uint64_t> shape{size_of(values) / components};
    if (components > 1) shape.push_back(components);
    set_shape(item, shape);
    set_number_type(item, values.index());
    set_attribute(item, "Format", files_.empty() ? "XML" : "HDF");
    if (files_.empty()) {
      set_text(item, text_of_values(values, components));
      return;
    }
    auto& [old_name, output] = *files_.begin();
    const std::string dataset = unused_dataset(output, part, name);
    output.file->write(dataset, values, shape);
    set_text(item, old_name + ":" + dataset);
  }

  static std::string unused_dataset(Hdf5Output& output, int part, const std::string& name) {
    const bool is_tags = part > 0 && name.ends_with("_tags");
    if (is_tags) {
      std::string path = "/MeshTags/" + name + "/Values";
      if (output.datasets.insert(path).second) return path;
    }
    while (true) {
      std::string path = fmt::format("/Attributes/{}", output.next_array++);
      if (output.datasets.insert(path).second) return path;
    }
  }

  /// Returns the Grid of a part, or the first one of a series.
  [[nodiscard]] pugi::xml_node grid_of(int part) const {
    return grids_[layout_.parts[static_cast<std::size_t>(part)].grid];
  }

  const Mesh& mesh_;
  const Layout& layout_;
  FilePath path_;
  std::string stem_;
  Notes& notes_;
  std::vector<std::vector<Index>> rows_;  // cells of each part
  pugi::xml_document xml_;
  std::vector<pugi::xml_node> items_;
  std::vector<pugi::xml_node> grids_;
  std::map<std::string, Hdf5Output> files_;  // by their names in the old XML
  std::map<std::string, std::vector<std::uint64_t>>
      shapes_;  // that have changed, by the new name of a dataset
  std::vector<OutputFile> binaries_;
  std::set<std::string> gone_datasets_;  // with their files
  std::vector<pugi::xml_node> gone_;
  std::set<std::pair<Association, std::string>> names_;  // of arrays
};

}  // namespace

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const hdf5::Session session;  // for all of it: failures in between count at the end
  if (const auto* const own = dynamic_cast<const Layout*>(mesh.format_metadata.get())) {
    std::vector<std::vector<Index>> rows = cells_of_parts(mesh, *own);
    if (!rows.front().empty()) return XdmfWriter(mesh, *own, std::move(rows), path, notes).write();
  }
  const Layout layout = layout_of(mesh, path);
  XdmfWriter(mesh, layout, cells_of_parts(mesh, layout), path, notes).write();
  note_metadata_unsupported(mesh, "XDMF", notes);
}

std::string mark_of(std::uint64_t checksum) { return fmt::format("{:016x}", checksum); }

std::string name_of_data(const Layout& layout, const std::filesystem::path& path) {
  const Mesh none;
  Notes ignored;
  return XdmfWriter(none, layout, {}, FilePath(path), ignored).new_name(layout.hdf5.begin()->first);
}

std::string write_without_values(const Layout& layout, const std::filesystem::path& path,
                                 const std::filesystem::path& data, const std::string& mark) {
  const hdf5::Session session;
  const Mesh none;
  Notes ignored;
  return XdmfWriter(none, layout, {}, FilePath(path), ignored).write_without_values(data, mark);
}

std::vector<std::uint64_t> places_of_values(const Layout& layout, const std::filesystem::path& data,
                                            const std::string& name) {
  const hdf5::Session session;
  const hdf5::File file = hdf5::File::open(data, name);
  std::vector<std::uint64_t> places;
  for (const Field& field : layout.fields) {
    const std::optional<std::uint64_t> place = file.place_of_values(field.place.dataset);
    if (!place) {
      throw InputError(name, fmt::format("the dataset '{}' got no room", field.place.dataset),
                       "is the disk full?");
    }
    places.push_back(*place);
  }
  return places;
}

}  // namespace meshorder::xdmf

namespace meshorder {

Format xdmf_format() {
  return {.name = "XDMF",
          .extensions = {".xdmf", ".xmf"},
          .groups_cells_by_type = false,
          .read = xdmf::read,
          .write = xdmf::write,
          .holds = xdmf::holds,
          .places = xdmf::places,
          .single_file = false};
}

}  // namespace meshorder
