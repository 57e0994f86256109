// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/lobpcg.hpp"

#include "base/memory.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kRows = 2048;       // rows of a chunk for threads; the data of a pass stay in the L2 cache
constexpr double kCalm = 0.01;      // a Ritz value is calm if its relative change per iteration is less
constexpr int kLeastUntilCalm = 4;  // iterations until noise becomes smooth
constexpr double kSettled = 0.2;    // largest residual / Ritz value at which a calm value will not fall later

/// Numbers that are added entry by entry.
template <std::size_t N>
struct Sums {
  std::array<double, N> values{};
  double& operator[](std::size_t i) { return values[i]; }
  Sums& operator+=(const Sums& other) {
    for (std::size_t i = 0; i < N; ++i) values[i] += other.values[i];
    return *this;
  }
};

/// A block of vectors, and L times this block.
template <int M>
struct WithImage {
  VectorBlock<M> vectors;
  VectorBlock<M> images;

  explicit WithImage(std::size_t n) : WithImage(VectorBlock<M>(n, std::array<double, M>{})) {}
  explicit WithImage(VectorBlock<M> block) : vectors(std::move(block)) {
    resize_large(images, vectors.size());
  }
};

/// The blocks whose span an iteration searches: iterates, preconditioned residuals, previous directions, and
/// C companions that stay the same.
template <int M, int C>
struct SearchSpace {
  static constexpr int kSize = 3 * M + C;

  WithImage<M> x, w, p;
  WithImage<C> companions;

  SearchSpace(VectorBlock<M> start, VectorBlock<C> fixed)
      : x(std::move(start)), w(x.vectors.size()), p(x.vectors.size()), companions(std::move(fixed)) {}
};

/// Returns row v of all vectors of the space, or of all images, side by side; `part` selects which.
template <int M, int C, class Part>
std::array<double, SearchSpace<M, C>::kSize> row(const SearchSpace<M, C>& s, Index v, Part part) {
  std::array<double, SearchSpace<M, C>::kSize> result;
  for (int m = 0; m < M; ++m) {
    result[m] = part(s.x)[v][m];
    result[M + m] = part(s.w)[v][m];
    result[2 * M + m] = part(s.p)[v][m];
  }
  if constexpr (C > 0) {
    for (int c = 0; c < C; ++c) result[3 * M + c] = part(s.companions)[v][c];
  }
  return result;
}

constexpr auto kVectors = [](auto& block) -> auto& { return block.vectors; };
constexpr auto kImages = [](auto& block) -> auto& { return block.images; };

/// Computes Sᵀ B S and Sᵀ L S of the search space S.
template <int M, int C, int N = SearchSpace<M, C>::kSize>
void gram_matrices(const SearchSpace<M, C>& s, const EigenProblem& problem, Eigen::MatrixXd& gram,
                   Eigen::MatrixXd& energy) {
  using Squares = Sums<std::size_t{2} * N * N>;
  auto sums = sum_over_chunks<Squares>(problem.size(), kRows, [&](Index begin, Index end) {
    Squares part;
    // in two loops: the sums of both matrices do not fit in registers at once
    for (Index v = begin; v < end; ++v) {
      const auto vectors = row(s, v, kVectors);
      for (int i = 0; i < N; ++i) {
        const double weighted = problem.mass(v) * vectors[i];
        for (int j = i; j < N; ++j) part[N * i + j] += weighted * vectors[j];
      }
    }
    for (Index v = begin; v < end; ++v) {
      const auto vectors = row(s, v, kVectors);
      const auto images = row(s, v, kImages);
      for (int i = 0; i < N; ++i) {
        for (int j = i; j < N; ++j) part[N * (N + i) + j] += vectors[i] * images[j];
      }
    }
    return part;
  });
  problem.add_up(sums.values);
  gram.resize(N, N);
  energy.resize(N, N);
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) {
      gram(i, j) = gram(j, i) = sums[N * i + j];
      energy(i, j) = energy(j, i) = sums[N * (N + i) + j];
    }
  }
}

/// The result of a search in a subspace: column m of `coefficients` gives the m-th Ritz vector in the basis.
struct Ritz {
  Eigen::MatrixXd coefficients;
  Eigen::VectorXd values;
};

