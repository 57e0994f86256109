// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/memory.hpp"
#include "io/exodus/exodus.hpp"
#include "io/exodus/reading.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

// Reads sets of nodes, sides and elements with their distribution factors, and variables over the steps.

namespace meshorder::exodus {
namespace {

/// The entries of a set's list whose members are in the range that is read.
struct Entries {
  std::vector<Index> places;   ///< positions in the list, ascending
  std::vector<Index> members;  ///< positions in the range
  std::vector<int> sides;      ///< sides from 1; always 1 in sets of nodes and elements
  // first factor and number of nodes of each entry, for side sets with a factor for each node of a side
  std::vector<Offset> first_factors;
  std::vector<int> nodes;
  Offset factors = 0;  ///< number of factors of all entries of the list, read or not
  int most_nodes = 0;  ///< largest number of nodes of an entry of the list, read or not
};

/// The members of a set, each once, in the order of their first entries.
struct Members {
  std::vector<Index> members;
  std::vector<Index> places;        ///< position of each member's first entry
  std::vector<std::int32_t> masks;  ///< sides of each member: bit s − 1 for side s
  std::vector<Index> row_of_entry;  ///< index of each entry's member in `members`; −1 for a repeated entry
  int most_sides = 1;               ///< largest number of sides of a member
};

std::int32_t bit_of_side(int side) { return 1 << (side - 1); }

int bit_count(std::int32_t mask) { return std::popcount(static_cast<std::uint32_t>(mask)); }

/// Returns the members of a set. Drops an entry if an earlier entry has the same member and side.
Members without_repeated(const Entries& own, bool are_sides) {
  const Index count = index_size(own.members);
  std::vector<Index> entries = index_range(0, count);
  std::stable_sort(entries.begin(), entries.end(),
                   [&](Index a, Index b) { return own.members[a] < own.members[b]; });
  Members result;
  // for each entry, find the first entry with the same member
  std::vector<Index>& rows = result.row_of_entry;
  rows.resize(own.members.size());
  for (Index i = 0; i < count; ++i) {
    const bool is_first = i == 0 || own.members[entries[i]] != own.members[entries[i - 1]];
    rows[entries[i]] = is_first ? entries[i] : rows[entries[i - 1]];
  }
  for (Index i = 0; i < count; ++i) {
    if (rows[i] == i) {
      rows[i] = index_size(result.members);
      result.members.push_back(own.members[i]);
      result.places.push_back(own.places[i]);
      result.masks.push_back(0);
    } else {
      rows[i] = rows[rows[i]];
    }
    std::int32_t& mask = result.masks[rows[i]];
    const std::int32_t bit = bit_of_side(own.sides[i]);
    if ((mask & bit) != 0) rows[i] = -1;
    mask |= bit;
  }
  if (are_sides) result.most_sides = 0;
  for (const std::int32_t mask : result.masks)
    result.most_sides = std::max(result.most_sides, bit_count(mask));
  return result;
}

/// Returns the truth table of the file, row by row: whether a block or set (row) has values of a variable
/// (column). Empty if the file has no table.
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
    family_.properties = read_records(reading_, prefix, family_.sets, family_.has_names);
    const std::string of(kind_.variable);
    family_.variables = reading_.take_names("name_" + of + "_var", file.count("num_" + of + "_var"));
    const std::vector<std::int64_t> table = read_table(reading_, of, count, family_.variables.size());
    (void)file.claimed(
        "the records of " + prefix, count,
        sizeof(SetRecord) + family_.variables.size() * 2 * sizeof(Series));  // doubled for arrays
    for (std::size_t s = 0; s < count; ++s) {
      SetRecord& set = family_.sets[s];
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
  /// Returns the name of the netCDF variable of set variable `v` (from 0) on set `set` (from 1).
  [[nodiscard]] std::string name_of_values(std::size_t v, std::size_t set) const {
    return fmt::format("vals_{}_var{}{}{}", kind_.variable, v + 1, kind_.prefix, set);
  }

  /// Returns the position, from 0, of node or element `number`. Throws InputError if it does not exist.
  [[nodiscard]] Index place_of(std::int32_t number, const Variable& variable, std::size_t entry) const {
    const auto limit = static_cast<std::uint32_t>(reading_.count(kind_.association));
    const std::uint32_t place = static_cast<std::uint32_t>(number) - 1;
    if (place >= limit) {
      const char* const what = kind_.association == Association::vertices ? "node" : "element";
      reading_.file.fail(
          fmt::format("{}, entry {}: {} {} does not exist", variable.name, entry + 1, what, number),
          fmt::format("the {}s are 1 to {}", what, limit));
    }
    return static_cast<Index>(place);
  }

  void read_set(std::size_t number, SetRecord& set) {
    const Variable* const variable = reading_.take(fmt::format("{}{}", kind_.members, number));
    set.in_mesh = set.name.empty() ? std::string(kind_.word) + std::to_string(set.id) : set.name;
    if (variable == nullptr) return add_empty(set);
    set.type = variable->type;
    const Variable* const sides = is_sides_ ? reading_.take(fmt::format("side_ss{}", number)) : nullptr;
    if (is_sides_ && sides == nullptr) {
      reading_.file.fail(fmt::format("side_ss{} is missing", number), "a side set names elements and sides");
    }
    const std::size_t size = reading_.file.size(*variable);
    if (size == 0) return add_empty(set);
    if (is_sides_) reading_.require_shape(*sides, {size});
    const Entries own = read_entries(*variable, sides);
    const Members members = without_repeated(own, is_sides_);
    note_repeated(set, size, members.row_of_entry);
    if (is_sides_) {
      set.in_mesh = add_rows(title(kind_, set.in_mesh), members, members.masks);
    } else {
      MeshPart::SetRows rows;
      if (!reading_.is_whole()) rows = {static_cast<Index>(size), members.places};
      set.in_mesh = reading_.add_set({set.in_mesh, kind_.association, members.members}, std::move(rows));
    }
    if (const Variable* const factors = reading_.take(fmt::format("dist_fact_{}{}", kind_.prefix, number)))
      read_factors(set, size, own, members, *factors);
    read_set_variables(number, set, size, own, members);
  }

  /// Adds a set without members. An empty side set gets no array.
  void add_empty(SetRecord& set) {
    set.in_mesh = is_sides_ ? "" : reading_.add_set({set.in_mesh, kind_.association, {}});
  }

  /// Notes that repeated entries are dropped. If only a part of the mesh is read, records the counts for the
  /// caller instead.
  void note_repeated(const SetRecord& set, std::size_t size, const std::vector<Index>& row_of_entry) {
    const std::string name = title(kind_, set.in_mesh);
    const auto repeated = std::count(row_of_entry.begin(), row_of_entry.end(), Index{-1});
    if (!reading_.is_whole()) {
      const auto kept = static_cast<Index>(std::ssize(row_of_entry) - repeated);
      reading_.part.lists.push_back({name, static_cast<Index>(size), kept});
    } else if (repeated > 0) {
      reading_.notes.push_back(note_of_repeated(name, static_cast<std::size_t>(repeated)));
    }
  }

  /// Throws InputError if elements of the block have no side of that number.
  void require_side(const BlockRecord& block, std::int64_t side, const Variable& variable,
                    std::size_t entry) const {
    const bool known = side >= 1 && side <= kMostSides &&
                       nodes_of_side(block.shape, block.nodes, static_cast<int>(side), 2) > 0;
    if (known) return;
    reading_.file.fail(fmt::format("{}, entry {}: a {} has no side {}", variable.name, entry + 1,
                                   to_string(block.shape), side),
                       "sides are counted from 1");
  }

  /// Reads the entries of a list of nodes or elements, in chunks. `side_numbers`: the sides of a side set,
  /// null for other sets.
  [[nodiscard]] Entries read_entries(const Variable& variable, const Variable* side_numbers) const {
    const NcInput& file = reading_.file;
    const MeshRange range = reading_.range(kind_.association);
    if (file.shape(variable).size() != 1) file.fail(variable.name + " is not a list");
    // counted twice: for the list and for the set
    const std::size_t count = file.claimed(variable.name, file.size(variable), 2 * sizeof(Index));
    Entries own;
    std::vector<std::int32_t> numbers;
    for (std::size_t first = 0; first < count; first += numbers.size()) {
      numbers.resize(std::min(reading_.values_at_once(), count - first));
      file.read(variable, {first}, {numbers.size()}, numbers.data());
      std::vector<std::int64_t> sides;
      if (is_sides_) sides = file.integers(*side_numbers, {first}, {numbers.size()});
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        const Index member = place_of(numbers[i], variable, first + i);
        int side = 1;
        int nodes = 1;
        if (is_sides_) {
          const BlockRecord& block = reading_.block_of(member);
          require_side(block, sides[i], *side_numbers, first + i);
          side = static_cast<int>(sides[i]);
          const int faces = faces_of(block.shape, block.type, reading_.metadata->coordinates);
          nodes = nodes_of_side(block.shape, block.nodes, side, faces);
        }
        if (range.contains(member)) {
          own.places.push_back(static_cast<Index>(first + i));
          own.members.push_back(member - range.first);
          own.sides.push_back(side);
          own.first_factors.push_back(own.factors);
          own.nodes.push_back(nodes);
        }
        own.factors += nodes;
        own.most_nodes = std::max(own.most_nodes, nodes);
      }
    }
    return own;
  }

