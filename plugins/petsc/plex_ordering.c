/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#include "meshorder_petsc.h"
#include "order.h"

/* Returns in `centres` (to be freed) each point's centre, which is the mean of the centres of the points that
 * bound it; null for a mesh without coordinates. */
static PetscErrorCode Centres(DM dm, PetscInt begin, PetscInt end, PetscInt* dimension, double** centres) {
  PetscSection section;
  Vec coordinates;
  const PetscScalar* values;
  PetscInt depth;

  PetscFunctionBeginUser;
  *centres = NULL;
  PetscCall(DMGetCoordinateDim(dm, dimension));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  if (!coordinates) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(*dimension * (end - begin), centres));
  PetscCall(DMPlexGetDepth(dm, &depth));
  PetscCall(VecGetArrayRead(coordinates, &values));
  for (PetscInt d = 0; d <= depth; ++d) {
    PetscInt first, last;
    PetscCall(DMPlexGetDepthStratum(dm, d, &first, &last));
    for (PetscInt point = first; point < last; ++point) {
      double* const centre = *centres + *dimension * (point - begin);
      if (d == 0) {
        PetscInt offset;
        PetscCall(PetscSectionGetOffset(section, point, &offset));
        for (PetscInt axis = 0; axis < *dimension; ++axis)
          centre[axis] = (double)PetscRealPart(values[offset + axis]);
        continue;
      }
      PetscInt size;
      const PetscInt* cone;
      PetscCall(DMPlexGetConeSize(dm, point, &size));
      PetscCall(DMPlexGetCone(dm, point, &cone));
      for (PetscInt k = 0; k < size; ++k) {
        const double* const part = *centres + *dimension * (cone[k] - begin);
        for (PetscInt axis = 0; axis < *dimension; ++axis) centre[axis] += part[axis] / (double)size;
      }
    }
  }
  PetscCall(VecRestoreArrayRead(coordinates, &values));
  PetscFunctionReturn(0);
}

/* The points of a mesh by kind (depth and cell type). Points of one kind may take each other's numbers. */
typedef struct Kinds {
  PetscInt* kind;    /* of each point */
  PetscInt* numbers; /* the points' numbers, kind after kind, ascending in each */
  PetscInt* next;    /* of each kind: position in `numbers` of the first number that is not taken yet */
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
  /* each `next` is now the end of its kind, where the following kind begins */
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

/* Finds the order of the cells in [first, last): cells[k] is the old number, from 0, of the cell at position
 * k.
 */
static PetscErrorCode OrderCells(DM dm, PetscInt begin, PetscInt end, PetscInt first, PetscInt last,
                                 const char* method, PetscInt* cells) {
  PetscInt count = 0;
  PetscInt dimension;
  PetscInt* offsets = NULL;
  PetscInt* neighbours = NULL;
  double* centres;

  PetscFunctionBeginUser;
  PetscCall(DMPlexCreateNeighborCSR(dm, 0, &count, &offsets, &neighbours));
  PetscCheck(count == last - first, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "meshorder: the graph of cells has %" PetscInt_FMT " vertices, the mesh %" PetscInt_FMT " cells",
             count, last - first);
  PetscCall(Centres(dm, begin, end, &dimension, &centres));
  PetscCall(MeshorderOrderGraph(count, offsets, neighbours, dimension,
                                centres ? centres + dimension * (first - begin) : NULL, method, cells));
  PetscCall(PetscFree(centres));
  PetscCall(PetscFree(offsets));
  PetscCall(PetscFree(neighbours));
  PetscFunctionReturn(0);
}

/* Numbers all points: cells in their order, then the points of each lower depth as points above first meet
 * them.
 */
static PetscErrorCode NumberPoints(DM dm, PetscInt begin, PetscInt end, PetscInt cell_count,
                                   const PetscInt* cells, PetscInt first_cell, PetscInt* old_to_new) {
  Kinds kinds;
  PetscInt taken = 0;
  PetscInt* sequence; /* the points, in the order in which they get their numbers */

  PetscFunctionBeginUser;
  PetscCall(KindsCreate(dm, begin, end, &kinds));
  PetscCall(PetscMalloc1(end - begin, &sequence));
  for (PetscInt k = 0; k < end - begin; ++k) old_to_new[k] = -1;
  for (PetscInt k = 0; k < cell_count; ++k) sequence[taken++] = first_cell + cells[k];
  for (PetscInt k = 0; k < taken; ++k) {
    PetscInt size;
    const PetscInt* cone;
    const PetscInt point = sequence[k];
    old_to_new[point - begin] = kinds.numbers[kinds.next[kinds.kind[point - begin]]++];
    PetscCall(DMPlexGetConeSize(dm, point, &size));
    PetscCall(DMPlexGetCone(dm, point, &cone));
    for (PetscInt c = 0; c < size; ++c) {
      if (old_to_new[cone[c] - begin] != -1) continue;
      old_to_new[cone[c] - begin] = -2; /* it is in the sequence */
      sequence[taken++] = cone[c];
    }
  }
  for (PetscInt point = begin; point < end; ++point) { /* points of no cell */
    if (old_to_new[point - begin] < 0) {
      old_to_new[point - begin] = kinds.numbers[kinds.next[kinds.kind[point - begin]]++];
    }
  }
  PetscCall(PetscFree(sequence));
  PetscCall(KindsDestroy(&kinds));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshorderDMPlexOrdering(DM dm, const char* method, IS* perm) {
  PetscInt begin, end, first_cell, end_cell;
  PetscInt* cells;
  PetscInt* old_to_new;
  PetscBool is_plex, distributed;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)dm, DMPLEX, &is_plex));
  PetscCheck(is_plex, PetscObjectComm((PetscObject)dm), PETSC_ERR_ARG_WRONG,
             "meshorder: this DM is not a DMPLEX");
  PetscCall(DMPlexIsDistributed(dm, &distributed));
  PetscCheck(!distributed, PetscObjectComm((PetscObject)dm), PETSC_ERR_SUP,
             "meshorder: DMPlexPermute would lose which process owns each point; order the mesh before "
             "DMPlexDistribute");
  PetscCall(DMPlexGetChart(dm, &begin, &end));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &first_cell, &end_cell));
  PetscCall(PetscMalloc1(end_cell - first_cell, &cells));
  if (end_cell > first_cell) PetscCall(OrderCells(dm, begin, end, first_cell, end_cell, method, cells));
  PetscCall(PetscMalloc1(end - begin, &old_to_new));
  PetscCall(NumberPoints(dm, begin, end, end_cell - first_cell, cells, first_cell, old_to_new));
  PetscCall(PetscFree(cells));
  PetscCall(
      ISCreateGeneral(PetscObjectComm((PetscObject)dm), end - begin, old_to_new, PETSC_OWN_POINTER, perm));
  PetscFunctionReturn(0);
}
