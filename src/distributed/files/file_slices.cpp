// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/file_slices.hpp"

#include "cells/cell_arrays.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/file_rows.hpp"
#include "io/vtk/vtk.hpp"
#include <meshorder/error.hpp>
#include <meshorder/shape.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

namespace meshorder::distributed {
namespace {

using Role = FilePart::Role;

}  // namespace

std::optional<FileHead> shared_head(const Communicator& communicator, const std::string& path) {
  std::optional<FileHead> at_root = communicator.at_root([&]() -> std::optional<FileHead> {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) return std::nullopt;  // a pipe can be read only once
    return read_head(path, communicator.size());
  });
  const std::vector<FileFacts> facts =
      communicator.broadcast(at_root ? std::vector<FileFacts>{at_root->facts} : std::vector<FileFacts>{});
  if (facts.empty()) return std::nullopt;
  FileHead head;
  if (at_root) head = *std::move(at_root);
  head.facts = facts.front();
  head.path = communicator.broadcast(std::vector{head.path}).front();
  head.parts = communicator.broadcast(std::move(head.parts));
  head.names = communicator.broadcast(head.names);
  head.blocks.resize(head.parts.size());
  return head;
}

FileSlices::FileSlices(const Communicator& communicator, const FileHead& head)
    : communicator_(communicator),
      head_(head),
      file_(communicator, head.path, head.path, SharedFile::Use::read) {}

bool FileSlices::has_nodes_as_a_mesh() const {
  if (head_.facts.kind == FileFacts::Kind::xdmf) return true;  // `read_head` refuses other .xdmf files
  const std::vector<int> numbers = types();
  const auto other = std::count_if(numbers.begin(), numbers.end(), [](int type) {
    return type >= 0 && type < 256 && vtk::may_be_reordered(static_cast<std::uint8_t>(type));
  });
  return communicator_.sum(static_cast<GlobalIndex>(other)) == 0;
}

MeshSlice FileSlices::read() const {
  MeshSlice slice = empty_slice();
  read_points(slice);
  read_shapes(slice);
  read_cells(slice);
  return slice;
}

const FilePart& FileSlices::part(Role role) const {
  return *std::find_if(head_.parts.begin(), head_.parts.end(),
                       [&](const FilePart& one) { return one.role == role; });
}

MeshSlice FileSlices::empty_slice() const {
  MeshSlice slice;
  slice.vertices = Layout::even(head_.facts.vertices, communicator_.size());
  slice.cells = Layout::even(head_.facts.cells, communicator_.size());
  return slice;
}

std::vector<std::byte> FileSlices::rows(const FilePart& part, GlobalIndex begin, GlobalIndex end) const {
  return read_values(communicator_, file_, {head_.path, head_.names[part.number]},
                     head_.facts.encoding.compressor, part, head_.blocks[part.number],
                     begin * part.row_size(), end * part.row_size());
}

void FileSlices::read_points(MeshSlice& slice) const {
  const int rank = communicator_.rank();
  const GlobalIndex first_vertex = slice.vertices.begin(rank);
  const FilePart& points = part(Role::points);
  const std::vector<std::byte> bytes = rows(points, first_vertex, slice.vertices.end(rank));
  communicator_.together([&] {
    const std::vector<double> coordinates = numbers_of<double>(bytes, points.type);
    const auto width = static_cast<std::size_t>(points.components);
    slice.points.resize(coordinates.size() / width);
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      if (!std::isfinite(coordinates[k])) {
        throw InputError(head_.path,
                         fmt::format("point {} (counted from 0) has a coordinate that is not finite",
                                     first_vertex + static_cast<GlobalIndex>(k / width)),
                         "finite numbers are needed");
      }
      slice.points[k / width][k % width] = coordinates[k];
    }
  });
}

std::vector<int> FileSlices::types() const {
  const Layout cells = empty_slice().cells;
  const int rank = communicator_.rank();
  const FilePart& types = part(Role::types);
  const std::vector<std::byte> bytes = rows(types, cells.begin(rank), cells.end(rank));
  return communicator_.together([&] { return numbers_of<int>(bytes, types.type); });
}

