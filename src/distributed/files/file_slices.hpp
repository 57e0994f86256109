// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/file_head.hpp"
#include "distributed/files/shared_file.hpp"
#include "distributed/order/mesh_slice.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// Returns the head of a file on all ranks; nothing if the file is not regular or `read_head` returns
/// nothing. Only the root gets the blocks, the XML, the mold and `files`. Every rank has to call it. Rank 0
/// finds the datasets of HDF5 files with libhdf5; the other ranks do not need this library.
///
/// @throws SharedError as `read_head`
[[nodiscard]] std::optional<FileHead> shared_head(const Communicator& communicator, const std::string& path);

/// A file that all ranks read at once, array after array; each rank reads its range of the rows. Every rank
/// has to call each function that reads; such a function throws SharedError if a rank cannot read.
///
/// Formats: "VTK File Formats", https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html, and
/// "VTKHDF File Format".
class FileSlices {
 public:
  /// @param head  as `shared_head` returned it; like `communicator`, it must outlive this object
  /// @throws SharedError if a rank cannot open the file
  FileSlices(const Communicator& communicator, const FileHead& head);

  /// Returns whether the nodes of each cell have the same sequence in the file as in a Mesh; if so, file and
  /// Mesh have the same checksum. O(cells).
  [[nodiscard]] bool has_nodes_as_a_mesh() const;

  /// Reads this rank's points and cells. O(size of the slice).
  ///
  /// @throws SharedError for coordinates that are not finite, unsupported cell types, offsets that do not
  ///         ascend to the number of entries, cells with too few vertices or with vertices that do not exist,
  ///         and damaged blocks
  [[nodiscard]] MeshSlice read() const;

  [[nodiscard]] const SharedFile& file() const noexcept { return file_; }
  [[nodiscard]] const FilePart& part(FilePart::Role role) const;
  /// Returns a slice that has the ranges of all ranks, but no points and cells.
  [[nodiscard]] MeshSlice empty_slice() const;
  /// Returns the bytes of rows begin … end − 1 of a part.
  [[nodiscard]] std::vector<std::byte> rows(const FilePart& part, GlobalIndex begin, GlobalIndex end) const;
  void read_points(MeshSlice& slice) const;
  void read_shapes(MeshSlice& slice) const;
  /// Reads the vertices of the cells; `slice.shapes` must be set.
  void read_cells(MeshSlice& slice) const;

 private:
  /// Returns the VTK types of this rank's cells.
  [[nodiscard]] std::vector<int> types() const;
  /// Reads the offsets of this rank's cells, relative to the first entry of these cells. Returns the index of
  /// that entry in the file.
  [[nodiscard]] Offset read_offsets(MeshSlice& slice) const;

  const Communicator& communicator_;
  const FileHead& head_;
  SharedFile file_;
};

}  // namespace meshorder::distributed
