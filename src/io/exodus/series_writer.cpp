// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/exodus/writing.hpp"
#include "io/names.hpp"
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

// Writes the nodal and element variables, step by step.

namespace meshorder::exodus {
namespace {

/// A netCDF variable, and the vertices or cells whose values it holds.
struct Target {
  NcSink sink;
  std::vector<std::size_t> starts;  ///< start indices of the values in the variable, at the first step
  Index first;
  Index count;
};

/// Writes a nodal or element variable at all steps to the targets, along the last dimension of each target's
/// variable.
void put_steps(const SeriesPlan& series, Index items, std::vector<Target> targets) {
  const DataArray* last = nullptr;
  std::vector<Index> table;
  for (std::size_t step = 0; step < series.arrays.size(); ++step) {
    const DataArray* const array = series.arrays[step];
    if (array != nullptr && array != last) table = rows_by_item(*array, items);
    last = array;
    for (Target& target : targets) {
      std::vector<std::size_t> counts(target.starts.size(), 1);
      target.starts.front() = step;
      put_as(series.type, array, [&]<class Number>(Number missing) {
        in_parts(target.count, [&](Index begin, Index rows) {
          target.starts.back() = static_cast<std::size_t>(begin);
          counts.back() = static_cast<std::size_t>(rows);
          target.sink.part(target.starts, counts,
                           array == nullptr ? std::vector<Number>(counts.back(), missing)
                                            : column(*array, series.component, table, target.first + begin,
                                                     rows, missing));
        });
      });
    }
  }
}

/// Returns the type in which to write an array that did not come from an Exodus file.
NcType type_for(const DataArray& array) {
  return std::holds_alternative<std::vector<float>>(array.values) ? kFloat : kDouble;
}

/// Returns the names of the variables for the components of an array.
std::vector<std::string> names_of_components(const DataArray& array) {
  constexpr std::array<std::string_view, 3> kAxes{"X", "Y", "Z"};
  const auto count = static_cast<std::size_t>(array.components);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < count; ++k) {
    std::string suffix = count <= kAxes.size() ? std::string(kAxes[k]) : std::to_string(k + 1);
    if (array.component_names.size() == count && !array.component_names[k].empty())
      suffix = array.component_names[k];
    names.push_back(array.name + "_" + suffix);
  }
  return names;
}

class SeriesPlanner {
 public:
  SeriesPlanner(Planning& planning, Association association)
      : planning_(planning), association_(association) {}

  std::vector<SeriesPlan> plans() && {
    const ExodusMetadata& of_file = planning_.metadata;
    for (const Series& series : association_ == Association::vertices ? of_file.nodal : of_file.elements)
      add(series);
    for (const DataArray& array : planning_.mesh.data) {
      if (array.association == association_ && !planning_.placed.contains(&array)) add(array);
    }
    return std::move(plans_);
  }

 private:
  void add(const Series& series) {
    SeriesPlan plan{
        .name = series.name, .type = series.type, .present = series.present, .declared = series.declared};
    bool found = series.arrays.empty();
    for (const std::string& name : series.arrays) {
      plan.arrays.push_back(planning_.take_column(name, association_));
      const DataArray* const array = plan.arrays.back();
      found = found || array != nullptr;
      if (array != nullptr) plan.type = written_type(plan.type, array->values);
    }
    for (const DataArray* const array : plan.arrays) note_digits(array, plan.type);
    if (!found) return;
    names_.insert(plan.name);
    plans_.push_back(std::move(plan));
  }

  void add(const DataArray& array) {
    Notes& notes = planning_.notes;
    if (are_texts(array.values)) return note_array_unsupported(array, "Exodus", notes);
    note_digits(&array, kDouble);
    if (array.components == 1) return add(array, 0, array.name);
    const std::vector<std::string> names = names_of_components(array);
    notes.push_back(fmt::format("the array '{}' of {} components is written as the variables '{}' to '{}'",
                                array.name, names.size(), names.front(), names.back()));
    for (Index k = 0; k < array.components; ++k) add(array, k, names[k]);
  }

  void note_digits(const DataArray* array, NcType type) {
    if (array == nullptr || can_hold(type, array->values)) return;
    planning_.notes.push_back(fmt::format(
        "the array '{}' loses digits: variables of Exodus are real numbers of 53 bits", array->name));
  }

  void add(const DataArray& array, Index component, const std::string& wanted) {
    const std::string held = trimmed(wanted).empty() ? "unnamed" : wanted;
    const std::string name = numbers_.free_name(
        held, [&](int k) { return fmt::format("{} ({})", held, k); },
        [&](const std::string& free) { return names_.insert(free).second; });
    if (name != wanted)
      planning_.notes.push_back(fmt::format("the array '{}' is written as the variable '{}'", wanted, name));
    const std::size_t steps = std::max<std::size_t>(1, planning_.metadata.steps);
    if (steps > 1) {
      planning_.notes.push_back(
          fmt::format("the variable '{}' is written with the same values in all {} steps", name, steps));
    }
    plans_.push_back({.name = name,
                      .type = type_for(array),
                      .arrays = std::vector<const DataArray*>(steps, &array),
                      .component = component});
  }

