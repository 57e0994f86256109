// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/memory.hpp"
#include "io/exodus/exodus.hpp"
#include "io/exodus/reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <type_traits>

// Reads sets of nodes, sides and elements with their distribution factors, and variables over the steps.

namespace meshorder::exodus {
namespace {

/// A set of sides, element by element.
struct Sides {
  std::vector<Index> cells;         ///< in the order in which the file first names them
  std::vector<std::int32_t> masks;  ///< their sides: bit s − 1 for side s
  std::vector<Index>
      row_of_entry;  ///< of each entry of the file: its place in `cells`, −1 for a repeated one
  std::vector<int> rank_of_entry;  ///< its place among the sides of the cell
  std::vector<int> side_of_entry;
  int most_sides = 0;  ///< of a cell
};

int bit_count(std::int32_t mask) {
  int count = 0;
  for (; mask != 0; mask &= mask - 1) ++count;
  return count;
}

/// Returns the rows of `values`, each of `width`, that `keep` names.
Values chosen_rows(const Values& values, const std::vector<Index>& keep) {
  return std::visit(
      [&](const auto& all) -> Values {
        std::decay_t<decltype(all)> chosen;
        chosen.reserve(keep.size());
        for (const Index row : keep) chosen.push_back(all[row]);
        return chosen;
      },
      values);
}

/// Returns one row for each cell: the values of its sides, ascending, each filled up to `width`.
template <class Number>
std::vector<Number> packed(const Sides& sides, const std::vector<Number>& values,
                           const std::vector<int>& counts, int width) {
  const auto row_width = static_cast<std::size_t>(sides.most_sides) * static_cast<std::size_t>(width);
  Number nothing{};
  if constexpr (std::is_floating_point_v<Number>) nothing = std::numeric_limits<Number>::quiet_NaN();
  std::vector<Number> result(sides.cells.size() * row_width, nothing);
  std::size_t from = 0;
  for (std::size_t i = 0; i < sides.row_of_entry.size(); ++i) {
    const auto length = static_cast<std::size_t>(counts[i]);
    if (sides.row_of_entry[i] >= 0) {
      const std::size_t into =
          static_cast<std::size_t>(sides.row_of_entry[i]) * row_width +
          static_cast<std::size_t>(sides.rank_of_entry[i]) * static_cast<std::size_t>(width);
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(from), length,
                  result.begin() + static_cast<std::ptrdiff_t>(into));
    }
    from += length;
  }
  return result;
}

/// Returns the table of which object, a block or a set, has values of which variable, row by row; empty where
/// the file has none.
std::vector<std::int64_t> read_table(Reading& reading, const std::string& of, std::size_t objects,
                                     std::size_t variables) {
  const Variable* const table = reading.take(of + "_var_tab");
  if (table == nullptr) return {};
  reading.require_shape(*table, {objects, variables});
  return reading.file.integers(*table);
}

/// Reads the sets of one kind and their variables.
class SetReader {
 public:
  SetReader(Reading& reading, std::size_t kind)
      : reading_(reading),
        kind_(kSetKinds[kind]),
        family_(reading.metadata->sets[kind]),
        is_sides_(kind == kSideSets) {}

  void read() {
    const NcInput& file = reading_.file;
    const std::string prefix(kind_.prefix);
    const std::size_t count = file.count(std::string(kind_.count));
    if (count == 0) return;
    family_.sets.resize(count);
    const std::vector<std::int64_t> ids = read_ids(reading_, prefix + "_prop1", count);
    family_.has_names = file.find(prefix + "_names") != nullptr;
    const std::vector<std::string> names = reading_.take_names(prefix + "_names", count);
    (void)reading_.take(prefix + "_status");
    family_.properties = read_properties(reading_, prefix, count, [&](std::size_t s, std::int64_t value) {
      family_.sets[s].properties.push_back(value);
    });
    const std::vector<std::int64_t> table = read_names_of_variables();
    (void)file.claimed(
        "the records of " + prefix, count,
        sizeof(SetRecord) + family_.variables.size() * 2 * sizeof(Series));  // and what they own
    for (std::size_t s = 0; s < count; ++s) {
      SetRecord& set = family_.sets[s];
      set.id = ids[s];
      set.name = names[s];
      set.variables.resize(family_.variables.size());
      for (std::size_t v = 0; v < set.variables.size(); ++v) {
        const Variable* const variable = file.find(name_of_values(v, s + 1));
        set.variables[v].declared = {variable != nullptr};
        set.variables[v].present = {table.empty() ? variable != nullptr
                                                  : table[s * set.variables.size() + v] != 0};
      }
      read_set(s + 1, set);
    }
  }

