/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
/* Tests orders of meshes for DMPlexPermute. */
#include "meshorder_petsc.h"
#include "testing.h"

#include <petscdmplex.h>

static PetscInt greatest_common_divisor(PetscInt a, PetscInt b) {
  return b == 0 ? a : greatest_common_divisor(b, a % b);
}

/* Permutes the numbers of the points of each depth by a stride. */
static PetscErrorCode Scramble(DM* dm) {
  PetscInt depth, begin, end;
  PetscInt* numbers;
  IS perm;
  DM scrambled;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepth(*dm, &depth));
  PetscCall(DMPlexGetChart(*dm, &begin, &end));
  PetscCall(PetscMalloc1(end - begin, &numbers));
  for (PetscInt d = 0; d <= depth; ++d) {
    PetscCall(DMPlexGetDepthStratum(*dm, d, &begin, &end));
    PetscInt stride = 37;
    while (greatest_common_divisor(stride, end - begin) != 1) ++stride;
    for (PetscInt k = 0; k < end - begin; ++k) numbers[begin + k] = begin + k * stride % (end - begin);
  }
  PetscCall(DMPlexGetChart(*dm, &begin, &end));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, end - begin, numbers, PETSC_OWN_POINTER, &perm));
  PetscCall(DMPlexPermute(*dm, perm, &scrambled));
  PetscCall(ISDestroy(&perm));
  PetscCall(DMDestroy(dm));
  *dm = scrambled;
  PetscFunctionReturn(0);
}

/* Makes a box of faces[0] x faces[1] (x faces[2]) squares or cubes, cut into 2 triangles or 6 tetrahedra
 * each, one for each sequence of the axes, along which a path leads from the lowest corner to the highest. */
static PetscErrorCode CreateSimplices(PetscInt dimension, const PetscInt faces[3], DM* dm) {
  static const PetscInt axes_2d[2][3] = {{0, 1, 0}, {1, 0, 0}};
  static const PetscInt axes_3d[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  const PetscInt each = dimension == 2 ? 2 : 6;
  PetscInt side[3] = {1, 1, 1}, boxes = 1, vertices = 1, filled = 0;
  PetscInt* cells;
  PetscReal* coordinates;

  PetscFunctionBeginUser;
  for (PetscInt axis = 0; axis < dimension; ++axis) {
    side[axis] = faces[axis] + 1;
    boxes *= faces[axis];
    vertices *= side[axis];
  }
  const PetscInt strides[3] = {1, side[0], side[0] * side[1]};
  PetscCall(PetscMalloc2(boxes * each * (dimension + 1), &cells, vertices * dimension, &coordinates));
  for (PetscInt v = 0; v < vertices; ++v) {
    PetscInt upper = 0; /* axes along which a box begins at this vertex */
    for (PetscInt axis = 0; axis < dimension; ++axis) {
      const PetscInt place = v / strides[axis] % side[axis];
      coordinates[v * dimension + axis] = (PetscReal)place / (PetscReal)faces[axis];
      upper += place < faces[axis];
    }
    for (PetscInt k = 0; upper == dimension && k < each; ++k) {
      const PetscInt* const axes = dimension == 2 ? axes_2d[k] : axes_3d[k];
      PetscInt* const cell = cells + filled;
      cell[0] = v;
      for (PetscInt step = 0; step < dimension; ++step) cell[step + 1] = cell[step] + strides[axes[step]];
      /* PETSc's triangles are counterclockwise; its tetrahedra are oriented unlike most programs' */
      if (dimension == 2 ? k == 1 : k < 3) {
        const PetscInt swapped = cell[1];
        cell[1] = cell[2];
        cell[2] = swapped;
      }
      filled += dimension + 1;
    }
  }
  PetscCall(DMPlexCreateFromCellListPetsc(PETSC_COMM_SELF, dimension, boxes * each, vertices, dimension + 1,
                                          PETSC_TRUE, cells, dimension, coordinates, dm));
  PetscCall(PetscFree2(cells, coordinates));
  DMLabel label;
  PetscCall(DMCreateLabel(*dm, "marker"));
  PetscCall(DMGetLabel(*dm, "marker", &label));
  PetscCall(DMPlexMarkBoundaryFaces(*dm, 1, label));
  PetscFunctionReturn(0);
}

/* Finds the largest difference between the numbers of two cells that share a facet. */
static PetscErrorCode CellBandwidth(DM dm, PetscInt* bandwidth) {
  PetscInt begin, end;

  PetscFunctionBeginUser;
  *bandwidth = 0;
  PetscCall(DMPlexGetHeightStratum(dm, 1, &begin, &end));
  for (PetscInt facet = begin; facet < end; ++facet) {
    PetscInt size;
    const PetscInt* cells;
    PetscCall(DMPlexGetSupportSize(dm, facet, &size));
    PetscCall(DMPlexGetSupport(dm, facet, &cells));
    if (size == 2) *bandwidth = PetscMax(*bandwidth, PetscAbsInt(cells[0] - cells[1]));
  }
  PetscFunctionReturn(0);
}

/* Fails unless cells meet the points of each depth in the order of their numbers. */
static PetscErrorCode CheckFirstUse(DM dm) {
  PetscInt depth, first_cell, end_cell, last[4] = {-1, -1, -1, -1};

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepth(dm, &depth));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &first_cell, &end_cell));
  for (PetscInt d = 0; d <= depth; ++d) {
    PetscInt end;
    PetscCall(DMPlexGetDepthStratum(dm, d, &last[d], &end));
    --last[d];
  }
  for (PetscInt cell = first_cell; cell < end_cell; ++cell) {
    PetscInt size, most[4] = {-1, -1, -1, -1}, found[4] = {0, 0, 0, 0};
    PetscInt* closure = NULL;
    PetscCall(DMPlexGetTransitiveClosure(dm, cell, PETSC_TRUE, &size, &closure));
    for (PetscInt p = 0; p < size; ++p) {
      PetscInt d;
      PetscCall(DMPlexGetPointDepth(dm, closure[2 * p], &d));
      most[d] = PetscMax(most[d], closure[2 * p]);
      found[d] += closure[2 * p] > last[d];
    }
    PetscCall(DMPlexRestoreTransitiveClosure(dm, cell, PETSC_TRUE, &size, &closure));
    for (PetscInt d = 0; d <= depth; ++d) {
      CHECK(most[d] <= last[d] + found[d]); /* new points have the numbers that follow */
      last[d] = PetscMax(last[d], most[d]);
    }
  }
  PetscFunctionReturn(0);
}

