// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/memory.hpp"
#include "io/med/med.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <type_traits>
#include <variant>

// Reads fields: at each step, their values at nodes, in cells, at the nodes of cells and at Gauss points. A
// dataset has the values of the first component, then those of the next component, and so on. The values of a
// component go item by item, and those of an item point by point.

namespace meshorder::med {
namespace {

/// A field of the mesh.
struct FieldInfo {
  std::string name;
  std::string path;
  std::size_t components = 1;
  std::vector<std::string> component_names;
  std::vector<std::string> steps;  ///< names of their groups, ordered by number
};

/// Splits a text into `count` names of 16 characters; returns no names if all are blank.
std::vector<std::string> short_names(const std::string& text, std::size_t count) {
  std::vector<std::string> names;
  bool any = false;
  for (std::size_t k = 0; k < count; ++k) {
    std::string name = k * kShortName < text.size() ? text.substr(k * kShortName, kShortName) : std::string();
    name.resize(name.find_last_not_of(' ') + 1);
    any = any || !name.empty();
    names.push_back(utf8(std::move(name)));
  }
  return any ? names : std::vector<std::string>();
}

class FieldReader {
 public:
  FieldReader(Reading& reading, FieldInfo field) : reading_(reading), field_(std::move(field)) {}

  void read() {
    for (std::size_t step = 0; step < field_.steps.size(); ++step) read_step(step);
  }

 private:
  /// An array of a step while its pieces are read.
  struct Gathered {
    DataArray array;                  // its indices are the vertices or cells of the rows, in any order
    std::vector<std::size_t> pieces;  // indices in the layout
  };

  void read_step(std::size_t step) {
    gathered_.clear();
    suffix_ = field_.steps.size() > 1 ? fmt::format(" step {}", step + 1) : "";
    const std::string path = field_.path + "/" + field_.steps[step];
    // read types in the order of the cells
    if (reading_.file.has(path + "/NOE")) read_support(path + "/NOE", nullptr, false);
    for (const GeometryType& type : geometry_types()) {
      for (const std::string_view prefix : {"MAI.", "NOE."}) {
        const std::string support = fmt::format("{}/{}{}", path, prefix, type.name);
        if (reading_.file.has(support)) read_support(support, &type, prefix == "NOE.");
      }
    }
    for (Gathered& gathered : gathered_) {
      const std::string name = reading_.add_array(std::move(gathered.array));
      for (const std::size_t piece : gathered.pieces) reading_.layout->pieces[piece].array = name;
    }
  }

  void read_support(const std::string& support, const GeometryType* type, bool at_nodes) {
    const std::vector<std::string> profiles = reading_.file.names(support);
    const std::string first = reading_.file.text_attribute(support, "PFL").value_or(std::string(kNoProfile));
    for (const std::string& profile : profiles) {
      if (!reading_.file.has(fmt::format("{}/{}/CO", support, profile))) continue;
      const bool is_other = profiles.size() > 1 && profile != first;
      read_piece({.field = field_.name,
                  .support = support,
                  .profile = profile,
                  .type = type,
                  .at_nodes = at_nodes,
                  .components = field_.components},
                 is_other);
    }
  }

  /// Returns the vertices or cells of a piece's profile.
  std::vector<Index> items_of(const Piece& piece) {
    const auto [first, count] = range_in(reading_.ranges, piece.type);
    if (piece.profile == kNoProfile) return index_range(first, count);
    const std::string path = profile_path(piece.profile);
    reading_.take(path);
    std::vector<Index> items = reading_.file.read_indices(path);
    std::vector<bool> seen(static_cast<std::size_t>(count), false);
    for (Index& item : items) {
      if (item < 1 || item > count || seen[item - 1]) {
        reading_.fail(path,
                      fmt::format("names item {}, which {}", item,
                                  item < 1 || item > count ? "does not exist" : "it has already named"),
                      fmt::format("'{}' has values for 1 to {}", piece.support, count));
      }
      seen[item - 1] = true;
      item += first - 1;
    }
    return items;
  }

  void read_piece(Piece piece, bool is_other_profile) {
    const std::string group = piece.support + "/" + piece.profile;
    const std::string path = group + "/CO";
    std::vector<Index> items = items_of(piece);
    if (items.empty()) return;
    const std::uint64_t size = reading_.file.info(path).size();
    const auto points = reading_.file.integer_attribute(group, "NGA").value_or(1);
    const std::uint64_t row = size / items.size();
    const bool fits = points >= 1 && size % items.size() == 0 && row % piece.components == 0 &&
                      row / piece.components == static_cast<std::uint64_t>(points) &&
                      row <= static_cast<std::uint64_t>(kMaxIndex);
    if (!fits) {
      reading_.fail(path, fmt::format("has {} values, not {} components × {} points × {} items", size,
                                      piece.components, points, items.size()));
    }
    piece.points = static_cast<std::size_t>(points);
    piece.counts_profile = reading_.file.integer_attribute(group, "NBR") == index_size(items);
    std::string name = utf8(field_.name);
    if (piece.at_nodes) {
      name += fmt::format(" at nodes of {}", piece.type->name);
    } else if (points > 1) {
      name += piece.type == nullptr ? " at points of nodes"
                                    : fmt::format(" at Gauss points of {}", piece.type->name);
    }
    if (is_other_profile) name += " in " + utf8(piece.profile);
    reading_.take(path);
    Values values = reading_.file.read(path);
    Gathered& gathered = array_for(name + suffix_, piece, values);
    append(gathered.array, std::move(values), piece, items.size());
    std::vector<Index>& indices = gathered.array.indices;
    indices.insert(indices.end(), items.begin(), items.end());
    gathered.pieces.push_back(reading_.layout->pieces.size());
    reading_.layout->pieces.push_back(std::move(piece));
  }

