/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
/* Tests MatOrderings of meshorder as PETSc uses them. Run with -dll_append libmeshorder_petsc.so: the test is
 * not linked with that library. */
#include "testing.h"

#include <petscksp.h>
#include <string.h>

/* Returns the number that vertex i of a path has in the matrix. 37 is not its own inverse modulo 101. */
enum { PATH = 101 };
static PetscInt scattered(PetscInt i) { return (37 * i + 11) % PATH; }

/* Makes the Laplacian of a path, shifted to be regular, with vertices numbered by `scattered`. Each vertex
 * has `block` unknowns, coupled with each other and with all unknowns of adjacent vertices. If `lower_too` is
 * 0, the matrix is upper bidiagonal along the path. */
static PetscErrorCode CreatePath(PetscInt block, int lower_too, Mat* matrix) {
  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, PATH * block, PATH * block, 3 * block, NULL, matrix));
  for (PetscInt i = 0; i < PATH; ++i) {
    for (PetscInt j = PetscMax(lower_too ? i - 1 : i, 0); j <= PetscMin(i + 1, PATH - 1); ++j) {
      for (PetscInt k = 0; k < block * block; ++k) {
        const PetscScalar value = i != j ? -1.0 / (PetscScalar)block : k % block == k / block ? 2.5 : 0.1;
        PetscCall(MatSetValue(*matrix, scattered(i) * block + k / block, scattered(j) * block + k % block,
                              value, INSERT_VALUES));
      }
    }
  }
  PetscCall(MatAssemblyBegin(*matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Finds the largest distance of an entry from the diagonal after MatPermute. */
static PetscErrorCode PermutedBandwidth(Mat matrix, IS rows, IS columns, PetscInt* bandwidth) {
  Mat permuted;
  PetscInt begin, end;

  PetscFunctionBeginUser;
  *bandwidth = 0;
  PetscCall(MatPermute(matrix, rows, columns, &permuted));
  PetscCall(MatGetOwnershipRange(permuted, &begin, &end));
  for (PetscInt row = begin; row < end; ++row) {
    PetscInt count;
    const PetscInt* entries;
    PetscCall(MatGetRow(permuted, row, &count, &entries, NULL));
    for (PetscInt k = 0; k < count; ++k) *bandwidth = PetscMax(*bandwidth, PetscAbsInt(entries[k] - row));
    PetscCall(MatRestoreRow(permuted, row, &count, &entries, NULL));
  }
  PetscCall(MatDestroy(&permuted));
  PetscFunctionReturn(0);
}

/* A path has bandwidth 1 only in its own order; the inverse permutation does not give this order. */
static PetscErrorCode TestDirection(int lower_too) {
  Mat matrix;
  IS rows, columns, inverse;
  PetscInt bandwidth;

  PetscFunctionBeginUser;
  PetscCall(CreatePath(1, lower_too, &matrix));
  PetscCall(MatGetOrdering(matrix, "meshorder_rcm", &rows, &columns));
  PetscCall(PermutedBandwidth(matrix, rows, columns, &bandwidth));
  CHECK(bandwidth == 1);
  PetscCall(CheckNotInvolutive(rows, &inverse));
  PetscCall(PermutedBandwidth(matrix, inverse, inverse, &bandwidth));
  CHECK(bandwidth > 1);
  PetscCall(ISDestroy(&inverse));
  PetscCall(ISDestroy(&rows));
  PetscCall(ISDestroy(&columns));
  PetscCall(MatDestroy(&matrix));
  PetscFunctionReturn(0);
}

/* PETSc orders the groups of rows with the same pattern (inodes), and expands them: each group stays
 * together. */
static PetscErrorCode TestBlocks(MatType type, PetscInt block) {
  Mat path, matrix;
  IS rows, columns;
  PetscInt size, bandwidth;

  PetscFunctionBeginUser;
  PetscCall(CreatePath(block, 1, &path));
  PetscCall(MatSetBlockSize(path, block));
  PetscCall(MatConvert(path, type, MAT_INITIAL_MATRIX, &matrix));
  PetscCall(MatGetOrdering(matrix, "meshorder_rcm", &rows, &columns));
  PetscCall(ISGetLocalSize(rows, &size));
  if (size == PATH * block) {
    PetscCall(PermutedBandwidth(path, rows, columns, &bandwidth));
    CHECK(bandwidth == 2 * block - 1);
  } else { /* block matrices are permuted by blocks */
    CHECK(size == PATH);
  }
  PetscCall(ISDestroy(&rows));
  PetscCall(ISDestroy(&columns));
  PetscCall(MatDestroy(&matrix));
  PetscCall(MatDestroy(&path));
  PetscFunctionReturn(0);
}

/* Solves a system by PETSc's factors in that order and checks the solution. `fill` is the number of entries
 * in the factors divided by the number in the matrix. */
static PetscErrorCode Solve(Mat matrix, PCType type, const char* ordering, PetscReal* fill) {
  KSP solver;
  PC preconditioner;
  Mat factors;
  MatInfo of_matrix, of_factors;
  Vec solution, right, expected;
  PetscReal error;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(matrix, &solution, &right));
  PetscCall(VecDuplicate(solution, &expected));
  PetscInt size;
  PetscCall(VecGetSize(expected, &size));
  for (PetscInt i = 0; i < size; ++i)
    PetscCall(VecSetValue(expected, i, (PetscScalar)(i * i % 17), INSERT_VALUES));
  PetscCall(MatMult(matrix, expected, right));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &solver));
  PetscCall(KSPSetOperators(solver, matrix, matrix));
  PetscCall(KSPSetType(solver, KSPPREONLY));
  PetscCall(KSPGetPC(solver, &preconditioner));
  PetscCall(PCSetType(preconditioner, type));
  PetscCall(PCFactorSetMatOrderingType(preconditioner, ordering));
  PetscCall(KSPSolve(solver, right, solution));
  PetscCall(VecAXPY(solution, -1, expected));
  PetscCall(VecNorm(solution, NORM_INFINITY, &error));
  CHECK(error < 1e-10);
  PetscCall(PCFactorGetMatrix(preconditioner, &factors));
  PetscCall(MatGetInfo(factors, MAT_LOCAL, &of_factors));
  PetscCall(MatGetInfo(matrix, MAT_LOCAL, &of_matrix));
  *fill = (PetscReal)(of_factors.nz_used / of_matrix.nz_used);
  PetscCall(KSPDestroy(&solver));
  PetscCall(VecDestroy(&expected));
  PetscCall(VecDestroy(&right));
  PetscCall(VecDestroy(&solution));
  PetscFunctionReturn(0);
}

