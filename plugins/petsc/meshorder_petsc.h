/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#ifndef MESHORDER_PETSC_H
#define MESHORDER_PETSC_H

/**
 * @file
 * Orders of meshorder for PETSc: as MatOrderingType "meshorder_<method>", and for meshes in a DMPlex.
 *
 * A program that is not linked with this library gets the MatOrderingTypes by the option
 * `-dll_append libmeshorder_petsc.so`, and then for instance
 * `-pc_type icc -pc_factor_mat_ordering_type meshorder_rcm`.
 */

#include <petscdmplex.h>
#include <petscmat.h>

/**
 * Registers "meshorder_<method>" as a MatOrderingType for every vertex method that meshorder knows now.
 * A second call changes nothing.
 *
 * MatGetOrdering then returns the order in PETSc's form, new to old: row k of the permuted matrix is row
 * perm[k] of the matrix. Rows and columns get the same order, that of the pattern of A + A^T. Values do not
 * count. Methods that need coordinates (hilbert, morton) fail with PETSC_ERR_LIB: a matrix has none.
 */
PETSC_EXTERN PetscErrorCode MeshorderMatOrderingRegister(void);

/**
 * Finds an order of all points of a mesh, for DMPlexPermute.
 *
 * Cells follow the method on the graph of cells that share a facet; faces, edges and vertices are numbered as
 * the cells in their new order meet them first. A point takes the number of a point of the same depth and
 * cell type, so that strata do not change.
 *
 * @param dm      a mesh that is not distributed, or on one process; not changed
 * @param method  name of a vertex method without "meshorder_", such as "auto"; methods by coordinates use
 *                the means of the cells' coordinates
 * @param perm    perm[old point number] = new point number, as DMPlexPermute needs it; the caller destroys it
 *
 * DMPlexGetOrdering ignores the type that it is given and computes only its own order.
 */
PETSC_EXTERN PetscErrorCode MeshorderDMPlexOrdering(DM dm, const char* method, IS* perm);

#endif /* MESHORDER_PETSC_H */
