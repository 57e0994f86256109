/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#include "order.h"

#include <meshorder.h>

PetscErrorCode MeshorderOrderGraph(PetscInt n, const PetscInt* offsets, const PetscInt* neighbours,
                                   PetscInt dimension, const double* points, const char* method,
                                   PetscInt* new_to_old) {
  const mo_type integer = sizeof(PetscInt) == 8 ? MO_INT64 : MO_INT32;
  const mo_in graph_offsets = {offsets, n + 1, integer};
  const mo_in graph_neighbours = {neighbours, offsets[n], integer};
  const mo_in coordinates = {points, points ? dimension * (int64_t)n : 0, MO_DOUBLE};
  const mo_out order = {new_to_old, n, integer};
  mo_options options;
  PetscMPIInt processes;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &processes));
  mo_options_init(&options, sizeof options);
  options.method = method;
  options.symmetrize = 1;
  options.threads = processes > 1 ? 1 : 0; /* the processes share the machine; the order is the same */
  const mo_status status =
      mo_order_graph(&graph_offsets, &graph_neighbours, NULL, points ? &coordinates : NULL,
                     (int32_t)dimension, &options, &order, NULL, NULL);
  PetscCheck(status == MO_OK, PETSC_COMM_SELF, PETSC_ERR_LIB, "meshorder: %s", mo_last_error());
  PetscFunctionReturn(0);
}
