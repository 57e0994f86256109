// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/med/med.hpp"
#include "io/names.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <type_traits>
#include <variant>

// Writes fields, and the profiles that list the items with values.

namespace meshorder::med {
namespace {

/// Numbers of the types of values: attribute TYP of a field.
constexpr std::int64_t kReals = 6;
constexpr std::int64_t kIntegers = 24;
constexpr std::int64_t kLongIntegers = 26;

bool is_text_array(const DataArray& array) {
  return std::holds_alternative<std::vector<std::string>>(array.values);
}

/// Returns a name, changed if HDF5 or MED would not allow it.
std::string clean_name(const std::string& given) {
  const std::string plain = plain_name(utf8(given), "/");
  std::string name(utf8_prefix(plain, kLongestName));
  if (name.empty() || name == "." || name == "..") return "array";
  return name;
}

/// Rows of an array that belong to some vertices or to cells of a type.
struct Rows {
  std::vector<Index> places;  ///< among the items, from 0, ascending
  std::vector<Index> rows;    ///< of the array
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
    std::vector<std::int64_t> numbers(places.begin(), places.end());
    for (std::int64_t& number : numbers) ++number;
    const std::string path = profile_path(name);
    writing_.file.make_group("/PROFILS/" + name);
    writing_.file.set_attribute("/PROFILS/" + name, "NBR", static_cast<std::int64_t>(numbers.size()));
    const std::vector<std::int32_t> values(numbers.begin(), numbers.end());
    writing_.file.write(path, Values(values), {values.size()});
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
    for (const std::string& name : writing_.file.names("/CHA")) names_.insert(name);
    write_new_fields();
    profiles_.remove_unused();
    if (!writing_.file.has("/CHA")) writing_.file.make_group("/CHA");
  }

 private:
  [[nodiscard]] std::size_t items_of(const GeometryType* type) const {
    if (type == nullptr) return writing_.mesh.points.size();
    const auto found = writing_.cells.find(type);
    return found == writing_.cells.end() ? 0 : found->second.size();
  }

  /// Returns the rows that an array has for vertices or for the cells of a type.
  Rows rows_of(const DataArray& array, const GeometryType* type) {
    if (last_array_ != &array) {
      const bool on_vertices = array.association == Association::vertices;
      table_ = rows_by_item(array, on_vertices ? writing_.mesh.vertex_count() : writing_.mesh.cell_count());
      last_array_ = &array;
    }
    Rows result;
    const std::size_t count = items_of(type);
    result.places.reserve(count);
    result.rows.reserve(count);
    const std::vector<Index>* const cells =
        type == nullptr || count == 0 ? nullptr : &writing_.cells.at(type);
    for (std::size_t i = 0; i < count; ++i) {
      const Index item = cells == nullptr ? static_cast<Index>(i) : (*cells)[i];
      const Index row = table_.empty() ? item : table_[static_cast<std::size_t>(item)];
      if (row < 0) continue;
      result.places.push_back(static_cast<Index>(i));
      result.rows.push_back(row);
    }
    return result;
  }

  /// Returns the place of each point of a cell in the rows of an array.
  [[nodiscard]] std::span<const int> order_of_points(const Piece& piece) const {
    const bool by_node = piece.at_nodes && !writing_.layout.in_mesh_order &&
                         piece.points == static_cast<std::size_t>(piece.type->nodes);
    return by_node ? mesh_order(*piece.type) : std::span<const int>();
  }