/// Returns the `wanted` Ritz vectors with the smallest Ritz values. Directions of the basis that nearly
/// depend on others are left out. If there are fewer Ritz vectors than `wanted`, the missing ones are 0.
Ritz rayleigh_ritz(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& energy, int wanted) {
  constexpr double kDependent = 1e-12;
  const Eigen::Index size = gram.rows();
  Eigen::VectorXd scale = gram.diagonal();
  for (Eigen::Index i = 0; i < size; ++i) scale[i] = scale[i] > 0 ? 1 / std::sqrt(scale[i]) : 0;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> independent(scaled);
  Eigen::Index kept = 0;
  Eigen::MatrixXd basis(size, size);
  for (Eigen::Index i = size - 1; i >= 0; --i) {
    const double eigenvalue = independent.eigenvalues()[i];
    if (eigenvalue < kDependent) break;
    basis.col(kept++) = scale.asDiagonal() * independent.eigenvectors().col(i) / std::sqrt(eigenvalue);
  }
  basis.conservativeResize(Eigen::NoChange, kept);
  const Eigen::MatrixXd energy_in_basis = basis.transpose() * energy * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> projected(energy_in_basis);
  Ritz ritz{Eigen::MatrixXd::Zero(size, wanted), Eigen::VectorXd::Zero(wanted)};
  for (Eigen::Index m = 0; m < std::min<Eigen::Index>(wanted, kept); ++m) {
    ritz.coefficients.col(m) = basis * projected.eigenvectors().col(m);
    ritz.values[m] = projected.eigenvalues()[m];
  }
  return ritz;
}

/// ‖r‖² of each column, then ‖x‖² of each column.
template <int M>
using Norms = Sums<std::size_t{2} * M>;

/// Returns ‖r‖ / ‖x‖ of each column.
template <int M>
std::array<double, M> residuals_of(Norms<M>& norms) {
  std::array<double, M> result;
  for (int m = 0; m < M; ++m) result[m] = std::sqrt(norms[m] / norms[M + m]);
  return result;
}

/// Computes r = L x − λ B x in row v, and adds the row's part to the norms.
template <int M>
void residual_of_row(const WithImage<M>& x, const std::array<double, M>& values, double mass, Index v,
                     VectorBlock<M>& r, Norms<M>& norms) {
  for (int m = 0; m < M; ++m) {
    r[v][m] = x.images[v][m] - values[m] * mass * x.vectors[v][m];
    norms[m] += r[v][m] * r[v][m];
    norms[M + m] += x.vectors[v][m] * x.vectors[v][m];
  }
}

/// Computes, for the search space S and the coefficients c:
/// - x ← S c;
/// - p ← S c without the contribution of x;
/// - the images of x and p, in the same way;
/// - r = L x − λ B x.
///
/// Returns ‖r‖ / ‖x‖ of each column.
template <int M, int C, int N = SearchSpace<M, C>::kSize>
std::array<double, M> update(SearchSpace<M, C>& s, const Eigen::MatrixXd& coefficients,
                             const std::array<double, M>& values, const EigenProblem& problem,
                             VectorBlock<M>& r) {
  std::array<std::array<double, M>, N> c;
  for (int i = 0; i < N; ++i) {
    for (int m = 0; m < M; ++m) c[i][m] = coefficients(i, m);
  }
  const auto combine = [&](Index v, auto part) {
    const auto old = row(s, v, part);
    for (int m = 0; m < M; ++m) {
      double from_x = 0;
      double direction = 0;
      for (int i = 0; i < M; ++i) from_x += old[i] * c[i][m];
      for (int i = M; i < N; ++i) direction += old[i] * c[i][m];
      part(s.x)[v][m] = from_x + direction;
      part(s.p)[v][m] = direction;
    }
  };
  auto norms = sum_over_chunks<Norms<M>>(problem.size(), kRows, [&](Index begin, Index end) {
    Norms<M> part;
    for (Index v = begin; v < end; ++v) {
      combine(v, kVectors);
      combine(v, kImages);
      residual_of_row<M>(s.x, values, problem.mass(v), v, r, part);
    }
    return part;
  });
  problem.add_up(norms.values);
  return residuals_of<M>(norms);
}

/// Computes L x anew, because rounding errors accumulate in images that are updated together with x. Then
/// computes the Rayleigh quotients and r from L x. Returns ‖r‖ / ‖x‖ of each column.
template <int M>
std::array<double, M> refresh(WithImage<M>& x, const EigenProblem& problem, std::array<double, M>& values,
                              VectorBlock<M>& r) {
  problem.apply(x.vectors, x.images);
  using Quotients = Sums<std::size_t{2} * M>;
  auto quotients = sum_over_chunks<Quotients>(problem.size(), kRows, [&](Index begin, Index end) {
    Quotients part;
    for (Index v = begin; v < end; ++v) {
      for (int m = 0; m < M; ++m) {
        part[m] += x.vectors[v][m] * x.images[v][m];
        part[M + m] += problem.mass(v) * x.vectors[v][m] * x.vectors[v][m];
      }
    }
    return part;
  });
  problem.add_up(quotients.values);
  for (int m = 0; m < M; ++m) values[m] = quotients[M + m] > 0 ? quotients[m] / quotients[M + m] : 0;
  auto norms = sum_over_chunks<Norms<M>>(problem.size(), kRows, [&](Index begin, Index end) {
    Norms<M> part;
    for (Index v = begin; v < end; ++v) residual_of_row<M>(x, values, problem.mass(v), v, r, part);
    return part;
  });
  problem.add_up(norms.values);
  return residuals_of<M>(norms);
}

