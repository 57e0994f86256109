// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/spectral/lobpcg.hpp>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include <cmath>

namespace meshorder {
namespace {

/// A block of vectors and L times it.
template <int M>
struct WithImage {
  VectorBlock<M> vectors;
  VectorBlock<M> images;

  explicit WithImage(std::size_t n)
      : vectors(n, std::array<double, M>{}), images(n, std::array<double, M>{}) {}
};

/// Numbers for the 3 M vectors of a search space, and for their pairs.
template <int M>
using RowOfSpace = std::array<double, std::size_t{3} * M>;
template <int M>
using SquareOfSpace = std::array<RowOfSpace<M>, std::size_t{3} * M>;

/// The three blocks whose span an iteration searches: iterates, preconditioned residuals, last directions.
template <int M>
struct SearchSpace {
  WithImage<M> x, w, p;

  explicit SearchSpace(std::size_t n) : x(n), w(n), p(n) {}

  /// Row v of the 3 M vectors (or images) side by side.
  [[nodiscard]] RowOfSpace<M> row(VectorBlock<M> WithImage<M>::*part, std::size_t v) const {
    RowOfSpace<M> result;
    for (int m = 0; m < M; ++m) {
      result[m] = (x.*part)[v][m];
      result[M + m] = (w.*part)[v][m];
      result[2 * M + m] = (p.*part)[v][m];
    }
    return result;
  }
};

template <int M>
using Gram = Eigen::Matrix<double, 3 * M, 3 * M>;

/// Sᵀ B S and Sᵀ L S of the search space S.
template <int M>
void gram_matrices(const SearchSpace<M>& s, const std::vector<double>& mass, Gram<M>& gram, Gram<M>& energy) {
  SquareOfSpace<M> g{};
  SquareOfSpace<M> e{};
  for (std::size_t v = 0; v < mass.size(); ++v) {
    const auto vectors = s.row(&WithImage<M>::vectors, v);
    const auto images = s.row(&WithImage<M>::images, v);
    for (int i = 0; i < 3 * M; ++i) {
      for (int j = i; j < 3 * M; ++j) {
        g[i][j] += mass[v] * vectors[i] * vectors[j];
        e[i][j] += vectors[i] * images[j];
      }
    }
  }
  for (int i = 0; i < 3 * M; ++i) {
    for (int j = i; j < 3 * M; ++j) {
      gram(i, j) = gram(j, i) = g[i][j];
      energy(i, j) = energy(j, i) = e[i][j];
    }
  }
}

/// The coefficients of the M Ritz vectors with the smallest Ritz values, and those values. Directions of the
/// basis that nearly depend on the others are left out.
template <int M>
void rayleigh_ritz(const Gram<M>& gram, const Gram<M>& energy, Eigen::Matrix<double, 3 * M, M>& coefficients,
                   Eigen::Matrix<double, M, 1>& values) {
  constexpr double kDependent = 1e-12;
  Eigen::Matrix<double, 3 * M, 1> scale = gram.diagonal();
  for (int i = 0; i < 3 * M; ++i) scale[i] = scale[i] > 0 ? 1 / std::sqrt(scale[i]) : 0;
  const Eigen::SelfAdjointEigenSolver<Gram<M>> independent(
      Gram<M>(scale.asDiagonal() * gram * scale.asDiagonal()));
  int kept = 0;
  Eigen::Matrix<double, 3 * M, Eigen::Dynamic> basis(3 * M, 3 * M);
  for (int i = 3 * M - 1; i >= 0; --i) {
    const double eigenvalue = independent.eigenvalues()[i];
    if (eigenvalue < kDependent) break;
    basis.col(kept++) = scale.asDiagonal() * independent.eigenvectors().col(i) / std::sqrt(eigenvalue);
  }
  basis.conservativeResize(Eigen::NoChange, kept);
  const Eigen::MatrixXd projected = basis.transpose() * energy * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(projected);
  coefficients.setZero();
  values.setZero();
  for (int m = 0; m < std::min(M, kept); ++m) {
    coefficients.col(m) = basis * solver.eigenvectors().col(m);
    values[m] = solver.eigenvalues()[m];
  }
}

/// x ← S c, p ← the part of that which is not from x, the same for the images, and r = L x − λ B x. Returns
/// ‖r‖ / ‖x‖ of the first column.
template <int M>
double update(SearchSpace<M>& s, const Eigen::Matrix<double, 3 * M, M>& coefficients,
              const Eigen::Matrix<double, M, 1>& values, const std::vector<double>& mass, VectorBlock<M>& r) {
  std::array<std::array<double, M>, std::size_t{3} * M> c;
  for (int i = 0; i < 3 * M; ++i) {
    for (int m = 0; m < M; ++m) c[i][m] = coefficients(i, m);
  }
  double residual_squared = 0;
  double norm_squared = 0;
  for (std::size_t v = 0; v < mass.size(); ++v) {
    for (const auto part : {&WithImage<M>::vectors, &WithImage<M>::images}) {
      const auto row = s.row(part, v);
      for (int m = 0; m < M; ++m) {
        double from_x = 0;
        double direction = 0;
        for (int i = 0; i < M; ++i) from_x += row[i] * c[i][m];
        for (int i = M; i < 3 * M; ++i) direction += row[i] * c[i][m];
        (s.x.*part)[v][m] = from_x + direction;
        (s.p.*part)[v][m] = direction;
      }
    }
    for (int m = 0; m < M; ++m) r[v][m] = s.x.images[v][m] - values[m] * mass[v] * s.x.vectors[v][m];
    residual_squared += r[v][0] * r[v][0];
    norm_squared += s.x.vectors[v][0] * s.x.vectors[v][0];
  }
  return std::sqrt(residual_squared / norm_squared);
}

/// Computes L x afresh, since images that follow x by recurrence drift by rounding, and r with it. Returns
/// what `update` does.
template <int M>
double refresh_images(WithImage<M>& x, const Laplacian& laplacian, const Eigen::Matrix<double, M, 1>& values,
                      const std::vector<double>& mass, VectorBlock<M>& r) {
  laplacian.apply<M>(x.vectors, x.images);
  double residual_squared = 0;
  double norm_squared = 0;
  for (std::size_t v = 0; v < mass.size(); ++v) {
    for (int m = 0; m < M; ++m) r[v][m] = x.images[v][m] - values[m] * mass[v] * x.vectors[v][m];
    residual_squared += r[v][0] * r[v][0];
    norm_squared += x.vectors[v][0] * x.vectors[v][0];
  }
  return std::sqrt(residual_squared / norm_squared);
}

/// Makes the columns B-orthogonal to constants.
template <int M>
void remove_constants(const std::vector<double>& mass, double total_mass, VectorBlock<M>& x) {
  std::array<double, M> mean{};
  for (std::size_t v = 0; v < mass.size(); ++v) {
    for (int m = 0; m < M; ++m) mean[m] += mass[v] * x[v][m];
  }
  for (int m = 0; m < M; ++m) mean[m] /= total_mass;
  for (auto& row : x) {
    for (int m = 0; m < M; ++m) row[m] -= mean[m];
  }
}

}  // namespace

template <int M>
LobpcgResult lobpcg(const Hierarchy& hierarchy, int level, const LobpcgOptions& options, VectorBlock<M>& x) {
  const Laplacian& laplacian = hierarchy.levels()[level].laplacian;
  const std::vector<double>& mass = hierarchy.levels()[level].mass;
  double total_mass = 0;
  for (const double m : mass) total_mass += m;

  SearchSpace<M> s(mass.size());
  VectorBlock<M> r(mass.size());
  Gram<M> gram, energy;
  Eigen::Matrix<double, 3 * M, M> coefficients;
  Eigen::Matrix<double, M, 1> values;
  const auto search = [&] {
    gram_matrices<M>(s, mass, gram, energy);
    rayleigh_ritz<M>(gram, energy, coefficients, values);
    return update<M>(s, coefficients, values, mass, r);
  };

  s.x.vectors = std::move(x);
  remove_constants<M>(mass, total_mass, s.x.vectors);
  laplacian.apply<M>(s.x.vectors, s.x.images);
  LobpcgResult result;
  result.residual = search();
  const auto converged = [&] { return result.residual <= options.tolerance * values[0]; };
  for (;; ++result.iterations) {
    const bool last = result.iterations >= options.max_iterations;
    if (last || converged()) {
      result.residual = refresh_images<M>(s.x, laplacian, values, mass, r);
      if (last || converged()) break;
    }
    hierarchy.v_cycle<M>(level, r, s.w.vectors);
    remove_constants<M>(mass, total_mass, s.w.vectors);
    laplacian.apply<M>(s.w.vectors, s.w.images);
    result.residual = search();
  }
  result.eigenvalue = values[0];
  result.converged = converged();
  x = std::move(s.x.vectors);
  return result;
}

template LobpcgResult lobpcg<1>(const Hierarchy&, int, const LobpcgOptions&, VectorBlock<1>&);
template LobpcgResult lobpcg<2>(const Hierarchy&, int, const LobpcgOptions&, VectorBlock<2>&);
template LobpcgResult lobpcg<3>(const Hierarchy&, int, const LobpcgOptions&, VectorBlock<3>&);

}  // namespace meshorder
