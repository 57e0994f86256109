// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/file_slices.hpp"

#include "cells/cell_arrays.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/file_rows.hpp"
#include "distributed/files/vtkhdf_head.hpp"
#include "distributed/files/vtu_head.hpp"
#include "distributed/files/xdmf_head.hpp"
#include "distributed/order/cell_order.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_compressor.hpp"
#include <meshorder/error.hpp>
#include <meshorder/shape.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

namespace meshorder::distributed {
namespace {

using Role = FileArray::Role;

constexpr Offset kChunk = Offset{1} << 24;  // bytes that are copied at a time

/// Copies bytes begin … end − 1 of a file to another; only the root copies.
void copy_bytes(const Communicator& communicator, const SharedFile& in, Offset begin, Offset end,
                const SharedFile& out, Offset to) {
  std::vector<std::byte> bytes;
  for (Offset at = begin; at < end; at += kChunk) {
    if (communicator.is_root()) bytes.resize(static_cast<std::size_t>(std::min(kChunk, end - at)));
    in.read(at, bytes);
    out.write(to + at - begin, bytes);
  }
}

/// Maps places in an old file to places in a new one.
class NewPlaces {
 public:
  /// Takes the first byte after the XML in each file.
  NewPlaces(Offset old_begin, Offset new_begin) : moves_{{old_begin, new_begin}} {}

  /// Adds a move: bytes of the old file from `old_begin` on, up to the next move, are in the new file from
  /// `new_begin` on. Calls must ascend.
  void add(Offset old_begin, Offset new_begin) { moves_.emplace_back(old_begin, new_begin); }

  /// Returns the first byte after the XML in the new file.
  [[nodiscard]] Offset first_byte() const { return moves_.front().second; }
  /// Returns the new offset for an old one. O(log arrays).
  [[nodiscard]] Offset of_offset(Offset old) const {
    const Offset at = moves_.front().first + old;
    const auto behind = std::upper_bound(moves_.begin(), moves_.end(), at,
                                         [](Offset byte, const auto& move) { return byte < move.first; });
    const auto& [old_begin, new_begin] = *(behind - 1);
    return new_begin + at - old_begin - first_byte();
  }

 private:
  std::vector<std::pair<Offset, Offset>> moves_;  ///< ascending
};

}  // namespace

std::optional<FileSlices> FileSlices::open(const Communicator& communicator, const std::string& path) {
  std::optional<FileHead> at_root = communicator.at_root([&]() -> std::optional<FileHead> {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) return std::nullopt;  // a pipe is read once
    if (is_xdmf(path)) return read_xdmf_head(path);
    return is_hdf5(path) ? read_vtkhdf_head(path) : read_vtu_head(path, communicator.size());
  });
  const std::vector<FileFacts> facts =
      communicator.broadcast(at_root ? std::vector<FileFacts>{at_root->facts} : std::vector<FileFacts>{});
  if (facts.empty()) return std::nullopt;
  FileSlices slices;
  const bool is_own = facts.front().kind != FileFacts::Kind::xdmf;
  slices.path_ = communicator.broadcast(std::vector{is_own || !at_root ? path : at_root->data}).front();
  slices.head_.facts = facts.front();
  slices.head_.arrays =
      communicator.broadcast(at_root ? std::move(at_root->arrays) : std::vector<FileArray>{});
  slices.head_.blocks.resize(slices.head_.arrays.size());
  if (at_root) {
    slices.head_.blocks = std::move(at_root->blocks);
    slices.head_.xml = std::move(at_root->xml);
    slices.head_.mold = std::move(at_root->mold);
    slices.head_.layout = std::move(at_root->layout);
  }
  return slices;
}

const FileArray& FileSlices::array(Role role) const {
  return *std::find_if(head_.arrays.begin(), head_.arrays.end(),
                       [&](const FileArray& one) { return one.role == role; });
}

MeshSlice FileSlices::empty_slice(const Communicator& communicator) const {
  MeshSlice slice;
  slice.vertices = Layout::even(head_.facts.vertices, communicator.size());
  slice.cells = Layout::even(head_.facts.cells, communicator.size());
  return slice;
}

