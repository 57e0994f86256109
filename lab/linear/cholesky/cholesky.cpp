// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Gilbert: Predicting Structure in Sparse Matrix Computations (1994).
#include "lab/linear/cholesky/cholesky.hpp"

#include "base/parallel.hpp"
#include "kernels/positions.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

namespace meshorder {
namespace {

/// Least number of entries of a reach that is worth tasks on other threads.
constexpr Offset kMinShared = 100'000;

template <class Real>
Real* at(Real* x, Index place) {
  return x + Offset{kPaddedStride} * place;
}

/// One solve: from the leaves of the tree of tasks to its root, and back.
template <class Real>
class Solve {
 public:
  /// Solves with all panels if `reach` is null.
  Solve(const PanelFactor<Real>& factor, const FactorReach* reach, const Real* b, Real* x, Real* work)
      : factor_(factor),
        reach_(reach),
        b_(b),
        x_(x),
        work_(work),
        shared_(thread_count() > 1 && (reach == nullptr || reach->entries >= kMinShared)) {}

  void run() const {
    if (factor_.tasks.empty()) return;
    const Index root = index_size(factor_.tasks) - 1;
    forwards(root);
    backwards(root);
  }

 private:
  const PanelFactor<Real>& factor_;
  const FactorReach* reach_;
  const Real* b_;
  Real* x_;
  Real* work_;
  bool shared_;

  [[nodiscard]] PanelRange panels_of(const PanelTask& task) const {
    if (reach_ == nullptr) return {nullptr, task.first_panel, task.end_panel - task.first_panel};
    const std::vector<Index>& panels = reach_->panels;
    const auto begin = std::lower_bound(panels.begin(), panels.end(), task.first_panel);
    const auto end = std::lower_bound(begin, panels.end(), task.end_panel);
    return {panels.data() + (begin - panels.begin()), 0, static_cast<Index>(end - begin)};
  }

  /// Returns whether any panel of the task is in the reach. If not, no panel of the tasks below is: their
  /// paths to the root pass through this task.
  [[nodiscard]] bool takes_part(Index task) const { return panels_of(factor_.tasks[task]).count > 0; }

  template <class Work>
  void for_children(const PanelTask& task, Work work) const {
    const auto work_on = [&](Index child) {
      if (takes_part(child)) work(child);
    };
    if (shared_ && task.children.size() > 1) {
      parallel_loop(index_size(task.children), [&](Index k) { work_on(task.children[k]); });
    } else {
      for (const Index child : task.children) work_on(child);
    }
  }

  void forwards(Index number) const {
    const PanelTask& task = factor_.tasks[number];
    for_children(task, [this](Index child) { forwards(child); });
    if (reach_ == nullptr) {
      for_columns(task, b_, [this](Index column, Index vertex) {
        std::copy_n(at(b_, vertex), kPaddedStride, at(work_, column));
      });
    }
    std::fill(at(work_, task.first_slot), at(work_, task.end_slot), Real{0});
    for (const Index child : task.children) {
      if (takes_part(child)) take_from(factor_.tasks[child]);
    }
    sweep_forwards(factor_.view(), panels_of(task), work_);
  }

  /// Calls `copy(column, vertex)` for each column of a task; prefetches the vertices' numbers in `vector`.
  template <class Vector, class Copy>
  void for_columns(const PanelTask& task, Vector vector, Copy copy) const {
    constexpr Index kAhead = 24;
    const Index* const vertices = factor_.vertex_of_column.data();
    const Index asked = std::max(task.first_column, task.end_column - kAhead);
    for (Index j = task.first_column; j < asked; ++j) {
      __builtin_prefetch(at(vector, vertices[j + kAhead]),
                         std::is_const_v<std::remove_pointer_t<Vector>> ? 0 : 1);
      copy(j, vertices[j]);
    }
    for (Index j = asked; j < task.end_column; ++j) copy(j, vertices[j]);
  }