 private:
  /// Returns the table of which set has values of which variable, empty where the file has none.
  std::vector<std::int64_t> read_names_of_variables() {
    const std::string of(kind_.variable);
    const std::size_t count = reading_.file.count("num_" + of + "_var");
    family_.variables = reading_.take_names("name_" + of + "_var", count);
    return read_table(reading_, of, family_.sets.size(), count);
  }

  /// Returns the name of the variable with the values of variable `v`, from 0, on a set, from 1.
  [[nodiscard]] std::string name_of_values(std::size_t v, std::size_t set) const {
    return fmt::format("vals_{}_var{}{}{}", kind_.variable, v + 1, kind_.prefix, set);
  }

  /// Returns the members of a set, from 0.
  std::vector<std::int32_t> read_members(const Variable& variable, std::size_t limit,
                                         const char* what) const {
    const std::vector<std::size_t> shape = reading_.file.shape(variable);
    if (shape.size() != 1) reading_.file.fail(variable.name + " is no list", "the file may be damaged");
    const std::size_t count = reading_.file.size(variable);
    // and the set that is made of them
    std::vector<std::int32_t> members(reading_.file.claimed(variable.name, count, 2 * sizeof(Index)));
    if (!members.empty()) reading_.file.read(variable, members.data());
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::uint32_t place = static_cast<std::uint32_t>(members[i]) - 1;
      if (place >= limit) {
        reading_.file.fail(
            fmt::format("{}, entry {}: {} {} does not exist", variable.name, i + 1, what, members[i]),
            fmt::format("the {}s are 1 to {}", what, limit));
      }
      members[i] = static_cast<std::int32_t>(place);
    }
    return members;
  }

  void read_set(std::size_t number, SetRecord& set) {
    const bool of_nodes = kind_.association == Association::vertices;
    const Variable* const variable = reading_.take(fmt::format("{}{}", kind_.members, number));
    set.in_mesh = set.name.empty() ? std::string(kind_.word) + std::to_string(set.id) : set.name;
    if (variable == nullptr) return add_empty(set);
    set.type = variable->type;
    const std::size_t limit = of_nodes ? reading_.mesh.points.size() : reading_.mesh.cells.shapes.size();
    const std::vector<std::int32_t> members = read_members(*variable, limit, of_nodes ? "node" : "element");
    const Variable* const sides = is_sides_ ? reading_.take(fmt::format("side_ss{}", number)) : nullptr;
    if (is_sides_ && sides == nullptr) {
      reading_.file.fail(fmt::format("side_ss{} is not there", number),
                         "a side set names elements and sides");
    }
    if (members.empty()) return add_empty(set);
    if (is_sides_) {
      add_sides(number, set, members, *sides);
    } else {
      add_members(number, set, members);
    }
  }

  /// Adds a set without members; one of sides has no array.
  void add_empty(SetRecord& set) {
    set.in_mesh = is_sides_ ? "" : reading_.add_set({set.in_mesh, kind_.association, {}});
  }

  void note_repeated(const SetRecord& set, std::size_t repeated) {
    if (repeated == 0) return;
    reading_.notes.push_back(
        fmt::format("{} names {} members twice, which are kept once", title(kind_, set.in_mesh), repeated));
  }

  // ---- nodes and elements

  void add_members(std::size_t number, SetRecord& set, const std::vector<std::int32_t>& members) {
    std::vector<Index> entries = index_range(0, index_size(members));
    std::stable_sort(entries.begin(), entries.end(),
                     [&](Index a, Index b) { return members[a] < members[b]; });
    entries.erase(std::unique(entries.begin(), entries.end(),
                              [&](Index a, Index b) { return members[a] == members[b]; }),
                  entries.end());
    std::sort(entries.begin(), entries.end());
    note_repeated(set, members.size() - entries.size());
    EntitySet added{set.in_mesh, kind_.association, {}};
    added.members.reserve(entries.size());
    for (const Index entry : entries) added.members.push_back(members[entry]);
    const std::vector<Index> rows = added.members;
    set.in_mesh = reading_.add_set(std::move(added));

    if (const Variable* const factors = reading_.take(fmt::format("dist_fact_{}{}", kind_.prefix, number))) {
      reading_.require_shape(*factors, {members.size()});
      set.factor_type = factors->type;
      add_rows(title(kind_, set.in_mesh) + std::string(kFactors), rows,
               chosen_rows(reading_.file.values(*factors, {0}, {members.size()}), entries));
    }
    read_set_variables(number, set, members.size(), [&](const Values& values, const std::string& name) {
      return add_rows(name, rows, chosen_rows(values, entries));
    });
  }