  /// Returns the values of some rows in the order of the file, as numbers of one type.
  template <class Number>
  [[nodiscard]] std::vector<Number> values_of(const DataArray& array, const Rows& rows,
                                              const Piece& piece) const {
    const std::span<const int> order = order_of_points(piece);
    const std::size_t width = piece.points * piece.components;
    std::vector<Number> result;
    result.reserve(rows.rows.size() * width);
    with_numbers(array.values, [&](const auto& values) {
      for (std::size_t c = 0; c < piece.components; ++c) {
        if (piece.points == 1 && order.empty()) {
          for (const Index row : rows.rows)
            result.push_back(static_cast<Number>(values[static_cast<std::size_t>(row) * width + c]));
          continue;
        }
        for (const Index row : rows.rows) {
          for (std::size_t p = 0; p < piece.points; ++p) {
            const std::size_t place = order.empty() ? p : static_cast<std::size_t>(order[p]);
            const std::size_t from = static_cast<std::size_t>(row) * width + place * piece.components + c;
            result.push_back(static_cast<Number>(values[from]));
          }
        }
      }
    });
    return result;
  }

  // ---- fields of the file

  void write_piece(const Piece& piece) {
    const Association association = piece.type == nullptr ? Association::vertices : Association::cells;
    const DataArray* const array = find_array(writing_.mesh, piece.array, association);
    const std::string group = piece.support + "/" + piece.profile;
    const std::string path = group + "/CO";
    if (array == nullptr || is_text_array(*array) ||
        static_cast<std::size_t>(array->components) != piece.components * piece.points ||
        array->values.index() != writing_.file.number_type(path)) {
      return remove_piece(piece);
    }
    writing_.placed.insert(array);
    const Rows rows = rows_of(*array, piece.type);
    if (rows.rows.empty()) return remove_piece(piece);
    const bool is_whole = rows.rows.size() == items_of(piece.type);
    std::string profile = piece.profile;
    if (profile != kNoProfile) {
      profile = profiles_.name_for(profile, rows.places);
    } else if (!is_whole) {
      profile = profiles_.name_for(profile_name(piece.field, piece.type), rows.places);
    }
    with_numbers(array->values, [&]<class Value>(const std::vector<Value>& /*values*/) {
      const std::vector<Value> of_file = values_of<Value>(*array, rows, piece);
      writing_.file.write(path, Values(of_file), {of_file.size()});
    });
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
      const bool is_series = are_steps(steps);
      if (!is_series) {
        write_field(array.name, {{&array, 0}});
      } else if (steps.front().array == &array) {
        write_field(step->first, steps);
      }
    }
  }

  [[nodiscard]] bool is_new(const DataArray& array) const {
    return !is_text_array(array) && !writing_.placed.contains(&array);
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
    const std::string clean = clean_name(wanted);
    const auto numbered = [&](int k) {
      const std::string number = fmt::format("_{}", k);
      return std::string(utf8_prefix(clean, kLongestName - number.size())) + number;
    };
    std::string name = numbers_.free_name(
        clean, numbered, [&](const std::string& free) { return names_.insert(free).second; });
    if (name != wanted) {
      writing_.notes.push_back(fmt::format("the array '{}' on {} is written as the field '{}'", array.name,
                                           to_string(array.association), name));
    }
    return name;
  }

