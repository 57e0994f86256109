// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/communicator.hpp"
#include "distributed/grid_rows.hpp"
#include "distributed/layout.hpp"
#include "distributed/mesh_slice.hpp"
#include "distributed/moved_rows.hpp"
#include "distributed/order.hpp"
#include "io/mesh_part.hpp"
#include "io/vtk/vtk.hpp"
#include <meshorder/io.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// A mesh of which each rank has read a part, in its new order. It is what `scattered_grid` makes of the
/// whole mesh once that is in this order: labels and ids are as wide as those of any rank need, ids are
/// sorted anew, sets are marked in the order of all their members.
class MovedPart {
 public:
  /// Every rank has to call it. O(size of the part).
  ///
  /// @param communicator  outlives this object
  /// @param part   of this rank: an even range of the vertices and one of the cells; VTK holds these. Arrays
  ///               have the same names on all ranks
  /// @param order  the mesh's new order
  /// @param notes  at the root: members and numbers that the file gives twice
  /// @throws as `Communicator::exchange`
  MovedPart(const Communicator& communicator, MeshPart part, const DistributedOrder& order, Notes& notes);

  /// Returns the points and cells of this rank's places, the nodes of cells as a Mesh has them. Every rank
  /// has to call it. O(size of the slice).
  [[nodiscard]] MeshSlice slice() const;

  /// Returns the mesh as a .vtu file holds it, this object's as long as it lives. Gives up the cells, so that
  /// neither this nor `slice` can be called again. Every rank has to call it. O(size of the cells).
  ///
  /// @param notes  at the root: what VTK's files hold in another way
  [[nodiscard]] GridRows grid(Notes& notes);

  /// Returns the new place of each cell of the part.
  [[nodiscard]] const std::vector<GlobalIndex>& new_cells() const noexcept { return cells_.places; }
  /// Returns the numbers that the file gives to the vertices or cells of the part, in their old order; null
  /// where they are none but their places.
  [[nodiscard]] const std::vector<std::int64_t>* ids(Association association) const;

 private:
  /// What is known of vertices or of cells.
  struct Entities {
    Layout layout;
    std::vector<GlobalIndex> places;  ///< new ones of the part's
    std::optional<RowMover> mover;
    bool has_ids = false;
    std::optional<RowMover> ids_mover;  ///< to where the ids go
  };
  /// An array of the .vtu file.
  struct Array {
    enum class Source : std::uint8_t { data, set, ids };
    Source source;
    std::size_t number;  ///< among the mesh's arrays or sets
    Association association;
    std::size_t type;  ///< number type, as the alternatives of Values
    Index components;
  };

  [[nodiscard]] const Entities& entities(Association association) const {
    return association == Association::vertices ? vertices_ : cells_;
  }
  [[nodiscard]] MeshSlice unmoved() const;
  void note_repeated(Notes& notes) const;
  void unify_arrays();
  void settle_ids(Entities& owner, std::vector<std::int64_t>& ids, const std::string& name, Notes& notes);
  [[nodiscard]] std::vector<GlobalIndex> places_of_ids(const Entities& owner,
                                                       const std::vector<GlobalIndex>& sorted) const;
  [[nodiscard]] std::vector<std::int32_t> ranks_in_set(std::size_t set) const;
  void list_arrays();
  /// Returns the bytes of an array in the old order of the part.
  [[nodiscard]] std::vector<std::byte> bytes(const Array& array) const;
  /// Returns the rows of the k-th array of the file that are in this rank's places.
  [[nodiscard]] std::vector<std::byte> rows(std::size_t k) const;
  [[nodiscard]] Rows moved_cells(Rows cells) const;
  [[nodiscard]] std::string xml(Notes& notes) const;

  const Communicator& communicator_;
  MeshPart part_;
  Entities vertices_;
  Entities cells_;
  std::vector<std::vector<std::int32_t>> set_ranks_;  ///< of the members of each set; none: 1 for each
  std::vector<Array> arrays_;
  std::vector<std::uint8_t> types_;  ///< VTK's
};

}  // namespace meshorder::distributed