  // ---- values of members

  /// Adds an array with a row for each member; returns the array's name.
  std::string add_rows(const std::string& name, const Members& set, Values values, int components = 1) {
    return reading_.add_array({.name = name,
                               .association = kind_.association,
                               .components = components,
                               .values = std::move(values),
                               .indices = set.members},
                              {true, reading_.is_whole() ? std::vector<Index>() : set.places});
  }

  /// Where the values of an entry are in a list of values.
  struct Piece {
    Offset begin;
    int length;
  };

  /// Adds an array with a row for each member: the values of its sides, in ascending order of sides, `width`
  /// for each, padded with missing values.
  ///
  /// @param piece_of  returns the piece of entry i; the pieces ascend
  /// @param read      `read(first, count)` returns `count` values of the list from `first` on. Pieces that
  ///                  lie within `values_at_once` values are read together
  template <class PieceOf, class Read>
  std::string add_values(const std::string& name, const Entries& own, const Members& set, int width,
                         const PieceOf& piece_of, const Read& read) {
    const int components = set.most_sides * width;
    const auto place_of_entry = [&](std::size_t i) {
      const Index row = set.row_of_entry[i];
      const int rank = bit_count(set.masks[row] & (bit_of_side(own.sides[i]) - 1));
      return Offset{row} * components + Offset{rank} * width;
    };
    const auto end_of = [&](std::size_t i) { return piece_of(i).begin + piece_of(i).length; };
    Values result = read(std::size_t{0}, std::size_t{0});
    with_numbers(result, [&]<class Number>(std::vector<Number>& values) {
      values.assign(set.members.size() * static_cast<std::size_t>(components), missing_value<Number>());
    });
    const std::size_t count = set.row_of_entry.size();
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
      const Offset from = piece_of(begin).begin;
      for (end = begin + 1; end < count; ++end) {
        if (static_cast<std::size_t>(end_of(end) - from) > reading_.values_at_once()) break;
      }
      const Values some =
          read(static_cast<std::size_t>(from), static_cast<std::size_t>(end_of(end - 1) - from));
      with_numbers(result, [&]<class Number>(std::vector<Number>& values) {
        const auto& found = std::get<std::vector<Number>>(some);
        for (std::size_t i = begin; i < end; ++i) {
          if (set.row_of_entry[i] < 0) continue;
          const auto [at, length] = piece_of(i);
          std::copy_n(found.begin() + (at - from), length, values.begin() + place_of_entry(i));
        }
      });
    }
    return add_rows(name, set, std::move(result), components);
  }

