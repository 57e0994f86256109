// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/base/parallel.hpp>
#include <meshorder/sim/kernels/positions.hpp>
#include <meshorder/sim/linear/cholesky.hpp>
#include <meshorder/sim/linear/panel_factor.hpp>

#include <algorithm>
#include <mutex>

namespace meshorder {

template <class Real>
struct CholeskyFactor<Real>::Factor {
  PanelFactor<Real> panels;
  Offset entries = 0;

  /// What a solve needs besides. Solves at the same time take one each.
  struct Workspace {
    AlignedVector<Real> x;      ///< of a solve
    std::vector<Index> marked;  ///< by the last search that met each panel
    Index mark = 0;
  };
  mutable std::mutex mutex;
  mutable std::vector<std::unique_ptr<Workspace>> idle;
};

namespace {

/// Below so much cost a task's children are not worth other threads.
constexpr double kLeastShared = 20'000;

template <class Real>
Real* at(Real* x, Index place) {
  return x + Offset{kPaddedStride} * place;
}

/// One solve: the tree of tasks from the leaves to the root, and back.
template <class Real>
class Solve {
 public:
  /// All of it.
  Solve(const PanelFactor<Real>& factor, std::span<const Real> b, std::span<Real> x, Real* work)
      : factor_(factor), b_(b.data()), x_(x.data()), work_(work) {}

  void run() {
    const Index root = index_size(factor_.tasks) - 1;
    forwards(root);
    backwards(root);
  }

 private:
  const PanelFactor<Real>& factor_;
  const Real* b_;
  Real* x_;
  Real* work_;

  template <class Work>
  void for_children(const PanelTask& task, Work work) {
    if (task.children.size() > 1 && thread_count() > 1) {
      tbb::parallel_for(std::size_t{0}, task.children.size(), [&](std::size_t k) { work(task.children[k]); });
    } else {
      for (const Index child : task.children) work(child);
    }
  }

  void forwards(Index number) {
    const PanelTask& task = factor_.tasks[number];
    for_children(task, [this](Index child) { forwards(child); });
    for (Index j = task.first_column; j < task.end_column; ++j) {
      std::copy_n(at(b_, factor_.vertex_of_column[j]), kPaddedStride, at(work_, j));
    }
    std::fill(at(work_, task.first_slot), at(work_, task.end_slot), Real{0});
    for (const Index child : task.children) {
      for (Index slot = factor_.tasks[child].first_slot; slot < factor_.tasks[child].end_slot; ++slot) {
        const Real* const from = at(work_, slot);
        Real* const to = at(work_, factor_.above_slots[slot - factor_.size()]);
        for (Index c = 0; c < kPaddedStride; ++c) to[c] += from[c];
      }
    }
    sweep_forwards(factor_.view(), {nullptr, task.first_panel, task.end_panel - task.first_panel}, work_);
  }

  void backwards(Index number) {
    const PanelTask& task = factor_.tasks[number];
    for (Index slot = task.first_slot; slot < task.end_slot; ++slot) {
      std::copy_n(at(work_, factor_.above_slots[slot - factor_.size()]), kPaddedStride, at(work_, slot));
    }
    sweep_backwards(factor_.view(), {nullptr, task.first_panel, task.end_panel - task.first_panel}, work_);
    for (Index j = task.first_column; j < task.end_column; ++j) {
      std::copy_n(at(work_, j), kPaddedStride, at(x_, factor_.vertex_of_column[j]));
    }
    for_children(task, [this](Index child) { backwards(child); });
  }
};

}  // namespace

template <class Real>
CholeskyFactor<Real>::CholeskyFactor(const SparseMatrix& matrix) {
  const auto factor = std::make_shared<Factor>();
  const Ldl ldl = factor_ldl(matrix);
  factor->panels = make_panel_factor<Real>(ldl);
  factor->entries = ldl.offsets.back() + ldl.size();
  factor_ = factor;
}

template <class Real>
void CholeskyFactor<Real>::solve(std::span<const Real> b, std::span<Real> x) const {
  AlignedVector<Real> work(std::size_t{kPaddedStride} * factor_->panels.places());
  Solve<Real>(factor_->panels, b, x, work.data()).run();
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
