// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/exodus/writing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <utility>

// Writes the sets of nodes, sides and elements.

namespace meshorder::exodus {
namespace {

/// Finds the row of a vertex or cell in an array, with memory proportional to the array's rows.
class SparseRows {
 public:
  explicit SparseRows(const DataArray& array) {
    rows_.reserve(array.indices.size());
    for (Index row = 0; row < index_size(array.indices); ++row) rows_.emplace_back(array.indices[row], row);
    if (!std::is_sorted(rows_.begin(), rows_.end())) std::sort(rows_.begin(), rows_.end());
    is_dense_ = array.is_dense();
  }

  /// Returns the row of a vertex or cell, −1 if it has none. O(log rows).
  [[nodiscard]] Index find(Index place) const {
    if (is_dense_) return place;
    const auto found = std::lower_bound(rows_.begin(), rows_.end(), std::pair{place, Index{0}});
    return found == rows_.end() || found->first != place ? -1 : found->second;
  }

 private:
  std::vector<std::pair<Index, Index>> rows_;  // vertex or cell, row
  bool is_dense_ = false;
};

/// Returns the number that a text of one to nine digits forms; −1 for other texts.
std::int64_t number_of(std::string_view text) {
  std::int64_t value = -1;
  const bool digits = !text.empty() && text.size() <= 9 &&
                      std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (digits) std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

bool is_side_set(const DataArray& array) {
  if (array.association != Association::cells || array.components != 1) return false;
  if (!array.name.starts_with(kSetKinds[kSideSets].word) || !are_whole(array.values)) return false;
  const std::vector<std::int64_t> masks = whole_values(array.values);
  return std::all_of(masks.begin(), masks.end(),
                     [](std::int64_t mask) { return mask >= 0 && mask < (1 << kMostSides); });
}

/// Plans the sets of one kind.
class FamilyPlanner {
 public:
  FamilyPlanner(Planning& planning, std::size_t kind)
      : planning_(planning), kind_(kSetKinds[kind]), family_(planning.metadata.sets[kind]) {}

  void add(const EntitySet& set) {
    SetPlan& plan = begin(set.name);
    plan.members.reserve(set.members.size());
    for (const Index member : set.members) plan.members.push_back(member + 1);
    plan.factors = find_factors(set.name);
    if (plan.factors != nullptr && plan.factors->components != 1) plan.factors = nullptr;
    if (plan.factors != nullptr) planning_.placed.insert(plan.factors);
  }

  void add(const DataArray& array) {
    planning_.placed.insert(&array);
    SetPlan& plan = begin(array.name);
    const std::vector<std::int64_t> masks = whole_values(array.values);
    for (Index row = 0; row < index_size(masks); ++row) {
      const Index cell = array.is_dense() ? row : array.indices[row];
      Index rank = 0;
      for (int side = 1; side <= kMostSides; ++side) {
        if ((masks[row] >> (side - 1) & 1) == 0) continue;
        plan.members.push_back(cell + 1);
        plan.sides.push_back(side);
        plan.ranks.push_back(rank++);
      }
    }
    add_factors(plan, array.name);
  }

  /// Adds a side set without sides, which has no array in the mesh.
  void add_empty(const SetRecord& record) {
    plans_.push_back({.id = record.id, .name = record.name, .record = &record});
    plans_.back().variables.resize(family_.variables.size());
  }

  std::vector<SetPlan> plans() && {
    std::set<std::int64_t> taken;
    for (const SetPlan& plan : plans_) {
      if (plan.record != nullptr) taken.insert(plan.id);
    }
    for (SetPlan& plan : plans_) {
      if (plan.record != nullptr) continue;
      while (plan.id < 1 || !taken.insert(plan.id).second)
        plan.id = taken.empty() ? 1 : std::max<std::int64_t>(1, *taken.rbegin() + 1);
    }
    return std::move(plans_);
  }

 private:
  SetPlan& begin(const std::string& in_mesh) {
    SetPlan& plan = plans_.emplace_back();
    plan.variables.resize(family_.variables.size());
    const auto record = std::find_if(family_.sets.begin(), family_.sets.end(),
                                     [&](const SetRecord& of_file) { return of_file.in_mesh == in_mesh; });
    if (record != family_.sets.end()) {
      plan.record = &*record;
      plan.id = record->id;
      plan.name = record->name;
      take_variables(plan);
      return plan;
    }
    const bool has_word = in_mesh.starts_with(kind_.word);
    plan.name = has_word ? in_mesh.substr(kind_.word.size()) : in_mesh;
    if (trimmed(plan.name).empty()) {
      plan.name = "unnamed";
      planning_.notes.push_back(fmt::format("the set '{}' is written as '{}'", in_mesh, plan.name));
    }
    plan.id = has_word ? number_of(plan.name) : -1;
    if (plan.id >= 0) plan.name.clear();
    return plan;
  }

  void take_variables(SetPlan& plan) {
    const bool is_sides = kind_.word == kSetKinds[kSideSets].word;
    for (std::size_t v = 0; v < plan.record->variables.size(); ++v) {
      for (const std::string& array : plan.record->variables[v].arrays) {
        // a side set's array has a component for each side of a cell
        plan.variables[v].push_back(is_sides ? planning_.take(array, kind_.association)
                                             : planning_.take_column(array, kind_.association));
      }
    }
  }

  [[nodiscard]] const DataArray* find_factors(const std::string& in_mesh) const {
    const DataArray* const found =
        find_array(planning_.mesh, title(kind_, in_mesh) + std::string(kFactors), kind_.association);
    return found == nullptr || are_texts(found->values) ? nullptr : found;
  }

  /// Finds the array of factors of a side set, and the number of factors of each side.
  void add_factors(SetPlan& plan, const std::string& in_mesh) {
    const DataArray* const factors = find_factors(in_mesh);
    if (factors == nullptr || plan.members.empty()) return;
    std::vector<int> counts;
    counts.reserve(plan.members.size());
    for (std::size_t i = 0; i < plan.members.size(); ++i) {
      const BlockPlan& block = planning_.block_of(plan.members[i] - 1);
      const CellPart& cells = block.cells;
      const int faces = faces_of(cells.shape, block.type(), planning_.mesh.dimension);
      counts.push_back(nodes_of_side(cells.shape, cells.nodes, plan.sides[i], faces));
    }
    const int most_nodes = *std::max_element(counts.begin(), counts.end());
    const Index most_sides = *std::max_element(plan.ranks.begin(), plan.ranks.end()) + 1;
    int width = 0;
    if (plan.record != nullptr && plan.record->factor_width > 0) {
      width = plan.record->factor_width;
      if (!plan.record->factors_by_nodes) counts.assign(counts.size(), width);
    } else if (most_nodes > 0 && factors->components == most_sides * most_nodes) {
      width = most_nodes;
    } else if (factors->components % most_sides == 0) {
      width = factors->components / most_sides;
      counts.assign(counts.size(), width);
    }
    if (width == 0 || factors->components < most_sides * width) return;
    plan.factors = factors;
    plan.factor_width = width;
    plan.factor_counts = std::move(counts);
    planning_.placed.insert(factors);
  }

  Planning& planning_;
  const SetKind& kind_;
  const SetFamily& family_;
  std::vector<SetPlan> plans_;
};

/// Returns the values of an array for the members of a set: counts[i] values for member i, or one value if
/// `counts` is empty. Members without a row get `missing`.
template <class Number>
std::vector<Number> values_of_members(const SetPlan& plan, const DataArray& array, int width,
                                      const std::vector<int>& counts, Number missing) {
  const SparseRows rows(array);
  std::vector<Number> result;
  result.reserve(plan.members.size());
  with_numbers(array.values, [&](const auto& values) {
    for (std::size_t i = 0; i < plan.members.size(); ++i) {
      const Index row = rows.find(plan.members[i] - 1);
      const Offset first = plan.ranks.empty() ? 0 : Offset{plan.ranks[i]} * width;
      const Offset end = first + (counts.empty() ? 1 : counts[i]);
      for (Offset k = first; k < end; ++k) {
        const bool there = row >= 0 && k < array.components;
        result.push_back(there ? static_cast<Number>(values[Offset{row} * array.components + k]) : missing);
      }
    }
  });
  return result;
}

/// Declares the dimensions and variables of the sets of one kind.
class FamilyWriter {
 public:
  FamilyWriter(Writing& writing, std::size_t kind, const std::vector<SetPlan>& plans)
      : writing_(writing), kind_(kSetKinds[kind]), family_(writing.metadata.sets[kind]), plans_(plans) {}

  void write() {
    if (plans_.empty()) return;
    const std::string count(kind_.count);
    writing_.file.dimension({count, plans_.size()});
    write_plans(writing_, std::string(kind_.prefix), count, plans_, family_.properties, family_.has_names);
    for (std::size_t s = 0; s < plans_.size(); ++s) write_set(std::to_string(s + 1), plans_[s]);
    write_variables();
  }

 private:
  void write_set(const std::string& number, const SetPlan& plan) {
    if (plan.members.empty()) return;
    NcOutput& file = writing_.file;
    const std::string size = std::string(kind_.size) + number;
    const NcType type = plan.record != nullptr && plan.record->type == kInt64 ? kInt64 : kInt;
    file.dimension({size, plan.members.size()});
    const NcSink members = writing_.declare(std::string(kind_.members) + number, type, {size});
    file.later([members, &plan] { members.list(plan.members); });
    if (!plan.sides.empty()) {
      const NcSink sides = writing_.declare("side_ss" + number, type, {size});
      file.later([sides, &plan] { sides.list(plan.sides); });
    }
    if (plan.factors == nullptr) return;
    const std::string factor_size = std::string(kind_.factor_size) + number;
    file.dimension({factor_size, plan.factor_count()});
    const NcType of_factors =
        plan.record != nullptr ? written_type(plan.record->factor_type, plan.factors->values) : kDouble;
    const NcSink sink =
        writing_.declare("dist_fact_" + std::string(kind_.prefix) + number, of_factors, {factor_size});
    file.later([sink, &plan] {
      sink.list(values_of_members(plan, *plan.factors, plan.factor_width, plan.factor_counts, 1.0));
    });
  }

  void write_variables() {
    if (family_.variables.empty()) return;
    const std::string of(kind_.variable);
    const std::string count = "num_" + of + "_var";
    writing_.file.dimension({count, family_.variables.size()});
    writing_.write_names("name_" + of + "_var", count, family_.variables);
    std::vector<std::int32_t> table;
    for (const SetPlan& plan : plans_) {
      for (std::size_t v = 0; v < family_.variables.size(); ++v)
        table.push_back(is_in_table(plan, v) ? 1 : 0);
    }
    const NcSink sink = writing_.declare(of + "_var_tab", kInt, {std::string(kind_.count), count});
    writing_.file.later([sink, table, sets = plans_.size(), variables = family_.variables.size()] {
      sink.part({0, 0}, {sets, variables}, table);
    });
    for (std::size_t v = 0; v < family_.variables.size(); ++v) {
      for (std::size_t s = 0; s < plans_.size(); ++s) {
        if (is_declared(plans_[s], v)) write_variable(v, s);
      }
    }
  }

  static bool has_values(const SetPlan& plan, std::size_t v) {
    return std::any_of(plan.variables[v].begin(), plan.variables[v].end(),
                       [](const DataArray* array) { return array != nullptr; });
  }

  /// Returns whether the table of variables marks values for a set: the set has values, or the table of the
  /// file that the mesh came from marked values that did not exist.
  static bool is_in_table(const SetPlan& plan, std::size_t v) {
    if (has_values(plan, v)) return true;
    if (plan.record == nullptr) return false;
    const Series& series = plan.record->variables[v];
    return series.present.front() && (series.arrays.empty() || !series.declared.front());
  }

  [[nodiscard]] bool is_declared(const SetPlan& plan, std::size_t v) const {
    if (has_values(plan, v)) return true;
    return writing_.steps == 0 && plan.record != nullptr && plan.record->variables[v].declared.front() &&
           !plan.members.empty();
  }

  void write_variable(std::size_t v, std::size_t s) {
    const SetPlan& plan = plans_[s];
    const std::string number = std::to_string(s + 1);
    NcType type = plan.record->variables[v].type;
    for (const DataArray* const array : plan.variables[v]) {
      if (array != nullptr) type = written_type(type, array->values);
    }
    const NcSink sink =
        writing_.declare(fmt::format("vals_{}_var{}{}{}", kind_.variable, v + 1, kind_.prefix, number), type,
                         {"time_step", std::string(kind_.size) + number});
    writing_.file.later([sink, type, &plan, v] {
      const std::size_t members = plan.members.size();
      for (std::size_t step = 0; step < plan.variables[v].size(); ++step) {
        const DataArray* const array = plan.variables[v][step];
        put_as(type, array, [&]<class Number>(Number missing) {
          sink.part({step, 0}, {1, members},
                    array == nullptr ? std::vector<Number>(members, missing)
                                     : values_of_members(plan, *array, 1, {}, missing));
        });
      }
    });
  }

  Writing& writing_;
  const SetKind& kind_;
  const SetFamily& family_;
  const std::vector<SetPlan>& plans_;
};

}  // namespace

std::size_t SetPlan::factor_count() const {
  if (factors == nullptr) return 0;
  return factor_counts.empty() ? members.size()
                               : std::accumulate(factor_counts.begin(), factor_counts.end(), std::size_t{0});
}

std::vector<std::vector<SetPlan>> plan_sets(Planning& planning,
                                            const std::vector<const EntitySet*>& element_sets) {
  FamilyPlanner nodes(planning, kNodeSets);
  FamilyPlanner sides(planning, kSideSets);
  FamilyPlanner elements(planning, kElementSets);
  for (const EntitySet& set : planning.mesh.sets) {
    if (set.association == Association::vertices) nodes.add(set);
  }
  for (const EntitySet* const set : element_sets) elements.add(*set);
  for (const SetRecord& record : planning.metadata.sets[kSideSets].sets) {
    const DataArray* const array = find_array(planning.mesh, record.in_mesh, Association::cells);
    if (record.in_mesh.empty()) {
      sides.add_empty(record);
    } else if (array != nullptr && is_side_set(*array)) {
      sides.add(*array);
    }
  }
  for (const DataArray& array : planning.mesh.data) {
    if (!planning.placed.contains(&array) && is_side_set(array)) sides.add(array);
  }
  return {std::move(nodes).plans(), std::move(sides).plans(), std::move(elements).plans()};
}

void write_sets(Writing& writing, const std::vector<std::vector<SetPlan>>& plans) {
  for (std::size_t kind = 0; kind < plans.size(); ++kind) FamilyWriter(writing, kind, plans[kind]).write();
}

}  // namespace meshorder::exodus