  std::string add_rows(const std::string& name, const std::vector<Index>& rows, Values values,
                       Index components = 1) {
    return reading_.add_array({.name = name,
                               .association = kind_.association,
                               .components = components,
                               .values = std::move(values),
                               .indices = rows});
  }

  // ---- sides

  Sides group(std::size_t number, const std::vector<std::int32_t>& cells,
              const std::vector<std::int64_t>& sides) {
    Sides result;
    const std::size_t count = cells.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Index cell = cells[i];
      const Shape shape = reading_.mesh.cells.shapes[cell];
      const bool known =
          sides[i] >= 1 && sides[i] <= kMostSides &&
          nodes_of_side(shape, reading_.mesh.cells.vertex_count(cell), static_cast<int>(sides[i]), 3) > 0;
      if (!known) {
        reading_.file.fail(fmt::format("side_ss{}, entry {}: a {} has no side {}", number, i + 1,
                                       to_string(shape), sides[i]),
                           "sides are counted from 1");
      }
    }
    std::vector<Index> entries = index_range(0, static_cast<Index>(count));
    std::sort(entries.begin(), entries.end(), [&](Index a, Index b) {
      return std::tuple(cells[a], sides[a], a) < std::tuple(cells[b], sides[b], b);
    });
    // the first entry of each cell, which decides the place of its row
    std::vector<std::pair<Index, std::size_t>> groups;
    for (std::size_t i = 0; i < count; ++i) {
      if (i == 0 || cells[entries[i]] != cells[entries[i - 1]]) {
        groups.emplace_back(entries[i], i);
      } else {
        groups.back().first = std::min(groups.back().first, entries[i]);
      }
    }
    std::sort(groups.begin(), groups.end());
    result.row_of_entry.assign(count, -1);
    result.rank_of_entry.assign(count, 0);
    for (const auto& [first, begin] : groups) {
      const Index cell = cells[first];
      std::int32_t mask = 0;
      for (std::size_t i = begin; i < count && cells[entries[i]] == cell; ++i) {
        const std::int32_t bit = 1 << (sides[entries[i]] - 1);
        if ((mask & bit) != 0) continue;
        result.row_of_entry[entries[i]] = index_size(result.cells);
        result.rank_of_entry[entries[i]] = bit_count(mask);
        mask |= bit;
      }
      result.cells.push_back(cell);
      result.masks.push_back(mask);
      result.most_sides = std::max(result.most_sides, bit_count(mask));
    }
    result.side_of_entry.assign(sides.begin(), sides.end());
    return result;
  }

  void add_sides(std::size_t number, SetRecord& set, const std::vector<std::int32_t>& cells,
                 const Variable& variable) {
    reading_.require_shape(variable, {cells.size()});
    const Sides sides = group(number, cells, reading_.file.integers(variable));
    note_repeated(set, static_cast<std::size_t>(
                           std::count(sides.row_of_entry.begin(), sides.row_of_entry.end(), Index{-1})));
    set.in_mesh = add_rows(title(kind_, set.in_mesh), sides.cells, sides.masks);
    if (const Variable* const factors = reading_.take(fmt::format("dist_fact_ss{}", number))) {
      add_factors(set, cells, sides, *factors);
    }
    read_set_variables(number, set, cells.size(), [&](const Values& values, const std::string& name) {
      return std::visit(
          [&](const auto& all) -> std::string {
            using Number = typename std::decay_t<decltype(all)>::value_type;
            if constexpr (std::is_arithmetic_v<Number>) {
              const std::vector<int> ones(all.size(), 1);
              return add_rows(name, sides.cells, packed(sides, all, ones, 1), sides.most_sides);
            } else {
              return {};
            }
          },
          values);
    });
  }

  /// Adds the factors of the nodes of each side: as many as the side's type has nodes, or the same number for
  /// each side.
  void add_factors(SetRecord& set, const std::vector<std::int32_t>& cells, const Sides& sides,
                   const Variable& variable) {
    const std::size_t values = reading_.file.size(variable);
    set.factor_type = variable.type;
    std::vector<int> counts;
    counts.reserve(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      counts.push_back(nodes_of_side(reading_.mesh.cells.shapes[cells[i]],
                                     reading_.mesh.cells.vertex_count(cells[i]), sides.side_of_entry[i],
                                     reading_.metadata->coordinates));
    }
    const int most = *std::max_element(counts.begin(), counts.end());
    int width = most;
    if (std::accumulate(counts.begin(), counts.end(), std::size_t{0}) != values) {
      width = static_cast<int>(values / cells.size());
      if (values % cells.size() != 0 || width == 0 || width == most) {
        reading_.notes.push_back(fmt::format("{} is left out: {} factors do not fit the nodes of {} sides",
                                             variable.name, values, cells.size()));
        return;
      }
      counts.assign(cells.size(), width);
    }
    set.factor_width = width;
    set.factors_by_nodes = width == most;
    const std::string name = set.in_mesh + std::string(kFactors);
    if (variable.type == kFloat) {
      const Values read = reading_.file.values(variable, {0}, {values});
      add_rows(name, sides.cells, packed(sides, std::get<std::vector<float>>(read), counts, width),
               sides.most_sides * width);
    } else {
      add_rows(name, sides.cells, packed(sides, reading_.file.reals(variable), counts, width),
               sides.most_sides * width);
    }
  }

  // ---- variables

  /// Reads all variables of a set; `add(values, name)` adds an array for one step and returns its name.
  template <class Add>
  void read_set_variables(std::size_t number, SetRecord& set, std::size_t members, const Add& add) {
    for (std::size_t v = 0; v < family_.variables.size(); ++v) {
      const Variable* const variable = reading_.take(name_of_values(v, number));
      if (variable == nullptr) continue;
      const std::size_t steps = reading_.metadata->steps;
      reading_.require_shape(*variable, {steps, members});
      Series& series = set.variables[v];
      series.type = variable->type;
      const std::string name = fmt::format("{} on {}", family_.variables[v], title(kind_, set.in_mesh));
      for (std::size_t step = 0; step < steps; ++step) {
        series.arrays.push_back(
            add(reading_.file.values(*variable, {step, 0}, {1, members}), name_of_step(name, step, steps)));
      }
    }
  }

  Reading& reading_;
  const SetKind& kind_;
  SetFamily& family_;
  bool is_sides_;
};

