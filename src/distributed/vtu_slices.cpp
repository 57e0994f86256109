// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/vtu_slices.hpp"

#include "cells/cell_arrays.hpp"
#include "distributed/cell_places.hpp"
#include "distributed/halo.hpp"
#include "distributed/moved_rows.hpp"
#include "distributed/shared_file.hpp"
#include "distributed/vtu_numbers.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

namespace meshorder::distributed {
namespace {

using Role = VtuArray::Role;

constexpr Offset kChunk = Offset{1} << 24;  // bytes that are copied at a time

}  // namespace

std::optional<VtuSlices> VtuSlices::open(const Communicator& communicator, const std::string& path) {
  std::optional<VtuHead> at_root = communicator.at_root([&] { return read_vtu_head(path); });
  const std::vector<VtuSizes> sizes =
      communicator.broadcast(at_root ? std::vector<VtuSizes>{at_root->sizes} : std::vector<VtuSizes>{});
  if (sizes.empty()) return std::nullopt;
  VtuSlices slices;
  slices.path_ = path;
  slices.head_.sizes = sizes.front();
  slices.head_.arrays =
      communicator.broadcast(at_root ? std::move(at_root->arrays) : std::vector<VtuArray>{});
  return slices;
}

const VtuArray& VtuSlices::array(Role role) const {
  return *std::find_if(head_.arrays.begin(), head_.arrays.end(),
                       [&](const VtuArray& one) { return one.role == role; });
}

MeshSlice VtuSlices::empty_slice(const Communicator& communicator) const {
  MeshSlice slice;
  slice.vertices = Layout::even(head_.sizes.vertices, communicator.size());
  slice.cells = Layout::even(head_.sizes.cells, communicator.size());
  return slice;
}

MeshSlice VtuSlices::read(const Communicator& communicator) const {
  MeshSlice slice = empty_slice(communicator);
  const SharedFile file(communicator, path_, path_, SharedFile::Use::read);
  read_points(communicator, file, slice);
  read_cells(communicator, file, slice);
  return slice;
}

/// Returns the bytes of rows begin … end − 1 of an array.
std::vector<std::byte> VtuSlices::rows(const Communicator& communicator, const SharedFile& file, Role role,
                                       GlobalIndex begin, GlobalIndex end) const {
  const VtuArray& array = this->array(role);
  std::vector<std::byte> bytes = communicator.together(
      [&] { return std::vector<std::byte>(static_cast<std::size_t>((end - begin) * array.row)); });
  file.read(array.at + begin * array.row, bytes);
  return bytes;
}

void VtuSlices::read_points(const Communicator& communicator, const SharedFile& file,
                            MeshSlice& slice) const {
  const int rank = communicator.rank();
  const GlobalIndex first_vertex = slice.vertices.begin(rank);
  const std::vector<std::byte> points =
      rows(communicator, file, Role::points, first_vertex, slice.vertices.end(rank));
  communicator.together([&] {
    const std::vector<double> coordinates = numbers_of<double>(points, array(Role::points).type);
    slice.points.resize(coordinates.size() / 3);
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      if (!std::isfinite(coordinates[k])) {
        throw InputError(path_,
                         fmt::format("point {} (counted from 0) has a coordinate that is not finite",
                                     first_vertex + static_cast<GlobalIndex>(k / 3)),
                         "finite numbers are needed");
      }
      slice.points[k / 3][k % 3] = coordinates[k];
    }
  });
}

void VtuSlices::read_cells(const Communicator& communicator, const SharedFile& file, MeshSlice& slice) const {
  const int rank = communicator.rank();
  const GlobalIndex first_cell = slice.cells.begin(rank);
  const GlobalIndex end_cell = slice.cells.end(rank);
  const std::vector<std::byte> types = rows(communicator, file, Role::types, first_cell, end_cell);
  // where the cell before ends is where the first one begins
  const GlobalIndex before = std::max<GlobalIndex>(first_cell - 1, 0);
  const std::vector<std::byte> ends =
      rows(communicator, file, Role::offsets, end_cell > first_cell ? before : end_cell, end_cell);
  Offset first_entry = 0;
  communicator.together([&] {
    std::vector<GlobalIndex> offsets = numbers_of<GlobalIndex>(ends, array(Role::offsets).type);
    if (first_cell == 0) offsets.insert(offsets.begin(), 0);
    if (end_cell == first_cell) offsets = {0};
    first_entry = offsets.front();
    for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
      if (offsets[c + 1] > offsets[c] && offsets[c] >= 0 && offsets[c + 1] <= head_.sizes.entries) continue;
      throw InputError(path_,
                       fmt::format("cell {} (counted from 0) has the entries {} to {} of {}",
                                   first_cell + static_cast<GlobalIndex>(c), offsets[c], offsets[c + 1],
                                   head_.sizes.entries),
                       "offsets must ascend to the number of entries");
    }
    if (end_cell == head_.sizes.cells && end_cell > first_cell && offsets.back() != head_.sizes.entries) {
      throw InputError(path_,
                       fmt::format("the cells have {} entries of {}", offsets.back(), head_.sizes.entries),
                       "offsets must ascend to the number of entries");
    }
    slice.cell_vertices.offsets.clear();
    for (const GlobalIndex offset : offsets) slice.cell_vertices.offsets.push_back(offset - first_entry);
    const std::vector<int> numbers = numbers_of<int>(types, array(Role::types).type);
    for (std::size_t c = 0; c < numbers.size(); ++c) {
      const std::optional<Shape> shape = shape_of_vtk_type(numbers[c]);
      const auto vertices = static_cast<int>(offsets[c + 1] - offsets[c]);
      if (!shape || *shape == Shape::polyhedron || vertices < corners(*shape, 1)) {
        throw InputError(path_,
                         fmt::format("cell {} (counted from 0) is of VTK's type {} and has {} points",
                                     first_cell + static_cast<GlobalIndex>(c), numbers[c], vertices),
                         "the type is not understood, or has more points");
      }
      slice.shapes.push_back(*shape);
    }
  });
  const std::vector<std::byte> connectivity = rows(communicator, file, Role::connectivity, first_entry,
                                                   first_entry + slice.cell_vertices.offsets.back());
  communicator.together([&] {
    slice.cell_vertices.entries = numbers_of<GlobalIndex>(connectivity, array(Role::connectivity).type);
    for (const GlobalIndex vertex : slice.cell_vertices.entries) {
      if (vertex >= 0 && vertex < head_.sizes.vertices) continue;
      throw InputError(path_, fmt::format("a cell names the point {}", vertex),
                       fmt::format("the file has points 0 to {}", head_.sizes.vertices - 1));
    }
  });
}

