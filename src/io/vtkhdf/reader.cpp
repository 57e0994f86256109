// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Reader of VTKHDF's unstructured grids. VTK's own reader is not used: it trusts the counts of a damaged
// file.
#include "base/memory.hpp"
#include "io/hdf5/hdf5_file.hpp"
#include "io/hdf5/session.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtkhdf/vtkhdf.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder::vtkhdf {
namespace {

constexpr std::string_view kDamaged = "the file may be damaged";

std::string path_in(std::string_view group, std::string_view name) {
  return fmt::format("{}/{}", group, name);
}
std::string path_of(std::string_view dataset) { return path_in(kRoot, dataset); }

class VtkHdfReader {
 public:
  VtkHdfReader(const FilePath& path, Notes& notes) : file_(hdf5::File::open(path)), notes_(notes) {}

  /// See `find_raw`.
  std::optional<RawGrid> find() {
    check_kind();
    read_counts();
    if (partitions_.size() != 1) return {};
    layout_ = {{all_.points, all_.cells, all_.entries}, {}, {}};
    using Role = FilePart::Role;
    const bool is_found = add(Role::points, "Points", all_.points, 3) &&
                          add(Role::connectivity, "Connectivity", all_.entries) &&
                          add(Role::offsets, "Offsets", all_.cells + 1) &&
                          add(Role::types, "Types", all_.cells) && add_data(Association::vertices) &&
                          add_data(Association::cells);
    if (!is_found) return {};
    constexpr std::ptrdiff_t kOfMesh = 4;
    std::rotate(layout_.parts.begin(), layout_.parts.begin() + kOfMesh, layout_.parts.end());
    std::rotate(layout_.names.begin(), layout_.names.begin() + kOfMesh, layout_.names.end());
    for (std::size_t k = 0; k < layout_.parts.size(); ++k) layout_.parts[k].number = k;
    read_fields();
    note_others();
    if (!notes_.empty()) return {};
    return RawGrid{std::move(layout_), *metadata_};
  }

  Mesh read() {
    check_kind();
    read_counts();
    read_points();
    read_cells();
    read_fields();
    for (const Association association : {Association::vertices, Association::cells}) read_data(association);
    if (full_partitions_ > 1)
      vtk::join_pieces({mesh_.points, cells_, arrays_, metadata_->roles}, error_of_file(), notes_);
    finish();
    note_others();
    mesh_.format_metadata = metadata_;
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] InputError error(std::string_view path, const std::string& what,
                                 std::string_view remedy = kDamaged) const {
    return {file_.name(), fmt::format("the dataset '{}' {}", path, what), std::string(remedy)};
  }

  // ---- positions of datasets in the file

  /// Adds a dataset as a part of the file; returns false if the bytes of its values cannot be read directly.
  bool add(FilePart part, const std::string& path, const std::string& name) {
    const std::optional<std::uint64_t> place = file_.place_of_values(path);
    if (!place) return false;
    part.type = static_cast<std::uint8_t>(file_.info(path).alternative);
    part.at = static_cast<std::int64_t>(*place);
    if (part.role == FilePart::Role::offsets) {  // skips the first offset; the others are the ends of cells
      --part.rows;
      part.at += part.row_size();
    }
    part.stored = part.size();
    layout_.parts.push_back(part);
    layout_.names.push_back(name);
    return true;
  }

  bool add(FilePart::Role role, const std::string& name, std::int64_t rows, Index width = 1) {
    const std::string path = path_of(name);
    const bool is_whole = check_rows(path, rows, static_cast<std::uint64_t>(width)).alternative > 1;
    const bool are_points = role == FilePart::Role::points;
    const Association association = are_points ? Association::vertices : Association::cells;
    return is_whole != are_points &&
           add({.role = role, .association = association, .components = width, .rows = rows}, path, name);
  }

  /// Adds the arrays on points or cells; returns false if one does not hold numbers or `add` returns false.
  bool add_data(Association association) {
    const std::string group = data_group(association);
    read_roles(association);
    const std::int64_t rows = association == Association::vertices ? all_.points : all_.cells;
    return std::ranges::all_of(file_.names(group, H5_ITER_NATIVE), [&](const std::string& name) {
      const std::string path = path_in(group, name);
      if (!file_.number_type(path)) return false;
      const hdf5::DatasetInfo info = file_.info(path);
      const Index components = components_of(path, info);
      check_count(path, info.shape.empty() ? 1 : static_cast<std::int64_t>(info.shape.front()), association,
                  rows);
      return add({.association = association, .components = components, .rows = rows}, path, name);
    });
  }