void FileSlices::read_shapes(MeshSlice& slice) const {
  const GlobalIndex first_cell = slice.cells.begin(communicator_.rank());
  if (head_.facts.nodes > 0) {
    const auto count = static_cast<std::size_t>(slice.cells.size(communicator_.rank()));
    return communicator_.together([&] { slice.shapes.assign(count, head_.facts.shape); });
  }
  const std::vector<int> numbers = types();
  communicator_.together([&] {
    slice.shapes.reserve(numbers.size());
    for (std::size_t c = 0; c < numbers.size(); ++c) {
      const std::optional<Shape> shape = shape_of_vtk_type(numbers[c]);
      if (!shape || *shape == Shape::polyhedron) {
        throw InputError(head_.path,
                         fmt::format("cell {} (counted from 0) is of VTK's type {}",
                                     first_cell + static_cast<GlobalIndex>(c), numbers[c]),
                         "the type is not supported");
      }
      slice.shapes.push_back(*shape);
    }
  });
}

Offset FileSlices::read_offsets(MeshSlice& slice) const {
  const int rank = communicator_.rank();
  const GlobalIndex entries = head_.facts.entries;
  const GlobalIndex first_cell = slice.cells.begin(rank);
  const GlobalIndex end_cell = slice.cells.end(rank);
  std::vector<Offset>& offsets = slice.cell_vertices.offsets;
  if (head_.facts.nodes > 0) {
    communicator_.together([&] {
      offsets.resize(static_cast<std::size_t>(end_cell - first_cell) + 1);
      for (std::size_t c = 0; c < offsets.size(); ++c)
        offsets[c] = static_cast<Offset>(c) * head_.facts.nodes;
    });
    return first_cell * head_.facts.nodes;
  }
  const FilePart& ends = part(Role::offsets);
  // the first cell begins where the cell before it ends
  const GlobalIndex before = std::max<GlobalIndex>(first_cell - 1, 0);
  const std::vector<std::byte> bytes = rows(ends, end_cell > first_cell ? before : end_cell, end_cell);
  return communicator_.together([&] {
    offsets = numbers_of<Offset>(bytes, ends.type);
    if (first_cell == 0) offsets.insert(offsets.begin(), 0);
    if (end_cell == first_cell) offsets = {0};
    for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
      const GlobalIndex cell = first_cell + static_cast<GlobalIndex>(c);
      if (offsets[c + 1] <= offsets[c] || offsets[c] < 0 || offsets[c + 1] > entries) {
        throw InputError(head_.path,
                         fmt::format("cell {} (counted from 0) has the entries {} to {} of {}", cell,
                                     offsets[c], offsets[c + 1], entries),
                         "offsets must ascend to the number of entries");
      }
      const GlobalIndex vertices = offsets[c + 1] - offsets[c];
      if (vertices < corners(slice.shapes[c], 1)) {
        throw InputError(head_.path,
                         fmt::format("cell {} (counted from 0) is a {} of {} points", cell,
                                     to_string(slice.shapes[c]), vertices),
                         fmt::format("it has {} corners", corners(slice.shapes[c], 1)));
      }
    }
    if (end_cell == head_.facts.cells && end_cell > first_cell && offsets.back() != entries) {
      throw InputError(head_.path, fmt::format("the cells have {} entries of {}", offsets.back(), entries),
                       "offsets must ascend to the number of entries");
    }
    const Offset first_entry = offsets.front();
    for (Offset& offset : offsets) offset -= first_entry;
    return first_entry;
  });
}

void FileSlices::read_cells(MeshSlice& slice) const {
  const Offset first_entry = read_offsets(slice);
  const FilePart& connectivity = part(Role::connectivity);
  const std::vector<std::byte> bytes =
      rows(connectivity, first_entry, first_entry + slice.cell_vertices.offsets.back());
  communicator_.together([&] {
    slice.cell_vertices.entries = numbers_of<GlobalIndex>(bytes, connectivity.type);
    for (const GlobalIndex vertex : slice.cell_vertices.entries) {
      if (vertex >= 0 && vertex < head_.facts.vertices) continue;
      throw InputError(head_.path, fmt::format("a cell names the point {}", vertex),
                       fmt::format("the file has points 0 to {}", head_.facts.vertices - 1));
    }
  });
}

}  // namespace meshorder::distributed
