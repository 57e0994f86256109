// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "kernels/aligned.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace meshorder {

/// Anderson acceleration of a fixed-point iteration x ← g(x) (Anderson 1965; Walker, Ni 2011; for ADMM:
/// Zhang, Peng, Ouyang, Deng 2019): the next iterate is that combination of the last few g(x) whose residuals
/// g(x) − x, combined likewise, are least. On a linear g as good as GMRES; it may also do harm, so callers
/// watch the residual, and where it grows go back to the last g(x) and `reset`.
///
/// The vector is made of parts, such as positions and duals. The same bits for any number of threads.
template <class Real>
class AndersonMixer {
 public:
  static constexpr int kWidestWindow = 10;

  /// Keeps `window` earlier iterates, 1 … 10. Throws InvalidArgument for others.
  explicit AndersonMixer(int window = 5);

  /// `mapped`, which holds g(x) on entry, becomes the next iterate; after a reset that is g(x) itself. Where
  /// earlier residuals hardly differ in some direction nothing is moved along it; what is not finite is left
  /// as it is, and resets. Throws InvalidArgument unless x and g(x) have the same parts, and the same as
  /// since the last reset. O(window · n), in two passes.
  void mix(std::span<const std::span<const Real>> x, std::span<const std::span<Real>> mapped);

  /// Forgets earlier iterates.
  void reset();

  /// ‖g(x) − x‖ of the last call, before mixing.
  [[nodiscard]] double residual() const noexcept { return residual_; }
  /// Earlier iterates that the next call combines.
  [[nodiscard]] int depth() const noexcept { return depth_; }
  /// Memory held: 2 window + 2 vectors.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Products;

  int window_;
  int depth_ = 0;         ///< steps from iterate to iterate that are held
  int newest_ = 0;        ///< of them
  bool started_ = false;  ///< whether there is an iterate before this
  double residual_ = 0.0;
  std::vector<std::size_t> sizes_;                   ///< of the parts
  AlignedVector<Real> last_residual_, last_mapped_;  ///< the parts one after the other
  std::vector<AlignedVector<Real>> residual_steps_, mapped_steps_;
  std::array<double, kWidestWindow * kWidestWindow> gram_{};  ///< scalar products of residual_steps_

  void check_parts(std::span<const std::span<const Real>> x, std::span<const std::span<Real>> mapped);
  Products add_iterate(const Real* x, const Real* mapped, Offset first, Index count);
};

}  // namespace meshorder
