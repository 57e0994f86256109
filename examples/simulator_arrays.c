/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
 *
 * Orders the arrays of a simulator: tetrahedra, springs, and a mass for each vertex. */
#include <meshorder.h>
#include <stdio.h>

enum { VERTICES = 6, TETRAHEDRA = 3, SPRINGS = 12 };

/* Prints the reason of a failure. */
static int failed(mo_status status) {
  if (status != MO_OK) fprintf(stderr, "%s\n", mo_last_error());
  return status != MO_OK;
}

int main(void) {
  const double x[3 * VERTICES] = {0, 0, 0, 2, 1, 0, 0, 1, 0, 3, 0, 1, 1, 0, 1, 2, 0, 0};
  const int32_t offsets[TETRAHEDRA + 1] = {0, 4, 8, 12};
  int32_t moved_tetrahedra[4 * TETRAHEDRA];
  int32_t tetrahedra[4 * TETRAHEDRA] = {0, 2, 4, 5, 2, 4, 5, 1, 4, 5, 1, 3};
  const int32_t springs[2 * SPRINGS] = {0, 2, 0, 4, 0, 5, 2, 4, 2, 5, 4, 5,
                                        2, 1, 4, 1, 5, 1, 4, 3, 5, 3, 1, 3};
  const double masses[VERTICES] = {1, 2, 3, 4, 5, 6};
  double moved_masses[VERTICES];
  int32_t new_to_old[VERTICES], old_to_new[VERTICES], cell_new_to_old[TETRAHEDRA], spring_new_to_old[SPRINGS];
  int k = 0;

  const mo_in cell_offsets = {offsets, TETRAHEDRA + 1, MO_INT32};
  const mo_in cell_vertices = {tetrahedra, 4 * TETRAHEDRA, MO_INT32};
  const mo_in points = {x, 3 * VERTICES, MO_DOUBLE};
  const mo_in ends = {springs, 2 * SPRINGS, MO_INT32};
  const mo_in order = {new_to_old, VERTICES, MO_INT32};
  const mo_in cell_order = {cell_new_to_old, TETRAHEDRA, MO_INT32};
  const mo_out order_out = {new_to_old, VERTICES, MO_INT32};
  const mo_out places_out = {old_to_new, VERTICES, MO_INT32};
  const mo_out cells_out = {cell_new_to_old, TETRAHEDRA, MO_INT32};
  const mo_out springs_out = {spring_new_to_old, SPRINGS, MO_INT32};

  if (failed(mo_order_mesh(&cell_offsets, &cell_vertices, NULL, VERTICES, &points, 3, NULL, &order_out,
                           &places_out, &cells_out, NULL, NULL, NULL)))
    return 1;
  /* mo_order_edges takes the old numbers of the ends */
  if (failed(mo_order_edges(&ends, &order, 0, &springs_out))) return 1;

  if (failed(mo_move(&order, 0, masses, moved_masses, sizeof masses[0]))) return 1;
  for (k = 0; k < 4 * TETRAHEDRA; ++k) tetrahedra[k] = old_to_new[tetrahedra[k]];
  if (failed(mo_move(&cell_order, 0, tetrahedra, moved_tetrahedra, 4 * sizeof tetrahedra[0]))) return 1;

  for (k = 0; k < SPRINGS; ++k) {
    const int32_t* const spring = springs + 2 * spring_new_to_old[k];
    printf("spring %d joins vertices %d and %d\n", k, (int)old_to_new[spring[0]], (int)old_to_new[spring[1]]);
  }
  for (k = 0; k < VERTICES; ++k)
    if (moved_masses[old_to_new[k]] != masses[k]) return 2;
  for (k = 0; k < 4 * TETRAHEDRA; ++k)
    if (moved_tetrahedra[k] != tetrahedra[4 * cell_new_to_old[k / 4] + k % 4]) return 3;
  return 0;
}
