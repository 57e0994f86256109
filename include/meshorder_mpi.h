/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#ifndef MESHORDER_MPI_H
#define MESHORDER_MPI_H

/**
 * @file
 * The C interface of meshorder for meshes that many ranks of MPI share (C99): new numbers of vertices, and
 * the order of each rank's elements. The library is libmeshorder_mpi; its binary interface is as stable as
 * that of meshorder.h.
 *
 * The functions are collective: every rank of the communicator has to call the same one. If one rank fails,
 * all of them return its status. MPI has to be initialised. A communicator is passed by its Fortran
 * handle: `MPI_Comm_c2f(comm)`, in mpi4py `comm.py2f()`.
 *
 * Vertices are numbered across the ranks from 0 on, as in PETSc and DOLFINx: first those that rank 0 owns,
 * then those of rank 1, and so on.
 */

#include <meshorder.h>

#ifdef __cplusplus
extern "C" {
#endif

/** One rank's share of a mesh. */
typedef struct mo_mpi_mesh {
  size_t struct_size;           /**< sizeof(mo_mpi_mesh) of the caller */
  int64_t vertex_count;         /**< vertices that this rank owns; >= 0 */
  int64_t cell_count;           /**< elements that this rank has; >= 0 */
  const int64_t* cell_offsets;  /**< cell_count + 1, ascending from 0; null without elements */
  const int64_t* cell_vertices; /**< vertices of each element; any rank may own them */
  const double* points;         /**< x y z of each own vertex; or null on all ranks */
  int64_t cell_vertex_count;    /**< length of cell_vertices: the last offset; 0 without elements */
  int64_t coordinate_count;     /**< length of points: 3 * vertex_count, 0 without points */
} mo_mpi_mesh;

/** Options of a call. All but `threads` must be the same on all ranks: if they differ, all ranks return
 * MO_INVALID_ARGUMENT. `mo_mpi_options_init` fills in the defaults; a null pointer means the defaults. */
typedef struct mo_mpi_options {
  size_t struct_size;     /**< sizeof(mo_mpi_options) of the caller */
  const char* method;     /**< vertex method for each rank or part; null: "spectral" */
  const char* partition;  /**< how to cut: "ptscotch" (null), "hilbert", "rsb", or "order": equal ranges
                             of one order of the whole mesh; "order" needs the method "fiedler" and the
                             balance "vertices", and excludes interface_last */
  const char* balance;    /**< every part gets equally many "vertices" (null) or "cells" */
  uint64_t seed;          /**< of the method; default 0 */
  int32_t parts;          /**< at most the number of vertices; 0 (default): one for each rank */
  int32_t threads;        /**< of this rank; default 1 */
  int32_t interface_last; /**< non-zero: vertices that share an element with vertices of other ranks or
                             parts come last; default 0 */
  int32_t reserved;       /**< 0 */
} mo_mpi_options;

/** Fills in the defaults. `struct_size` is sizeof(mo_mpi_options) of the caller. Does nothing for a null
 * pointer. */
MO_API void mo_mpi_options_init(mo_mpi_options* options, size_t struct_size);

/**
 * Orders each rank's vertices among themselves: vertices stay with their owners. A rank's order begins near
 * the rank before it and ends near the rank after it, as far as possible.
 *
 * An element may be on several ranks (ghost layers); each rank orders all elements that it has.
 *
 * @param communicator  Fortran handle of the communicator whose ranks share the mesh
 * @param mesh          this rank's share
 * @param options       or null; `parts`, `partition` and `balance` are not used
 * @param new_numbers   vertex_count numbers: the new number of each own vertex, within the rank's own range
 * @param cell_order    cell_count numbers, or null: the elements in their new order, by `lexmax`: entry k is
 *                      the old place (from 0 on) of the element at new place k
 */
MO_API mo_status mo_mpi_order_ranks(int32_t communicator, const mo_mpi_mesh* mesh,
                                    const mo_mpi_options* options, int64_t* new_numbers, int64_t* cell_order);

/**
 * Cuts the mesh into parts, orders each part, and numbers the parts one after another, so that touching
 * parts get nearby numbers. The caller has to move vertices and elements to their new owners.
 *
 * Needs coordinates. Each element must be on exactly one rank. Without MPI_THREAD_MULTIPLE
 * "hilbert" replaces "ptscotch".
 *
 * @param communicator  Fortran handle of the communicator whose ranks share the mesh
 * @param mesh          this rank's share
 * @param options       or null
 * @param new_numbers   vertex_count numbers: the new number of each own vertex
 * @param part_starts   parts + 1 numbers, or ranks + 1 if `parts` is 0: the first new number of each part,
 *                      then the end of the last part; vertices that no element uses have the numbers from
 *                      that end on
 * @param cell_parts    cell_count numbers, or null: the part of each element, which is the part of the
 *                      element's vertex with the largest new number
 */
MO_API mo_status mo_mpi_order_parts(int32_t communicator, const mo_mpi_mesh* mesh,
                                    const mo_mpi_options* options, int64_t* new_numbers, int64_t* part_starts,
                                    int64_t* cell_parts);

/** Returns the message of this thread's last failure in one of these functions, or "" if there was none.
 * Valid until this thread's next call. */
MO_API const char* mo_mpi_last_error(void);

#ifdef __cplusplus
}
#endif

#endif
