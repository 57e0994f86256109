// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Spectra's Lanczos method on the inverse of the Laplacian, factored by Eigen's sparse LDLᵀ:
// `peer-spectra GRAPH TOLERANCE VECTOR [metis]`. Without `metis` the factor is in the order of approximate
// minimum degree.
#include "peer.hpp"

// Eigen 3.4's MetisSupport needs <iostream> and does not include it
// clang-format off
#include <iostream>
#include <Eigen/MetisSupport>
// clang-format on
#include <Eigen/SparseCholesky>
#include <Spectra/SymEigsShiftSolver.h>

#include <string_view>

namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr double kShift = 1e-8;  // makes the matrix regular; far below λ₂

/// (L + kShift)⁻¹ on the vectors that sum to 0, with the interface that Spectra needs.
template <class Order>
class Inverse {
 public:
  using Scalar = double;

  explicit Inverse(const SparseMatrix& shifted) : factor_(shifted) {}
  [[nodiscard]] Eigen::Index rows() const { return factor_.rows(); }
  [[nodiscard]] Eigen::Index cols() const { return factor_.cols(); }
  void set_shift(double) {}
  void perform_op(const double* x, double* y) const {  // NOLINT(readability-non-const-parameter)
    const Eigen::Map<const Eigen::VectorXd> in(x, rows());
    Eigen::Map<Eigen::VectorXd> out(y, rows());
    out = factor_.solve((in.array() - in.mean()).matrix());
    out.array() -= out.mean();
  }

 private:
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Order> factor_;
};

template <class Order>
std::vector<double> solve(const SparseMatrix& shifted, double tolerance) {
  Inverse<Order> inverse(shifted);
  Spectra::SymEigsShiftSolver<Inverse<Order>> solver(inverse, 1, 8, -kShift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 100, tolerance);
  if (solver.info() != Spectra::CompInfo::Successful) throw std::runtime_error("Spectra did not converge");
  const Eigen::VectorXd y = solver.eigenvectors().col(0);
  return {y.begin(), y.end()};
}

}  // namespace

int main(int argc, char** argv) {
  const bool metis = argc > 4 && std::string_view(argv[4]) == "metis";
  return peer::run(argc, argv, [&](const peer::Arguments& arguments) {
    const peer::Matrix shifted = peer::laplacian(arguments.graph, kShift);
    const SparseMatrix matrix =
        Eigen::Map<const SparseMatrix>(shifted.size, shifted.size, static_cast<int>(shifted.values.size()),
                                       shifted.offsets.data(), shifted.columns.data(), shifted.values.data());
    peer::measure(arguments.vector, [&] {
      return metis ? solve<Eigen::MetisOrdering<int>>(matrix, arguments.tolerance)
                   : solve<Eigen::AMDOrdering<int>>(matrix, arguments.tolerance);
    });
  });
}
