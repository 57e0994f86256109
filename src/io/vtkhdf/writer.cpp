// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/all_formats.hpp"
#include "io/hdf5/hdf5_file.hpp"
#include "io/hdf5/session.hpp"
#include "io/names.hpp"
#include "io/unsupported.hpp"
#include "io/vtkhdf/vtkhdf.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

// Writes files of one partition, and files of several partitions without their values.

namespace meshorder::vtkhdf {
namespace {

/// Names of the arrays in each group. VTK lists them as HDF5 does, unsorted.
using Lists = std::map<std::string, std::vector<std::string>>;

/// Returns lists without the names of arrays on points and cells.
Lists lists_of(const std::vector<DataArray>& fields) {
  std::vector<std::string> names;
  names.reserve(fields.size());
  for (const DataArray& field : fields) names.push_back(field.name);
  return {{data_group(Association::vertices), {}},
          {data_group(Association::cells), {}},
          {fmt::format("{}/FieldData", kRoot), std::move(names)}};
}

/// Returns the bytes of a file without datasets.
std::string empty_file(const Lists& lists) {
  hdf5::File file = hdf5::File::in_memory({}, "");
  const std::string root(kRoot);
  file.make_group(root);
  constexpr std::array<std::int64_t, 2> kVersion{1, 0};
  file.set_attribute(root, "Version", kVersion);
  file.set_attribute(root, "Type", std::string(kType));
  for (const auto& [group, names] : lists) file.make_list(group, names);
  return file.bytes();
}

void write_field(hdf5::File& file, const DataArray& field, const std::string& path) {
  if (const auto* const texts = std::get_if<std::vector<std::string>>(&field.values)) {
    file.write_strings(path, *texts);
  } else {
    const auto size = size_of(field.values);
    file.write(path, field.values, {size});
  }
  if (field.components != 1)
    file.set_attribute(path, std::string(kComponents), std::int64_t{field.components});
}

/// Writes all fields, each under a name that no other field has.
void write_fields(hdf5::File& file, const std::vector<DataArray>& fields, Notes& notes) {
  DistinctNames names;
  for (const DataArray& field : fields) {
    const std::string name = names.take(vtk::name_in_hdf5(field.name));
    if (name != field.name)
      notes.push_back(fmt::format("the field '{}' is written as '{}'", field.name, name));
    write_field(file, field, fmt::format("{}/FieldData/{}", kRoot, name));
  }
}

void write_counts(hdf5::File& file, const std::vector<Partition>& partitions) {
  const auto write = [&](std::string_view dataset, std::int64_t Partition::*count) {
    std::vector<std::int64_t> counts;
    counts.reserve(partitions.size());
    for (const Partition& partition : partitions) counts.push_back(partition.*count);
    file.write(fmt::format("{}/{}", kRoot, dataset), Values(counts), {counts.size()});
  };
  write("NumberOfPoints", &Partition::points);
  write("NumberOfCells", &Partition::cells);
  write("NumberOfConnectivityIds", &Partition::entries);
}

class VtkHdfWriter {
 public:
  VtkHdfWriter(vtk::WriteContext& from, hdf5::File& file) : from_(from), file_(file) {}

  void write() {
    const Cells& cells = from_.cells();
    write_counts(file_, {{from_.mesh.vertex_count(), from_.mesh.cell_count(), cells.offsets.back()}});
    write_points();
    // both have the same 64-bit type, as in the files of VTK's own writer
    put("Offsets", std::vector<std::int64_t>(cells.offsets.begin(), cells.offsets.end()));
    put("Connectivity", std::vector<std::int64_t>(cells.vertices.begin(), cells.vertices.end()));
    put("Types", from_.types);
    for (const DataArray* const array : from_.arrays) {
      if (!are_texts(array->values)) put_rows(data_group(array->association) + "/" + array->name, *array);
    }
    for (const Association association : {Association::vertices, Association::cells}) name_roles(association);
    write_fields(file_, from_.metadata.fields, from_.notes);
  }

 private:
  template <class Number>
  void put(std::string_view dataset, std::vector<Number> numbers) {
    const std::vector<std::uint64_t> shape{numbers.size()};
    file_.write(fmt::format("{}/{}", kRoot, dataset), Values(std::move(numbers)), shape);
  }

  void write_points() {
    const std::string path = fmt::format("{}/Points", kRoot);
    const std::span<const double> numbers = from_.coordinates();
    const std::vector<std::uint64_t> shape{numbers.size() / 3, 3};
    if (from_.points_are_floats()) {
      file_.write(path, std::vector<float>(numbers.begin(), numbers.end()), shape);
    } else {
      file_.write(path, std::vector<double>(numbers.begin(), numbers.end()), shape);
    }
  }

