// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/moved_rows.hpp"
#include "distributed/comm/rows.hpp"
#include "distributed/files/file_head.hpp"
#include "distributed/files/file_slices.hpp"
#include "distributed/files/grid_rows.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "distributed/order/order.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// A file to be written, which exists and is empty.
struct SliceFile {
  std::string path;  ///< path of the temporary file
  std::string name;  ///< final name, also in messages
  // for an .xdmf file, path and name (as above) of its HDF5 file; else empty
  std::string data;
  std::string name_of_data;
};

/// A file's mesh, in its new order. Every rank has to call all functions; they throw SharedError if a rank
/// cannot read or write. Each array is read when its rows are needed; the cells are read only once.
///
/// The new file is the old one with the rows of its arrays in their new order. Everything else is copied byte
/// by byte, except the offsets of arrays that follow a compressed array. A new .xdmf file and its HDF5 file
/// are the same as those that the serial writer makes.
class MovedFile {
 public:
  /// Reads the shapes of the cells. `communicator`, `head` and `order` must outlive this object.
  MovedFile(const Communicator& communicator, const FileHead& head, const DistributedOrder& order);

  /// Returns the new place of each cell of the slice.
  [[nodiscard]] const std::vector<GlobalIndex>& new_cells() const noexcept { return new_cells_; }

  /// Returns the path of the HDF5 file that belongs to a new .xdmf file of this name; empty for files of
  /// other kinds.
  [[nodiscard]] std::string new_data(const std::string& name) const;

  /// Writes the new file. O(size of the slice); takes memory for three copies of the cells or of the largest
  /// array of a rank.
  void write(const SliceFile& file);

  /// Returns the points and cells in this rank's range of new places. O(size of the slice).
  [[nodiscard]] MeshSlice slice();

  /// Returns the mesh, which is valid as long as this object. Moves the cells out of this object, so call it
  /// last. O(size of the slice).
  [[nodiscard]] GridRows grid();

 private:
  [[nodiscard]] Rows& cells();
  [[nodiscard]] std::vector<std::byte> rows(const FilePart& part);
  void write_xdmf(const SliceFile& file);

  const Communicator& communicator_;
  const FileHead& head_;
  FileSlices file_;
  const DistributedOrder& order_;
  MeshSlice slice_;
  RowMover vertices_;
  std::vector<GlobalIndex> new_cells_;
  RowMover cell_mover_;
  std::optional<Rows> cells_;
};

}  // namespace meshorder::distributed
