/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#include "meshorder_petsc.h"
#include "order.h"

#include <meshorder.h>

static const char prefix[] = "meshorder_";

/* Orders a matrix, as a MatOrderingType. If the matrix has inodes or blocks, PETSc gives the graph of these
 * and expands the result. meshorder makes the pattern symmetric, since PETSc would take the lower triangle
 * for the whole. */
static PetscErrorCode OrderMatrix(Mat matrix, MatOrderingType type, IS* rows, IS* columns) {
  const PetscInt* offsets;
  const PetscInt* neighbours;
  PetscInt n;
  PetscInt* new_to_old;
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(MatGetRowIJ(matrix, 0, PETSC_FALSE, PETSC_TRUE, &n, &offsets, &neighbours, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_SUP, "meshorder: a matrix of this type does not give its rows");
  PetscCall(PetscMalloc1(n, &new_to_old));
  PetscCall(MeshorderOrderGraph(n, offsets, neighbours, 0, NULL, type + sizeof prefix - 1, new_to_old));
  PetscCall(MatRestoreRowIJ(matrix, 0, PETSC_FALSE, PETSC_TRUE, NULL, &offsets, &neighbours, &done));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, new_to_old, PETSC_OWN_POINTER, rows));
  PetscCall(ISDuplicate(*rows, columns));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshorderMatOrderingRegister(void) {
  PetscFunctionBeginUser;
  for (int32_t k = 0; k < mo_method_count(); ++k) {
    char name[64];
    PetscCall(PetscSNPrintf(name, sizeof name, "%s%s", prefix, mo_method_name(k)));
    PetscCall(MatOrderingRegister(name, OrderMatrix));
  }
  PetscFunctionReturn(0);
}

/* PETSc calls the function of this name when it opens libmeshorder_petsc.so by -dll_append. */
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_meshorder_petsc(void);
PetscErrorCode PetscDLLibraryRegister_meshorder_petsc(void) {
  PetscFunctionBeginUser;
  PetscCall(MeshorderMatOrderingRegister());
  PetscFunctionReturn(0);
}