  Planning& planning_;
  Association association_;
  std::set<std::string> names_;
  NameNumbers numbers_;
  std::vector<SeriesPlan> plans_;
};

/// Returns the type of the netCDF variable "vals_nod_var", which holds all nodal variables.
NcType type_of_all(const std::vector<SeriesPlan>& series) {
  const NcType first = series.front().type;
  const bool is_one =
      std::all_of(series.begin(), series.end(), [&](const SeriesPlan& one) { return one.type == first; });
  return is_one ? first : kDouble;
}

/// Returns how many cells of each block have a row in an array.
std::vector<Index> rows_in_blocks(Writing& writing, const DataArray& array) {
  std::vector<Index> rows;
  for (const BlockPlan& block : writing.blocks) rows.push_back(array.is_dense() ? block.cells.count : 0);
  for (const Index cell : array.indices)
    ++rows[static_cast<std::size_t>(&writing.block_of(cell) - writing.blocks.data())];
  return rows;
}

/// How an element variable appears in a block.
struct Presence {
  bool in_table = false;
  bool declared = false;
};

/// Returns how an element variable appears in each block. A block that never had values keeps its entries
/// from the file that the mesh came from.
std::vector<Presence> presence(Writing& writing, const SeriesPlan& series) {
  std::vector<Presence> result(writing.blocks.size());
  for (std::size_t b = 0; b < result.size(); ++b) {
    const BlockRecord* const record = writing.blocks[b].record;
    if (record == nullptr || series.present.empty()) continue;
    const auto place = static_cast<std::size_t>(record - writing.metadata.blocks.data());
    const bool had_values = series.declared[place] && !series.arrays.empty();
    result[b].in_table = series.present[place] && !had_values;
    result[b].declared = series.declared[place] && writing.steps == 0;
  }
  const DataArray* last = nullptr;
  for (const DataArray* const array : series.arrays) {
    if (array == nullptr || array == last) continue;
    last = array;
    const std::vector<Index> rows = rows_in_blocks(writing, *array);
    bool filled = false;
    for (std::size_t b = 0; b < result.size(); ++b) {
      if (rows[b] > 0) result[b] = {true, true};
      filled = filled || (rows[b] > 0 && rows[b] < writing.blocks[b].cells.count);
    }
    if (filled && series.component == 0) note_filled(*array, "NaN", writing.notes);
  }
  return result;
}

}  // namespace

std::vector<SeriesPlan> plan_series(Planning& planning, Association association) {
  return SeriesPlanner(planning, association).plans();
}

void write_nodal(Writing& writing, const std::vector<SeriesPlan>& series) {
  if (series.empty()) return;
  NcOutput& file = writing.file;
  const Mesh& mesh = writing.mesh;
  file.dimension({"num_nod_var", series.size()});
  writing.write_names("name_nod_var", "num_nod_var", names_of(series));
  const bool packed = writing.metadata.packs_nodal;
  if (mesh.points.empty()) return;
  const NcSink together =
      packed ? writing.declare("vals_nod_var", type_of_all(series), {"time_step", "num_nod_var", "num_nodes"})
             : NcSink(file, "", -1);
  for (std::size_t v = 0; v < series.size(); ++v) {
    const SeriesPlan& one = series[v];
    const DataArray* const first = one.arrays.empty() ? nullptr : one.arrays.front();
    if (first != nullptr && !first->is_dense() && one.component == 0)
      note_filled(*first, "NaN", writing.notes);
    if (!packed && one.arrays.empty() && (writing.steps > 0 || !one.declared.front())) continue;
    const NcSink sink =
        packed ? together
               : writing.declare(fmt::format("vals_nod_var{}", v + 1), one.type, {"time_step", "num_nodes"});
    const std::vector<std::size_t> starts =
        packed ? std::vector{std::size_t{0}, v, std::size_t{0}} : std::vector<std::size_t>(2, 0);
    file.later([sink, starts, &one, nodes = mesh.vertex_count()] {
      put_steps(one, nodes, {{sink, starts, 0, nodes}});
    });
  }
}

void write_elemental(Writing& writing, const std::vector<SeriesPlan>& series) {
  if (series.empty()) return;
  NcOutput& file = writing.file;
  file.dimension({"num_elem_var", series.size()});
  writing.write_names("name_elem_var", "num_elem_var", names_of(series));
  std::vector<std::int32_t> table(writing.blocks.size() * series.size(), 0);
  for (std::size_t v = 0; v < series.size(); ++v) {
    const SeriesPlan& one = series[v];
    const std::vector<Presence> presences = presence(writing, one);
    std::vector<Target> targets;
    for (std::size_t b = 0; b < writing.blocks.size(); ++b) {
      table[b * series.size() + v] = presences[b].in_table ? 1 : 0;
      const CellPart& cells = writing.blocks[b].cells;
      if (!presences[b].declared || cells.count == 0) continue;
      const NcSink sink = writing.declare(fmt::format("vals_elem_var{}eb{}", v + 1, b + 1), one.type,
                                          {"time_step", fmt::format("num_el_in_blk{}", b + 1)});
      targets.push_back({sink, {0, 0}, cells.first, cells.count});
    }
    file.later([targets, &one, items = writing.mesh.cell_count()] { put_steps(one, items, targets); });
  }
  const NcSink sink = writing.declare("elem_var_tab", kInt, {"num_el_blk", "num_elem_var"});
  file.later([sink, table, blocks = writing.blocks.size(), variables = series.size()] {
    sink.part({0, 0}, {blocks, variables}, table);
  });
}

}  // namespace meshorder::exodus
