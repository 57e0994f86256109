// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/global_system.hpp"

#include "kernels/positions.hpp"

#include <algorithm>
#include <utility>

namespace meshorder {

template <class Real>
GlobalSystem<Real>::GlobalSystem(SparseMatrix stiffness, std::span<const double> masses, double squared_step)
    : whole_(std::move(stiffness)), held_(masses.size(), 0) {
  for (double& value : whole_.values) value *= squared_step;
  for (Index v = 0; v < whole_.size(); ++v) {
    const auto row = whole_.columns.begin() + whole_.offsets[v];
    const auto diagonal = std::lower_bound(row, whole_.columns.begin() + whole_.offsets[v + 1], v);
    whole_.values[diagonal - whole_.columns.begin()] += masses[v];
  }
}

template <class Real>
bool GlobalSystem<Real>::hold(const HeldVertices& held) {
  std::vector<Index> vertices(held.vertices().begin(), held.vertices().end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  if (factor_ && vertices == held_vertices_) return false;
  held_vertices_ = std::move(vertices);
  std::fill(held_.begin(), held_.end(), char{0});
  for (const Index v : held_vertices_) held_[v] = 1;
  matrix_ = whole_;
  couplings_.clear();
  for (Index v = 0; v < matrix_.size(); ++v) {
    for (Offset k = matrix_.offsets[v]; k < matrix_.offsets[v + 1]; ++k) {
      const Index column = matrix_.columns[k];
      if (held_[v] == 0 && held_[column] == 0) continue;
      if (held_[v] == 0) couplings_.push_back({v, column, static_cast<Real>(matrix_.values[k])});
      matrix_.values[k] = v == column ? 1.0 : 0.0;
    }
  }
  factor_.emplace(matrix_);
  return true;
}

template <class Real>
void GlobalSystem<Real>::apply_held(std::span<const Real> x, std::span<Real> b) const {
  for (const Coupling& coupling : couplings_) {
    for (Index c = 0; c < 3; ++c) {
      b[Offset{kPaddedStride} * coupling.vertex + c] -=
          coupling.value * x[Offset{kPaddedStride} * coupling.held + c];
    }
  }
  for (const Index v : held_vertices_)
    std::copy_n(x.begin() + Offset{kPaddedStride} * v, kPaddedStride, b.begin() + Offset{kPaddedStride} * v);
}

template <class Real>
std::size_t GlobalSystem<Real>::bytes() const {
  std::size_t bytes = factor_ ? factor_->bytes() : 0;
  for (const SparseMatrix* matrix : {&whole_, &matrix_}) {
    bytes += matrix->offsets.capacity() * sizeof(Offset) + matrix->columns.capacity() * sizeof(Index) +
             matrix->values.capacity() * sizeof(double);
  }
  return bytes + held_.capacity() + held_vertices_.capacity() * sizeof(Index) +
         couplings_.capacity() * sizeof(Coupling);
}

template class GlobalSystem<double>;
template class GlobalSystem<float>;

}  // namespace meshorder
