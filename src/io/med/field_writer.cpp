// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/exact_values.hpp"
#include "io/med/med.hpp"
#include "io/names.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <type_traits>
#include <variant>

// Writes fields, and the profiles that list the items with values.

namespace meshorder::med {
namespace {

/// The type of a new field's values.
struct ValueType {
  std::int64_t number;      ///< attribute TYP of a field
  std::size_t alternative;  ///< index of an alternative of Values
};
constexpr ValueType kReals{6, 0};
constexpr ValueType kIntegers{24, 6};
constexpr ValueType kLongIntegers{26, 8};

/// Returns a name, changed if HDF5 or MED would not allow it.
std::string clean_name(const std::string& given) {
  const std::string plain = plain_name(utf8(given), "/");
  std::string name(utf8_prefix(plain, kLongestName));
  if (name.empty() || name == "." || name == "..") return "array";
  return name;
}

/// Rows of an array for some vertices, or for some cells of a type.
struct Rows {
  std::vector<Index> places;  ///< positions among the vertices or cells of the type, from 0, ascending
  std::vector<Index> rows;    ///< row of the array for each position
};

/// The profiles of a file that is being written.
class Profiles {
 public:
  explicit Profiles(Writing& writing) : writing_(writing) {
    for (const Piece& piece : writing.layout.pieces) {
      if (piece.profile != kNoProfile) old_.insert(piece.profile);
    }
  }

  /// Returns the name of a profile with these places: the wanted name unless another profile has that name.
  /// Writes the profile if it is new.
  std::string name_for(const std::string& wanted, const std::vector<Index>& places) {
    const std::string clean = clean_name(wanted);
    std::string name = clean;
    for (int k = 2;; ++k) {
      const auto known = written_.find(name);
      if (known != written_.end() && known->second == places) return name;
      const bool is_free =
          known == written_.end() && (old_.contains(name) || !writing_.file.has("/PROFILS/" + name));
      if (is_free) break;
      const std::string number = fmt::format("_{}", k);
      name = std::string(utf8_prefix(clean, kLongestName - number.size())) + number;
    }
    std::vector<Index> numbers = places;
    for (Index& number : numbers) ++number;
    writing_.file.make_group("/PROFILS/" + name);
    writing_.file.set_attribute("/PROFILS/" + name, "NBR", std::int64_t{std::ssize(numbers)});
    writing_.file.write(profile_path(name), std::span<const Index>(numbers), {numbers.size()});
    written_.emplace(name, places);
    return name;
  }

  /// Removes the profiles of the old file that no field uses any more.
  void remove_unused() {
    for (const std::string& name : old_) {
      if (!written_.contains(name)) writing_.file.remove("/PROFILS/" + name);
    }
  }

 private:
  Writing& writing_;
  std::set<std::string> old_;
  std::map<std::string, std::vector<Index>> written_;
};

/// An array that becomes one step of a new field.
struct Step {
  const DataArray* array;
  int number;  ///< number of the step, from 1; 0 for a field of one step
};

/// Splits "NAME step K" into NAME and K; returns nullopt for other names.
std::optional<std::pair<std::string, int>> split_step(const std::string& name) {
  constexpr std::string_view kWord = " step ";
  const std::size_t at = name.rfind(kWord);
  if (at == std::string::npos || at == 0) return {};
  int number = 0;
  const char* const begin = name.data() + at + kWord.size();
  const char* const end = name.data() + name.size();
  const auto [stop, fault] = std::from_chars(begin, end, number);
  if (fault != std::errc() || stop != end || number < 1 || begin == end) return {};
  return std::pair(name.substr(0, at), number);
}

class FieldWriter {
 public:
  explicit FieldWriter(Writing& writing) : writing_(writing), profiles_(writing) {}

  void write() {
    for (const Piece& piece : writing_.layout.pieces) write_piece(piece);
    for (const std::string& name : writing_.file.names("/CHA")) (void)names_.take(name);
    write_new_fields();
    profiles_.remove_unused();
    if (!writing_.file.has("/CHA")) writing_.file.make_group("/CHA");
  }

 private:
  [[nodiscard]] std::size_t items_of(const GeometryType* type) const {
    return static_cast<std::size_t>(range_in(writing_.ranges, type).count);
  }

  /// Returns the rows that an array has for vertices or for the cells of a type.
  Rows rows_of(const DataArray& array, const GeometryType* type) {
    if (last_array_ != &array) {
      table_ = rows_by_item(array, item_count(writing_.mesh, array.association));
      last_array_ = &array;
    }
    Rows result;
    const auto [first, count] = range_in(writing_.ranges, type);
    result.places.reserve(items_of(type));
    result.rows.reserve(items_of(type));
    for (Index i = 0; i < count; ++i) {
      const Index row = table_.empty() ? first + i : table_[first + i];
      if (row < 0) continue;
      result.places.push_back(i);
      result.rows.push_back(row);
    }
    return result;
  }

