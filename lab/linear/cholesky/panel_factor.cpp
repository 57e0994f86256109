// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cholesky/panel_factor.hpp"

#include "lab/linear/cholesky/supernodes.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Least cost of a branch that becomes a task: the larger of kMinCost and kMinPart times the whole cost (see
/// PanelCosts).
constexpr double kMinCost = 40'000;
constexpr double kMinPart = 1.0 / 32;

/// Builds the factor: first numbers all columns, then fills in rows and values.
template <class Real>
class Builder {
 public:
  explicit Builder(const Ldl& ldl) : ldl_(ldl), number_(ldl.size()), place_of_(ldl.size(), -1) {
    const Supernodes supernodes = find_supernodes(ldl, {.widest = Panel::kWidest});
    std::vector<std::vector<Index>> columns(supernodes.count());
    for (Index j = 0; j < ldl.size(); ++j) columns[supernodes.of_column[j]].push_back(j);
    const double cost = std::accumulate(supernodes.cost.begin(), supernodes.cost.end(), 0.0);
    const SolveTasks tasks = make_solve_tasks(supernodes, std::max(kMinCost, kMinPart * cost));

    factor_.column_of_vertex.resize(ldl.size());
    // children before their parents
    for (Index task = tasks.count() - 1; task >= 0; --task) {
      begin_task(tasks, task);
      for (const Index s : tasks.supernodes[task]) add_columns(columns[s]);
      factor_.tasks.back().end_column = factor_.size();
      factor_.tasks.back().end_panel = index_size(factor_.panels);
    }
    factor_.rows.resize(rows_);
    factor_.values.resize(values_ + 16 / sizeof(Real));
    for (Index task = 0; task < tasks.count(); ++task) {
      for (const Index s : tasks.supernodes[tasks.count() - 1 - task]) fill_panels(supernodes.top[s]);
      give_slots(factor_.tasks[task]);
    }
  }

  PanelFactor<Real> result() && { return std::move(factor_); }

 private:
  const Ldl& ldl_;
  std::vector<Index> number_;    ///< for each column of L, its number in the factor
  std::vector<Index> columns_;   ///< for each of these numbers, the column of L
  std::vector<Index> place_of_;  ///< scratch, for some columns: row in the panel, or slot in the task
  PanelFactor<Real> factor_;
  Offset rows_ = 0, values_ = 0;  ///< numbers of rows and values in the panels so far
  Index filled_ = 0;              ///< number of panels filled so far
  std::vector<Index> above_;      ///< the column that each slot is for

  void begin_task(const SolveTasks& tasks, Index task) {
    PanelTask& added = factor_.tasks.emplace_back();
    added.cost = tasks.cost[task];
    for (const Index child : tasks.children[task]) added.children.push_back(tasks.count() - 1 - child);
    added.first_column = factor_.size();
    added.first_panel = index_size(factor_.panels);
  }

  void add_columns(const std::vector<Index>& columns) {
    const Index width = index_size(columns);
    const Offset below = ldl_.offsets[columns.back() + 1] - ldl_.offsets[columns.back()];
    const Index panels = panel_count(width, Panel::kWidest);
    for (Index k = 0; k < panels; ++k) {
      Panel& panel = factor_.panels.emplace_back();
      panel.column = factor_.size();
      const auto begin = static_cast<Index>(Offset{width} * k / panels);
      const auto end = static_cast<Index>(Offset{width} * (k + 1) / panels);
      panel.width = end - begin;
      panel.row_count = width - end + static_cast<Index>(below);
      panel.rows = rows_;
      panel.values = values_;
      rows_ += panel.row_count;
      values_ += Offset{panel.width} * panel.row_count + panel.width * (panel.width + 1) / 2;
      for (Index i = begin; i < end; ++i) {
        const Index vertex = ldl_.new_to_old[columns[i]];
        number_[columns[i]] = factor_.size();
        columns_.push_back(columns[i]);
        factor_.column_of_vertex[vertex] = factor_.size();
        factor_.vertex_of_column.push_back(vertex);
        factor_.panel_of_column.push_back(index_size(factor_.panels) - 1);
      }
    }
  }

