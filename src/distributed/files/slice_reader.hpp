// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/file_head.hpp"
#include "distributed/files/shared_file.hpp"
#include "distributed/order/mesh_slice.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// Reads a file as its head describes it: each rank reads its range of the rows. Every rank has to call all
/// functions.
class SliceReader {
 public:
  /// @param communicator  like `path` and `head`, it must outlive this object
  /// @param path          of the file that has the parts
  /// @throws SharedError if a rank cannot open it
  SliceReader(const Communicator& communicator, const std::string& path, const FileHead& head);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] const SharedFile& file() const noexcept { return file_; }
  [[nodiscard]] const FilePart& part(FilePart::Role role) const;
  /// Returns the ranges of all ranks, without points and cells.
  [[nodiscard]] MeshSlice empty_slice() const;
  /// Returns the bytes of rows begin … end − 1 of a part.
  [[nodiscard]] std::vector<std::byte> rows(const FilePart& part, GlobalIndex begin, GlobalIndex end) const;
  /// Returns the VTK types of this rank's cells.
  [[nodiscard]] std::vector<int> types() const;
  void read_points(MeshSlice& slice) const;
  void read_shapes(MeshSlice& slice) const;
  /// Reads the vertices of the cells; `slice.shapes` must be set.
  void read_cells(MeshSlice& slice) const;

 private:
  /// Reads the offsets of this rank's cells, counted from the first entry of these cells; returns that
  /// entry's place.
  [[nodiscard]] Offset read_offsets(MeshSlice& slice) const;

  const Communicator& communicator_;
  const std::string& path_;
  const FileHead& head_;
  SharedFile file_;
};

}  // namespace meshorder::distributed