  static std::int64_t type_of(const DataArray& array) {
    return std::visit(
        [](const auto& values) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          if constexpr (std::is_integral_v<Value>) {
            constexpr bool kFits =
                std::numeric_limits<Value>::digits <= std::numeric_limits<std::int32_t>::digits;
            const bool small = std::all_of(values.begin(), values.end(),
                                           [](Value value) { return std::in_range<std::int64_t>(value); });
            return kFits ? kIntegers : small ? kLongIntegers : kReals;
          }
          return kReals;
        },
        array.values);
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
    const auto components = static_cast<std::size_t>(first.components);
    std::int64_t type = kIntegers;
    for (const Step& step : steps) {
      const std::int64_t of_step = type_of(*step.array);
      if (of_step == kReals || type == kIntegers) type = of_step;
    }
    const bool whole = std::visit(
        [](const auto& values) {
          return std::is_integral_v<typename std::decay_t<decltype(values)>::value_type>;
        },
        first.values);
    if (whole && type == kReals) {
      writing_.notes.push_back(
          fmt::format("the array '{}' loses digits: whole numbers above 9,223,372,036,854,775,807 are "
                      "written as real ones",
                      first.name));
    }
    hdf5::File& file = writing_.file;
    file.make_group(path);
    file.set_attribute(path, "MAI", writing_.layout.mesh);
    file.set_attribute(path, "NCO", static_cast<std::int64_t>(components));
    file.set_attribute(path, "NOM", component_names(first));
    file.set_attribute(path, "UNI", std::string(kShortName * components, ' '));
    file.set_attribute(path, "UNT", std::string());
    file.set_attribute(path, "TYP", type);
    for (const Step& step : steps) write_step(name, path, step, type);
  }

  void write_step(const std::string& name, const std::string& path, const Step& step, std::int64_t type) {
    hdf5::File& file = writing_.file;
    const int number = step.number == 0 ? -1 : step.number;
    const std::string group = fmt::format("{}/{:020d}{:020d}", path, number, -1);
    const std::string mesh_step = writing_.layout.mesh_path() + "/" + writing_.layout.step;
    file.make_group(group);
    file.set_attribute(group, "NDT", std::int64_t{number});
    file.set_attribute(group, "NOR", std::int64_t{-1});
    file.set_attribute(group, "PDT", static_cast<double>(step.number));
    file.set_attribute(group, "RDT", file.integer_attribute(mesh_step, "NDT").value_or(-1));
    file.set_attribute(group, "ROR", file.integer_attribute(mesh_step, "NOR").value_or(-1));
    const DataArray& array = *step.array;
    if (array.association == Association::vertices) {
      return write_support(name, group + "/NOE", array, nullptr, type);
    }
    for (const GeometryType& geometry : geometry_types()) {
      if (writing_.cells.contains(&geometry))
        write_support(name, fmt::format("{}/MAI.{}", group, geometry.name), array, &geometry, type);
    }
  }

  void write_support(const std::string& field, const std::string& support, const DataArray& array,
                     const GeometryType* geometry, std::int64_t type) {
    const Rows rows = rows_of(array, geometry);
    if (rows.rows.empty()) return;
    hdf5::File& file = writing_.file;
    std::string profile(kNoProfile);
    if (rows.rows.size() < items_of(geometry))
      profile = profiles_.name_for(profile_name(field, geometry), rows.places);
    const Piece piece{.field = field,
                      .support = support,
                      .profile = profile,
                      .array = array.name,
                      .type = geometry,
                      .components = static_cast<std::size_t>(array.components)};
    const std::string group = support + "/" + profile;
    file.make_group(group);
    file.set_attribute(support, "GAU", std::string());
    file.set_attribute(support, "PFL", profile);
    file.set_attribute(group, "NBR", static_cast<std::int64_t>(items_of(geometry)));
    file.set_attribute(group, "NGA", std::int64_t{1});
    file.set_attribute(group, "GAU", std::string());
    Values values;
    if (type == kReals) {
      values = values_of<double>(array, rows, piece);
    } else if (type == kLongIntegers) {
      values = values_of<std::int64_t>(array, rows, piece);
    } else {
      values = values_of<std::int32_t>(array, rows, piece);
    }
    const std::size_t size = rows.rows.size() * piece.components;
    file.write(group + "/CO", values, {size});
  }

  /// Returns the name of a new profile for a field.
  static std::string profile_name(const std::string& field, const GeometryType* type) {
    const std::string suffix = fmt::format("_{}", type == nullptr ? "NOE" : type->name);
    return std::string(utf8_prefix(field, kLongestName - suffix.size())) + suffix;
  }

  Writing& writing_;
  Profiles profiles_;
  std::set<std::string> names_;  // names of fields
  NameNumbers numbers_;
  const DataArray* last_array_ = nullptr;
  std::vector<Index> table_;  // rows of `last_array_` by item
};

}  // namespace

void write_fields(Writing& writing) { FieldWriter(writing).write(); }

}  // namespace meshorder::med