  /// Returns the values of some rows in the order of the file, as numbers of an alternative of Values.
  [[nodiscard]] Values values_of(const DataArray& array, const Rows& rows, const Piece& piece,
                                 std::size_t alternative) const {
    const std::span<const int> order = writing_.layout.order_of_points(piece);
    const std::size_t width = piece.points * piece.components;
    return values_of_type(alternative, [&]<class Number>(std::vector<Number>& result) {
      if constexpr (std::is_arithmetic_v<Number>) {
        result.reserve(rows.rows.size() * width);
        with_numbers(array.values, [&](const auto& values) {
          for (std::size_t c = 0; c < piece.components; ++c) {
            for (const Index row : rows.rows) {
              const auto* const of_row = values.data() + row * width + c;
              for (std::size_t p = 0; p < piece.points; ++p) {
                const std::size_t place = order.empty() ? p : static_cast<std::size_t>(order[p]);
                result.push_back(static_cast<Number>(of_row[place * piece.components]));
              }
            }
          }
        });
      }
    });
  }

  /// Returns the name of the profile for these rows, made from `old`. If `old` is kNoProfile: kNoProfile if
  /// all items have rows, else a name made from the field's.
  std::string profile_for(const std::string& old, const Rows& rows, const Piece& piece) {
    if (old != kNoProfile) return profiles_.name_for(old, rows.places);
    if (rows.rows.size() == items_of(piece.type)) return old;
    const std::string suffix = fmt::format("_{}", piece.type == nullptr ? "NOE" : piece.type->name);
    return profiles_.name_for(std::string(utf8_prefix(piece.field, kLongestName - suffix.size())) + suffix,
                              rows.places);
  }

  // ---- fields of the file

  void write_piece(const Piece& piece) {
    const Association association = piece.type == nullptr ? Association::vertices : Association::cells;
    const DataArray* const array = find_array(writing_.mesh, piece.array, association);
    const std::string group = piece.support + "/" + piece.profile;
    const std::string path = group + "/CO";
    if (array == nullptr || are_texts(array->values) ||
        std::cmp_not_equal(array->components, piece.components * piece.points) ||
        array->values.index() != writing_.file.number_type(path)) {
      return remove_piece(piece);
    }
    writing_.placed.insert(array);
    const Rows rows = rows_of(*array, piece.type);
    if (rows.rows.empty()) return remove_piece(piece);
    const std::string profile = profile_for(piece.profile, rows, piece);
    const Values values = values_of(*array, rows, piece, array->values.index());
    writing_.file.write(path, values, {size_of(values)});
    const std::size_t count = piece.counts_profile ? rows.rows.size() : items_of(piece.type);
    writing_.file.set_attribute(group, "NBR", static_cast<std::int64_t>(count));
    if (profile == piece.profile) return;
    if (writing_.file.text_attribute(piece.support, "PFL").value_or("") == piece.profile)
      writing_.file.set_attribute(piece.support, "PFL", profile);
    writing_.file.move(group, piece.support + "/" + profile);
  }

  /// Removes values that the mesh no longer has, and the groups around them that become empty.
  void remove_piece(const Piece& piece) {
    std::string group = piece.support + "/" + piece.profile;
    constexpr std::size_t kGroups = 4;  // profile, support, step and field
    for (std::size_t k = 0; k < kGroups; ++k) {
      writing_.file.remove(group);
      group.resize(group.rfind('/'));
      if (!writing_.file.names(group).empty()) return;
    }
  }

  // ---- new fields

  void write_new_fields() {
    std::map<std::pair<Association, std::string>, std::vector<Step>> series;
    for (const DataArray& array : writing_.mesh.data) {
      if (!is_new(array)) continue;
      if (const auto step = split_step(array.name))
        series[{array.association, step->first}].push_back({&array, step->second});
    }
    for (const DataArray& array : writing_.mesh.data) {
      if (!is_new(array)) continue;
      const auto step = split_step(array.name);
      if (!step) {
        write_field(array.name, {{&array, 0}});
        continue;
      }
      const std::vector<Step>& steps = series[{array.association, step->first}];
      if (!are_steps(steps)) {
        write_field(array.name, {{&array, 0}});
      } else if (steps.front().array == &array) {
        write_field(step->first, steps);
      }
    }
  }

  [[nodiscard]] bool is_new(const DataArray& array) const {
    return !are_texts(array.values) && !writing_.placed.contains(&array);
  }

  /// Returns whether arrays are steps 1, 2, … of one field.
  static bool are_steps(const std::vector<Step>& steps) {
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const DataArray& first = *steps.front().array;
      const DataArray& array = *steps[k].array;
      const bool fits = steps[k].number == static_cast<int>(k) + 1 && array.components == first.components &&
                        array.values.index() == first.values.index();
      if (!fits) return false;
    }
    return steps.size() > 1;
  }

