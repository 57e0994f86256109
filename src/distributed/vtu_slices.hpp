// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/communicator.hpp"
#include "distributed/grid_rows.hpp"
#include "distributed/layout.hpp"
#include "distributed/mesh_slice.hpp"
#include "distributed/moved_rows.hpp"
#include "distributed/order.hpp"
#include "distributed/shared_file.hpp"
#include "distributed/vtu_head.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// A .vtu file of one piece, the arrays of which stand in its appended data, raw or in compressed blocks, or
/// a .vtkhdf file of one partition whose datasets are neither chunked nor compressed, read and written by all
/// ranks at once: each its share of every array, one array after another. The new file is the old one with
/// the rows of its arrays in their new places; whatever else it has is copied byte by byte, but for the
/// offsets of arrays behind compressed ones. libhdf5 tells rank 0 where the datasets are; no rank else
/// needs it.
///
/// Formats: "VTK File Formats", https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html, and
/// "VTKHDF File Format".
class VtuSlices {
 public:
  /// Looks at a file; every rank has to call it. Returns nothing for a file that is no such one: of several
  /// pieces or partitions, with text, base64, chunks, the other order of bytes, or compression that this
  /// build lacks. O(size of its XML + blocks) at the root.
  ///
  /// @throws SharedError for a file of that kind that is damaged: XML, counts that differ, bytes beyond its
  ///         end, blocks that cannot hold what they are said to
  [[nodiscard]] static std::optional<VtuSlices> open(const Communicator& communicator,
                                                     const std::string& path);

  /// Returns whether all cells have their nodes in the order in which a Mesh has them, so that the checksums
  /// of both are the same. Every rank has to call it. O(cells).
  ///
  /// @throws SharedError where a rank cannot read
  [[nodiscard]] bool has_nodes_as_a_mesh(const Communicator& communicator) const;

  /// Reads this rank's points and cells. Every rank has to call it. O(size of the slice).
  ///
  /// @throws SharedError for coordinates that are not finite, unknown types, cells without vertices, with too
  ///         few, or with such that do not exist, and for blocks that are damaged
  [[nodiscard]] MeshSlice read(const Communicator& communicator) const;

  /// Returns the mesh in its new order, this object's as long as it lives. Every rank has to call it. Reads
  /// the cells once more, and each array when its rows are asked for. O(size of the slice).
  ///
  /// @throws SharedError where a rank cannot read
  [[nodiscard]] GridRows in_new_order(const Communicator& communicator, const DistributedOrder& order) const;

  /// Writes the mesh in its new order over a file that exists, and is empty. Every rank has to call it. Reads
  /// the arrays once more, one after another. O(size of the slice), memory for the cells or the largest array
  /// of a rank three times.
  ///
  /// @param path    of the new file
  /// @param name    of the new file in messages
  /// @return the new place of each cell of the slice
  /// @throws SharedError where a rank cannot read or write
  [[nodiscard]] std::vector<GlobalIndex> write(const Communicator& communicator, const std::string& path,
                                               const std::string& name, const DistributedOrder& order) const;

 private:
  [[nodiscard]] const VtuArray& array(VtuArray::Role role) const;
  [[nodiscard]] MeshSlice empty_slice(const Communicator& communicator) const;
  [[nodiscard]] std::vector<std::byte> rows(const Communicator& communicator, const SharedFile& file,
                                            const VtuArray& array, GlobalIndex begin, GlobalIndex end) const;
  void read_points(const Communicator& communicator, const SharedFile& file, MeshSlice& slice) const;
  [[nodiscard]] std::vector<int> types(const Communicator& communicator, const SharedFile& file,
                                       const Layout& cells) const;
  void read_shapes(const Communicator& communicator, const SharedFile& file, MeshSlice& slice) const;
  void read_cells(const Communicator& communicator, const SharedFile& file, MeshSlice& slice) const;
  [[nodiscard]] Rows moved_cells(const Communicator& communicator, const SharedFile& file, MeshSlice slice,
                                 const RowMover& mover, const std::vector<GlobalIndex>& new_vertices) const;

  std::string path_;
  VtuHead head_;  ///< blocks and XML at the root only
};

}  // namespace meshorder::distributed