/* Sums volume, and volume times centre, over the cells; counts the facets on the boundary. */
static PetscErrorCode Measure(DM dm, PetscReal* volume, PetscReal moment[3], PetscInt* boundary) {
  PetscInt begin, end;
  DMLabel label;

  PetscFunctionBeginUser;
  *volume = 0;
  for (int axis = 0; axis < 3; ++axis) moment[axis] = 0;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &begin, &end));
  for (PetscInt cell = begin; cell < end; ++cell) {
    PetscReal size, centre[3] = {0, 0, 0};
    PetscCall(DMPlexComputeCellGeometryFVM(dm, cell, &size, centre, NULL));
    CHECK(size > 0);
    *volume += size;
    for (int axis = 0; axis < 3; ++axis) moment[axis] += size * centre[axis];
  }
  /* exactly the facets of only one cell are marked, as before */
  *boundary = 0;
  PetscCall(DMGetLabel(dm, "marker", &label));
  PetscCall(DMPlexGetHeightStratum(dm, 1, &begin, &end));
  for (PetscInt facet = begin; label && facet < end; ++facet) {
    PetscInt size, value;
    PetscCall(DMPlexGetSupportSize(dm, facet, &size));
    PetscCall(DMLabelGetValue(label, facet, &value));
    CHECK((size == 1) == (value == 1));
    *boundary += size == 1;
  }
  PetscFunctionReturn(0);
}

/* Orders a scrambled mesh and moves it: the mesh stays the same, and adjacent cells have near numbers. */
static PetscErrorCode TestBox(PetscInt dimension, PetscBool simplex, const PetscInt faces[3],
                              const char* method, PetscInt most) {
  DM dm, ordered, swapped;
  IS perm, inverse;
  PetscReal volume, moment[3], moved_volume, moved_moment[3];
  PetscInt boundary, moved_boundary, bandwidth;

  PetscFunctionBeginUser;
  if (simplex) {
    PetscCall(CreateSimplices(dimension, faces, &dm));
  } else {
    PetscCall(DMPlexCreateBoxMesh(PETSC_COMM_SELF, dimension, PETSC_FALSE, faces, NULL, NULL, NULL,
                                  PETSC_TRUE, &dm));
  }
  PetscCall(Scramble(&dm));
  PetscCall(MeshorderDMPlexOrdering(dm, method, &perm));
  PetscCall(DMPlexPermute(dm, perm, &ordered));
  PetscCall(CellBandwidth(ordered, &bandwidth));
  CHECK(bandwidth <= most);
  PetscCall(CheckFirstUse(ordered));
  PetscCall(Measure(dm, &volume, moment, &boundary));
  PetscCall(Measure(ordered, &moved_volume, moved_moment, &moved_boundary));
  CHECK(boundary > 0 && boundary == moved_boundary);
  CHECK(PetscAbsReal(volume - moved_volume) < 1e-12 && PetscAbsReal(volume - 1) < 1e-12);
  for (int axis = 0; axis < 3; ++axis) CHECK(PetscAbsReal(moment[axis] - moved_moment[axis]) < 1e-12);
  PetscCall(DMPlexCheck(dm));
  PetscCall(DMPlexCheck(ordered));

  PetscCall(CheckNotInvolutive(perm, &inverse));
  PetscCall(DMPlexPermute(dm, inverse, &swapped));
  PetscCall(CellBandwidth(swapped, &bandwidth));
  CHECK(bandwidth > most);

  PetscCall(DMDestroy(&swapped));
  PetscCall(DMDestroy(&ordered));
  PetscCall(DMDestroy(&dm));
  PetscCall(ISDestroy(&inverse));
  PetscCall(ISDestroy(&perm));
  PetscFunctionReturn(0);
}