  Gathered& array_for(const std::string& name, const Piece& piece, const Values& values) {
    const Association association = piece.type == nullptr ? Association::vertices : Association::cells;
    const auto components = static_cast<Index>(piece.components * piece.points);
    const auto found = std::find_if(gathered_.begin(), gathered_.end(), [&](const Gathered& gathered) {
      const DataArray& array = gathered.array;
      return array.name == name && array.association == association && array.components == components &&
             array.values.index() == values.index();
    });
    if (found != gathered_.end()) return *found;
    Gathered& made = gathered_.emplace_back();
    made.array = {.name = name, .association = association, .components = components};
    made.array.values = values_of_type(values.index());
    if (piece.points == 1) made.array.component_names = field_.component_names;
    return made;
  }

  /// Appends the values of a piece as rows.
  void append(DataArray& array, Values values, const Piece& piece, std::size_t rows) const {
    const std::span<const int> order = reading_.layout->order_of_points(piece);
    std::visit(
        [&](auto& numbers) {
          auto& target = std::get<std::decay_t<decltype(numbers)>>(array.values);
          const std::size_t begin = target.size();
          const std::size_t width = piece.points * piece.components;
          if (begin == 0 && width == 1) {
            target = std::move(numbers);
            return;
          }
          resize_large(target, begin + numbers.size());
          std::size_t from = 0;
          if (piece.points == 1) {
            for (std::size_t c = 0; c < width; ++c) {
              for (std::size_t r = 0; r < rows; ++r) target[begin + r * width + c] = numbers[from++];
            }
            return;
          }
          for (std::size_t c = 0; c < piece.components; ++c) {
            for (std::size_t r = 0; r < rows; ++r) {
              for (std::size_t p = 0; p < piece.points; ++p) {
                const std::size_t place = order.empty() ? p : static_cast<std::size_t>(order[p]);
                target[begin + r * width + place * piece.components + c] = numbers[from++];
              }
            }
          }
        },
        values);
  }

  Reading& reading_;
  FieldInfo field_;
  std::string suffix_;
  std::vector<Gathered> gathered_;
};

/// Returns a field, without steps if the field belongs to another mesh.
FieldInfo field_of(const Reading& reading, const std::string& name) {
  const hdf5::File& file = reading.file;
  FieldInfo field{.name = name, .path = "/CHA/" + name, .component_names = {}, .steps = {}};
  if (file.text_attribute(field.path, "MAI").value_or(reading.layout->mesh) != reading.layout->mesh) {
    return field;
  }
  const auto components = file.integer_attribute(field.path, "NCO").value_or(1);
  if (components < 1 || components > kMaxIndex) {
    reading.fail(field.path, fmt::format("has {} components", components));
  }
  field.components = static_cast<std::size_t>(components);
  std::set<std::tuple<std::int64_t, std::int64_t, std::string>> steps;
  for (const std::string& step : file.names(field.path)) {
    const std::string path = field.path + "/" + step;
    steps.emplace(file.integer_attribute(path, "NDT").value_or(-1),
                  file.integer_attribute(path, "NOR").value_or(-1), step);
  }
  for (const auto& [number, order, step] : steps) field.steps.push_back(step);
  // one component needs no name
  const std::string names = file.text_attribute(field.path, "NOM").value_or("");
  if (components > 1 && field.components <= names.size() / kShortName + 1)
    field.component_names = short_names(names, field.components);
  return field;
}

}  // namespace

std::string profile_path(const std::string& profile) { return fmt::format("/PROFILS/{}/PFL", profile); }

void read_fields(Reading& reading) {
  std::size_t with_times = 0;
  std::size_t with_units = 0;
  const auto is_blank = [](const std::string& text) {
    return text.find_first_not_of(' ') == std::string::npos;
  };
  for (const std::string& name : reading.file.names("/CHA")) {
    FieldInfo field = field_of(reading, name);
    if (field.steps.empty()) continue;
    if (field.steps.size() > 1) ++with_times;
    if (!is_blank(reading.file.text_attribute(field.path, "UNI").value_or(""))) ++with_units;
    FieldReader(reading, std::move(field)).read();
  }
  std::vector<std::string>& words = reading.layout->words;
  const auto count = [&](std::size_t number, std::string_view what) {
    if (number > 0)
      words.push_back(fmt::format("the {} of {} {}", what, number, number == 1 ? "field" : "fields"));
  };
  count(with_times, "times");
  count(with_units, "units");
  if (const std::size_t sets = reading.file.names("/GAUSS").size(); sets > 0)
    words.push_back(fmt::format("the places of {} {} of Gauss points", sets, sets == 1 ? "set" : "sets"));
}

}  // namespace meshorder::med