  // ---- kind and counts

  void check_kind() const {
    const std::string root(kRoot);
    if (!file_.has(root)) {
      throw InputError(file_.name(), "has no group 'VTKHDF'", "a file of VTKHDF has its mesh in this group");
    }
    const std::vector<std::int64_t> version = file_.integers_attribute(root, "Version");
    if (version.empty() || version.front() < 1 || version.front() > 2) {
      throw InputError(file_.name(),
                       version.empty() ? "has no version of VTKHDF"
                                       : fmt::format("is of version {} of VTKHDF", version.front()),
                       "the group 'VTKHDF' has an attribute Version, [1, 0] or [2, n]");
    }
    const std::optional<std::string> type = file_.text_attribute(root, "Type");
    if (!type) {
      throw InputError(file_.name(), "the group 'VTKHDF' has no attribute Type of fixed length",
                       "VTK requires one, ASCII: UnstructuredGrid");
    }
    if (*type != kType) {
      throw InputError(file_.name(), fmt::format("holds VTK's {}", type->substr(0, 40)),
                       "save it as one UnstructuredGrid, in ParaView with Append Datasets and Save Data");
    }
    const std::optional<std::int64_t> steps = file_.integer_attribute(path_of("Steps"), "NSteps");
    if (steps && *steps > 1) {
      throw InputError(file_.name(), fmt::format("holds {} time steps", *steps),
                       "save each step as a separate file");
    }
  }

  /// Reads a dataset that has one count for each partition.
  [[nodiscard]] std::vector<std::int64_t> counts(std::string_view dataset) const {
    const std::string path = path_of(dataset);
    const Values values = file_.read(path);
    std::vector<std::int64_t> result = vtk::integers_of<std::int64_t>(values);
    if (values.index() <= 1) throw error(path, "does not hold whole numbers");
    if (const auto low = std::find_if(result.begin(), result.end(), [](std::int64_t n) { return n < 0; });
        low != result.end()) {
      throw error(path, fmt::format("has the count {}", *low));
    }
    return result;
  }

  void read_counts() {
    const std::vector<std::int64_t> points = counts("NumberOfPoints");
    const std::vector<std::int64_t> cells = counts("NumberOfCells");
    const std::vector<std::int64_t> entries = counts("NumberOfConnectivityIds");
    if (points.empty()) throw error(path_of("NumberOfPoints"), "has no count", "one for each partition");
    for (const auto& [name, size] :
         {std::pair{"NumberOfCells", cells.size()}, {"NumberOfConnectivityIds", entries.size()}}) {
      if (size != points.size()) {
        throw error(path_of(name), fmt::format("has {} counts", size),
                    fmt::format("there are {} partitions by NumberOfPoints", points.size()));
      }
    }
    for (std::size_t p = 0; p < points.size(); ++p) {
      partitions_.push_back({points[p], cells[p], entries[p]});
      if (points[p] > kMaxIndex - all_.points || cells[p] > kMaxIndex - all_.cells) {
        throw InputError(file_.name(), "the partitions have too many points or cells",
                         "at most 2147483647 are possible");
      }
      all_.points += points[p];
      all_.cells += cells[p];
      if (entries[p] > INT64_MAX - all_.entries)
        throw error(path_of("NumberOfConnectivityIds"), "has counts that are too large");
      all_.entries += entries[p];
    }
    full_partitions_ = std::count_if(partitions_.begin(), partitions_.end(),
                                     [](const Partition& p) { return p.points > 0 || p.cells > 0; });
    if (full_partitions_ > 1)
      notes_.push_back(fmt::format("the {} partitions of the file became one", full_partitions_));
  }

  // ---- the mesh

  /// Returns the shape and type of a dataset. Throws InputError unless it has `rows` rows of `width` numbers.
  [[nodiscard]] hdf5::DatasetInfo check_rows(const std::string& path, std::int64_t rows,
                                             std::uint64_t width) const {
    hdf5::DatasetInfo info = file_.info(path);
    const bool fits = width == 1 ? info.shape.size() == 1 : info.shape.size() == 2 && info.shape[1] == width;
    if (!fits || std::cmp_not_equal(info.shape.front(), rows)) {
      throw error(path, fmt::format("has the shape ({})", fmt::join(info.shape, ", ")),
                  fmt::format("{} rows of {} are needed, by the counts of the partitions", rows, width));
    }
    return info;
  }

  [[nodiscard]] Values read_rows(const std::string& path, std::int64_t rows, std::uint64_t width) const {
    (void)check_rows(path, rows, width);
    return file_.read(path);
  }

