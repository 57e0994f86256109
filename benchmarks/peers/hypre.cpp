// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// hypre's own LOBPCG, preconditioned with one cycle of BoomerAMG.
#include "peer.hpp"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_lobpcg.h>
#include <HYPRE_parcsr_ls.h>

#include <numeric>

namespace {

void ok(HYPRE_Int code) {
  if (code != 0) throw std::runtime_error("hypre error " + std::to_string(code));
}

HYPRE_ParCSRMatrix hypre_matrix(peer::Matrix& matrix, HYPRE_IJMatrix& holder) {
  ok(HYPRE_IJMatrixCreate(MPI_COMM_SELF, 0, matrix.size - 1, 0, matrix.size - 1, &holder));
  ok(HYPRE_IJMatrixSetObjectType(holder, HYPRE_PARCSR));
  std::vector<HYPRE_Int> entries(matrix.size), rows(matrix.size);
  for (int row = 0; row < matrix.size; ++row) entries[row] = matrix.offsets[row + 1] - matrix.offsets[row];
  std::iota(rows.begin(), rows.end(), 0);
  ok(HYPRE_IJMatrixSetDiagOffdSizes(holder, entries.data(), std::vector<HYPRE_Int>(matrix.size).data()));
  ok(HYPRE_IJMatrixInitialize(holder));
  ok(HYPRE_IJMatrixSetValues(holder, matrix.size, entries.data(), rows.data(), matrix.columns.data(),
                             matrix.values.data()));
  ok(HYPRE_IJMatrixAssemble(holder));
  void* object = nullptr;
  ok(HYPRE_IJMatrixGetObject(holder, &object));
  return static_cast<HYPRE_ParCSRMatrix>(object);
}

HYPRE_ParVector hypre_vector(int size, HYPRE_IJVector& holder) {
  ok(HYPRE_IJVectorCreate(MPI_COMM_SELF, 0, size - 1, &holder));
  ok(HYPRE_IJVectorSetObjectType(holder, HYPRE_PARCSR));
  ok(HYPRE_IJVectorInitialize(holder));
  ok(HYPRE_IJVectorAssemble(holder));
  void* object = nullptr;
  ok(HYPRE_IJVectorGetObject(holder, &object));
  return static_cast<HYPRE_ParVector>(object);
}

HYPRE_Solver one_cycle_of_boomeramg() {
  HYPRE_Solver amg = nullptr;
  ok(HYPRE_BoomerAMGCreate(&amg));
  ok(HYPRE_BoomerAMGSetPrintLevel(amg, 0));
  ok(HYPRE_BoomerAMGSetMaxIter(amg, 1));
  ok(HYPRE_BoomerAMGSetTol(amg, 0));
  // the fastest of the usual settings on the benchmark's meshes: aggressive coarsening, symmetric
  // Gauss-Seidel
  ok(HYPRE_BoomerAMGSetAggNumLevels(amg, 1));
  ok(HYPRE_BoomerAMGSetRelaxType(amg, 6));
  return amg;
}

HYPRE_ParVector only_vector(mv_MultiVectorPtr vectors) {
  return static_cast<HYPRE_ParVector>(
      static_cast<mv_TempMultiVector*>(mv_MultiVectorGetData(vectors))->vector[0]);
}

std::vector<double> solve(HYPRE_ParCSRMatrix laplacian, HYPRE_ParVector sample, int size, double tolerance) {
  mv_InterfaceInterpreter interpreter;
  HYPRE_MatvecFunctions products;
  ok(HYPRE_ParCSRSetupInterpreter(&interpreter));
  ok(HYPRE_ParCSRSetupMatvec(&products));
  mv_MultiVectorPtr constants = mv_MultiVectorCreateFromSampleVector(&interpreter, 1, sample);
  mv_MultiVectorPtr vectors = mv_MultiVectorCreateFromSampleVector(&interpreter, 1, sample);
  ok(HYPRE_ParVectorSetConstantValues(only_vector(constants), 1));
  mv_MultiVectorSetRandom(vectors, 1);

  HYPRE_Solver amg = one_cycle_of_boomeramg();
  HYPRE_Solver solver = nullptr;
  ok(HYPRE_LOBPCGCreate(&interpreter, &products, &solver));
  ok(HYPRE_LOBPCGSetMaxIter(solver, 500));
  ok(HYPRE_LOBPCGSetPrintLevel(solver, 0));
  ok(HYPRE_LOBPCGSetPrecondUsageMode(solver, 1));
  ok(HYPRE_LOBPCGSetTol(solver, tolerance));
  ok(HYPRE_LOBPCGSetPrecond(solver, reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSolve),
                            reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSetup), amg));
  auto* const b = reinterpret_cast<HYPRE_Vector>(sample);
  ok(HYPRE_LOBPCGSetup(solver, reinterpret_cast<HYPRE_Matrix>(laplacian), b, b));
  double eigenvalue = 0;
  ok(HYPRE_LOBPCGSolve(solver, constants, vectors, &eigenvalue));

  std::vector<double> result(size);
  std::vector<HYPRE_Int> rows(size);
  std::iota(rows.begin(), rows.end(), 0);
  ok(HYPRE_ParVectorGetValues(only_vector(vectors), size, rows.data(), result.data()));
  mv_MultiVectorDestroy(constants);
  mv_MultiVectorDestroy(vectors);
  ok(HYPRE_LOBPCGDestroy(solver));
  ok(HYPRE_BoomerAMGDestroy(amg));
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  return peer::run(argc, argv, [&](const peer::Arguments& arguments) {
    MPI_Init(&argc, &argv);
    ok(HYPRE_Init());
    peer::Matrix matrix = peer::laplacian(arguments.graph);
    HYPRE_IJMatrix matrix_holder = nullptr;
    HYPRE_IJVector vector_holder = nullptr;
    HYPRE_ParCSRMatrix laplacian = hypre_matrix(matrix, matrix_holder);
    HYPRE_ParVector sample = hypre_vector(matrix.size, vector_holder);
    peer::measure(arguments.vector,
                  [&] { return solve(laplacian, sample, matrix.size, arguments.tolerance); });
    ok(HYPRE_IJMatrixDestroy(matrix_holder));
    ok(HYPRE_IJVectorDestroy(vector_holder));
    ok(HYPRE_Finalize());
    MPI_Finalize();
  });
}
