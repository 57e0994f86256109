// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Tests orders of degrees of freedom and of a triangulation's cells: their direction, and that the solution
// stays the same.
#include <meshorder/dealii.hpp>

#include <deal.II/base/function.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/matrix_creator.h>
#include <deal.II/numerics/vector_tools.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

namespace {

void check(bool holds, const char* what, int line) {
  if (holds) return;
  std::printf("line %d: not true: %s\n", line, what);
  std::exit(1);
}
#define EXPECT(condition) check((condition), #condition, __LINE__)

// Returns a permutation that is not its own inverse: k goes to stride · k mod n.
std::vector<dealii::types::global_dof_index> strided(unsigned int n) {
  unsigned int stride = 37;
  while (std::gcd(stride, n) != 1) ++stride;
  std::vector<dealii::types::global_dof_index> map(n);
  for (unsigned int k = 0; k < n; ++k) map[k] = k * stride % n;
  return map;
}

unsigned int bandwidth(const dealii::DoFHandler<2>& dofs) {
  dealii::DynamicSparsityPattern pattern(dofs.n_dofs(), dofs.n_dofs());
  dealii::DoFTools::make_sparsity_pattern(dofs, pattern);
  return static_cast<unsigned int>(pattern.bandwidth());
}

// Orders a strip of 60 squares: in a good order, neighbours' numbers differ by at most 3.
void test_direction_of_dofs() {
  dealii::Triangulation<2> strip;
  dealii::GridGenerator::subdivided_hyper_rectangle(strip, {60, 1}, {0, 0}, {60, 1});
  const dealii::FE_Q<2> element(1);
  dealii::DoFHandler<2> dofs(strip);
  dofs.distribute_dofs(element);
  dofs.renumber_dofs(strided(dofs.n_dofs()));
  EXPECT(bandwidth(dofs) > 3);

  const meshorder::Order order = meshorder::order_dofs(dofs, "rcm");
  EXPECT(order.permutation != order.permutation.inverse());
  dealii::DoFHandler<2> swapped(strip);
  swapped.distribute_dofs(element);
  swapped.renumber_dofs(strided(swapped.n_dofs()));
  const auto wrong = order.permutation.new_to_old();
  swapped.renumber_dofs({wrong.begin(), wrong.end()});
  EXPECT(bandwidth(swapped) > 3);

  meshorder::renumber_dofs(dofs, "rcm");
  EXPECT(bandwidth(dofs) == 3);
  meshorder::renumber_dofs(dofs, "hilbert");  // by support points
}

// Solves −Δu = x + 1 on a refined disk with hanging nodes; returns u at the vertices, by coordinates.
std::map<std::pair<double, double>, double> solution(const std::string& method) {
  dealii::Triangulation<2> disk;
  dealii::GridGenerator::hyper_ball(disk);
  disk.refine_global(3);
  for (const auto& cell : disk.active_cell_iterators()) {
    if (cell->center()[0] > 0.2) cell->set_refine_flag();
  }
  disk.execute_coarsening_and_refinement();
  const dealii::FE_Q<2> element(2);
  dealii::DoFHandler<2> dofs(disk);
  dofs.distribute_dofs(element);
  if (!method.empty()) {
    dealii::AffineConstraints<double> hanging;
    dealii::DoFTools::make_hanging_node_constraints(dofs, hanging);
    hanging.close();
    meshorder::renumber_dofs(dofs, method, hanging);
  }

  dealii::AffineConstraints<double> constraints;
  dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
  dealii::VectorTools::interpolate_boundary_values(dofs, 0, dealii::Functions::ZeroFunction<2>(),
                                                   constraints);
  constraints.close();
  dealii::DynamicSparsityPattern dynamic(dofs.n_dofs(), dofs.n_dofs());
  dealii::DoFTools::make_sparsity_pattern(dofs, dynamic, constraints);
  dealii::SparsityPattern pattern;
  pattern.copy_from(dynamic);
  dealii::SparseMatrix<double> matrix(pattern);
  dealii::Vector<double> right(dofs.n_dofs());
  dealii::Vector<double> u(dofs.n_dofs());
  const dealii::ScalarFunctionFromFunctionObject<2> load(
      [](const dealii::Point<2>& place) { return place[0] + 1; });
  dealii::MatrixCreator::create_laplace_matrix(dofs, dealii::QGauss<2>(3), matrix, load, right,
                                               static_cast<const dealii::Function<2>*>(nullptr), constraints);
  dealii::SolverControl control(1000, 1e-14);
  dealii::SolverCG<dealii::Vector<double>>(control).solve(matrix, u, right, dealii::PreconditionIdentity());
  constraints.distribute(u);

  std::map<std::pair<double, double>, double> values;
  for (const auto& cell : dofs.active_cell_iterators()) {
    for (const unsigned int v : cell->vertex_indices()) {
      values[{cell->vertex(v)[0], cell->vertex(v)[1]}] = u[cell->vertex_dof_index(v, 0)];
    }
  }
  return values;
}

void test_the_same_solution() {
  const auto expected = solution("");
  for (const char* const method : {"rcm", "spectral", "auto", "scrambled"}) {
    const auto found = solution(method);
    EXPECT(found.size() == expected.size());
    double largest = 0;
    for (const auto& [place, value] : expected) {
      EXPECT(found.contains(place));
      EXPECT(std::abs(found.at(place) - value) < 1e-10);
      largest = std::max(largest, std::abs(value));
    }
    EXPECT(largest > 0.1);
  }
}

// Orders a strip of shuffled cubes. The material of each cube is its position; one end is marked.
void test_cells() {
  dealii::Triangulation<3> strip;
  dealii::GridGenerator::subdivided_hyper_rectangle(strip, {60, 1, 1}, {0, 0, 0}, {60, 1, 1});
  for (const auto& cell : strip.active_cell_iterators()) {
    cell->set_material_id(static_cast<dealii::types::material_id>(cell->center()[0]));
    for (const auto& face : cell->face_iterators()) {
      if (face->at_boundary() && face->center()[0] == 60) face->set_boundary_id(7);
    }
  }
  auto [vertices, cells, sub_cells] = dealii::GridTools::get_coarse_mesh_description(strip);
  const auto scattered = strided(static_cast<unsigned int>(cells.size()));
  auto shuffled = cells;
  for (std::size_t c = 0; c < cells.size(); ++c) shuffled[scattered[c]] = cells[c];

  const meshorder::MeshOrder order = meshorder::reorder(vertices, shuffled, sub_cells, {.vertices = "rcm"});
  EXPECT(order.cells.permutation != order.cells.permutation.inverse());
  dealii::Triangulation<3> ordered;
  ordered.create_triangulation(vertices, shuffled, sub_cells);
  EXPECT(std::abs(dealii::GridTools::volume(ordered) - 60) < 1e-12);
  int marked = 0;
  for (const auto& cell : ordered.active_cell_iterators()) {
    EXPECT(cell->material_id() == static_cast<dealii::types::material_id>(cell->center()[0]));
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->at_boundary(f)) {
        EXPECT(std::abs(cell->neighbor(f)->index() - cell->index()) == 1);
      } else if (cell->face(f)->boundary_id() == 7) {
        EXPECT(cell->face(f)->center()[0] == 60);
        ++marked;
      }
    }
  }
  EXPECT(marked == 1);
}

}  // namespace

int main() {
  test_direction_of_dofs();
  test_the_same_solution();
  test_cells();
  return 0;
}
