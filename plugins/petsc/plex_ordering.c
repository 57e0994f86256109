/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#include "meshorder_petsc.h"
#include "order.h"

/* Returns the mean of each cell's coordinates in `means`, to be freed, or null for a mesh without
 * coordinates. */
static PetscErrorCode CellCentres(DM dm, PetscInt begin, PetscInt end, PetscInt* dimension, double** means) {
  PetscSection section;
  Vec coordinates;

  PetscFunctionBeginUser;
  *means = NULL;
  PetscCall(DMGetCoordinateDim(dm, dimension));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  if (!coordinates) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(*dimension * (end - begin), means));
  for (PetscInt cell = begin; cell < end; ++cell) {
    PetscInt size = 0;
    PetscScalar* values = NULL;
    double* const mean = *means + *dimension * (cell - begin);
    PetscCall(DMPlexVecGetClosure(dm, section, coordinates, cell, &size, &values));
    for (PetscInt k = 0; k < size; ++k) mean[k % *dimension] += (double)PetscRealPart(values[k]);
    for (PetscInt axis = 0; axis < *dimension; ++axis)
      mean[axis] *= (double)*dimension / (double)PetscMax(size, 1);
    PetscCall(DMPlexVecRestoreClosure(dm, section, coordinates, cell, &size, &values));
  }
  PetscFunctionReturn(0);
}

/* The points of a mesh by kind, which is their depth and cell type: what may take each other's numbers. */
typedef struct Kinds {
  PetscInt* kind;    /* of each point */
  PetscInt* numbers; /* the points' numbers, kind after kind, ascending in each */
  PetscInt* next;    /* of each kind: place in `numbers` of the first one that is not taken yet */
  PetscInt count;
} Kinds;

static PetscErrorCode KindsCreate(DM dm, PetscInt begin, PetscInt end, Kinds* kinds) {
  PetscInt depth;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepth(dm, &depth));
  kinds->count = (depth + 1) * DM_NUM_POLYTOPES;
  PetscCall(PetscMalloc2(end - begin, &kinds->kind, end - begin, &kinds->numbers));
  PetscCall(PetscCalloc1(kinds->count + 1, &kinds->next));
  for (PetscInt point = begin; point < end; ++point) {
    DMPolytopeType type;
    PetscInt point_depth;
    PetscCall(DMPlexGetCellType(dm, point, &type));
    PetscCall(DMPlexGetPointDepth(dm, point, &point_depth));
    const PetscInt kind = point_depth * DM_NUM_POLYTOPES + (PetscInt)type;
    kinds->kind[point - begin] = kind;
    ++kinds->next[kind + 1];
  }
  for (PetscInt k = 0; k < kinds->count; ++k) kinds->next[k + 1] += kinds->next[k];
  for (PetscInt point = begin; point < end; ++point) {
    kinds->numbers[kinds->next[kinds->kind[point - begin]]++] = point;
  }
  /* each next is the end of its kind now, which is where the one after it begins */
  for (PetscInt k = kinds->count; k > 0; --k) kinds->next[k] = kinds->next[k - 1];
  kinds->next[0] = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode KindsDestroy(Kinds* kinds) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(kinds->kind, kinds->numbers));
  PetscCall(PetscFree(kinds->next));
  PetscFunctionReturn(0);
}

/* Gives a point that has no new number yet (-1) the next one of its kind. */
static void number_point(Kinds* kinds, PetscInt begin, PetscInt point, PetscInt* old_to_new) {
  if (old_to_new[point - begin] < 0) {
    old_to_new[point - begin] = kinds->numbers[kinds->next[kinds->kind[point - begin]]++];
  }
}

/* Finds the order of the cells in [begin, end): cells[k] is the old number of the cell at place k, from 0. */
static PetscErrorCode OrderCells(DM dm, PetscInt begin, PetscInt end, const char* method, PetscInt* cells) {
  PetscInt count = 0;
  PetscInt dimension;
  PetscInt* offsets = NULL;
  PetscInt* neighbours = NULL;
  double* centres;

  PetscFunctionBeginUser;
  PetscCall(DMPlexCreateNeighborCSR(dm, 0, &count, &offsets, &neighbours));
  PetscCheck(count == end - begin, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "meshorder: the graph of cells has %" PetscInt_FMT " vertices, the mesh %" PetscInt_FMT " cells",
             count, end - begin);
  PetscCall(CellCentres(dm, begin, end, &dimension, &centres));
  PetscCall(MeshorderOrderGraph(count, offsets, neighbours, dimension, centres, method, cells));
  PetscCall(PetscFree(centres));
  PetscCall(PetscFree(offsets));
  PetscCall(PetscFree(neighbours));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshorderDMPlexOrdering(DM dm, const char* method, IS* perm) {
  PetscInt begin, end, first_cell, end_cell;
  PetscInt* cells;
  PetscInt* old_to_new;
  PetscBool is_plex, distributed;
  Kinds kinds;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)dm, DMPLEX, &is_plex));
  PetscCheck(is_plex, PetscObjectComm((PetscObject)dm), PETSC_ERR_ARG_WRONG,
             "meshorder: this DM is no DMPLEX");
  PetscCall(DMPlexIsDistributed(dm, &distributed));
  PetscCheck(
      !distributed, PetscObjectComm((PetscObject)dm), PETSC_ERR_SUP,
      "meshorder: DMPlexPermute would lose which process owns what; order the mesh before DMPlexDistribute");
  PetscCall(DMPlexGetChart(dm, &begin, &end));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &first_cell, &end_cell));
  PetscCall(PetscMalloc1(end_cell - first_cell, &cells));
  if (end_cell > first_cell) PetscCall(OrderCells(dm, first_cell, end_cell, method, cells));

  PetscCall(KindsCreate(dm, begin, end, &kinds));
  PetscCall(PetscMalloc1(end - begin, &old_to_new));
  for (PetscInt k = 0; k < end - begin; ++k) old_to_new[k] = -1;
  for (PetscInt k = 0; k < end_cell - first_cell; ++k) {
    PetscInt size;
    PetscInt* closure = NULL; /* pairs of a point and its orientation, the cell itself first */
    PetscCall(DMPlexGetTransitiveClosure(dm, first_cell + cells[k], PETSC_TRUE, &size, &closure));
    for (PetscInt p = 0; p < size; ++p) number_point(&kinds, begin, closure[2 * p], old_to_new);
    PetscCall(DMPlexRestoreTransitiveClosure(dm, first_cell + cells[k], PETSC_TRUE, &size, &closure));
  }
  for (PetscInt point = begin; point < end; ++point)
    number_point(&kinds, begin, point, old_to_new); /* of no cell */
  PetscCall(KindsDestroy(&kinds));
  PetscCall(PetscFree(cells));
  PetscCall(
      ISCreateGeneral(PetscObjectComm((PetscObject)dm), end - begin, old_to_new, PETSC_OWN_POINTER, perm));
  PetscFunctionReturn(0);
}
