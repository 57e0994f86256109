// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/files/file_head.hpp"
#include "distributed/order/mesh_slice.hpp"

#include <optional>
#include <string>

namespace meshorder::distributed {

/// A file that all ranks read at once, array after array; each rank handles its range of the rows.
/// The file is one of these:
/// - a .vtu file of one piece with its arrays in appended data, raw or in compressed blocks;
/// - a .vtkhdf file of one partition, whose datasets are neither chunked nor compressed;
/// - an .xdmf file of one mesh of one cell type, with such datasets.
///
/// Rank 0 finds the datasets by libhdf5; the other ranks do not need this library.
///
/// Formats: "VTK File Formats", https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html, and
/// "VTKHDF File Format".
class FileSlices {
 public:
  /// Opens a file; every rank has to call it. Returns nothing for a file of another kind: with several pieces
  /// or partitions, with text, base64, chunks or the other byte order, or with a compression that this build
  /// lacks. O(size of its XML + blocks) at the root.
  ///
  /// @throws SharedError for a file of this kind that is damaged: bad XML, counts that differ, arrays beyond
  ///         its end, blocks whose sizes are impossible
  [[nodiscard]] static std::optional<FileSlices> open(const Communicator& communicator,
                                                      const std::string& path);

  /// Returns whether the nodes of each cell have the same sequence in the file as in a Mesh; if so, file and
  /// Mesh have the same checksum. Every rank has to call it. O(cells).
  ///
  /// @throws SharedError if a rank cannot read
  [[nodiscard]] bool has_nodes_as_a_mesh(const Communicator& communicator) const;

  /// Reads this rank's points and cells. Every rank has to call it. O(size of the slice).
  ///
  /// @throws SharedError for coordinates that are not finite, unknown cell types, cells with too few vertices
  ///         or with vertices that do not exist, and for damaged blocks
  [[nodiscard]] MeshSlice read(const Communicator& communicator) const;

  /// Returns the path of the HDF5 file that belongs to a new .xdmf file of this mesh; empty for files of
  /// other kinds. Every rank has to call it.
  [[nodiscard]] std::string new_data(const Communicator& communicator, const std::string& name) const;

  /// Returns the path of the file that has the arrays.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Returns the description of the file. It has blocks and XML only at the root.
  [[nodiscard]] const FileHead& head() const noexcept { return head_; }

 private:
  std::string path_;
  FileHead head_;
};

}  // namespace meshorder::distributed
