/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#ifndef MESHORDER_PLUGINS_PETSC_TESTING_H
#define MESHORDER_PLUGINS_PETSC_TESTING_H

#include <petscis.h>
#include <petscsys.h>

/* Ends the test with an error that names the line, unless the condition holds. */
#define CHECK(condition) \
  PetscCheck((condition), PETSC_COMM_SELF, PETSC_ERR_PLIB, "line %d: not true: %s", __LINE__, #condition)

/* Fails if a permutation equals its inverse: a test of direction needs a permutation that is not its own
 * inverse. */
static inline PetscErrorCode CheckNotInvolutive(IS perm, IS* inverse) {
  PetscBool same;
  PetscFunctionBeginUser;
  PetscCall(ISSetPermutation(perm));
  PetscCall(ISInvertPermutation(perm, PETSC_DECIDE, inverse));
  PetscCall(ISEqualUnsorted(perm, *inverse, &same));
  CHECK(!same);
  PetscFunctionReturn(0);
}

#endif /* MESHORDER_PLUGINS_PETSC_TESTING_H */
