// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Measures the gain of orders in deal.II: −Δu + u = 1 by FE_Q(1), on a mesh of TetGen whose tetrahedra are
// cut into four hexahedra each.
//
//   dealii_measure PREFIX ROUNDS
#include "../measuring.hpp"
#include <meshorder/dealii.hpp>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/sparse_ilu.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

struct Hexahedra {
  std::vector<dealii::Point<3>> vertices;
  std::vector<dealii::CellData<3>> cells;
};

// Cuts each tetrahedron into four hexahedra, at the middles of the edges, the faces and the tetrahedron.
Hexahedra hexahedra_of(const measuring::Tetrahedra& mesh) {
  Hexahedra hexahedra;
  std::map<std::vector<int>, unsigned int> middles;
  const auto middle = [&](std::vector<int> corners) {
    std::ranges::sort(corners);
    const auto [found, is_new] =
        middles.try_emplace(corners, static_cast<unsigned int>(hexahedra.vertices.size()));
    if (is_new) {
      dealii::Point<3> sum;
      for (const int corner : corners) {
        for (unsigned int axis = 0; axis < 3; ++axis) {
          sum[axis] +=
              mesh.points[static_cast<std::size_t>(corner)][axis] / static_cast<double>(corners.size());
        }
      }
      hexahedra.vertices.push_back(sum);
    }
    return found->second;
  };
  for (std::size_t p = 0; p < mesh.points.size(); ++p) middle({static_cast<int>(p)});
  // for each corner: itself, then the other three, clockwise as seen from it
  constexpr std::array<std::array<std::size_t, 4>, 4> corners{
      {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};
  for (const auto& cell : mesh.cells) {
    for (const auto& [i, j, k, l] : corners) {
      const int a = cell[i];
      const int b = cell[j];
      const int c = cell[k];
      const int d = cell[l];
      dealii::CellData<3> hexahedron(8);
      hexahedron.vertices = {middle({a}),    middle({a, b}),    middle({a, c}),    middle({a, b, c}),
                             middle({a, d}), middle({a, b, d}), middle({a, c, d}), middle({a, b, c, d})};
      hexahedra.cells.push_back(hexahedron);
    }
  }
  return hexahedra;
}

class Problem {
 public:
  Problem(const Hexahedra& mesh, const std::function<void(dealii::DoFHandler<3>&)>& renumber) {
    triangulation_.create_triangulation(mesh.vertices, mesh.cells, dealii::SubCellData());
    dofs_.reinit(triangulation_);
    dofs_.distribute_dofs(element_);
    renumber(dofs_);
    dealii::DynamicSparsityPattern dynamic(dofs_.n_dofs(), dofs_.n_dofs());
    dealii::DoFTools::make_sparsity_pattern(dofs_, dynamic);
    pattern_.copy_from(dynamic);
    matrix_.reinit(pattern_);
    right_.reinit(dofs_.n_dofs());
    solution_.reinit(dofs_.n_dofs());
    assemble();
  }

  void assemble() {
    matrix_ = 0;
    right_ = 0;
    dealii::FEValues<3> values(element_, dealii::QGauss<3>(2),
                               dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
    dealii::FullMatrix<double> local(8, 8);
    dealii::Vector<double> load(8);
    std::vector<dealii::types::global_dof_index> numbers(8);
    for (const auto& cell : dofs_.active_cell_iterators()) {
      values.reinit(cell);
      local = 0;
      load = 0;
      for (const unsigned int q : values.quadrature_point_indices()) {
        for (const unsigned int i : values.dof_indices()) {
          for (const unsigned int j : values.dof_indices()) {
            local(i, j) += (values.shape_grad(i, q) * values.shape_grad(j, q) +
                            values.shape_value(i, q) * values.shape_value(j, q)) *
                           values.JxW(q);
          }
          load(i) += values.shape_value(i, q) * values.JxW(q);
        }
      }
      cell->get_dof_indices(numbers);
      matrix_.add(numbers, local);
      right_.add(numbers, load);
    }
  }

  void multiply(int times) {
    for (int k = 0; k < times; ++k) matrix_.vmult(solution_, right_);
  }

  unsigned int solve() {
    dealii::SparseILU<double> preconditioner;
    preconditioner.initialize(matrix_);
    dealii::SolverControl control(10000, 1e-8 * right_.l2_norm());
    solution_ = 0;
    dealii::SolverCG<dealii::Vector<double>>(control).solve(matrix_, solution_, right_, preconditioner);
    return control.last_step();
  }

  double mean_span() const {
    double sum = 0;
    for (const auto& entry : pattern_) {
      sum += std::abs(static_cast<double>(entry.row()) - static_cast<double>(entry.column()));
    }
    return sum / static_cast<double>(pattern_.n_nonzero_elements() - pattern_.n_rows());
  }

  unsigned int unknowns() const { return static_cast<unsigned int>(dofs_.n_dofs()); }

 private:
  dealii::FE_Q<3> element_{1};
  dealii::Triangulation<3> triangulation_;
  dealii::DoFHandler<3> dofs_;
  dealii::SparsityPattern pattern_;
  dealii::SparseMatrix<double> matrix_;
  dealii::Vector<double> right_;
  dealii::Vector<double> solution_;
};

Hexahedra ordered(Hexahedra mesh, const std::string& method) {
  dealii::SubCellData none;
  meshorder::reorder(mesh.vertices, mesh.cells, none, {.vertices = method});
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::printf("usage: %s PREFIX ROUNDS\n", argv[0]);
    return 2;
  }
  const Hexahedra made = hexahedra_of(measuring::read_tetgen(argv[1]));
  const auto keep = [](dealii::DoFHandler<3>&) {};
  const auto by = [](const char* method) {
    return [method](dealii::DoFHandler<3>& dofs) { meshorder::renumber_dofs(dofs, method); };
  };
  struct Orders {
    std::string name;
    std::string cells;  // method, or empty
    std::function<void(dealii::DoFHandler<3>&)> renumber;
  };
  const std::vector<Orders> orders{
      {"as it was made, `distribute_dofs`", "", keep},
      {"`DoFRenumbering::Cuthill_McKee`, reversed", "",
       [](dealii::DoFHandler<3>& dofs) { dealii::DoFRenumbering::Cuthill_McKee(dofs, true); }},
      {"unknowns rcm", "", by("rcm")},
      {"unknowns hilbert", "", by("hilbert")},
      {"cells auto", "auto", keep},
      {"cells rcm", "rcm", keep},
      {"cells and unknowns rcm", "rcm", by("rcm")},
      {"cells and unknowns hilbert", "hilbert", by("hilbert")},
      {"cells and unknowns scrambled", "scrambled", by("scrambled")},
  };
  std::deque<Problem> problems;
  std::vector<measuring::Case> cases;
  for (const Orders& order : orders) {
    const Hexahedra moved = order.cells.empty() ? made : ordered(made, order.cells);
    Problem& problem = problems.emplace_back(moved, order.renumber);
    std::array<char, 100> facts{};
    (void)std::snprintf(facts.data(), facts.size(), "%.0f | %u", problem.mean_span(), problem.solve());
    cases.push_back({order.name,
                     facts.data(),
                     {[&problem] { problem.assemble(); }, [&problem] { problem.multiply(50); },
                      [&problem] { problem.solve(); }}});
  }
  std::printf("%zu hexahedra, %u unknowns\n\n", made.cells.size(), problems.front().unknowns());
  measuring::measure(cases, {"assembly", "50 products", "CG with ILU"}, "mean span | iterations",
                     std::stoi(argv[2]));
  return 0;
}
