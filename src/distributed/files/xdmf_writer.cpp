// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/checksum.hpp"
#include "distributed/comm/communicator.hpp"
#include "distributed/comm/moved_rows.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/file_rows.hpp"
#include "distributed/files/file_slices.hpp"
#include "distributed/files/xdmf_head.hpp"
#include "distributed/order/cell_order.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

// Writes .xdmf files: rank 0 makes the HDF5 file by libhdf5, and all ranks fill it.

namespace meshorder::distributed {
namespace {

/// Returns, on all ranks, the checksum with which the writer of whole meshes marks both files.
std::uint64_t checksum_of_xdmf(const Communicator& communicator, const FileFacts& facts,
                               const FileArray& array, const std::vector<std::byte>& points,
                               const Rows& cells) {
  Checksum sum;
  sum.add(facts.vertices);
  add_in_rank_order(communicator, sum, [&] {
    const std::vector<double> coordinates = numbers_of<double>(points, array.type);
    const auto width = static_cast<std::size_t>(array.row / size_of_type(array.type));
    for (std::size_t k = 0; k < coordinates.size(); k += width) {
      Point point{};
      for (std::size_t x = 0; x < width; ++x) point[x] = coordinates[k + x];
      sum.add(point);
    }
  });
  add_in_rank_order(communicator, sum, [&] {
    for (Offset c = 0; c < cells.size(); ++c) sum.add_all(cells[c]);
  });
  return sum.value();
}

}  // namespace

std::vector<GlobalIndex> FileSlices::write_xdmf(const Communicator& communicator, const SliceFile& file,
                                                const DistributedOrder& order) const {
  const SharedFile in(communicator, path_, path_, SharedFile::Use::read);
  MeshSlice slice = empty_slice(communicator);
  read_shapes(communicator, in, slice);
  const RowMover vertices(communicator, slice.vertices, order.new_vertices);
  std::vector<GlobalIndex> new_cells = places_by_dimension(communicator, slice, order.cells);
  const RowMover cells(communicator, slice.cells, new_cells);

  // compute the checksum first, because both files begin with it
  const FileArray& points = array(FileArray::Role::points);
  const std::vector<std::byte> moved_points = moved_rows(communicator, in, points, vertices, cells);
  const Rows moved = moved_cells(communicator, in, std::move(slice), cells, order.new_vertices);
  const std::uint64_t checksum = checksum_of_xdmf(communicator, head_.facts, points, moved_points, moved);
  const std::string xml =
      communicator.at_root([&] { return write_xdmf_head(head_, file.name, file.data, checksum); });
  const std::vector<FileArray> arrays = written(communicator, file).head_.arrays;

  SharedFile data(communicator, file.data, new_data(communicator, file.name), SharedFile::Use::write);
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    const FileArray& array = head_.arrays[k];
    const auto write_array = [&](const std::vector<std::byte>& values) {
      write_raw(communicator, data, arrays[k].at, values);
    };
    if (array.role == FileArray::Role::points) {
      write_array(moved_points);
    } else if (array.role == FileArray::Role::connectivity) {
      write_array(communicator.together([&] { return bytes_of(moved.entries, array.type); }));
    } else {
      write_array(moved_rows(communicator, in, array, vertices, cells));
    }
  }
  data.close();
  SharedFile document(communicator, file.path, file.name, SharedFile::Use::write);
  document.write(0, std::as_bytes(std::span(xml)));
  document.close();
  return new_cells;
}

}  // namespace meshorder::distributed