  void take_from(const PanelTask& child) const {
    for (Index slot = child.first_slot; slot < child.end_slot; ++slot) {
      const Real* const from = at(work_, slot);
      Real* const to = at(work_, factor_.above_slots[slot - factor_.size()]);
      for (Index c = 0; c < kPaddedStride; ++c) to[c] += from[c];
    }
  }

  void backwards(Index number) const {
    const PanelTask& task = factor_.tasks[number];
    for (Index slot = task.first_slot; slot < task.end_slot; ++slot) {
      std::copy_n(at(work_, factor_.above_slots[slot - factor_.size()]), kPaddedStride, at(work_, slot));
    }
    sweep_backwards(factor_.view(), panels_of(task), work_);
    if (reach_ == nullptr) {
      for_columns(task, x_, [this](Index column, Index vertex) {
        std::copy_n(at(work_, column), kPaddedStride, at(x_, vertex));
      });
    }
    for_children(task, [this](Index child) { backwards(child); });
  }
};

}  // namespace

template <class Real>
CholeskyFactor<Real>::CholeskyFactor(const Ldl& ldl)
    : panels_(make_panel_factor<Real>(ldl)),
      entries_(ldl.offsets.back() + ldl.size()),
      work_(std::size_t{kPaddedStride} * panels_.places()),
      marked_(panels_.panels.size(), 0) {}

template <class Real>
void CholeskyFactor<Real>::check_sizes(std::span<const Real> b, std::span<Real> x) const {
  const std::size_t expected = std::size_t{kPaddedStride} * size();
  if (b.size() != expected || x.size() != expected) {
    throw InvalidArgument(
        fmt::format("CholeskyFactor::solve: b and x must hold {} numbers for each of {} "
                    "vertices, not {} and {} in all",
                    kPaddedStride, size(), b.size(), x.size()));
  }
}

template <class Real>
void CholeskyFactor<Real>::solve(std::span<const Real> b, std::span<Real> x) const {
  check_sizes(b, x);
  Solve<Real>(panels_, nullptr, b.data(), x.data(), work_.data()).run();
}

template <class Real>
FactorReach CholeskyFactor<Real>::reach_of(std::span<const Index> vertices) const {
  for (const Index v : vertices) {
    if (v < 0 || v >= size()) {
      throw InvalidArgument(fmt::format("CholeskyFactor::reach_of: there is no vertex {} of {}", v, size()));
    }
  }
  if (searches_ == kMaxIndex) {
    std::fill(marked_.begin(), marked_.end(), 0);
    searches_ = 0;
  }
  const Index mark = ++searches_;
  FactorReach reach;
  reach.vertices.assign(vertices.begin(), vertices.end());
  for (const Index v : vertices) {
    Index p = panels_.panel_of_column[panels_.column_of_vertex[v]];
    for (; p >= 0 && marked_[p] != mark; p = panels_.panels[p].parent) {
      marked_[p] = mark;
      reach.panels.push_back(p);
      const Panel& panel = panels_.panels[p];
      reach.entries += Offset{panel.width} * panel.row_count + panel.width * (panel.width + 1) / 2;
    }
  }
  std::sort(reach.panels.begin(), reach.panels.end());
  return reach;
}

template <class Real>
void CholeskyFactor<Real>::solve(const FactorReach& reach, std::span<const Real> b, std::span<Real> x) const {
  check_sizes(b, x);
  Real* const work = work_.data();
  for (const Index p : reach.panels) {
    const Panel& panel = panels_.panels[p];
    std::fill_n(at(work, panel.column), kPaddedStride * panel.width, Real{0});
  }
  for (const Index v : reach.vertices) {
    std::copy_n(at(b.data(), v), kPaddedStride, at(work, panels_.column_of_vertex[v]));
  }
  Solve<Real>(panels_, &reach, b.data(), x.data(), work).run();
  for (const Index v : reach.vertices) {
    std::copy_n(at(work, panels_.column_of_vertex[v]), kPaddedStride, at(x.data(), v));
  }
}

template class CholeskyFactor<double>;
template class CholeskyFactor<float>;

}  // namespace meshorder
