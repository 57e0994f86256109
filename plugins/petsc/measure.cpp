// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Measures the gain of orders in PETSc: −Δu + u = 1 on a mesh of TetGen in a DMPlex.
//
//   petsc_measure PREFIX ROUNDS mesh      the mesh in each order: assembly, products, CG with ICC
//   petsc_measure PREFIX ROUNDS factors   the mesh as it is, ICC in each MatOrdering
//   petsc_measure PREFIX ROUNDS direct    the mesh as it is, complete Cholesky factors in each MatOrdering
#include "../measuring.hpp"
#include "meshorder_petsc.h"

#include <petscdmplex.h>
#include <petscksp.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace {

// ends the program if PETSc reports an error
void must(PetscErrorCode code) { PetscCallAbort(PETSC_COMM_SELF, code); }

DM create_mesh(const measuring::Tetrahedra& tetrahedra) {
  std::vector<PetscInt> corners;
  std::vector<PetscReal> points;
  for (const auto& cell : tetrahedra.cells)
    corners.insert(corners.end(), {cell[0], cell[2], cell[1], cell[3]});
  for (const auto& point : tetrahedra.points) points.insert(points.end(), point.begin(), point.end());
  DM dm = nullptr;
  must(DMPlexCreateFromCellListPetsc(PETSC_COMM_SELF, 3, static_cast<PetscInt>(tetrahedra.cells.size()),
                                     static_cast<PetscInt>(tetrahedra.points.size()), 4, PETSC_TRUE,
                                     corners.data(), 3, points.data(), &dm));
  return dm;
}

DM permuted(DM dm, IS perm) {
  DM moved = nullptr;
  must(DMPlexPermute(dm, perm, &moved));
  return moved;
}

// The problem on a mesh, in the mesh's own order.
class Problem {
 public:
  explicit Problem(DM dm) : dm_(dm) {
    PetscInt begin = 0;
    PetscInt end = 0;
    PetscInt vertex_begin = 0;
    PetscInt vertex_end = 0;
    must(DMPlexGetChart(dm, &begin, &end));
    must(DMPlexGetDepthStratum(dm, 0, &vertex_begin, &vertex_end));
    must(PetscSectionCreate(PETSC_COMM_SELF, &section_));
    must(PetscSectionSetChart(section_, begin, end));
    for (PetscInt v = vertex_begin; v < vertex_end; ++v) must(PetscSectionSetDof(section_, v, 1));
    must(PetscSectionSetUp(section_));
    must(DMSetLocalSection(dm, section_));
    must(DMCreateMatrix(dm, &matrix_));
    must(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
    must(MatCreateVecs(matrix_, &solution_, &right_));
    must(VecSet(right_, 1));
    assemble();
  }

  void assemble() {
    PetscInt begin = 0;
    PetscInt end = 0;
    must(DMPlexGetHeightStratum(dm_, 0, &begin, &end));
    must(MatZeroEntries(matrix_));
    for (PetscInt cell = begin; cell < end; ++cell) {
      std::array<PetscReal, 3> corner{};
      std::array<PetscReal, 9> jacobian{};
      std::array<PetscReal, 9> inverse{};
      PetscReal determinant = 0;
      must(DMPlexComputeCellGeometryFEM(dm_, cell, nullptr, corner.data(), jacobian.data(), inverse.data(),
                                        &determinant));
      // gradients of the four shape functions: rows of the inverse, and minus their sum
      std::array<std::array<PetscReal, 3>, 4> gradients{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < 3; ++k) {
          gradients[k + 1][axis] = inverse[3 * k + axis];
          gradients[0][axis] -= inverse[3 * k + axis];
        }
      }
      const PetscReal volume = determinant / 6;
      std::array<PetscScalar, 16> element{};
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
          PetscReal product = i == j ? 0.1 : 0.05;
          for (std::size_t axis = 0; axis < 3; ++axis) product += gradients[i][axis] * gradients[j][axis];
          element[4 * i + j] = product * volume;
        }
      }
      must(DMPlexMatSetClosure(dm_, section_, section_, matrix_, cell, element.data(), ADD_VALUES));
    }
    must(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
    must(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
  }

  void multiply(int times) const {
    for (int k = 0; k < times; ++k) must(MatMult(matrix_, right_, solution_));
  }

  // Returns a new solver, so that the set-up is timed again.
  [[nodiscard]] KSP solver(KSPType type, PCType preconditioner, MatOrderingType ordering) const {
    KSP ksp = nullptr;
    PC pc = nullptr;
    must(KSPCreate(PETSC_COMM_SELF, &ksp));
    must(KSPSetOperators(ksp, matrix_, matrix_));
    must(KSPSetType(ksp, type));
    must(KSPSetTolerances(ksp, 1e-8, PETSC_DEFAULT, PETSC_DEFAULT, 10000));
    must(KSPGetPC(ksp, &pc));
    must(PCSetType(pc, preconditioner));
    must(PCFactorSetMatOrderingType(pc, ordering));
    return ksp;
  }

  PetscInt solve(KSP ksp) const {
    PetscInt iterations = 0;
    must(KSPSolve(ksp, right_, solution_));
    must(KSPGetIterationNumber(ksp, &iterations));
    return iterations;
  }

  [[nodiscard]] Mat matrix() const { return matrix_; }

  [[nodiscard]] std::string bandwidth() const {
    PetscInt width = 0;
    must(MatComputeBandwidth(matrix_, 0, &width));
    return std::to_string(width);
  }

 private:
  DM dm_;
  PetscSection section_ = nullptr;
  Mat matrix_ = nullptr;
  Vec solution_ = nullptr;
  Vec right_ = nullptr;
};