  void read_points() {
    const std::string path = path_of("Points");
    const Values values = read_rows(path, all_.points, 3);
    metadata_->float_points = std::holds_alternative<std::vector<float>>(values);
    if (values.index() > 1) notes_.push_back("the points are integers and are stored as double");
    vtk::add_points(mesh_.points, values, [&](std::size_t p) {
      return error(path, fmt::format("has a coordinate of point {} (counted from 0) that is not finite", p),
                   "finite numbers are needed");
    });
  }

  /// Reserves `all` entries in `target`, then calls `take(partition, i, number)` for every number of a
  /// dataset of integers, which has `count(partition)` numbers for each partition.
  template <class Target, class Count, class Take>
  void for_integers(const std::string& path, std::int64_t all, std::vector<Target>& target,
                    const Count& count, const Take& take) const {
    const Values values = read_rows(path, all, 1);
    if (!are_integers(values)) throw error(path, "does not hold whole numbers");
    reserve_large(target, static_cast<std::size_t>(all));
    with_integers(values, [&](const auto& numbers) {
      std::size_t at = 0;
      for (const Partition& partition : partitions_) {
        const std::int64_t n = count(partition);
        for (std::int64_t i = 0; i < n; ++i) take(partition, i, numbers[at++]);
      }
    });
  }

  void read_cells() {
    vtk::FileCells& cells = cells_;
    const std::string offsets = path_of("Offsets");
    std::int64_t last = 0;
    Offset first_entry = 0;
    const auto count = std::ssize(partitions_);
    for_integers(
        offsets, all_.cells + count, cells.offsets, [](const Partition& p) { return p.cells + 1; },
        [&](const Partition& partition, std::int64_t i, auto end) {
          if (i == 0 && end != 0) {
            throw error(offsets, fmt::format("begins a partition with {}", end),
                        "the first cell begins at 0");
          }
          if (i == 0) {
            last = 0;
          } else if (!std::in_range<std::int64_t>(end) || std::cmp_less(end, last)) {
            throw error(offsets, fmt::format("ends a cell at {}, before it begins at {}", end, last),
                        "offsets must ascend");
          } else {
            last = static_cast<std::int64_t>(end);
            if (last > partition.entries) break_off(offsets, last, partition.entries);
            cells.offsets.push_back(first_entry + last);
          }
          if (i < partition.cells) return;
          if (last != partition.entries) break_off(offsets, last, partition.entries);
          first_entry += partition.entries;
        });

    const std::string connectivity = path_of("Connectivity");
    Index first_point = 0;
    const Partition* of = partitions_.data();
    for_integers(
        connectivity, all_.entries, cells.vertices, [](const Partition& p) { return p.entries; },
        [&](const Partition& partition, std::int64_t /*i*/, auto point) {
          for (; of != &partition; ++of) first_point += static_cast<Index>(of->points);
          if (std::cmp_less(point, 0) || std::cmp_greater_equal(point, partition.points)) {
            throw error(connectivity, fmt::format("names the point {}", point),
                        fmt::format("the partition has points 0 to {}", partition.points - 1));
          }
          cells.vertices.push_back(first_point + static_cast<Index>(point));
        });

    const std::string types = path_of("Types");
    for_integers(
        types, all_.cells, cells.types, [](const Partition& p) { return p.cells; },
        [&](const Partition& /*partition*/, std::int64_t /*i*/, auto type) {
          if (std::cmp_less(type, 0) || std::cmp_greater(type, 255))
            throw error(types, fmt::format("has the type {}", type), "VTK's types run from 0 to 81");
          cells.types.push_back(static_cast<std::uint8_t>(type));
        });
  }

  [[nodiscard]] vtk::ErrorAt error_of_file() const {
    return [this](const std::string& what, const std::string& remedy) {
      return InputError(file_.name(), what, remedy);
    };
  }

  void finish() {
    metadata_->inward_wedges = take_cells(mesh_, cells_, error_of_file(), notes_);
    for (DataArray& array : arrays_) vtk::add_array(mesh_, std::move(array));
  }

  [[noreturn]] void break_off(const std::string& offsets, std::int64_t end, std::int64_t entries) const {
    throw error(offsets, fmt::format("ends the cells of a partition at {}", end),
                fmt::format("it has {} entries by NumberOfConnectivityIds", entries));
  }

  // ---- arrays