// ---- variables of nodes and elements

/// Returns the values as 32-bit integers if the array is one of labels, which other formats have as integers.
Values as_labels(const std::string& name, Values values) {
  const auto* const reals = std::get_if<std::vector<double>>(&values);
  if (name != kLabel || reals == nullptr) return values;
  const bool whole = std::all_of(reals->begin(), reals->end(), [](double value) {
    return value == std::trunc(value) && std::abs(value) < 2147483648.0;
  });
  if (!whole) return values;
  return std::vector<std::int32_t>(reals->begin(), reals->end());
}

std::string name_or_number(const std::string& name, std::size_t v) {
  return name.empty() ? "variable " + std::to_string(v + 1) : name;
}

void read_nodal(Reading& reading) {
  const NcInput& file = reading.file;
  Metadata& metadata = *reading.metadata;
  const std::size_t nodes = reading.mesh.points.size();
  const std::size_t count = file.count("num_nod_var");
  const std::vector<std::string> names = reading.take_names("name_nod_var", count);
  const Variable* const together = reading.take("vals_nod_var");
  metadata.packs_nodal = together != nullptr;
  if (together != nullptr) reading.require_shape(*together, {metadata.steps, count, nodes});
  for (std::size_t v = 0; v < count; ++v) {
    Series series{.name = names[v]};
    const Variable* const variable =
        together != nullptr ? together : reading.take(fmt::format("vals_nod_var{}", v + 1));
    const std::vector<std::size_t> shape =
        variable == nullptr ? std::vector<std::size_t>() : file.shape(*variable);
    const bool is_vector = together == nullptr && shape.size() == 3;  // as meshio writes them
    if (variable != nullptr && together == nullptr) {
      reading.require_shape(*variable, is_vector ? std::vector{metadata.steps, nodes, shape[2]}
                                                 : std::vector{metadata.steps, nodes});
    }
    if (variable != nullptr) series.type = variable->type;
    series.declared = {variable != nullptr};
    for (std::size_t step = 0; variable != nullptr && step < metadata.steps; ++step) {
      const Values values = together != nullptr ? file.values(*together, {step, v, 0}, {1, 1, nodes})
                            : is_vector         ? file.values(*variable, {step, 0, 0}, {1, nodes, shape[2]})
                                                : file.values(*variable, {step, 0}, {1, nodes});
      const std::string name = name_of_step(name_or_number(names[v], v), step, metadata.steps);
      series.arrays.push_back(reading.add_array({.name = name,
                                                 .components = is_vector ? static_cast<Index>(shape[2]) : 1,
                                                 .values = as_labels(name, values)}));
    }
    // a vector is written as scalar variables, as the format has them
    if (!is_vector) metadata.nodal.push_back(std::move(series));
  }
}