void measure_meshes(const measuring::Tetrahedra& tetrahedra, int rounds) {
  const DM original = create_mesh(tetrahedra);
  std::vector<std::pair<std::string, DM>> meshes{{"as TetGen made it", original}};
  IS perm = nullptr;
  std::printf("orders of the mesh:");
  std::printf(" DMPlexGetOrdering %.2f s", measuring::processor_seconds([&] {
                must(DMPlexGetOrdering(original, nullptr, nullptr, &perm));
              }));
  meshes.emplace_back("DMPlexGetOrdering", permuted(original, perm));
  for (const char* const method : {"rcm", "hilbert", "spectral"}) {
    std::printf(", %s %.2f s", method, measuring::processor_seconds([&] {
                  must(MeshorderDMPlexOrdering(original, method, &perm));
                }));
    meshes.emplace_back(std::string("meshorder ") + method, permuted(original, perm));
  }
  std::printf("\n\n");
  std::vector<Problem> problems;
  problems.reserve(meshes.size());
  std::vector<measuring::Case> cases;
  for (const auto& [name, dm] : meshes) {
    Problem& problem = problems.emplace_back(dm);
    const KSP once = problem.solver(KSPCG, PCICC, MATORDERINGNATURAL);
    const std::string iterations = std::to_string(problem.solve(once));
    cases.push_back({name,
                     problem.bandwidth() + " | " + iterations,
                     {[&problem] { problem.assemble(); }, [&problem] { problem.multiply(100); },
                      [&problem] {
                        KSP ksp = problem.solver(KSPCG, PCICC, MATORDERINGNATURAL);
                        problem.solve(ksp);
                        must(KSPDestroy(&ksp));
                      }}});
  }
  measuring::measure(cases, {"assembly", "100 products", "CG with ICC"}, "bandwidth | iterations", rounds);
}

void measure_orderings(const measuring::Tetrahedra& tetrahedra, int rounds, bool direct) {
  const Problem problem(create_mesh(tetrahedra));
  const PCType preconditioner = direct ? PCCHOLESKY : PCICC;
  const KSPType type = direct ? KSPPREONLY : KSPCG;
  const std::vector<std::string> orderings = direct ? std::vector<std::string>{"nd",
                                                                               "rcm",
                                                                               "qmd",
                                                                               "meshorder_metis-nd",
                                                                               "meshorder_rcm",
                                                                               "meshorder_spectral"}
                                                    : std::vector<std::string>{"natural",
                                                                               "rcm",
                                                                               "nd",
                                                                               "meshorder_rcm",
                                                                               "meshorder_fiedler",
                                                                               "meshorder_spectral",
                                                                               "meshorder_metis-nd",
                                                                               "meshorder_scrambled"};
  std::vector<KSP> solvers(orderings.size());
  std::vector<measuring::Case> cases;
  for (std::size_t k = 0; k < orderings.size(); ++k) {
    const char* const ordering = orderings[k].c_str();
    IS rows = nullptr;
    IS columns = nullptr;
    const double seconds = measuring::processor_seconds(
        [&] { must(MatGetOrdering(problem.matrix(), ordering, &rows, &columns)); });
    Mat moved = nullptr;
    must(MatPermute(problem.matrix(), rows, columns, &moved));
    PetscInt width = 0;
    must(MatComputeBandwidth(moved, 0, &width));
    must(MatDestroy(&moved));
    KSP ksp = problem.solver(type, preconditioner, ordering);
    const PetscInt iterations = problem.solve(ksp);
    PC pc = nullptr;
    Mat factors = nullptr;
    MatInfo info;
    must(KSPGetPC(ksp, &pc));
    must(PCFactorGetMatrix(pc, &factors));
    must(MatGetInfo(factors, MAT_LOCAL, &info));
    must(KSPDestroy(&ksp));
    std::array<char, 100> facts{};
    if (direct) {
      (void)std::snprintf(facts.data(), facts.size(), "%d | %.1fM | %.2f s", static_cast<int>(width),
                          info.nz_used / 1e6, seconds);
    } else {
      (void)std::snprintf(facts.data(), facts.size(), "%d | %d | %.2f s", static_cast<int>(width),
                          static_cast<int>(iterations), seconds);
    }
    cases.push_back({orderings[k],
                     facts.data(),
                     {[&problem, &solver = solvers[k], type, preconditioner, ordering] {
                        solver = problem.solver(type, preconditioner, ordering);
                        must(KSPSetUp(solver));
                      },
                      [&problem, &solver = solvers[k]] {
                        problem.solve(solver);
                        must(KSPDestroy(&solver));
                      }}});
  }
  measuring::measure(cases, {"order and factor", "solve"},
                     direct ? "bandwidth | entries of the factor | order" : "bandwidth | iterations | order",
                     rounds);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::printf("usage: %s PREFIX ROUNDS mesh|factors|direct\n", argv[0]);
    return 2;
  }
  must(PetscInitialize(&argc, &argv, nullptr, nullptr));
  must(MeshorderMatOrderingRegister());
  const measuring::Tetrahedra tetrahedra = measuring::read_tetgen(argv[1]);
  const int rounds = std::stoi(argv[2]);
  const std::string what = argv[3];
  std::printf("%zu vertices, %zu tetrahedra\n\n", tetrahedra.points.size(), tetrahedra.cells.size());
  if (what == "mesh") {
    measure_meshes(tetrahedra, rounds);
  } else {
    measure_orderings(tetrahedra, rounds, what == "direct");
  }
  must(PetscFinalize());
  return 0;
}