  /// Returns how many numbers a row of a dataset has.
  [[nodiscard]] Index components_of(const std::string& path, const hdf5::DatasetInfo& info) const {
    constexpr std::uint64_t kMost = kMaxIndex;
    std::uint64_t components = 1;
    for (std::size_t k = 1; k < info.shape.size(); ++k)
      components = std::min(components * std::min(info.shape[k], kMost + 1), kMost + 1);
    if (components < 1 || components > kMost) {
      throw error(path, fmt::format("has the shape ({})", fmt::join(info.shape, ", ")),
                  "the rows of an array have at least one number");
    }
    return static_cast<Index>(components);
  }

  void check_count(const std::string& path, std::int64_t found, Association association,
                   std::int64_t needed) const {
    if (found != needed) {
      throw error(path, fmt::format("has {} rows", found),
                  fmt::format("there are {} {}", needed, to_string(association)));
    }
  }

  /// Reads an array of a group; returns nullopt, with a note, if it holds neither numbers nor texts.
  std::optional<DataArray> read_array(const std::string& group, const std::string& name) {
    const std::string path = path_in(group, name);
    DataArray array;
    array.name = name;
    if (file_.number_type(path)) {
      array.components = components_of(path, file_.info(path));
      array.values = file_.read(path);
    } else if (file_.has_texts(path)) {
      array.values = file_.read_texts(path);
    } else {
      notes_.push_back(
          fmt::format("'{}' is not read: only datasets of numbers and of texts are supported", path));
      return {};
    }
    return array;
  }

  void read_fields() {
    const std::string group = path_of("FieldData");
    for (const std::string& name : file_.names(group, H5_ITER_NATIVE)) {
      std::optional<DataArray> field = read_array(group, name);
      if (!field) continue;
      const std::int64_t components =
          file_.integer_attribute(path_in(group, name), std::string(kComponents)).value_or(field->components);
      const auto count = static_cast<std::int64_t>(size_of(field->values));
      if (components < 1 || components > kMaxIndex || count % components != 0) {
        throw error(path_in(group, name), fmt::format("has {} values in rows of {}", count, components));
      }
      field->components = static_cast<Index>(components);
      metadata_->fields.push_back(std::move(*field));
    }
  }

  void read_roles(Association association) {
    for (std::size_t role = 0; role < vtk::kXmlRoles.size(); ++role) {
      const std::optional<std::string> name =
          file_.text_attribute(data_group(association), std::string(vtk::kXmlRoles[role]));
      if (name && !name->empty())
        metadata_->roles.push_back({static_cast<vtk::Role>(role), association, *name, {}});
    }
  }

  void read_data(Association association) {
    const std::string group = data_group(association);
    read_roles(association);
    const std::int64_t rows = association == Association::vertices ? all_.points : all_.cells;
    for (const std::string& name : file_.names(group, H5_ITER_NATIVE)) {
      std::optional<DataArray> array = read_array(group, name);
      if (!array) continue;
      check_count(path_in(group, name), row_count(*array), association, rows);
      array->association = association;
      arrays_.push_back(std::move(*array));
    }
  }

  /// Notes the datasets and groups of the file that are not read.
  void note_others() {
    constexpr std::array<std::string_view, 10> kKnown{
        "NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds",
        "Points",         "Types",         "Connectivity",
        "Offsets",        "PointData",     "CellData",
        "FieldData"};
    const auto note = [&](const std::string& path) {
      notes_.push_back(
          fmt::format("'{}' is ignored: it is not part of an unstructured grid with one step", path));
    };
    for (const std::string& name : file_.names(std::string(kRoot))) {
      if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end()) note(path_of(name));
    }
    for (const std::string& name : file_.names("/")) {
      if (name != kRoot.substr(1)) note("/" + name);
    }
  }

  hdf5::File file_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<vtk::VtkMetadata> metadata_ = std::make_shared<vtk::VtkMetadata>();
  std::vector<Partition> partitions_;
  std::int64_t full_partitions_ = 0;  ///< partitions that have points or cells
  vtk::FileCells cells_;              ///< cells of all partitions; `arrays_` has the rows of all partitions
  std::vector<DataArray> arrays_;
  Partition all_;
  FileLayout layout_;
};

}  // namespace

std::optional<RawGrid> find_raw(const FilePath& path) {
  Notes notes;
  return hdf5::read_whole(path.string(), [&] { return VtkHdfReader(path, notes).find(); });
}

Mesh read(const FilePath& path, Notes& notes) {
  return hdf5::read_whole(path.string(), [&] { return VtkHdfReader(path, notes).read(); });
}

}  // namespace meshorder::vtkhdf
