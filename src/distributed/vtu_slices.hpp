// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/communicator.hpp"
#include "distributed/grid_rows.hpp"
#include "distributed/layout.hpp"
#include "distributed/mesh_slice.hpp"
#include "distributed/order.hpp"
#include "distributed/shared_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// A .vtu file of one piece, the arrays of which stand raw in its appended data, read and written by all
/// ranks at once: each its share of every array, one array after another. The new file is the old one with
/// the rows of its arrays in their new places; whatever else it has is copied byte by byte.
///
/// Format: "VTK File Formats", https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.
class VtuSlices {
 public:
  /// Looks at a file; every rank has to call it. Returns nothing for a file that is no such .vtu file: of
  /// several pieces, with text, base64, compression or the other order of bytes. O(size of its XML) at the
  /// root.
  ///
  /// @throws SharedError for a file of that kind that is damaged: XML, counts that differ, bytes beyond its
  ///         end
  [[nodiscard]] static std::optional<VtuSlices> open(const Communicator& communicator,
                                                     const std::string& path);

  /// Reads this rank's points and cells. Every rank has to call it. O(size of the slice).
  ///
  /// @throws SharedError for coordinates that are not finite, unknown types, cells without vertices, with too
  ///         few, or with such that do not exist
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
  /// @throws SharedError where a rank cannot read or write
  void write(const Communicator& communicator, const std::string& path, const std::string& name,
             const DistributedOrder& order) const;

 private:
  enum class Role : std::uint8_t { points, types, offsets, connectivity, data };

  /// The values of an array in the file.
  struct Array {
    Role role;
    Association association;
    std::uint8_t type;  ///< number type, as the alternatives of Values
    Offset at;          ///< first byte
    Offset row;         ///< bytes of a row
    Offset size;        ///< bytes
  };

  class Head;

  [[nodiscard]] const Array& array(Role role) const;
  [[nodiscard]] MeshSlice empty_slice(const Communicator& communicator) const;
  [[nodiscard]] std::vector<std::byte> rows(const Communicator& communicator, const SharedFile& file,
                                            Role role, GlobalIndex begin, GlobalIndex end) const;
  void read_points(const Communicator& communicator, const SharedFile& file, MeshSlice& slice) const;
  void read_cells(const Communicator& communicator, const SharedFile& file, MeshSlice& slice) const;
  void copy_rest(const std::string& path, const std::string& name) const;

  std::string path_;
  std::string head_;  ///< at the root: the file up to its appended data
  GlobalIndex vertices_ = 0;
  GlobalIndex cells_ = 0;
  GlobalIndex entries_ = 0;  ///< of the connectivity
  Offset bytes_ = 0;         ///< size of the file
  std::vector<Array> arrays_;
};

/// Returns the new place of each cell of a slice: those of a dimension take their places in the order in
/// which `in_order`, this rank's share of all cells, lists them. Every rank has to call it. O(cells).
///
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<GlobalIndex> places_by_dimension(const Communicator& communicator,
                                                           const MeshSlice& slice,
                                                           const std::vector<GlobalIndex>& in_order);

}  // namespace meshorder::distributed