  /// Adds an array of the factors of a set. A set of nodes or elements has a factor for each entry. A side
  /// set has a factor for each node of a side, or the same number of factors for each side; other lists are
  /// left out with a note.
  void read_factors(SetRecord& set, std::size_t size, const Entries& own, const Members& members,
                    const Variable& variable) {
    if (!is_sides_) reading_.require_shape(variable, {size});
    const std::size_t values = reading_.file.size(variable);
    set.factor_type = variable.type;
    const bool by_nodes = static_cast<std::size_t>(own.factors) == values;
    const int width = by_nodes ? own.most_nodes : static_cast<int>(values / size);
    if (!by_nodes && (values % size != 0 || width == 0 || width == own.most_nodes)) {
      reading_.notes.push_back(fmt::format("{} is left out: {} factors do not fit the nodes of {} sides",
                                           variable.name, values, size));
      return;
    }
    set.factor_width = width;
    set.factors_by_nodes = by_nodes;
    const auto piece_of = [&](std::size_t i) {
      return by_nodes ? Piece{own.first_factors[i], own.nodes[i]}
                      : Piece{Offset{own.places[i]} * width, width};
    };
    add_values(title(kind_, set.in_mesh) + std::string(kFactors), own, members, width, piece_of,
               [&](std::size_t first, std::size_t count) -> Values {
                 if (!is_sides_ || variable.type == kFloat)
                   return reading_.file.values(variable, {first}, {count});
                 return reading_.file.reals(variable, {first}, {count});
               });
  }

