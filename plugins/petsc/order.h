/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#ifndef MESHORDER_PLUGINS_PETSC_ORDER_H
#define MESHORDER_PLUGINS_PETSC_ORDER_H

#include <petscsys.h>

/**
 * Orders the vertices of a graph.
 *
 * @param n           vertices
 * @param offsets     n + 1, from 0
 * @param neighbours  offsets[n] numbers; loops, repeats and edges in one direction only are allowed
 * @param dimension   of the points, 0 to 3
 * @param points      dimension * n coordinates, or null
 * @param method      name of a vertex method
 * @param new_to_old  n numbers, written
 */
PETSC_INTERN PetscErrorCode MeshorderOrderGraph(PetscInt n, const PetscInt* offsets,
                                                const PetscInt* neighbours, PetscInt dimension,
                                                const double* points, const char* method,
                                                PetscInt* new_to_old);

#endif /* MESHORDER_PLUGINS_PETSC_ORDER_H */
