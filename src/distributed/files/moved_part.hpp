// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/moved_rows.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "distributed/order/order.hpp"
#include "io/mesh_part.hpp"
#include <meshorder/io.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// A mesh of which each rank has read a part, and the new places of its vertices and cells. Each rank owns a
/// range of the new places. Each array has one type on all ranks, and ids are sorted anew, as if one rank
/// moved the whole mesh.
class MovedPart {
 public:
  /// Every rank has to call it. O(size of the part).
  ///
  /// @param communicator  must outlive this object
  /// @param part        the part that this rank has read: an equal share of the vertices and of the cells.
  ///                    Arrays must have the same names on all ranks
  /// @param order       the mesh's new order
  /// @param block_ends  as in `places_by_block`; empty: cells keep the places of their dimension
  /// @param notes       receives, at the root, notes on members and numbers that the file gives twice
  /// @throws as `Communicator::exchange`
  MovedPart(const Communicator& communicator, MeshPart part, const DistributedOrder& order,
            std::vector<GlobalIndex> block_ends, Notes& notes);

  /// Returns the part that this rank has read, in the old order, with the old numbers of the cells' vertices.
  [[nodiscard]] const MeshPart& part() const noexcept { return part_; }
  /// Returns the owners of the vertices or cells; the ranges of old numbers and of new places are the same.
  [[nodiscard]] const Layout& layout(Association association) const { return entities(association).layout; }
  /// Returns the new place of each vertex or cell of the part.
  [[nodiscard]] const std::vector<GlobalIndex>& new_places(Association association) const {
    return entities(association).places;
  }
  /// Returns the file's ids of the vertices or cells of the part, in their old order; null if there are none,
  /// or if they are 1, 2, … or not unique.
  [[nodiscard]] const std::vector<std::int64_t>* ids(Association association) const;

  /// Returns the points and cells in this rank's range of new places, with the node order of a Mesh. Every
  /// rank has to call it. O(size of the slice).
  [[nodiscard]] MeshSlice slice() const;
  /// Returns the cells in this rank's range of new places, with the new numbers of their vertices. Every rank
  /// has to call it. O(entries).
  ///
  /// @param cells  vertices of the part's cells; freed before the exchange
  [[nodiscard]] Rows moved_cells(Rows cells) const;
  /// Returns the rows that move to this rank's places. `rows` has `width` bytes for each vertex or cell of
  /// the part. Every rank has to call it. O(bytes).
  [[nodiscard]] std::vector<std::byte> moved(Association association, std::span<const std::byte> rows,
                                             Offset width) const;
  /// As above, for the k-th array of the mesh; NaN or 0 for a vertex or cell without a row.
  [[nodiscard]] std::vector<std::byte> moved_array(std::size_t k) const;
  /// Returns the ids at this rank's places, converted to a number type; there must be ids. Every rank has to
  /// call it.
  [[nodiscard]] std::vector<std::byte> moved_ids(Association association, std::size_t type) const;

  /// Moves the cells out of the part; `part` and `slice` then lack them.
  [[nodiscard]] Cells take_cells() { return std::move(part_.mesh.cells); }

 private:
  /// Data of the vertices or of the cells.
  struct Entities {
    Layout layout;
    std::vector<GlobalIndex> places;  ///< new place of each vertex or cell of the part
    std::optional<RowMover> mover;
    bool has_ids = false;
    std::optional<RowMover> ids_mover;  ///< moves ids to their new places; none if ids stay
  };

  [[nodiscard]] const Entities& entities(Association association) const {
    return association == Association::vertices ? vertices_ : cells_;
  }
  void note_repeated(Notes& notes) const;
  void unify_arrays();
  void settle_ids(Entities& owner, std::vector<std::int64_t>& ids, const std::string& name, Notes& notes);
  [[nodiscard]] std::vector<GlobalIndex> places_of_cells(const std::vector<GlobalIndex>& in_order) const;
  [[nodiscard]] std::vector<GlobalIndex> places_of_ids(const Entities& owner,
                                                       const std::vector<GlobalIndex>& sorted) const;

  const Communicator& communicator_;
  MeshPart part_;
  std::vector<GlobalIndex> block_ends_;
  Entities vertices_;
  Entities cells_;
};

}  // namespace meshorder::distributed
