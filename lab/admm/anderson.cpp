// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Anderson: Iterative Procedures for Nonlinear Integral Equations (1965). Walker, Ni: Anderson Acceleration
// for Fixed-Point Iterations (2011). Zhang, Peng, Ouyang, Deng: Accelerating ADMM for Efficient Simulation
// and Optimization (2019).
#include "lab/admm/anderson.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"

#include <Eigen/Dense>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace meshorder {
namespace {

/// Few enough for all vectors' chunks to stay in a cache between two uses.
constexpr Index kChunk = 2048;

/// Eigenvalues of the scaled scalar products that are less than this part of the largest are taken for zero.
constexpr double kLeastEigenvalue = 1e-12;

template <class Real>
double dot(const Real* a, const Real* b, Index count) {
  constexpr Index kSums = 8;  // additions of one sum would wait for each other
  double sums[kSums] = {};
  Index i = 0;
  for (; i + kSums <= count; i += kSums) {
    for (Index k = 0; k < kSums; ++k)
      sums[k] += static_cast<double>(a[i + k]) * static_cast<double>(b[i + k]);
  }
  for (; i < count; ++i) sums[0] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return std::accumulate(sums, sums + kSums, 0.0);
}

/// Least ‖residual − Σ γᵢ stepᵢ‖ by the scalar products of the steps with each other and with the residual.
/// Steps are compared at length 1; γ = 0 for those that are not longer than `rounding`, and along what is
/// left undetermined. Empty where something is not finite.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& gram, const Eigen::VectorXd& with_residual,
                              double rounding) {
  if (!gram.allFinite() || !with_residual.allFinite()) return {};
  const Eigen::VectorXd scale = gram.diagonal().unaryExpr(
      [rounding](double square) { return square > rounding * rounding ? 1 / std::sqrt(square) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * gram * scale.asDiagonal());
  const double least = kLeastEigenvalue * eigen.eigenvalues().maxCoeff();
  const Eigen::VectorXd inverse = eigen.eigenvalues().unaryExpr(
      [least](double value) { return value > least && value > 0 ? 1 / value : 0.0; });
  const Eigen::MatrixXd& vectors = eigen.eigenvectors();
  return scale.asDiagonal() *
         (vectors * (inverse.asDiagonal() * (vectors.transpose() * (scale.asDiagonal() * with_residual))));
}

}  // namespace

/// Sums over all entries.
template <class Real>
struct AndersonMixer<Real>::Products {
  double residual = 0.0;                              ///< ‖residual‖²
  double mapped = 0.0;                                ///< ‖g(x)‖²
  std::array<double, kWidestWindow> with_newest{};    ///< of each step of the residual with the newest one
  std::array<double, kWidestWindow> with_residual{};  ///< and with the residual

  Products& operator+=(const Products& other) {
    residual += other.residual;
    mapped += other.mapped;
    for (std::size_t i = 0; i < with_newest.size(); ++i) {
      with_newest[i] += other.with_newest[i];
      with_residual[i] += other.with_residual[i];
    }
    return *this;
  }
};

template <class Real>
AndersonMixer<Real>::AndersonMixer(int window) : window_(window) {
  if (window < 1 || window > kWidestWindow) {
    throw InvalidArgument(
        fmt::format("the window of Anderson acceleration must be 1 … {}, not {}", kWidestWindow, window));
  }
}

template <class Real>
void AndersonMixer<Real>::reset() {
  depth_ = 0;
  newest_ = 0;
  started_ = false;
}

template <class Real>
void AndersonMixer<Real>::check_parts(std::span<const std::span<const Real>> x,
                                      std::span<const std::span<Real>> mapped) {
  std::vector<std::size_t> sizes;
  for (const std::span<const Real>& part : x) sizes.push_back(part.size());
  const bool same =
      std::equal(sizes.begin(), sizes.end(), mapped.begin(), mapped.end(),
                 [](std::size_t size, const std::span<Real>& part) { return part.size() == size; });
  if (!same || (started_ && sizes != sizes_)) {
    throw InvalidArgument(
        "AndersonMixer::mix: x and g(x) must have the same parts, and those of the last call");
  }
  if (sizes == sizes_) return;
  sizes_ = std::move(sizes);
  const std::size_t entries = std::accumulate(sizes_.begin(), sizes_.end(), std::size_t{0});
  last_residual_.resize(entries);
  last_mapped_.resize(entries);
  residual_steps_.assign(window_, AlignedVector<Real>(entries));
  mapped_steps_.assign(window_, AlignedVector<Real>(entries));
}

