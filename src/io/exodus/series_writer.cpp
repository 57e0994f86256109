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

// Writes the variables of nodes and elements, step by step.

namespace meshorder::exodus {
namespace {

/// Writes the values of one step for `count` vertices or cells from `first` on, along the last dimension of
/// the variable. If `array` is null, writes NaN, or 0 for integer types.
void put(const NcSink& sink, NcType type, std::vector<std::size_t> starts, const DataArray* array,
         Index component, const std::vector<Index>& table, Index first, Index count) {
  std::vector<std::size_t> counts(starts.size(), 1);
  const auto put_as = [&]<class Number>(Number nothing) {
    in_parts(count, [&](Index begin, Index rows) {
      starts.back() = static_cast<std::size_t>(begin);
      counts.back() = static_cast<std::size_t>(rows);
      sink.part(starts, counts,
                array == nullptr ? std::vector<Number>(static_cast<std::size_t>(rows), nothing)
                                 : column<Number>(*array, component, table, first + begin, rows, nothing));
    });
  };
  if (type == kFloat) return put_as(std::numeric_limits<float>::quiet_NaN());
  const bool is_wide = array != nullptr && std::holds_alternative<std::vector<std::uint64_t>>(array->values);
  if (is_whole(type)) return is_wide ? put_as(std::uint64_t{0}) : put_as(std::int64_t{0});
  put_as(std::numeric_limits<double>::quiet_NaN());
}

/// Returns the type in which an array is written if it did not come from an Exodus file.
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
  SeriesPlanner(Writing& writing, Association association) : writing_(writing), association_(association) {}

  std::vector<SeriesPlan> plans() && {
    const ExodusMetadata& of_file = writing_.metadata;
    for (const Series& series : association_ == Association::vertices ? of_file.nodal : of_file.elements) {
      add(series);
    }
    for (const DataArray& array : writing_.mesh.data) {
      if (array.association == association_ && !writing_.placed.contains(&array)) add(array);
    }
    return std::move(plans_);
  }