MeshSlice FileSlices::read(const Communicator& communicator) const {
  MeshSlice slice = empty_slice(communicator);
  const SharedFile file(communicator, path_, path_, SharedFile::Use::read);
  read_points(communicator, file, slice);
  read_shapes(communicator, file, slice);
  read_cells(communicator, file, slice);
  return slice;
}

/// Returns the bytes of rows begin … end − 1 of an array of the file.
std::vector<std::byte> FileSlices::rows(const Communicator& communicator, const SharedFile& file,
                                        const FileArray& array, GlobalIndex begin, GlobalIndex end) const {
  const auto number = static_cast<std::size_t>(&array - head_.arrays.data());
  return read_values(communicator, file, path_, head_.facts.encoding.compressor, array, head_.blocks[number],
                     begin * array.row, end * array.row);
}

void FileSlices::read_points(const Communicator& communicator, const SharedFile& file,
                             MeshSlice& slice) const {
  const int rank = communicator.rank();
  const GlobalIndex first_vertex = slice.vertices.begin(rank);
  const FileArray& array = this->array(Role::points);
  const std::vector<std::byte> bytes =
      rows(communicator, file, array, first_vertex, slice.vertices.end(rank));
  communicator.together([&] {
    const std::vector<double> coordinates = numbers_of<double>(bytes, array.type);
    const auto width = static_cast<std::size_t>(array.row / size_of_type(array.type));
    slice.points.resize(coordinates.size() / width);
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      if (!std::isfinite(coordinates[k])) {
        throw InputError(path_,
                         fmt::format("point {} (counted from 0) has a coordinate that is not finite",
                                     first_vertex + static_cast<GlobalIndex>(k / width)),
                         "finite numbers are needed");
      }
      slice.points[k / width][k % width] = coordinates[k];
    }
  });
}

/// Returns the VTK types of this rank's cells.
std::vector<int> FileSlices::types(const Communicator& communicator, const SharedFile& file,
                                   const Layout& cells) const {
  const int rank = communicator.rank();
  const FileArray& array = this->array(Role::types);
  const std::vector<std::byte> bytes = rows(communicator, file, array, cells.begin(rank), cells.end(rank));
  return communicator.together([&] { return numbers_of<int>(bytes, array.type); });
}

bool FileSlices::has_nodes_as_a_mesh(const Communicator& communicator) const {
  if (head_.facts.kind == FileFacts::Kind::xdmf) return true;  // `open` refuses other .xdmf files
  const SharedFile file(communicator, path_, path_, SharedFile::Use::read);
  const std::vector<int> numbers = types(communicator, file, empty_slice(communicator).cells);
  const auto other = std::count_if(numbers.begin(), numbers.end(), [](int type) {
    return type >= 0 && type < 256 && vtk::may_be_reordered(static_cast<std::uint8_t>(type));
  });
  return communicator.sum(static_cast<GlobalIndex>(other)) == 0;
}

void FileSlices::read_shapes(const Communicator& communicator, const SharedFile& file,
                             MeshSlice& slice) const {
  const GlobalIndex first_cell = slice.cells.begin(communicator.rank());
  if (head_.facts.kind == FileFacts::Kind::xdmf) {
    const auto count = static_cast<std::size_t>(slice.cells.end(communicator.rank()) - first_cell);
    return communicator.together([&] { slice.shapes.assign(count, head_.facts.shape); });
  }
  const std::vector<int> numbers = types(communicator, file, slice.cells);
  communicator.together([&] {
    slice.shapes.reserve(numbers.size());
    for (std::size_t c = 0; c < numbers.size(); ++c) {
      const std::optional<Shape> shape = shape_of_vtk_type(numbers[c]);
      if (!shape || *shape == Shape::polyhedron) {
        throw InputError(path_,
                         fmt::format("cell {} (counted from 0) is of VTK's type {}",
                                     first_cell + static_cast<GlobalIndex>(c), numbers[c]),
                         "the type is not understood");
      }
      slice.shapes.push_back(*shape);
    }
  });
}

