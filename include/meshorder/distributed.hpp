// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/error.hpp>

#include <meshorder_mpi.h>
#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// What a rank has of a mesh that many ranks share. Vertices are numbered across the ranks from 0 on: those
/// that rank 0 owns, those of rank 1, and so on.
struct RankMesh {
  std::int64_t vertex_count = 0;                    ///< vertices that this rank owns
  std::span<const std::int64_t> cell_offsets = {};  ///< elements + 1, ascending from 0; none: no elements
  /// Numbers of the elements' vertices, whichever rank owns these.
  std::span<const std::int64_t> cell_vertices = {};
  std::span<const double> points = {};  ///< x y z of each own vertex; or none, on all ranks
};

/// The same on all ranks.
struct RankOptions {
  std::string method = "spectral";  ///< vertex method of a part, see `vertex_methods`
  /// Of `order_parts`: "ptscotch", "hilbert", "rsb": recursive spectral bisection, or "order": equal ranges
  /// of one order of the whole mesh, by the method "fiedler" only.
  std::string partition = "ptscotch";
  std::string balance = "vertices";  ///< of `order_parts`: "vertices" or "cells" are shared out evenly
  std::uint64_t seed = 0;
  std::int32_t parts = 0;    ///< of `order_parts`; 0: one for each rank
  std::int32_t threads = 1;  ///< of this rank
  /// Whether vertices that share an element with those of other ranks or parts come after the others.
  bool interface_last = false;
};

/// Order of what a rank has.
struct RankOrder {
  std::vector<std::int64_t> new_numbers;  ///< of each own vertex, within the rank's own range
  /// The elements in their new order, by `lexmax`: entry k is the old place of the element that comes k-th.
  std::vector<std::int64_t> cell_order;
};

/// Parts of a mesh, and the order in which they and their vertices follow each other.
struct PartOrder {
  std::vector<std::int64_t> new_numbers;  ///< of each own vertex
  /// First new number of each part, and the end of the last one's: the same on all ranks. Vertices that no
  /// element uses have the numbers from there on.
  std::vector<std::int64_t> part_starts;
  /// Part of each element: that of its vertex with the largest new number.
  std::vector<std::int64_t> cell_parts;
};

namespace detail {

inline mo_mpi_mesh to_c(const RankMesh& mesh) {
  const std::size_t cells = mesh.cell_offsets.empty() ? 0 : mesh.cell_offsets.size() - 1;
  return {sizeof(mo_mpi_mesh),
          mesh.vertex_count,
          static_cast<std::int64_t>(cells),
          mesh.cell_offsets.data(),
          mesh.cell_vertices.data(),
          mesh.points.empty() ? nullptr : mesh.points.data(),
          static_cast<std::int64_t>(mesh.cell_vertices.size()),
          static_cast<std::int64_t>(mesh.points.size())};
}

inline mo_mpi_options to_c(const RankOptions& options) {
  return {.struct_size = sizeof(mo_mpi_options),
          .method = options.method.c_str(),
          .partition = options.partition.c_str(),
          .balance = options.balance.c_str(),
          .seed = options.seed,
          .parts = options.parts,
          .threads = options.threads,
          .interface_last = options.interface_last ? 1 : 0,
          .reserved = 0};
}

/// A negative count is for the library to refuse, on all ranks.
inline std::size_t room_for(std::int64_t count) { return count > 0 ? static_cast<std::size_t>(count) : 0; }

inline void throw_unless_ok(mo_status status) {
  if (status != MO_OK) throw Error(static_cast<Code>(status), mo_mpi_last_error());
}

}  // namespace detail

/// Orders the vertices of every rank among themselves: each stays with its owner. The ends of a rank's order
/// turn towards the ranks before and after it. Every rank has to call it.
///
/// @param communicator  of the ranks that share the mesh
/// @param mesh          of this rank. Elements may be on several ranks (ghost layers); each rank orders all
///                      that it has
/// @param options       the same on all ranks; `parts`, `partition` and `balance` are not used
/// @throws Error on all ranks where one fails: for an unknown method, for numbers of vertices that there are
///         not, for a geometric method without coordinates
/// @note The same order for the same mesh on the same ranks. O(sum of element sizes squared) memory for the
///       graph, and what the method costs.
inline RankOrder order_ranks(MPI_Comm communicator, const RankMesh& mesh, const RankOptions& options = {}) {
  const mo_mpi_mesh given = detail::to_c(mesh);
  const mo_mpi_options wanted = detail::to_c(options);
  RankOrder order;
  order.new_numbers.resize(detail::room_for(mesh.vertex_count));
  order.cell_order.resize(static_cast<std::size_t>(given.cell_count));
  detail::throw_unless_ok(mo_mpi_order_ranks(MPI_Comm_c2f(communicator), &given, &wanted,
                                             order.new_numbers.data(), order.cell_order.data()));
  return order;
}

/// Cuts the mesh into parts, orders each, and numbers them one after another, so that parts that touch are
/// near each other. Moving vertices and elements to their new owners is left to the caller. Every rank has to
/// call it.
///
/// @param communicator  of the ranks that share the mesh
/// @param mesh          of this rank, with coordinates; each element on one rank
/// @param options       the same on all ranks
/// @throws Error as above
/// @note Parts by PT-Scotch need MPI_THREAD_MULTIPLE; without it they are those of "hilbert".
inline PartOrder order_parts(MPI_Comm communicator, const RankMesh& mesh, const RankOptions& options = {}) {
  const mo_mpi_mesh given = detail::to_c(mesh);
  const mo_mpi_options wanted = detail::to_c(options);
  int ranks = 1;
  MPI_Comm_size(communicator, &ranks);
  PartOrder order;
  order.new_numbers.resize(detail::room_for(mesh.vertex_count));
  order.part_starts.resize(detail::room_for(options.parts > 0 ? options.parts : ranks) + 1);
  order.cell_parts.resize(static_cast<std::size_t>(given.cell_count));
  detail::throw_unless_ok(mo_mpi_order_parts(MPI_Comm_c2f(communicator), &given, &wanted,
                                             order.new_numbers.data(), order.part_starts.data(),
                                             order.cell_parts.data()));
  return order;
}

}  // namespace v0_3
}  // namespace meshorder