  /// Adds an array for each set variable and each step.
  void read_set_variables(std::size_t number, SetRecord& set, std::size_t size, const Entries& own,
                          const Members& members) {
    for (std::size_t v = 0; v < family_.variables.size(); ++v) {
      const Variable* const variable = reading_.take(name_of_values(v, number));
      if (variable == nullptr) continue;
      const std::size_t steps = reading_.metadata->steps;
      reading_.require_shape(*variable, {steps, size});
      Series& series = set.variables[v];
      series.type = variable->type;
      const std::string name = fmt::format("{} on {}", family_.variables[v], title(kind_, set.in_mesh));
      for (std::size_t step = 0; step < steps; ++step) {
        series.arrays.push_back(add_values(
            name_of_step(name, step, steps), own, members, 1,
            [&](std::size_t i) {
              return Piece{own.places[i], 1};
            },
            [&](std::size_t first, std::size_t count) {
              return reading_.file.values(*variable, {step, first}, {1, count});
            }));
      }
    }
  }

  Reading& reading_;
  const SetKind& kind_;
  SetFamily& family_;
  bool is_sides_;
};

// ---- nodal and element variables

/// Converts labels that are whole numbers to 32-bit integers, as other formats have them. Returns other
/// values unchanged.
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

}  // namespace

void read_sets(Reading& reading) {
  for (std::size_t kind = 0; kind < kSetKinds.size(); ++kind) SetReader(reading, kind).read();
}

void read_nodal(Reading& reading) {
  const NcInput& file = reading.file;
  ExodusMetadata& metadata = *reading.metadata;
  const auto nodes = static_cast<std::size_t>(reading.nodes);
  const auto [first, rows] = reading.rows(Association::vertices);
  const std::size_t count = file.count("num_nod_var");
  const std::vector<std::string> names = reading.take_names("name_nod_var", count);
  const Variable* const together = reading.take("vals_nod_var");
  metadata.packs_nodal = together != nullptr;
  if (together != nullptr) reading.require_shape(*together, {metadata.steps, count, nodes});
  for (std::size_t v = 0; v < count; ++v) {
    Series series{.name = names[v]};
    const Variable* const variable =
        together != nullptr ? together : reading.take(fmt::format("vals_nod_var{}", v + 1));
    series.declared = {variable != nullptr};
    std::vector<std::size_t> starts{0, first};
    std::vector<std::size_t> counts{1, rows};
    Index components = 1;
    bool is_vector = false;
    if (together != nullptr) {
      starts = {0, v, first};
      counts = {1, 1, rows};
    } else if (variable != nullptr) {
      const std::vector<std::size_t> shape = file.shape(*variable);
      std::vector<std::size_t> expected{metadata.steps, nodes};
      is_vector = shape.size() == 3;  // meshio writes such vectors
      if (is_vector) {
        for (auto* const list : {&expected, &counts}) list->push_back(shape[2]);
        starts.push_back(0);
        components = static_cast<Index>(shape[2]);
      }
      reading.require_shape(*variable, expected);
    }
    if (variable != nullptr) series.type = variable->type;
    for (std::size_t& step = starts.front(); variable != nullptr && step < metadata.steps; ++step) {
      const std::string name = name_of_step(name_or_number(names[v], v), step, metadata.steps);
      series.arrays.push_back(
          reading.add_array({.name = name,
                             .components = components,
                             .values = as_labels(name, file.values(*variable, starts, counts))}));
    }
    // a vector gets no series: it is written as scalar variables, the only variables of the format
    if (!is_vector) metadata.nodal.push_back(std::move(series));
  }
}

