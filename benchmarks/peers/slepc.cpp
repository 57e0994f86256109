// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// SLEPc's LOBPCG with PETSc's algebraic multigrid: `peer-slepc GRAPH TOLERANCE VECTOR -st_pc_type
// gamg|hypre`, and any other option of SLEPc and PETSc.
#include "peer.hpp"

#include <slepceps.h>

namespace {

constexpr double kShift = 1e-6;  // makes the preconditioner's matrix regular; far below λ₂

void ok(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error("PETSc error " + std::to_string(code));
}

/// Returns a matrix of PETSc that uses the arrays of `matrix`, with the constants as multigrid's near null
/// space.
Mat petsc_matrix(peer::Matrix& matrix) {
  Mat result = nullptr;
  ok(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, matrix.size, matrix.size, matrix.offsets.data(),
                               matrix.columns.data(), matrix.values.data(), &result));
  MatNullSpace constants = nullptr;
  ok(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_TRUE, 0, nullptr, &constants));
  ok(MatSetNearNullSpace(result, constants));
  ok(MatNullSpaceDestroy(&constants));
  ok(MatSetOption(result, MAT_SYMMETRIC, PETSC_TRUE));
  return result;
}

std::vector<double> solve(Mat laplacian, Mat shifted, double tolerance) {
  Vec constant = nullptr, vector = nullptr;
  ok(MatCreateVecs(laplacian, &constant, &vector));
  ok(VecSet(constant, 1));
  EPS solver = nullptr;
  ok(EPSCreate(PETSC_COMM_SELF, &solver));
  ok(EPSSetOperators(solver, laplacian, nullptr));
  ok(EPSSetProblemType(solver, EPS_HEP));
  ok(EPSSetType(solver, EPSLOBPCG));
  ok(EPSSetWhichEigenpairs(solver, EPS_SMALLEST_REAL));
  ok(EPSSetConvergenceTest(solver, EPS_CONV_REL));  // ‖residual‖ / |λ|, as ours
  ok(EPSSetTolerances(solver, tolerance, 5000));
  ok(EPSSetDeflationSpace(solver, 1, &constant));
  ST transformation = nullptr;
  ok(EPSGetST(solver, &transformation));
  ok(STSetPreconditionerMat(transformation, shifted));
  ok(EPSSetFromOptions(solver));
  ok(EPSSolve(solver));
  PetscInt converged = 0;
  ok(EPSGetConverged(solver, &converged));
  if (converged < 1) throw std::runtime_error("SLEPc did not converge");
  ok(EPSGetEigenvector(solver, 0, vector, nullptr));
  const PetscScalar* values = nullptr;
  PetscInt size = 0;
  ok(VecGetLocalSize(vector, &size));
  ok(VecGetArrayRead(vector, &values));
  std::vector<double> result(values, values + size);
  ok(VecRestoreArrayRead(vector, &values));
  ok(EPSDestroy(&solver));
  ok(VecDestroy(&constant));
  ok(VecDestroy(&vector));
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  return peer::run(argc, argv, [&](const peer::Arguments& arguments) {
    ok(SlepcInitialize(&argc, &argv, nullptr, nullptr));
    peer::Matrix plain = peer::laplacian(arguments.graph);
    peer::Matrix regular = peer::laplacian(arguments.graph, kShift);
    Mat laplacian = petsc_matrix(plain), shifted = petsc_matrix(regular);
    peer::measure(arguments.vector, [&] { return solve(laplacian, shifted, arguments.tolerance); });
    ok(MatDestroy(&laplacian));
    ok(MatDestroy(&shifted));
    ok(SlepcFinalize());
  });
}