Offset FileSlices::read_offsets(const Communicator& communicator, const SharedFile& file,
                                MeshSlice& slice) const {
  const int rank = communicator.rank();
  const GlobalIndex entries = head_.facts.entries;
  const GlobalIndex first_cell = slice.cells.begin(rank);
  const GlobalIndex end_cell = slice.cells.end(rank);
  std::vector<Offset>& offsets = slice.cell_vertices.offsets;
  if (head_.facts.kind == FileFacts::Kind::xdmf) {
    communicator.together([&] {
      offsets.resize(static_cast<std::size_t>(end_cell - first_cell) + 1);
      for (std::size_t c = 0; c < offsets.size(); ++c)
        offsets[c] = static_cast<Offset>(c) * head_.facts.nodes;
    });
    return first_cell * head_.facts.nodes;
  }
  const FileArray& ends = array(Role::offsets);
  // the first cell begins where the cell before it ends
  const GlobalIndex before = std::max<GlobalIndex>(first_cell - 1, 0);
  const std::vector<std::byte> bytes =
      rows(communicator, file, ends, end_cell > first_cell ? before : end_cell, end_cell);
  return communicator.together([&] {
    offsets = numbers_of<Offset>(bytes, ends.type);
    if (first_cell == 0) offsets.insert(offsets.begin(), 0);
    if (end_cell == first_cell) offsets = {0};
    for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
      const GlobalIndex cell = first_cell + static_cast<GlobalIndex>(c);
      if (offsets[c + 1] <= offsets[c] || offsets[c] < 0 || offsets[c + 1] > entries) {
        throw InputError(path_,
                         fmt::format("cell {} (counted from 0) has the entries {} to {} of {}", cell,
                                     offsets[c], offsets[c + 1], entries),
                         "offsets must ascend to the number of entries");
      }
      const GlobalIndex vertices = offsets[c + 1] - offsets[c];
      if (vertices < corners(slice.shapes[c], 1)) {
        throw InputError(path_,
                         fmt::format("cell {} (counted from 0) is a {} of {} points", cell,
                                     to_string(slice.shapes[c]), vertices),
                         fmt::format("it has {} corners", corners(slice.shapes[c], 1)));
      }
    }
    if (end_cell == head_.facts.cells && end_cell > first_cell && offsets.back() != entries) {
      throw InputError(path_, fmt::format("the cells have {} entries of {}", offsets.back(), entries),
                       "offsets must ascend to the number of entries");
    }
    const Offset first_entry = offsets.front();
    for (Offset& offset : offsets) offset -= first_entry;
    return first_entry;
  });
}

/// Reads the vertices of the cells; `slice.shapes` must be set.
void FileSlices::read_cells(const Communicator& communicator, const SharedFile& file,
                            MeshSlice& slice) const {
  const Offset first_entry = read_offsets(communicator, file, slice);
  const FileArray& connectivity = array(Role::connectivity);
  const std::vector<std::byte> bytes =
      rows(communicator, file, connectivity, first_entry, first_entry + slice.cell_vertices.offsets.back());
  communicator.together([&] {
    slice.cell_vertices.entries = numbers_of<GlobalIndex>(bytes, connectivity.type);
    for (const GlobalIndex vertex : slice.cell_vertices.entries) {
      if (vertex >= 0 && vertex < head_.facts.vertices) continue;
      throw InputError(path_, fmt::format("a cell names the point {}", vertex),
                       fmt::format("the file has points 0 to {}", head_.facts.vertices - 1));
    }
  });
}

std::vector<std::byte> FileSlices::moved_rows(const Communicator& communicator, const SharedFile& file,
                                              const FileArray& array, const RowMover& vertices,
                                              const RowMover& cells) const {
  const MeshSlice all = empty_slice(communicator);
  const bool on_vertices = array.association == Association::vertices;
  const Layout& layout = on_vertices ? all.vertices : all.cells;
  const int rank = communicator.rank();
  const std::vector<std::byte> values = rows(communicator, file, array, layout.begin(rank), layout.end(rank));
  return (on_vertices ? vertices : cells).moved(values, array.row);
}