namespace {

/// The netCDF variables that hold an element variable, for the blocks that have elements.
struct ElementVariable {
  std::vector<std::size_t> blocks;
  std::vector<const Variable*> of_block;
  bool is_of_one_type = true;
};

/// Finds the netCDF variables of element variable `v`, and fills in `series`. `table`: see `read_table`.
ElementVariable find_element_variable(Reading& reading, std::size_t v, const std::vector<std::int64_t>& table,
                                      std::size_t count, Series& series) {
  ElementVariable result;
  for (std::size_t b = 0; b < reading.metadata->blocks.size(); ++b) {
    const Variable* const variable = reading.take(fmt::format("vals_elem_var{}eb{}", v + 1, b + 1));
    series.declared.push_back(variable != nullptr);
    series.present.push_back(table.empty() ? variable != nullptr : table[b * count + v] != 0);
    if (variable == nullptr) continue;
    reading.require_shape(*variable, {reading.metadata->steps, reading.size_of_block(b)});
    series.type = result.blocks.empty() || series.type == variable->type ? variable->type : kDouble;
    if (reading.size_of_block(b) == 0) continue;
    result.blocks.push_back(b);
    result.of_block.push_back(variable);
    result.is_of_one_type = result.is_of_one_type && variable->type == result.of_block.front()->type;
  }
  return result;
}

/// Returns the values of an element variable at a step; as real numbers if blocks have different types.
/// `keeps_digits` becomes false if `type` is kDouble and cannot hold the values exactly.
Values values_at(const Reading& reading, const ElementVariable& variable, NcType type, std::size_t step,
                 bool& keeps_digits) {
  Values result;
  for (std::size_t i = 0; i < variable.blocks.size(); ++i) {
    const auto [first, rows] = reading.rows_of_block(variable.blocks[i]);
    Values values = reading.file.values(*variable.of_block[i], {step, first}, {1, rows});
    keeps_digits = keeps_digits && (type != kDouble || can_hold(kDouble, values));
    if (!variable.is_of_one_type) values = as_reals(values);
    if (i == 0) {
      result = std::move(values);
    } else {
      append_values(result, std::move(values));
    }
  }
  return result;
}

}  // namespace

void read_elemental(Reading& reading) {
  const NcInput& file = reading.file;
  ExodusMetadata& metadata = *reading.metadata;
  const std::size_t count = file.count("num_elem_var");
  const std::vector<std::string> names = reading.take_names("name_elem_var", count);
  const std::size_t blocks = metadata.blocks.size();
  (void)file.claimed("the table of variables", count, bytes_for(blocks, sizeof(Series)));
  const std::vector<std::int64_t> table = read_table(reading, "elem", blocks, count);
  for (std::size_t v = 0; v < count; ++v) {
    Series series{.name = names[v]};
    const std::string name = name_or_number(series.name, v);
    const ElementVariable variable = find_element_variable(reading, v, table, count, series);
    bool keeps_digits = true;
    for (std::size_t step = 0; step < metadata.steps && !variable.blocks.empty(); ++step) {
      const std::string of_step = name_of_step(name, step, metadata.steps);
      Values values = as_labels(of_step, values_at(reading, variable, series.type, step, keeps_digits));
      series.arrays.push_back(reading.add_array(of_step, std::move(values), variable.blocks));
    }
    if (!keeps_digits) {
      reading.notes.push_back(fmt::format(
          "the variable '{}' loses digits: its blocks have whole and real numbers, which become real "
          "numbers of 53 bits",
          name));
    }
    metadata.elements.push_back(std::move(series));
  }
}

}  // namespace meshorder::exodus