/* The factors of a path in its own order have no fill, and the solution is right in every order. */
static PetscErrorCode TestFactors(void) {
  static const char* const with_fill[] = {"natural", "meshorder_original", "meshorder_scrambled"};
  static const char* const without[] = {"meshorder_rcm", "meshorder_fiedler"};
  static const char* const others[] = {"meshorder_auto", "meshorder_spectral", "meshorder_minla"};
  Mat matrix;
  PetscReal fill;

  PetscFunctionBeginUser;
  PetscCall(CreatePath(1, 1, &matrix));
  for (size_t k = 0; k < sizeof with_fill / sizeof with_fill[0]; ++k) {
    PetscCall(Solve(matrix, PCLU, with_fill[k], &fill));
    CHECK(fill > 1);
  }
  for (size_t k = 0; k < sizeof without / sizeof without[0]; ++k) {
    PetscCall(Solve(matrix, PCLU, without[k], &fill));
    CHECK(fill == 1);
  }
  for (size_t k = 0; k < sizeof others / sizeof others[0]; ++k) {
    PetscCall(Solve(matrix, PCCHOLESKY, others[k], &fill));
  }
  PetscCall(MatDestroy(&matrix));
  PetscFunctionReturn(0);
}

static char message[1024];
static PetscErrorCode KeepMessage(MPI_Comm comm, int line, const char* function, const char* file,
                                  PetscErrorCode code, PetscErrorType type, const char* text, void* context) {
  (void)comm, (void)line, (void)function, (void)file, (void)context;
  if (type == PETSC_ERROR_INITIAL) (void)strncpy(message, text, sizeof message - 1);
  return code;
}

/* A matrix has no coordinates: the error has meshorder's message. */
static PetscErrorCode TestMethodThatNeedsPoints(void) {
  Mat matrix;
  IS rows, columns;

  PetscFunctionBeginUser;
  PetscCall(CreatePath(1, 1, &matrix));
  PetscCall(PetscPushErrorHandler(KeepMessage, NULL));
  const PetscErrorCode code = MatGetOrdering(matrix, "meshorder_hilbert", &rows, &columns);
  PetscCall(PetscPopErrorHandler());
  CHECK(code != 0);
  CHECK(strstr(message, "meshorder: ") && strstr(message, "hilbert"));
  PetscFunctionReturn(0);
}

int main(int argc, char** argv) {
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestDirection(1));
  PetscCall(TestDirection(0));
  PetscCall(TestBlocks(MATSEQAIJ, 3));
  PetscCall(TestBlocks(MATSEQBAIJ, 3));
  PetscCall(TestFactors());
  PetscCall(TestMethodThatNeedsPoints());
  PetscCall(PetscFinalize());
  return 0;
}