template <class Real>
typename AndersonMixer<Real>::Products AndersonMixer<Real>::add_iterate(const Real* x, const Real* mapped,
                                                                        Offset first, Index count) {
  Real* const residual = last_residual_.data() + first;
  Real* const last = last_mapped_.data() + first;
  Real* const residual_step = residual_steps_[newest_].data() + first;
  Real* const mapped_step = mapped_steps_[newest_].data() + first;
  for (Index i = 0; i < count; ++i) {
    const Real now = mapped[i] - x[i];
    residual_step[i] = now - residual[i];
    mapped_step[i] = mapped[i] - last[i];
    residual[i] = now;
    last[i] = mapped[i];
  }
  Products products;
  products.residual = dot(residual, residual, count);
  products.mapped = dot(mapped, mapped, count);
  for (int k = 0; k < depth_; ++k) {
    const Real* const step = residual_steps_[k].data() + first;
    products.with_newest[k] = dot(step, residual_step, count);
    products.with_residual[k] = dot(step, residual, count);
  }
  return products;
}

template <class Real>
void AndersonMixer<Real>::mix(std::span<const std::span<const Real>> x,
                              std::span<const std::span<Real>> mapped) {
  check_parts(x, mapped);
  if (started_) {
    newest_ = depth_ < window_ ? depth_ : (newest_ + 1) % window_;
    depth_ = std::min(depth_ + 1, window_);
  }
  Products products;
  Offset first = 0;
  for (std::size_t part = 0; part < x.size(); ++part) {
    products +=
        sum_over_chunks<Products>(static_cast<Index>(x[part].size()), kChunk, [&](Index begin, Index end) {
          return add_iterate(x[part].data() + begin, mapped[part].data() + begin, first + begin, end - begin);
        });
    first += static_cast<Offset>(x[part].size());
  }
  residual_ = std::sqrt(products.residual);
  if (!started_) {
    started_ = std::isfinite(residual_);
    return;
  }
  for (int k = 0; k < depth_; ++k) {
    gram_[newest_ * kWidestWindow + k] = gram_[k * kWidestWindow + newest_] = products.with_newest[k];
  }
  using Gram = Eigen::Matrix<double, kWidestWindow, kWidestWindow>;
  constexpr double kRounding = 16 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  const Eigen::VectorXd weights =
      least_squares(Eigen::Map<const Gram>(gram_.data()).topLeftCorner(depth_, depth_),
                    Eigen::Map<const Eigen::VectorXd>(products.with_residual.data(), depth_),
                    kRounding * std::sqrt(products.mapped));
  if (weights.size() == 0 || !weights.allFinite() || !std::isfinite(residual_)) {
    reset();
    return;
  }
  first = 0;
  for (const std::span<Real>& part : mapped) {
    for_each_chunk(static_cast<Index>(part.size()), kChunk, [&](Index, Index begin, Index end) {
      for (int k = 0; k < depth_; ++k) {
        const auto weight = static_cast<Real>(weights[k]);
        const Real* const step = mapped_steps_[k].data() + first;
        for (Index i = begin; i < end; ++i) part[i] -= weight * step[i];
      }
    });
    first += static_cast<Offset>(part.size());
  }
}

template <class Real>
std::size_t AndersonMixer<Real>::bytes() const {
  std::size_t entries = last_residual_.capacity() + last_mapped_.capacity();
  for (const AlignedVector<Real>& steps : residual_steps_) entries += steps.capacity();
  for (const AlignedVector<Real>& steps : mapped_steps_) entries += steps.capacity();
  return sizeof(Real) * entries;
}

template class AndersonMixer<double>;
template class AndersonMixer<float>;

}  // namespace meshorder
