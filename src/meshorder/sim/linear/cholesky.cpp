// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/sim/kernels/positions.hpp>
#include <meshorder/sim/linear/cholesky.hpp>

#include <Eigen/SparseCholesky>

#include <numeric>

namespace meshorder {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Offset>;

Matrix to_eigen(const SparseMatrix& matrix) {
  Matrix result(matrix.size(), matrix.size());
  std::vector<Eigen::Triplet<double, Offset>> entries;
  for (Index row = 0; row < matrix.size(); ++row) {
    for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k)
      entries.emplace_back(row, matrix.columns[k], matrix.values[k]);
  }
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

template <class Real>
struct CholeskyFactor<Real>::Factor {
  Index size = 0;
  Eigen::SimplicialLLT<Matrix> llt;
};

template <class Real>
CholeskyFactor<Real>::CholeskyFactor(const SparseMatrix& matrix) {
  const auto factor = std::make_shared<Factor>();
  factor->size = matrix.size();
  factor->llt.compute(to_eigen(matrix));
  if (factor->llt.info() != Eigen::Success) throw InvalidArgument("the matrix is not positive definite");
  factor_ = factor;
}

template <class Real>
void CholeskyFactor<Real>::solve(std::span<const Real> b, std::span<Real> x) const {
  using Vectors = Eigen::Matrix<Real, Eigen::Dynamic, kPaddedStride, Eigen::RowMajor>;
  const Eigen::Map<const Vectors> right(b.data(), size(), kPaddedStride);
  const Eigen::MatrixXd solution = factor_->llt.solve(right.template cast<double>().eval());
  Eigen::Map<Vectors>(x.data(), size(), kPaddedStride) = solution.cast<Real>();
}

template <class Real>
typename CholeskyFactor<Real>::Reach CholeskyFactor<Real>::reach_of(std::span<const Index> vertices) const {
  return {{vertices.begin(), vertices.end()}};
}

template <class Real>
void CholeskyFactor<Real>::solve(const Reach& reach, std::span<const Real> b, std::span<Real> x) const {
  const std::size_t count = static_cast<std::size_t>(kPaddedStride) * static_cast<std::size_t>(size());
  std::vector<Real> right(count, Real{0});
  std::vector<Real> all(count, Real{0});
  for (const Index v : reach.columns)
    std::copy_n(b.begin() + Offset{4} * v, 4, right.begin() + Offset{4} * v);
  solve(right, all);
  for (const Index v : reach.columns) std::copy_n(all.begin() + Offset{4} * v, 4, x.begin() + Offset{4} * v);
}

template <class Real>
Index CholeskyFactor<Real>::size() const noexcept {
  return factor_->size;
}

template <class Real>
Offset CholeskyFactor<Real>::entries() const noexcept {
  return factor_->llt.matrixL().nestedExpression().nonZeros();
}

template <class Real>
std::size_t CholeskyFactor<Real>::bytes() const {
  return static_cast<std::size_t>(entries()) * (sizeof(double) + sizeof(Offset));
}

template class CholeskyFactor<double>;
template class CholeskyFactor<float>;

}  // namespace meshorder
