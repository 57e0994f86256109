// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cholesky/cholesky.hpp"

#include "kernels/positions.hpp"
#include "lab/linear/cholesky/panel_solve.hpp"
#include <meshorder/error.hpp>

#include <fmt/core.h>

#include <algorithm>
#include <mutex>
#include <utility>

namespace meshorder {

template <class Real>
class CholeskyFactor<Real>::Factor {
 public:
  const PanelFactor<Real> panels;
  const Offset entries;

  explicit Factor(const Ldl& ldl)
      : panels(make_panel_factor<Real>(ldl)), entries(ldl.offsets.back() + ldl.size()) {
    idle_.push_back(std::make_unique<PanelWorkspace<Real>>(panels));
  }

  /// Returns a workspace that no other solve uses until it is given back.
  [[nodiscard]] std::unique_ptr<PanelWorkspace<Real>> take_workspace() const {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<PanelWorkspace<Real>> workspace = std::move(idle_.back());
        idle_.pop_back();
        return workspace;
      }
    }
    return std::make_unique<PanelWorkspace<Real>>(panels);
  }

  void give_back(std::unique_ptr<PanelWorkspace<Real>> workspace) const {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

  void check_sizes(std::span<const Real> b, std::span<Real> x) const {
    const std::size_t size = std::size_t{kPaddedStride} * panels.size();
    if (b.size() != size || x.size() != size) {
      throw InvalidArgument(
          fmt::format("CholeskyFactor::solve: b and x must hold {} numbers for each of {} "
                      "vertices, not {} and {} in all",
                      kPaddedStride, panels.size(), b.size(), x.size()));
    }
  }

 private:
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<PanelWorkspace<Real>>> idle_;
};

template <class Real>
CholeskyFactor<Real>::CholeskyFactor(const SparseMatrix& matrix)
    : factor_(std::make_shared<const Factor>(factor_ldl(matrix))) {}

template <class Real>
void CholeskyFactor<Real>::solve(std::span<const Real> b, std::span<Real> x) const {
  factor_->check_sizes(b, x);
  auto workspace = factor_->take_workspace();
  solve_panels(factor_->panels, b.data(), x.data(), *workspace);
  factor_->give_back(std::move(workspace));
}

template <class Real>
typename CholeskyFactor<Real>::Reach CholeskyFactor<Real>::reach_of(std::span<const Index> vertices) const {
  for (const Index v : vertices) {
    if (v < 0 || v >= size()) {
      throw InvalidArgument(fmt::format("CholeskyFactor::reach_of: there is no vertex {} of {}", v, size()));
    }
  }
  auto workspace = factor_->take_workspace();
  Reach reach = panels_reached(factor_->panels, vertices, *workspace);
  factor_->give_back(std::move(workspace));
  return reach;
}

template <class Real>
void CholeskyFactor<Real>::solve(const Reach& reach, std::span<const Real> b, std::span<Real> x) const {
  factor_->check_sizes(b, x);
  auto workspace = factor_->take_workspace();
  solve_panels(factor_->panels, reach, b.data(), x.data(), *workspace);
  factor_->give_back(std::move(workspace));
}

template <class Real>
Index CholeskyFactor<Real>::size() const noexcept {
  return factor_->panels.size();
}

template <class Real>
Offset CholeskyFactor<Real>::entries() const noexcept {
  return factor_->entries;
}

template <class Real>
std::size_t CholeskyFactor<Real>::bytes() const {
  return factor_->panels.bytes();
}

template class CholeskyFactor<double>;
template class CholeskyFactor<float>;

}  // namespace meshorder
