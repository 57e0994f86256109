// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "io/mesh_part.hpp"
#include <meshorder/io.hpp>

#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// An Exodus II file that all ranks read at once. Each rank opens the file with libnetcdf, with or without
/// MPI support, and reads a range of the nodes, a range of the elements, and the values of every variable in
/// these ranges.
class ExodusSlices {
 public:
  /// Opens a file; every rank has to call it. Returns nothing in a build without netCDF, and for a file
  /// - of another format, or that is not a regular file,
  /// - that is compressed as a whole,
  /// - without vertices or elements,
  /// - with elements that VTK cannot hold, or with an element variable that gives VTK's cell types.
  ///
  /// O(size of the header) at the root.
  ///
  /// @throws SharedError for an Exodus II file that is damaged
  [[nodiscard]] static std::optional<ExodusSlices> open(const Communicator& communicator,
                                                        const std::string& path);

  /// Returns 0, then the end of each block of elements.
  [[nodiscard]] const std::vector<GlobalIndex>& block_ends() const noexcept { return block_ends_; }
  /// Returns whether Nemesis pieces can keep these blocks: there are not too many, and the file itself is no
  /// piece.
  [[nodiscard]] bool has_blocks_of_pieces() const noexcept { return has_blocks_of_pieces_; }

  /// Reads this rank's points and cells. Every rank has to call it. O(size of the slice).
  ///
  /// @throws SharedError if a rank cannot read, for coordinates that are not finite and for cells with
  ///         vertices that do not exist
  [[nodiscard]] MeshSlice read(const Communicator& communicator) const;

  /// Reads this rank's points and cells with their arrays, sets and ids. Every rank has to call it. O(size of
  /// the slice + entries of sets).
  ///
  /// @param notes  receives, at the root, the notes of the readers of all ranks
  /// @throws SharedError as `read`
  [[nodiscard]] MeshPart read_part(const Communicator& communicator, Notes& notes) const;

 private:
  /// Reads this rank's points and cells, and their data if `with_data`.
  [[nodiscard]] MeshPart own_part(const Communicator& communicator, bool with_data, Notes& notes) const;

  std::string path_;
  Layout vertices_;
  Layout cells_;
  std::vector<GlobalIndex> block_ends_;
  bool has_blocks_of_pieces_ = false;
};

}  // namespace meshorder::distributed