/* Orders a row of alternating squares and triangles: a cell takes the number of a cell of its type. */
static PetscErrorCode TestMixedTypes(void) {
  enum { PAIRS = 5, CELLS = 2 * PAIRS };
  /* square k: 0-1-3-2 of the grid's column, then a triangle on its upper edge */
  PetscInt sizes[CELLS + 3 * PAIRS + 2], cones[7 * PAIRS], orientations[7 * PAIRS];
  const PetscInt sizes_by_depth[2] = {3 * PAIRS + 2, CELLS};
  PetscScalar coordinates[2 * (3 * PAIRS + 2)];
  DM dm, whole, ordered;
  IS perm;
  const PetscInt* numbers;

  PetscFunctionBeginUser;
  PetscInt entry = 0;
  for (PetscInt k = 0; k < PAIRS; ++k) {
    const PetscInt below = CELLS + 2 * k, top = CELLS + 2 * (PAIRS + 1) + k;
    const PetscInt corners[7] = {below, below + 2, below + 3, below + 1, below + 1, below + 3, top};
    sizes[2 * k] = 4;
    sizes[2 * k + 1] = 3;
    for (int c = 0; c < 7; ++c) {
      cones[entry] = corners[c];
      orientations[entry++] = 0;
    }
  }
  for (PetscInt v = 0; v < 3 * PAIRS + 2; ++v) {
    const PetscInt column = v / 2;
    sizes[CELLS + v] = 0;
    coordinates[2 * v] = v < 2 * (PAIRS + 1) ? (PetscScalar)column : (PetscScalar)(v - 2 * (PAIRS + 1)) + 0.5;
    coordinates[2 * v + 1] = v < 2 * (PAIRS + 1) ? (PetscScalar)(v % 2) : 2;
  }
  PetscCall(DMPlexCreate(PETSC_COMM_SELF, &dm));
  PetscCall(DMSetDimension(dm, 2));
  PetscCall(DMPlexCreateFromDAG(dm, 1, sizes_by_depth, sizes, cones, orientations, coordinates));
  PetscCall(DMPlexInterpolate(dm, &whole));
  PetscCall(MeshorderDMPlexOrdering(whole, "scrambled", &perm));
  PetscCall(DMPlexPermute(whole, perm, &ordered));
  PetscCall(DMPlexCheck(ordered));
  PetscCall(ISGetIndices(perm, &numbers));
  PetscInt moved = 0;
  for (PetscInt cell = 0; cell < CELLS; ++cell) {
    CHECK(numbers[cell] % 2 == cell % 2);
    moved += numbers[cell] != cell;
  }
  CHECK(moved > 0);
  PetscCall(ISRestoreIndices(perm, &numbers));
  PetscCall(ISDestroy(&perm));
  PetscCall(DMDestroy(&ordered));
  PetscCall(DMDestroy(&whole));
  PetscCall(DMDestroy(&dm));
  PetscFunctionReturn(0);
}

int main(int argc, char** argv) {
  const PetscInt strip[3] = {60, 1, 1}, square[3] = {12, 15, 1}, cube[3] = {6, 7, 5};

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestBox(2, PETSC_FALSE, strip, "rcm", 1));
  PetscCall(TestBox(2, PETSC_TRUE, strip, "rcm", 1));
  PetscCall(TestBox(2, PETSC_TRUE, square, "rcm", 40));
  PetscCall(TestBox(3, PETSC_TRUE, cube, "rcm", 250));
  PetscCall(TestBox(3, PETSC_FALSE, cube, "rcm", 45));
  PetscCall(TestBox(2, PETSC_FALSE, strip, "hilbert", 1));
  PetscCall(TestMixedTypes());
  PetscCall(PetscFinalize());
  return 0;
}