 private:
  void add(const Series& series) {
    SeriesPlan plan{
        .name = series.name, .type = series.type, .present = series.present, .declared = series.declared};
    bool found = series.arrays.empty();
    for (const std::string& name : series.arrays) {
      plan.arrays.push_back(writing_.take_column(name, association_));
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
    Notes& notes = writing_.notes;
    if (std::holds_alternative<std::vector<std::string>>(array.values)) {
      return note_array_unsupported(array, "Exodus", notes);
    }
    note_digits(&array, kDouble);
    if (array.components == 1) return add(array, 0, array.name);
    const std::vector<std::string> names = names_of_components(array);
    notes.push_back(fmt::format("the array '{}' of {} components is written as the variables '{}' to '{}'",
                                array.name, names.size(), names.front(), names.back()));
    for (Index k = 0; k < array.components; ++k) add(array, k, names[k]);
  }

  void note_digits(const DataArray* array, NcType type) {
    if (array == nullptr || can_hold(type, array->values)) return;
    writing_.notes.push_back(fmt::format(
        "the array '{}' loses digits: variables of Exodus are real numbers of 53 bits", array->name));
  }

  void add(const DataArray& array, Index component, const std::string& wanted) {
    const std::string held = trimmed(wanted).empty() ? "unnamed" : wanted;
    const std::string name = numbers_.free_name(
        held, [&](int k) { return fmt::format("{} ({})", held, k); },
        [&](const std::string& free) { return names_.insert(free).second; });
    if (name != wanted) {
      writing_.notes.push_back(fmt::format("the array '{}' is written as the variable '{}'", wanted, name));
    }
    const std::size_t steps = std::max<std::size_t>(1, writing_.metadata.steps);
    if (steps > 1) {
      writing_.notes.push_back(
          fmt::format("the variable '{}' has the same values in all {} steps", name, steps));
    }
    plans_.push_back({.name = name,
                      .type = type_for(array),
                      .arrays = std::vector<const DataArray*>(steps, &array),
                      .component = component});
  }

  Writing& writing_;
  Association association_;
  std::set<std::string> names_;
  NameNumbers numbers_;
  std::vector<SeriesPlan> plans_;
};

std::vector<std::string> names_of_series(const std::vector<SeriesPlan>& series) {
  std::vector<std::string> names;
  names.reserve(series.size());
  for (const SeriesPlan& one : series) names.push_back(one.name);
  return names;
}

/// Returns the type of the variable "vals_nod_var", which holds all nodal variables.
NcType type_of_all(const std::vector<SeriesPlan>& series) {
  const NcType first = series.front().type;
  const bool is_one =
      std::all_of(series.begin(), series.end(), [&](const SeriesPlan& one) { return one.type == first; });
  return is_one ? first : kDouble;
}

/// Returns, for each block, the number of cells for which an array has a row.
std::vector<Index> rows_in_blocks(const Writing& writing, const DataArray& array) {
  std::vector<Index> rows;
  std::vector<Index> firsts;
  for (const BlockPlan& block : writing.blocks) {
    rows.push_back(array.is_dense() ? block.cells.count : 0);
    firsts.push_back(block.cells.first);
  }
  for (const Index cell : array.indices) {
    // an empty block has the same first cell as the next block, so the last block with that first cell has
    // the cell
    const auto next = std::upper_bound(firsts.begin(), firsts.end(), cell);
    ++rows[static_cast<std::size_t>(next - firsts.begin()) - 1];
  }
  return rows;
}

/// How a variable appears in a block.
struct Presence {
  bool in_table = false;
  bool declared = false;
};

/// Returns how a variable appears in each block. A block that never had values appears as it does in the
/// file.
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

std::vector<SeriesPlan> plan_series(Writing& writing, Association association) {
  return SeriesPlanner(writing, association).plans();
}

void write_nodal(Writing& writing, const std::vector<SeriesPlan>& series) {
  if (series.empty()) return;
  NcOutput& file = writing.file;
  const Mesh& mesh = writing.mesh;
  file.dimension({"num_nod_var", series.size()});
  writing.write_names("name_nod_var", "num_nod_var", names_of_series(series));
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
    file.later([sink, &one, &mesh, v, packed] {
      const DataArray* last = nullptr;
      std::vector<Index> table;
      for (std::size_t step = 0; step < one.arrays.size(); ++step) {
        const DataArray* const array = one.arrays[step];
        if (array != nullptr && array != last) table = rows_by_item(*array, mesh.vertex_count());
        last = array;
        put(sink, one.type, packed ? std::vector{step, v, std::size_t{0}} : std::vector{step, std::size_t{0}},
            array, one.component, table, 0, mesh.vertex_count());
      }
    });
  }
}

void write_elemental(Writing& writing, const std::vector<SeriesPlan>& series) {
  if (series.empty()) return;
  NcOutput& file = writing.file;
  file.dimension({"num_elem_var", series.size()});
  writing.write_names("name_elem_var", "num_elem_var", names_of_series(series));
  std::vector<std::int32_t> table(writing.blocks.size() * series.size(), 0);
  for (std::size_t v = 0; v < series.size(); ++v) {
    const SeriesPlan& one = series[v];
    const std::vector<Presence> presences = presence(writing, one);
    std::vector<std::pair<std::size_t, NcSink>> sinks;
    for (std::size_t b = 0; b < writing.blocks.size(); ++b) {
      table[b * series.size() + v] = presences[b].in_table ? 1 : 0;
      if (!presences[b].declared || writing.blocks[b].cells.count == 0) continue;
      sinks.emplace_back(b, writing.declare(fmt::format("vals_elem_var{}eb{}", v + 1, b + 1), one.type,
                                            {"time_step", fmt::format("num_el_in_blk{}", b + 1)}));
    }
    file.later([sinks, &one, &writing] {
      const DataArray* last = nullptr;
      std::vector<Index> rows;
      for (std::size_t step = 0; step < one.arrays.size(); ++step) {
        const DataArray* const array = one.arrays[step];
        if (array != nullptr && array != last) rows = rows_by_item(*array, writing.mesh.cell_count());
        last = array;
        for (const auto& [b, sink] : sinks) {
          const Block& cells = writing.blocks[b].cells;
          put(sink, one.type, {step, 0}, array, one.component, rows, cells.first, cells.count);
        }
      }
    });
  }
  const NcSink sink = writing.declare("elem_var_tab", kInt, {"num_el_blk", "num_elem_var"});
  file.later([sink, table, blocks = writing.blocks.size(), variables = series.size()] {
    sink.part({0, 0}, {blocks, variables}, table);
  });
}

}  // namespace meshorder::exodus