  /// Fills the panels of the supernode whose last column of L is `top`. Call it in the order of the panels.
  void fill_panels(Index top) {
    std::vector<Index> below;
    for (Offset k = ldl_.offsets[top]; k < ldl_.offsets[top + 1]; ++k) below.push_back(number_[ldl_.rows[k]]);
    std::sort(below.begin(), below.end());
    const Index end = number_[top] + 1;
    for (; filled_ < index_size(factor_.panels) && factor_.panels[filled_].column < end; ++filled_) {
      Panel& panel = factor_.panels[filled_];
      Index row = panel.column + panel.width;
      const auto rows = factor_.rows.begin() + panel.rows;
      const auto own_end = std::generate_n(rows, end - row, [&row] { return row++; });
      std::copy(below.begin(), below.end(), own_end);
      panel.parent = panel.row_count > 0 ? factor_.panel_of_column[factor_.rows[panel.rows]] : -1;
      fill_values(panel);
    }
  }

  void fill_values(const Panel& panel) {
    const Index width = panel.width;
    const Index triangle = width * (width - 1) / 2;
    Real* const values = factor_.values.data() + panel.values;
    for (Index r = 0; r < panel.row_count; ++r) place_of_[factor_.rows[panel.rows + r]] = r;
    for (Index j = 0; j < width; ++j) {
      const Index column = columns_[panel.column + j];
      values[triangle + j] = static_cast<Real>(1.0 / ldl_.pivots[column]);
      for (Offset k = ldl_.offsets[column]; k < ldl_.offsets[column + 1]; ++k) {
        const Index row = number_[ldl_.rows[k]];
        const Index i = row - panel.column;
        const Offset place = i < width ? i * (i - 1) / 2 + j : place_below(panel, place_of_[row], j);
        values[place] = static_cast<Real>(ldl_.values[k]);
      }
    }
  }

  /// Returns the index, in the panel's values, of the entry at column j and the r-th row below; see
  /// PanelView.
  static Offset place_below(const Panel& panel, Index r, Index j) {
    const Index group = r - r % Panel::kGroup;
    const Index in_group = std::min(Panel::kGroup, panel.row_count - group);
    return panel.width * (panel.width + 1) / 2 + Offset{panel.width} * group + in_group * j + (r - group);
  }

  /// Gives the task whose panels were filled last a slot for each row that belongs to a later task. Sets the
  /// place in this task of each slot of its children.
  void give_slots(PanelTask& task) {
    const Index n = factor_.size();
    if (task.first_panel == task.end_panel) {
      task.first_slot = task.end_slot = n + index_size(above_);
      return;
    }
    const Panel& last = factor_.panels[task.end_panel - 1];
    const auto begin = factor_.rows.begin() + factor_.panels[task.first_panel].rows;
    const auto end = factor_.rows.begin() + last.rows + last.row_count;
    std::vector<Index> later;
    std::copy_if(begin, end, std::back_inserter(later), [&](Index row) { return row >= task.end_column; });
    std::sort(later.begin(), later.end());
    later.erase(std::unique(later.begin(), later.end()), later.end());
    task.first_slot = n + index_size(above_);
    task.end_slot = task.first_slot + index_size(later);
    for (Index k = 0; k < index_size(later); ++k) place_of_[later[k]] = task.first_slot + k;
    const auto place = [&](Index row) { return row < task.end_column ? row : place_of_[row]; };
    std::transform(begin, end, begin, place);
    above_.insert(above_.end(), later.begin(), later.end());
    factor_.above_slots.resize(above_.size());
    // each row that a child contributes to is a column of this task or has a slot in it
    for (const Index child : task.children) {
      for (Index slot = factor_.tasks[child].first_slot; slot < factor_.tasks[child].end_slot; ++slot) {
        factor_.above_slots[slot - n] = place(above_[slot - n]);
      }
    }
  }
};

}  // namespace

template <class Real>
std::size_t PanelFactor<Real>::bytes() const {
  std::size_t result = sizeof(Real) * values.capacity() + sizeof(Panel) * panels.capacity();
  for (const std::vector<Index>* numbers :
       {&vertex_of_column, &column_of_vertex, &panel_of_column, &rows, &above_slots}) {
    result += sizeof(Index) * numbers->capacity();
  }
  return result;
}

template <class Real>
PanelFactor<Real> make_panel_factor(const Ldl& ldl) {
  return Builder<Real>(ldl).result();
}

template struct PanelFactor<double>;
template struct PanelFactor<float>;
template PanelFactor<double> make_panel_factor(const Ldl&);
template PanelFactor<float> make_panel_factor(const Ldl&);

}  // namespace meshorder