/// Returns the cells of this rank's places, with the new numbers of their vertices.
Rows FileSlices::moved_cells(const Communicator& communicator, const SharedFile& file, MeshSlice slice,
                             const RowMover& mover, const std::vector<GlobalIndex>& new_vertices) const {
  read_cells(communicator, file, slice);
  std::vector<GlobalIndex>& numbers = slice.cell_vertices.entries;
  {
    const Halo halo(communicator, slice.vertices, numbers);
    const std::vector<GlobalIndex> new_numbers = halo.fetch(new_vertices);
    for (GlobalIndex& number : numbers) number = new_numbers[halo.position(number)];
  }
  return mover.moved(std::move(slice.cell_vertices));
}

std::string FileSlices::new_data(const Communicator& communicator, const std::string& name) const {
  if (head_.facts.kind != FileFacts::Kind::xdmf) return {};
  return communicator
      .broadcast(communicator.at_root([&] { return std::vector{new_data_of_xdmf(head_, name)}; }))
      .front();
}

FileSlices FileSlices::written(const Communicator& communicator, const SliceFile& file) const {
  if (head_.facts.kind != FileFacts::Kind::xdmf) return *open(communicator, file.path);
  FileSlices result = *this;
  result.path_ = file.data;
  const std::vector<Offset> places = communicator.broadcast(
      communicator.at_root([&] { return places_in_xdmf(head_, file.name, file.data); }));
  for (FileArray& array : result.head_.arrays) array.at = places[array.element];
  return result;
}

std::vector<GlobalIndex> FileSlices::write(const Communicator& communicator, const SliceFile& file,
                                           const DistributedOrder& order) const {
  if (head_.facts.kind == FileFacts::Kind::xdmf) return write_xdmf(communicator, file, order);
  const int rank = communicator.rank();
  const SharedFile in(communicator, path_, path_, SharedFile::Use::read);
  SharedFile out(communicator, file.path, file.name, SharedFile::Use::write);
  MeshSlice slice = empty_slice(communicator);
  read_shapes(communicator, in, slice);
  const RowMover vertices(communicator, slice.vertices, order.new_vertices);
  std::vector<GlobalIndex> new_cells = places_by_dimension(communicator, slice, order.cells);
  const RowMover cells(communicator, slice.cells, new_cells);

  // the XML comes last: it has the offsets of arrays whose compressed sizes are not known yet
  const bool is_vtkhdf = head_.facts.kind == FileFacts::Kind::vtkhdf;
  const bool is_raw = head_.facts.encoding.compressor == VtuEncoding::Compressor::none;
  Offset from = head_.facts.first_byte;
  Offset to = communicator.broadcast(std::vector<Offset>{is_raw ? from : head_.xml.most_bytes()}).front();
  NewPlaces places(from, to);
  std::optional<Rows> moved;
  for (const FileArray& array : head_.arrays) {
    copy_bytes(communicator, in, from, array.at, out, to);
    to += array.at - from;
    from = array.at + array.stored;
    const auto write_array = [&](std::vector<std::byte> values) {
      places.add(array.at, to);
      to += is_vtkhdf ? write_raw(communicator, out, to, values)
                      : write_values(communicator, out, head_.facts.encoding, to, std::move(values),
                                     vtk::VtuCompressor::kBlock);
      places.add(from, to);
    };
    if (array.role == Role::connectivity || array.role == Role::offsets) {
      if (!moved) moved = moved_cells(communicator, in, slice, cells, order.new_vertices);
      const GlobalIndex first_entry =
          Layout::of_sizes(communicator.gathered(std::ssize(moved->entries))).begin(rank);
      write_array(communicator.together([&] {
        if (array.role == Role::connectivity) return bytes_of(moved->entries, array.type);
        std::vector<GlobalIndex> ends(moved->offsets.begin() + 1, moved->offsets.end());
        for (GlobalIndex& end : ends) end += first_entry;
        return bytes_of(ends, array.type);
      }));
      continue;
    }
    write_array(moved_rows(communicator, in, array, vertices, cells));
  }
  copy_bytes(communicator, in, from, head_.facts.bytes, out, to);
  const std::string xml = communicator.at_root([&] {
    if (is_vtkhdf) return std::string();
    return head_.xml.with_offsets([&](Offset offset) { return places.of_offset(offset); },
                                  places.first_byte());
  });
  out.write(0, std::as_bytes(std::span(xml)));
  out.close();
  return new_cells;
}

}  // namespace meshorder::distributed