/// Makes the vectors B-orthogonal to constants, and computes their images.
template <int M>
void prepare(const EigenProblem& problem, double total_mass, WithImage<M>& block) {
  VectorBlock<M>& x = block.vectors;
  auto mean = sum_over_chunks<Sums<M>>(problem.size(), kRows, [&](Index begin, Index end) {
    Sums<M> part;
    for (Index v = begin; v < end; ++v) {
      for (int m = 0; m < M; ++m) part[m] += problem.mass(v) * x[v][m];
    }
    return part;
  });
  problem.add_up(mean.values);
  for (int m = 0; m < M; ++m) mean[m] /= total_mass;
  for_each_chunk(problem.size(), kRows, [&](Index, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) {
      for (int m = 0; m < M; ++m) x[v][m] -= mean[m];
    }
  });
  problem.apply(x, block.images);
}

}  // namespace

template <int M, int Companions>
LobpcgResult lobpcg(EigenProblem& problem, const LobpcgOptions& options, VectorBlock<M>& x,
                    VectorBlock<Companions> companions) {
  const Index n = problem.size();
  Sums<1> total_mass;
  for (Index v = 0; v < n; ++v) {
    poll_in_loop(v);
    total_mass[0] += problem.mass(v);
  }
  problem.add_up(total_mass.values);

  SearchSpace<M, Companions> s(std::move(x), std::move(companions));
  VectorBlock<M> r(n);
  Eigen::MatrixXd gram, energy;
  std::array<double, M> values{};
  const auto search = [&] {
    gram_matrices<M, Companions>(s, problem, gram, energy);
    const Ritz ritz = rayleigh_ritz(gram, energy, M);
    for (int m = 0; m < M; ++m) values[m] = ritz.values[m];
    return update<M, Companions>(s, ritz.coefficients, values, problem, r);
  };

  prepare(problem, total_mass[0], s.x);
  if constexpr (Companions > 0) prepare(problem, total_mass[0], s.companions);
  LobpcgResult result;
  std::array<double, M> residuals = search();
  int calm = 0;  // number of successive iterations that hardly changed any Ritz value
  const auto converged = [&] { return residuals[0] <= options.tolerance * values[0]; };
  const auto settled = [&] {
    for (int m = 0; m < M; ++m) {
      if (residuals[m] > kSettled * values[m]) return false;
    }
    return true;
  };
  const auto done = [&] {
    return options.until_calm ? result.iterations >= kLeastUntilCalm && calm >= 2 && settled() : converged();
  };
  for (;; ++result.iterations) {
    report("eigenvector");
    const bool last = result.iterations >= options.max_iterations || options.limit.is_over();
    if (last || done()) {
      if (result.iterations == 0) break;  // no rounding errors have accumulated
      residuals = refresh<M>(s.x, problem, values, r);
      if (last || done()) break;
    }
    const std::array<double, M> before = values;
    problem.precondition(r, s.w.vectors);
    prepare(problem, total_mass[0], s.w);
    residuals = search();
    ++calm;
    for (int m = 0; m < M; ++m) {
      if (std::abs(before[m] - values[m]) > kCalm * before[m]) calm = 0;
    }
  }
  result.eigenvalue = values[0];
  result.residual = residuals[0];
  result.converged = converged();
  x = std::move(s.x.vectors);
  return result;
}

template <int M, int Companions>
LobpcgResult lobpcg(const Hierarchy& hierarchy, int level, const LobpcgOptions& options, VectorBlock<M>& x,
                    VectorBlock<Companions> companions) {
  LevelProblem problem(hierarchy, level);
  return lobpcg<M, Companions>(problem, options, x, std::move(companions));
}

template LobpcgResult lobpcg<1, 0>(const Hierarchy&, int, const LobpcgOptions&, VectorBlock<1>&,
                                   VectorBlock<0>);
template LobpcgResult lobpcg<1, 1>(const Hierarchy&, int, const LobpcgOptions&, VectorBlock<1>&,
                                   VectorBlock<1>);
template LobpcgResult lobpcg<2, 0>(const Hierarchy&, int, const LobpcgOptions&, VectorBlock<2>&,
                                   VectorBlock<0>);
template LobpcgResult lobpcg<1, 1>(EigenProblem&, const LobpcgOptions&, VectorBlock<1>&, VectorBlock<1>);
template LobpcgResult lobpcg<2, 0>(EigenProblem&, const LobpcgOptions&, VectorBlock<2>&, VectorBlock<0>);

}  // namespace meshorder