/// Copies all that is no row of an array, and gives the new file its size.
void VtuSlices::copy_rest(const std::string& path, const std::string& name) const {
  std::vector<std::pair<Offset, Offset>> rows;
  for (const VtuArray& array : head_.arrays) rows.emplace_back(array.at, array.at + array.size);
  rows.emplace_back(head_.sizes.bytes, head_.sizes.bytes);
  std::sort(rows.begin(), rows.end());
  std::ifstream from(path_, std::ios::binary);
  std::ofstream to(path, std::ios::binary | std::ios::in | std::ios::out);
  std::vector<char> buffer(static_cast<std::size_t>(kChunk));
  Offset at = 0;
  for (const auto& [begin, end] : rows) {
    for (; at < begin; at += kChunk) {
      const Offset count = std::min(kChunk, begin - at);
      from.seekg(at);
      from.read(buffer.data(), count);
      to.seekp(at);
      to.write(buffer.data(), count);
    }
    at = end;
  }
  if (!from) throw InputError(path_, "cannot be read", "it may have changed while it was read");
  to.close();
  if (!to) throw InputError(name, "cannot be written", "the disk may be full");
}

void VtuSlices::write(const Communicator& communicator, const std::string& path, const std::string& name,
                      const DistributedOrder& order) const {
  communicator.at_root([&] { copy_rest(path, name); });
  const int rank = communicator.rank();
  const SharedFile in(communicator, path_, path_, SharedFile::Use::read);
  SharedFile out(communicator, path, name, SharedFile::Use::write);
  MeshSlice slice = empty_slice(communicator);
  read_cells(communicator, in, slice);
  const GlobalIndex first_cell = slice.cells.begin(rank);

  const RowMover vertices(communicator, slice.vertices, order.new_vertices);
  const RowMover cells(communicator, slice.cells, places_by_dimension(communicator, slice, order.cells));
  for (const VtuArray& array : head_.arrays) {
    if (array.role == Role::offsets || array.role == Role::connectivity) continue;
    const bool on_vertices = array.association == Association::vertices;
    const Layout& layout = on_vertices ? slice.vertices : slice.cells;
    const Offset at = array.at + layout.begin(rank) * array.row;
    std::vector<std::byte> rows = communicator.together(
        [&] { return std::vector<std::byte>(static_cast<std::size_t>(layout.size(rank) * array.row)); });
    in.read(at, rows);
    rows = (on_vertices ? vertices : cells).moved(rows, array.row);
    out.write(at, rows);
  }

  {
    std::vector<GlobalIndex>& numbers = slice.cell_vertices.entries;
    const Halo halo(communicator, slice.vertices, numbers);
    const std::vector<GlobalIndex> new_numbers = halo.fetch(order.new_vertices);
    for (GlobalIndex& number : numbers) number = new_numbers[halo.position(number)];
  }
  const Rows moved = cells.moved(slice.cell_vertices);
  slice = {};
  GlobalIndex first_entry = 0;
  const std::vector<GlobalIndex> sizes =
      communicator.gathered(static_cast<GlobalIndex>(moved.entries.size()));
  for (int r = 0; r < rank; ++r) first_entry += sizes[static_cast<std::size_t>(r)];
  const VtuArray& entries = array(Role::connectivity);
  out.write(entries.at + first_entry * entries.row,
            communicator.together([&] { return bytes_of(moved.entries, entries.type); }));
  const VtuArray& ends = array(Role::offsets);
  out.write(ends.at + first_cell * ends.row, communicator.together([&] {
    std::vector<GlobalIndex> numbers(moved.offsets.begin() + 1, moved.offsets.end());
    for (GlobalIndex& number : numbers) number += first_entry;
    return bytes_of(numbers, ends.type);
  }));
  out.close();
}

}  // namespace meshorder::distributed
