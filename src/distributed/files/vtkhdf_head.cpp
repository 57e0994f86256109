// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/vtkhdf_head.hpp"

#include "base/input_file.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/mold.hpp"
#include "distributed/files/raw_arrays.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/read_limits.hpp"
#ifdef MESHORDER_HAS_HDF5
#include "io/vtkhdf/vtkhdf.hpp"
#endif

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder::distributed {

bool is_hdf5(const std::string& path) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  std::array<char, kSignature.size()> start{};
  (void)InputFile(path).read(start);
  return std::string_view(start.data(), start.size()) == kSignature;
}

#ifdef MESHORDER_HAS_HDF5
namespace {

using vtkhdf::RawDataset;
using vtkhdf::RawGrid;

constexpr Index kMostOfRow = Index{1} << 24;

FileArray::Role role_of(RawDataset::Role role) {
  switch (role) {
    case RawDataset::Role::points:
      return FileArray::Role::points;
    case RawDataset::Role::connectivity:
      return FileArray::Role::connectivity;
    case RawDataset::Role::offsets:
      return FileArray::Role::offsets;
    case RawDataset::Role::types:
      return FileArray::Role::types;
    default:
      return FileArray::Role::data;
  }
}

FileArray array_of(const RawDataset& dataset, std::size_t element) {
  // skip the first offset: the others are the ends of cells, as in a .vtu file
  const Offset before = dataset.role == RawDataset::Role::offsets ? 1 : 0;
  FileArray array = raw_array(dataset.name, role_of(dataset.role), dataset.association, dataset.type,
                              dataset.components, dataset.rows - before,
                              static_cast<Offset>(dataset.place) + before * size_of_type(dataset.type));
  array.element = element;
  return array;
}

/// Returns whether the first offset of a file is 0.
bool begins_at_zero(const std::string& path, const FileArray& offsets) {
  std::vector<std::byte> first(static_cast<std::size_t>(offsets.row));
  const std::size_t got = InputFile(path).read_at(static_cast<std::uint64_t>(offsets.at - offsets.row),
                                                  {reinterpret_cast<char*>(first.data()), first.size()});
  return got == first.size() && numbers_of<Offset>(first, offsets.type).front() == 0;
}

/// Returns the mold of a mesh: see `mold_of`.
std::string mold_of_grid(const RawGrid& grid) {
  std::vector<DataArray> rows;
  for (const RawDataset& dataset : grid.datasets) {
    if (dataset.role != RawDataset::Role::data) continue;
    DataArray& row = rows.emplace_back(
        DataArray{dataset.name, dataset.association, dataset.components, vtk::values_of_type(dataset.type)});
    std::visit([&](auto& values) { values.resize(static_cast<std::size_t>(dataset.components)); },
               row.values);
  }
  Notes ignored;  // on names that XML cannot hold
  return mold_of(std::move(rows), grid.metadata, true, ignored);
}

}  // namespace

std::optional<FileHead> read_vtkhdf_head(const std::string& path) {
  const FilePath file(path);
  const ReadScope scope(file);
  std::optional<RawGrid> grid = vtkhdf::find_raw(file);
  if (!grid || grid->vertices == 0 || grid->cells == 0 || grid->entries == 0) return std::nullopt;
  // the sequence of a .vtu file: first the arrays of points and of cells, then the mesh
  std::stable_partition(grid->datasets.begin(), grid->datasets.end(),
                        [](const RawDataset& dataset) { return dataset.role == RawDataset::Role::data; });
  FileHead head;
  head.facts.kind = FileFacts::Kind::vtkhdf;
  head.facts.vertices = grid->vertices;
  head.facts.cells = grid->cells;
  head.facts.entries = grid->entries;
  head.facts.bytes = static_cast<Offset>(std::filesystem::file_size(path));
  for (const RawDataset& dataset : grid->datasets) {
    if (dataset.components > kMostOfRow) return std::nullopt;
    head.arrays.push_back(array_of(dataset, head.arrays.size()));
    if (dataset.role == RawDataset::Role::points) grid->metadata.float_points = dataset.type == 1;
  }
  if (!sort_by_bytes(head.arrays, head.facts.bytes)) return std::nullopt;
  const auto offsets = std::find_if(head.arrays.begin(), head.arrays.end(), [](const FileArray& array) {
    return array.role == FileArray::Role::offsets;
  });
  if (!begins_at_zero(path, *offsets)) return std::nullopt;
  head.blocks.resize(head.arrays.size());
  head.mold = mold_of_grid(*grid);
  return head;
}
#else
std::optional<FileHead> read_vtkhdf_head(const std::string& /*path*/) { return std::nullopt; }
#endif

}  // namespace meshorder::distributed