/// Appends values; as real numbers if they are not of one type.
void append(Values& to, Values&& values) {
  if (std::visit([](const auto& all) { return all.empty(); }, to)) {
    to = std::move(values);
    return;
  }
  const auto as_reals = [](const Values& from) {
    return std::visit(
        [](const auto& all) -> std::vector<double> {
          using Number = typename std::decay_t<decltype(all)>::value_type;
          if constexpr (std::is_arithmetic_v<Number>) {
            return {all.begin(), all.end()};
          } else {
            return {};
          }
        },
        from);
  };
  if (to.index() != values.index()) {
    to = as_reals(to);
    values = as_reals(values);
  }
  std::visit(
      [&](auto& all) {
        const auto& more = std::get<std::decay_t<decltype(all)>>(values);
        all.insert(all.end(), more.begin(), more.end());
      },
      to);
}

void read_elemental(Reading& reading) {
  const NcInput& file = reading.file;
  Metadata& metadata = *reading.metadata;
  const std::size_t count = file.count("num_elem_var");
  const std::vector<std::string> names = reading.take_names("name_elem_var", count);
  const std::size_t blocks = metadata.blocks.size();
  (void)file.claimed("the table of variables", count, bytes_for(blocks, sizeof(Series)));
  const std::vector<std::int64_t> table = read_table(reading, "elem", blocks, count);
  for (std::size_t v = 0; v < count; ++v) {
    Series series{.name = names[v]};
    std::vector<const Variable*> of_block(blocks, nullptr);
    std::vector<Index> rows;
    for (std::size_t b = 0; b < blocks; ++b) {
      of_block[b] = reading.take(fmt::format("vals_elem_var{}eb{}", v + 1, b + 1));
      series.declared.push_back(of_block[b] != nullptr);
      series.present.push_back(table.empty() ? of_block[b] != nullptr : table[b * count + v] != 0);
      if (of_block[b] == nullptr) continue;
      const Index first = reading.block_ends[b];
      const Index end = reading.block_ends[b + 1];
      reading.require_shape(*of_block[b], {metadata.steps, static_cast<std::size_t>(end - first)});
      series.type = rows.empty() || series.type == of_block[b]->type ? of_block[b]->type : kDouble;
      for (Index c = first; c < end; ++c) rows.push_back(c);
    }
    bool keeps_digits = true;
    const bool covers_all = index_size(rows) == reading.mesh.cell_count();
    for (std::size_t step = 0; step < metadata.steps && !rows.empty(); ++step) {
      DataArray array{.name = name_of_step(name_or_number(names[v], v), step, metadata.steps),
                      .association = Association::cells};
      for (std::size_t b = 0; b < blocks; ++b) {
        if (of_block[b] == nullptr) continue;
        const auto elements = static_cast<std::size_t>(reading.block_ends[b + 1] - reading.block_ends[b]);
        Values values = file.values(*of_block[b], {step, 0}, {1, elements});
        keeps_digits = keeps_digits && (series.type != kDouble || can_hold(kDouble, values));
        append(array.values, std::move(values));
      }
      array.values = as_labels(array.name, std::move(array.values));
      if (!covers_all) array.indices = rows;
      series.arrays.push_back(reading.add_array(std::move(array)));
    }
    if (!keeps_digits) {
      reading.notes.push_back(fmt::format(
          "the variable '{}' loses digits: its blocks have whole and real numbers, which become real "
          "numbers of 53 bits",
          name_or_number(names[v], v)));
    }
    metadata.elements.push_back(std::move(series));
  }
}

}  // namespace

void read_sets(Reading& reading) {
  for (std::size_t kind = 0; kind < kSetKinds.size(); ++kind) SetReader(reading, kind).read();
}

void read_variables(Reading& reading) {
  read_nodal(reading);
  read_elemental(reading);
}

}  // namespace meshorder::exodus