  std::string unused_name(const DataArray& array, const std::string& wanted) {
    std::string name = names_.take(clean_name(wanted));
    if (name != wanted) {
      writing_.notes.push_back(fmt::format("the array '{}' on {} is written as the field '{}'", array.name,
                                           to_string(array.association), name));
    }
    return name;
  }

  /// Returns the type for the values of all steps, whose arrays have one number type.
  ValueType type_of(const std::vector<Step>& steps) {
    const DataArray& first = *steps.front().array;
    if (!are_integers(first.values)) return kReals;
    if (first.values.index() <= kIntegers.alternative) return kIntegers;
    const bool fit = std::all_of(steps.begin(), steps.end(), [](const Step& step) {
      return are_exact<std::int64_t>(step.array->values);
    });
    if (fit) return kLongIntegers;
    writing_.notes.push_back(
        fmt::format("the array '{}' loses digits: whole numbers above 9,223,372,036,854,775,807 are written "
                    "as real ones",
                    first.name));
    return kReals;
  }

  std::string component_names(const DataArray& array) {
    std::string names;
    bool is_cut = false;
    for (Index k = 0; k < array.components; ++k) {
      std::string name;
      if (!array.component_names.empty()) name = array.component_names[static_cast<std::size_t>(k)];
      is_cut = is_cut || name.size() > kShortName;
      name = utf8_prefix(name, kShortName);
      name.resize(kShortName, ' ');
      names += name;
    }
    if (is_cut) {
      writing_.notes.push_back(fmt::format("the names of the components of '{}' are cut to {} characters",
                                           array.name, kShortName));
    }
    return names;
  }

  void write_field(const std::string& wanted, const std::vector<Step>& steps) {
    const DataArray& first = *steps.front().array;
    const std::string name = unused_name(first, wanted);
    const std::string path = "/CHA/" + name;
    const ValueType type = type_of(steps);
    hdf5::File& file = writing_.file;
    file.make_group(path, hdf5::File::LinkOrder::made);
    file.set_attribute(path, "MAI", writing_.layout.mesh);
    file.set_attribute(path, "NCO", std::int64_t{first.components});
    file.set_attribute(path, "NOM", component_names(first));
    file.set_attribute(path, "UNI",
                       std::string(kShortName * static_cast<std::size_t>(first.components), ' '));
    file.set_attribute(path, "UNT", std::string());
    file.set_attribute(path, "TYP", type.number);
    for (const Step& step : steps) write_step(name, path, step, type);
  }

  void write_step(const std::string& name, const std::string& path, const Step& step, const ValueType& type) {
    hdf5::File& file = writing_.file;
    const int number = step.number == 0 ? -1 : step.number;
    const std::string group = fmt::format("{}/{:020d}{:020d}", path, number, -1);
    const std::string mesh_step = writing_.layout.step_path();
    file.make_group(group);
    set_attributes(file, group, {{"NDT", number}, {"NOR", -1}});
    file.set_attribute(group, "PDT", static_cast<double>(step.number));
    set_attributes(file, group,
                   {{"RDT", file.integer_attribute(mesh_step, "NDT").value_or(-1)},
                    {"ROR", file.integer_attribute(mesh_step, "NOR").value_or(-1)}});
    const bool on_vertices = step.array->association == Association::vertices;
    for (const auto& [geometry, range] : writing_.ranges) {
      if (on_vertices != (geometry == nullptr)) continue;
      const std::string support = on_vertices ? "/NOE" : fmt::format("/MAI.{}", geometry->name);
      write_support({.field = name,
                     .support = group + support,
                     .type = geometry,
                     .components = static_cast<std::size_t>(step.array->components)},
                    *step.array, type);
    }
  }

  /// Writes the values of a new field for vertices or for the cells of a type.
  void write_support(const Piece& piece, const DataArray& array, const ValueType& type) {
    const Rows rows = rows_of(array, piece.type);
    if (rows.rows.empty()) return;
    hdf5::File& file = writing_.file;
    const std::string profile = profile_for(std::string(kNoProfile), rows, piece);
    const std::string group = piece.support + "/" + profile;
    file.make_group(group);
    file.set_attribute(piece.support, "GAU", std::string());
    file.set_attribute(piece.support, "PFL", profile);
    set_attributes(file, group, {{"NBR", static_cast<std::int64_t>(items_of(piece.type))}, {"NGA", 1}});
    file.set_attribute(group, "GAU", std::string());
    const Values values = values_of(array, rows, piece, type.alternative);
    file.write(group + "/CO", values, {size_of(values)});
  }

  Writing& writing_;
  Profiles profiles_;
  DistinctNames names_{kLongestName};  // names of fields
  const DataArray* last_array_ = nullptr;
  std::vector<Index> table_;  // rows of `last_array_` by item
};

}  // namespace

void write_fields(Writing& writing) { FieldWriter(writing).write(); }

}  // namespace meshorder::med