  /// Writes an array. VTK reads rows of one number only from datasets of one dimension.
  void put_rows(const std::string& path, const DataArray& array) {
    std::vector<std::uint64_t> shape{static_cast<std::uint64_t>(row_count(array))};
    if (array.components != 1) shape.push_back(static_cast<std::uint64_t>(array.components));
    file_.write(path, array.values, shape);
  }

  void name_roles(Association association) {
    for (std::size_t role = 0; role < vtk::kXmlRoles.size(); ++role) {
      const vtk::ArrayRole* const found = from_.role(association, static_cast<vtk::Role>(role));
      if (found != nullptr)
        file_.set_attribute(data_group(association), std::string(vtk::kXmlRoles[role]), found->array);
    }
  }

  vtk::WriteContext& from_;
  hdf5::File& file_;
};

/// Names of the datasets of a mesh, in the order of FilePart::Role.
constexpr std::array<std::string_view, 4> kDatasets{"Points", "Types", "Offsets", "Connectivity"};

}  // namespace

void note_lacking(const vtk::WriteContext& from, Notes& notes) {
  for (const DataArray* const array : from.arrays) {
    if (are_texts(array->values)) {
      note_array_unsupported(*array, "VTKHDF", notes);
    } else {
      note_component_names_unsupported(*array, "VTKHDF", notes);
    }
  }
  for (const std::string& what : from.metadata.contents()) {
    if (!what.starts_with("the field ")) notes.push_back("not written (VTKHDF cannot hold it): " + what);
  }
}

void write_without_values(const std::filesystem::path& path, const std::string& name,
                          const std::vector<Partition>& partitions, FileLayout& layout,
                          const vtk::VtkMetadata& metadata, Notes& notes) {
  const hdf5::Session session;
  Lists lists = lists_of(metadata.fields);
  for (const FilePart& part : layout.parts) {
    if (part.role == FilePart::Role::data)
      lists[data_group(part.association)].push_back(layout.names[part.number]);
  }
  hdf5::File file = hdf5::File::make(path, empty_file(lists), name);
  write_counts(file, partitions);
  std::map<Association, DistinctNames> names;
  std::map<std::pair<Association, std::string>, std::string> held;  // arrays by their names in the file
  std::vector<std::string> paths;
  for (const FilePart& part : layout.parts) {
    if (part.role == FilePart::Role::data) {
      const DataArray array{.name = layout.names[part.number], .association = part.association};
      const std::string own = names[array.association].take(vtk::name_in_hdf5(array.name));
      note_renamed_array(array, own, notes);
      held.try_emplace({array.association, own}, array.name);
      paths.push_back(data_group(array.association) + "/" + own);
    } else {
      paths.push_back(fmt::format("{}/{}", kRoot, kDatasets[static_cast<std::size_t>(part.role)]));
    }
    std::vector<std::uint64_t> shape{static_cast<std::uint64_t>(part.rows)};
    if (part.components != 1) shape.push_back(static_cast<std::uint64_t>(part.components));
    file.make_room(paths.back(), part.type, shape);
  }
  for (const auto& [place, array] : held) {
    for (const vtk::ArrayRole& role : metadata.roles) {
      if (role.association == place.first && role.array == array)
        file.set_attribute(data_group(place.first),
                           std::string(vtk::kXmlRoles[static_cast<std::size_t>(role.role)]), place.second);
    }
  }
  write_fields(file, metadata.fields, notes);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const std::optional<std::uint64_t> place = file.place_of_values(paths[k]);
    if (!place)
      throw InputError(name, fmt::format("no space was allocated for dataset '{}'", paths[k]),
                       "is the disk full?");
    layout.parts[k].at = static_cast<std::int64_t>(*place);
  }
  file.close();
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const hdf5::Session session;
  vtk::WriteContext from(mesh, notes, vtk::NamePlace::hdf5);
  note_lacking(from, notes);
  Lists lists = lists_of(from.metadata.fields);
  for (const DataArray* const array : from.arrays) {
    if (!are_texts(array->values)) lists[data_group(array->association)].push_back(array->name);
  }
  hdf5::write_from(path, empty_file(lists), [&](hdf5::File& file) { VtkHdfWriter(from, file).write(); });
}

}  // namespace meshorder::vtkhdf

namespace meshorder {

Format vtkhdf_format() {
  return {.name = "VTKHDF",
          .extensions = {".vtkhdf"},
          .groups_cells_by_type = false,
          .read = vtkhdf::read,
          .write = vtkhdf::write,
          .holds =
              [](const Mesh& mesh, Shape shape, int vertices) {
                return vtk::holds(mesh, shape, vertices) &&
                       !(shape == Shape::polyhedron && vtk::has_polyhedra(mesh));
              },
          .library = "HDF5",
          .load_library = hdf5::load_library};
}

}  // namespace meshorder
