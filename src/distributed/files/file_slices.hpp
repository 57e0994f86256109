// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/file_head.hpp"
#include "distributed/files/grid_rows.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "distributed/order/order.hpp"

#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// A new file, which exists and is empty.
struct SliceFile {
  std::string path;  ///< temporary path, until it is complete
  std::string name;  ///< final name, also in messages
  std::string data;  ///< temporary path of the HDF5 file that belongs to an .xdmf file
};

/// A file that all ranks read and write at once, array after array; each rank handles its range of the rows.
/// The file is one of these:
/// - a .vtu file of one piece with its arrays in appended data, raw or in compressed blocks;
/// - a .vtkhdf file of one partition, whose datasets are neither chunked nor compressed;
/// - an .xdmf file of one mesh of one cell type, with such datasets.
///
/// The new file is the old one with the rows of its arrays in their new places; everything else is copied
/// byte by byte, except the offsets of arrays that follow a compressed array. A new .xdmf file and its HDF5
/// file are the same as those of the serial writer. Rank 0 finds the datasets by libhdf5; the other ranks do
/// not need this library.
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

  /// Returns the mesh in its new order, valid as long as this object. Every rank has to call it. Reads
  /// the cells once more, and each array when its rows are requested. O(size of the slice).
  ///
  /// @throws SharedError if a rank cannot read
  [[nodiscard]] GridRows in_new_order(const Communicator& communicator, const DistributedOrder& order) const;

  /// Writes the mesh in its new order to a file that exists and is empty. Every rank has to call it. Reads
  /// the arrays once more, one after another. O(size of the slice); takes memory for three copies of the
  /// cells or of the largest array of a rank.
  ///
  /// @return the new place of each cell of the slice
  /// @throws SharedError if a rank cannot read or write
  [[nodiscard]] std::vector<GlobalIndex> write(const Communicator& communicator, const SliceFile& file,
                                               const DistributedOrder& order) const;

  /// Returns the path of the HDF5 file that belongs to a new .xdmf file of this mesh; empty for files of
  /// other kinds. Every rank has to call it.
  [[nodiscard]] std::string new_data(const Communicator& communicator, const std::string& name) const;

  /// Opens a file that this object wrote. Every rank has to call it.
  ///
  /// @throws SharedError as `open`
  [[nodiscard]] FileSlices written(const Communicator& communicator, const SliceFile& file) const;

 private:
  /// As `write`, for .xdmf files.
  [[nodiscard]] std::vector<GlobalIndex> write_xdmf(const Communicator& communicator, const SliceFile& file,
                                                    const DistributedOrder& order) const;
  /// Returns the first byte of each part in the data of a new .xdmf file.
  [[nodiscard]] std::vector<Offset> new_places(const Communicator& communicator, const SliceFile& file) const;

  std::string path_;  ///< path of the file that has the arrays
  FileHead head_;     ///< has its blocks and XML only at the root
};

}  // namespace meshorder::distributed
