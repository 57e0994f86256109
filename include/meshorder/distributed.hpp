// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/error.hpp>

#include <meshorder_mpi.h>
#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// One rank's share of a mesh. Vertices are numbered across the ranks from 0 on: first those that rank 0
/// owns, then those of rank 1, and so on.
struct RankMesh {
  std::int64_t vertex_count = 0;                    ///< vertices that this rank owns
  std::span<const std::int64_t> cell_offsets = {};  ///< elements + 1, ascending from 0; none: no elements
  /// The vertices of each element, one element after another; any rank may own them.
  std::span<const std::int64_t> cell_vertices = {};
  std::span<const double> points = {};  ///< x y z of each own vertex, also in 2D; or none on all ranks
};

/// Options of a call. All but `threads` must be the same on all ranks.
struct RankOptions {
  std::string method = "spectral";  ///< orders each rank or part; see `vertex_methods`
  /// How `order_parts` makes the parts: "ptscotch", "hilbert", "rsb" (recursive spectral bisection), or
  /// "order": equal ranges of one order of the whole mesh. "order" needs the method "fiedler" and the balance
  /// "vertices", and excludes `interface_last`.
  std::string partition = "ptscotch";
  std::string balance = "vertices";  ///< for `order_parts`: parts get equally many "vertices" or "cells"
  std::uint64_t seed = 0;
  std::int32_t parts = 0;    ///< for `order_parts`, at most the number of vertices; 0: one for each rank
  std::int32_t threads = 1;  ///< number of threads of this rank
  /// Whether the vertices that share an element with vertices of other ranks or parts come last.
  bool interface_last = false;
};

/// Order of one rank's vertices and elements.
struct RankOrder {
  std::vector<std::int64_t> new_numbers;  ///< new number of each owned vertex, within the rank's range
  /// The elements in their new order, by `lexmax`: entry k is the old place of the element at new place k.
  std::vector<std::int64_t> cell_order;
};

/// The parts of a mesh, one after another, and the new numbers of the vertices.
struct PartOrder {
  std::vector<std::int64_t> new_numbers;  ///< new number of each owned vertex
  /// First new number of each part, then the end of the last part; the same on all ranks. Vertices that no
  /// element uses have the numbers from that end on.
  std::vector<std::int64_t> part_starts;
  /// Part of each element: the part of the element's vertex with the largest new number.
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

/// Returns the count; 0 for a negative count, for which the library throws on all ranks.
inline std::size_t room_for(std::int64_t count) { return count > 0 ? static_cast<std::size_t>(count) : 0; }

inline void throw_unless_ok(mo_status status) {
  if (status != MO_OK) throw Error(static_cast<Code>(status), mo_mpi_last_error());
}

/// Calls `allocate` on this rank; throws Error on all ranks if it throws on any rank. Otherwise a rank
/// without memory would leave the others waiting for it.
template <class Allocate>
void allocate_together(MPI_Comm communicator, const Allocate& allocate) {
  int lacks = 0;
  try {
    allocate();
  } catch (const std::exception&) {
    lacks = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, &lacks, 1, MPI_INT, MPI_MAX, communicator);
  if (lacks != 0) throw Error(Code::internal, "a rank lacks memory for the result");
}

}  // namespace detail

/// Orders each rank's vertices among themselves: vertices stay with their owners. A rank's order begins near
/// the rank before it and ends near the rank after it, as far as possible. All ranks must call this function.
///
/// @param communicator  the ranks that share the mesh
/// @param mesh          this rank's share. An element may be on several ranks (ghost layers); each rank
///                      orders all elements that it has
/// @param options       the same on all ranks; `parts`, `partition` and `balance` are not used
/// @throws Error on all ranks if one fails, such as for an unknown method, for options that differ between
///         ranks, for vertex numbers that do not exist, or for a geometric method without coordinates
/// @note The same mesh on the same ranks gives the same order. Memory: O(Σ (vertices of an element)²) for the
///       graph, plus the memory of the method.
inline RankOrder order_ranks(MPI_Comm communicator, const RankMesh& mesh, const RankOptions& options = {}) {
  const mo_mpi_mesh given = detail::to_c(mesh);
  const mo_mpi_options wanted = detail::to_c(options);
  RankOrder order;
  detail::allocate_together(communicator, [&] {
    order.new_numbers.resize(detail::room_for(mesh.vertex_count));
    order.cell_order.resize(static_cast<std::size_t>(given.cell_count));
  });
  detail::throw_unless_ok(mo_mpi_order_ranks(MPI_Comm_c2f(communicator), &given, &wanted,
                                             order.new_numbers.data(), order.cell_order.data()));
  return order;
}

/// Cuts the mesh into parts, orders each part, and numbers the parts one after another, so that touching
/// parts get nearby numbers. The caller has to move vertices and elements to their new owners. All ranks must
/// call this function.
///
/// @param communicator  the ranks that share the mesh
/// @param mesh          this rank's share, with coordinates; each element must be on exactly one rank
/// @param options       the same on all ranks
/// @throws Error as `order_ranks`, and for more parts than vertices
/// @note PT-Scotch needs MPI_THREAD_MULTIPLE; without it "hilbert" makes the parts.
inline PartOrder order_parts(MPI_Comm communicator, const RankMesh& mesh, const RankOptions& options = {}) {
  const mo_mpi_mesh given = detail::to_c(mesh);
  const mo_mpi_options wanted = detail::to_c(options);
  int ranks = 1;
  MPI_Comm_size(communicator, &ranks);
  std::int64_t parts = options.parts > 0 ? options.parts : ranks;
  std::int64_t vertices = 0;
  MPI_Allreduce(&mesh.vertex_count, &vertices, 1, MPI_INT64_T, MPI_SUM, communicator);
  if (options.parts > 0) parts = std::min(parts, vertices);  // more parts than vertices are refused
  PartOrder order;
  detail::allocate_together(communicator, [&] {
    order.new_numbers.resize(detail::room_for(mesh.vertex_count));
    order.part_starts.resize(detail::room_for(parts) + 1);
    order.cell_parts.resize(static_cast<std::size_t>(given.cell_count));
  });
  detail::throw_unless_ok(mo_mpi_order_parts(MPI_Comm_c2f(communicator), &given, &wanted,
                                             order.new_numbers.data(), order.part_starts.data(),
                                             order.cell_parts.data()));
  return order;
}

}  // namespace v0_3
}  // namespace meshorder
