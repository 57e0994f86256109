// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/accelerated_iteration.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace meshorder {

template <class Real>
void AcceleratedIteration<Real>::reset() {
  mixer_.reset();
  last_residual_ = std::numeric_limits<double>::infinity();
}

template <class Real>
void AcceleratedIteration<Real>::begin(std::span<const Real> positions, std::vector<Real> duals) {
  positions_.assign(positions.begin(), positions.end());
  duals_ = std::move(duals);
}

template <class Real>
void AcceleratedIteration<Real>::finish(std::span<Real> positions, std::span<Real> duals) {
  std::vector<Real> new_positions(positions.begin(), positions.end());
  std::vector<Real> new_duals(duals.begin(), duals.end());
  mixer_.mix(std::array{std::span<const Real>(positions_), std::span<const Real>(duals_)},
             std::array{positions, duals});
  if (mixer_.residual() > last_residual_) {
    std::copy(mapped_positions_.begin(), mapped_positions_.end(), positions.begin());
    std::copy(mapped_duals_.begin(), mapped_duals_.end(), duals.begin());
    reset();
    return;
  }
  last_residual_ = mixer_.residual();
  mapped_positions_ = std::move(new_positions);
  mapped_duals_ = std::move(new_duals);
}

template <class Real>
std::size_t AcceleratedIteration<Real>::bytes() const {
  return mixer_.bytes() + sizeof(Real) * (positions_.capacity() + duals_.capacity() +
                                          mapped_positions_.capacity() + mapped_duals_.capacity());
}

template class AcceleratedIteration<double>;
template class AcceleratedIteration<float>;

}  // namespace meshorder
