// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/mesh_share.hpp"
#include "graph/incidence.hpp"
#include <meshorder/mesh.hpp>

#include <span>
#include <vector>

namespace meshorder::distributed {

/// The cells and vertices of the parts of a mesh, without ghost cells. A cell is in the part of its vertex
/// with the largest number. A vertex is in each part whose cells use it; an unused vertex is in the part to
/// which its number belongs. A rank has only the cells of its own parts, and knows which other parts share
/// their vertices. Vertices and cells are numbered as in the rank's share of the mesh.
class MeshParts {
 public:
  /// Every rank has to call it. O(entries · log parts).
  ///
  /// @param mesh         this rank's share of the mesh, as in `MeshShare`
  /// @param numbers      new numbers of the vertices and cells of `mesh`
  /// @param part_starts  as in `part_of`
  /// @throws as `Communicator::exchange`
  MeshParts(const Communicator& communicator, const Mesh& mesh, const ShareNumbers& numbers,
            const std::vector<GlobalIndex>& part_starts);

  [[nodiscard]] Index size() const noexcept { return cells_.size(); }
  /// Returns the cells of a part, ascending.
  [[nodiscard]] std::span<const Index> cells(Index part) const { return cells_[part]; }
  /// Returns the vertices of a part: first those that belong to the part, then those of other parts. Both
  /// lists ascend, so that the second is grouped by part.
  [[nodiscard]] std::span<const Index> vertices(Index part) const { return vertices_[part]; }
  /// Returns all parts, of any rank, that have a vertex; ascending.
  [[nodiscard]] std::span<const Index> parts_with(Index vertex) const { return parts_of_vertices_[vertex]; }
  /// Returns the part of a cell.
  [[nodiscard]] Index part_with(Index cell) const { return part_of_cells_[static_cast<std::size_t>(cell)]; }

 private:
  void find_own(const Mesh& mesh, const std::vector<GlobalIndex>& part_starts);
  void find_sharing_parts(const Communicator& communicator, const ShareNumbers& numbers);

  std::vector<Index> part_of_cells_;
  Incidence cells_;              ///< cells of each part
  Incidence vertices_;           ///< vertices of each part
  Incidence parts_of_vertices_;  ///< parts that have each vertex
};

/// Extracts the parts of a mesh, with the arrays, sets and ids of their cells and vertices.
class PartCutter {
 public:
  /// The arguments must outlive this object. O(vertices + cells + rows of partial arrays + members of sets).
  PartCutter(const Mesh& mesh, const MeshParts& parts);

  /// Returns a part as a mesh with vertices and cells in the order of `MeshParts` and the metadata of the
  /// whole mesh, but without `cell_blocks`. Keeps sets even if they have no members in the part. Drops an
  /// array on only some vertices or cells if it has no rows in the part. O(size of the part).
  [[nodiscard]] Mesh cut(Index part);

 private:
  void cut_cells(Index part, Mesh& piece) const;
  void cut_data(Index part, Mesh& piece) const;
  void cut_sets(Index part, Mesh& piece) const;
  /// Returns the position of each of these vertices or cells in the part that is being cut.
  [[nodiscard]] std::vector<Index> placed(Association association, std::span<const Index> numbers) const;

  const Mesh& mesh_;
  const MeshParts& parts_;
  std::vector<Incidence> rows_;       ///< rows of each part, by array; empty for dense arrays
  std::vector<Incidence> members_;    ///< by set: positions, in the set's list, of each part's members
  std::vector<Index> vertex_places_;  ///< positions in the part being cut; stale for vertices not in it
  std::vector<Index> cell_places_;
};

}  // namespace meshorder::distributed
