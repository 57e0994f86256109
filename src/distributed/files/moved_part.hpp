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

/// A mesh of which each rank has read a part, and where all of it goes in a new order. Each rank has a range
/// of the new places. Arrays are as wide as those of any rank, and ids are sorted anew, as where one rank
/// moves the whole mesh.
class MovedPart {
 public:
  /// Every rank has to call it. O(size of the part).
  ///
  /// @param communicator  outlives this object
  /// @param part        of this rank: an even range of the vertices and one of the cells. Arrays have the
  /// same
  ///                    names on all ranks
  /// @param order       the mesh's new order
  /// @param block_ends  as of `places_by_block`; empty where cells stay among those of their dimension
  /// @param notes       at the root: members and numbers that the file gives twice
  /// @throws as `Communicator::exchange`
  MovedPart(const Communicator& communicator, MeshPart part, const DistributedOrder& order,
            std::vector<GlobalIndex> block_ends, Notes& notes);

  /// Returns what this rank has read, in the old order; cells name the old numbers of their vertices.
  [[nodiscard]] const MeshPart& part() const noexcept { return part_; }
  /// Returns who has which vertices or cells, by their old numbers or their new places.
  [[nodiscard]] const Layout& layout(Association association) const { return entities(association).layout; }
  /// Returns the new place of each vertex or cell of the part.
  [[nodiscard]] const std::vector<GlobalIndex>& new_places(Association association) const {
    return entities(association).places;
  }
  /// Returns the numbers that the file gives to the vertices or cells of the part, in their old order; null
  /// where they are none but their places.
  [[nodiscard]] const std::vector<std::int64_t>* ids(Association association) const;

  /// Returns the points and cells of this rank's places, the nodes of cells as a Mesh has them. Every rank
  /// has to call it. O(size of the slice).
  [[nodiscard]] MeshSlice slice() const;
  /// Returns the cells of this rank's places, with the new numbers of their vertices. Every rank has to call
  /// it. O(entries).
  ///
  /// @param cells  of the part; taken
  [[nodiscard]] Rows moved_cells(Rows cells) const;
  /// Returns the rows of the vertices or cells of this rank's places, of which there are `width` bytes for
  /// each of the part. Every rank has to call it. O(bytes).
  [[nodiscard]] std::vector<std::byte> moved(Association association, std::span<const std::byte> rows,
                                             Offset width) const;
  /// The same for the k-th array of the mesh; NaN or 0 where it has no row.
  [[nodiscard]] std::vector<std::byte> moved_array(std::size_t k) const;
  /// Returns the ids of this rank's places, which there are, as numbers of a type. Every rank has to call it.
  [[nodiscard]] std::vector<std::byte> moved_ids(Association association, std::size_t type) const;

  /// Gives up the cells of the part, which `part` and `slice` then lack.
  [[nodiscard]] Cells take_cells() { return std::move(part_.mesh.cells); }

 private:
  /// What is known of vertices or of cells.
  struct Entities {
    Layout layout;
    std::vector<GlobalIndex> places;  ///< new ones of the part's
    std::optional<RowMover> mover;
    bool has_ids = false;
    std::optional<RowMover> ids_mover;  ///< to where the ids go
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
