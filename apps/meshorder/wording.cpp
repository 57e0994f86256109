// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "wording.hpp"

#include "base/text.hpp"
#include "console.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

/// Returns the number of cells of each type, highest dimension first.
std::vector<std::pair<std::string, Index>> type_counts(const Mesh& mesh) {
  std::map<std::array<int, 3>, Index> counts;
  const auto is_as = [&](Index a, Index b) {
    return mesh.cells.shapes[a] == mesh.cells.shapes[b] &&
           mesh.cells.vertex_count(a) == mesh.cells.vertex_count(b);
  };
  for (Index first = 0, end = 0; first < mesh.cell_count(); first = end) {
    while (end < mesh.cell_count() && is_as(first, end)) ++end;
    const Shape shape = mesh.cells.shapes[first];
    const bool fixed = corners(shape, 0) > 0;  // polygons are one type whatever their size
    counts[{-dimension(shape), static_cast<int>(shape), fixed ? mesh.cells.vertex_count(first) : 0}] +=
        end - first;
  }
  std::vector<std::pair<std::string, Index>> result;
  result.reserve(counts.size());
  for (const auto& [type, count] : counts) {
    result.emplace_back(type_name(static_cast<Shape>(type[1]), type[2]), count);
  }
  return result;
}

/// Returns the plural of a type's name: "tetrahedra", "tetrahedra of 10 vertices" for "tetrahedron10".
std::string plural(const std::string& type) {
  const std::size_t end = type.find_last_not_of("0123456789") + 1;
  if (end < type.size())
    return fmt::format("{} of {} vertices", plural(type.substr(0, end)), type.substr(end));
  const std::map<std::string, std::string> irregular{{"tetrahedron", "tetrahedra"},
                                                     {"hexahedron", "hexahedra"},
                                                     {"polyhedron", "polyhedra"},
                                                     {"vertex", "vertex cells"}};
  const auto found = irregular.find(type);
  return found == irregular.end() ? type + "s" : found->second;
}

/// A note without its first quoted name, and that name with its quotes; "" if there is none.
struct Parts {
  std::pair<std::string, std::string> around;
  std::string name;
};

Parts parts_of(const std::string& note) {
  const std::size_t begin = note.find(" '");
  const std::size_t end = begin == std::string::npos ? begin : note.find("' ", begin + 2);
  if (end == std::string::npos) return {{note, ""}, ""};
  return {{note.substr(0, begin + 1), note.substr(end + 1)}, note.substr(begin + 1, end - begin)};
}

/// Returns whether the note is on a set that Gmsh's reader made of periodic nodes. The loss of the pairs of
/// periodic entities has a note of its own.
bool is_on_periodic_nodes(const std::string& note) { return note.starts_with("the set 'gmsh:periodic "); }

std::string likewise(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 3;
  std::string words;
  const std::size_t shown = names.size() <= kShown ? names.size() : kShown - 1;
  for (std::size_t i = 0; i < shown; ++i) words += (i == 0 ? "" : ", ") + names[i];
  if (shown < names.size()) words += fmt::format(" and {} more", names.size() - shown);
  return words;
}

}  // namespace

nlohmann::ordered_json or_null(std::string_view text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

nlohmann::ordered_json to_json(const EdgeSpan& span) {
  return {{"mean", span.mean}, {"max", span.max}, {"mean_log2", span.mean_log2}};
}

nlohmann::ordered_json to_json(const std::vector<FiedlerComponent>& components) {
  auto list = nlohmann::ordered_json::array();
  for (const FiedlerComponent& component : components) {
    list.push_back({{"size", component.size},
                    {"lambda2", component.lambda2},
                    {"residual", component.residual},
                    {"iterations", component.iterations},
                    {"converged", component.converged}});
  }
  return {{"components", list}};
}

nlohmann::ordered_json to_json(const MethodChoice& choice) {
  return {{"method", choice.name},
          {"chosen_by", choice.reason.empty() ? "user" : "auto"},
          {"because", or_null(choice.reason)}};
}

nlohmann::ordered_json to_json(const Grouping& grouping) {
  auto list = nlohmann::ordered_json::array();
  Index first_vertex = 0;
  for (const GroupSize& group : group_sizes(grouping)) {
    nlohmann::ordered_json value;
    if (group.value) value = *group.value;
    if (!group.name.empty()) value = group.name;
    list.push_back({{"value", value},
                    {"first_vertex", first_vertex},
                    {"vertices", group.vertices},
                    {"cells", grouping.of_cells.empty() ? nullptr : nlohmann::ordered_json(group.cells)}});
    first_vertex += group.vertices;
  }
  return {{"name", grouping.name}, {"on", to_string(grouping.association)}, {"groups", list}};
}

nlohmann::ordered_json cells_by_type(const Mesh& mesh) {
  auto result = nlohmann::ordered_json::object();
  for (const auto& [type, count] : type_counts(mesh)) result[type] = count;
  return result;
}

std::string cells_in_words(const Mesh& mesh) {
  return join(type_counts(mesh), [](const auto& entry) {
    const auto& [type, count] = entry;
    const std::size_t end = type.find_last_not_of("0123456789") + 1;
    const std::string one =
        type.substr(0, end) + (end < type.size() ? " of " + type.substr(end) + " vertices" : "");
    return with_commas(count) + " " + (count == 1 ? one : plural(type));
  });
}

std::string method_in_words(const MethodChoice& choice) {
  return choice.name + (choice.reason.empty() ? "" : " (auto)");
}

std::string groups_in_words(const Grouping& grouping) {
  constexpr std::size_t kShown = 8;
  const std::size_t count = grouping.values.size();
  std::string words = fmt::format("{} group{} by {} on {}:", with_commas(static_cast<long long>(count)),
                                  count == 1 ? "" : "s", grouping.name, to_string(grouping.association));
  for (std::size_t g = 0; g < std::min(count, kShown); ++g) {
    words += (g == 0 ? " " : ", ") +
             (grouping.names.empty() ? std::to_string(grouping.values[g]) : visible(grouping.names[g]));
  }
  return words + (count > kShown ? ", …" : "");
}

void note_convergence(const std::vector<FiedlerComponent>& components, const std::string& of, Notes& notes) {
  for (const FiedlerComponent& component : components) {
    if (component.converged) continue;
    notes.push_back(fmt::format(
        "the Fiedler vector of {} did not converge on a component of {} vertices: residual {:.2g} of lambda2 "
        "after {} iterations; the order follows the best vector found",
        of, with_commas(component.size), component.residual / component.lambda2, component.iterations));
  }
}

std::string replaced(std::string text, std::string_view what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

std::string ordered_name(const std::string& mesh) {
  const std::filesystem::path file = std::filesystem::path(mesh).filename();
  // outputs are never compressed
  return "ordered-" + (file.extension() == ".gz" ? file.stem() : file).string();
}

std::string bar(double share, int width) {
  std::string result;
  const long length = std::lround(width * std::clamp(share, 0.0, 1.0));
  for (long i = 0; i < length; ++i) result += "█";
  return result.empty() ? "▏" : result;
}

std::string in_shell(const std::string& text) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./,:=@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

Notes grouped_by_name(const Notes& notes) {
  struct Group {
    std::string first;
    std::vector<std::string> others;  ///< names
  };
  std::vector<Group> groups;
  std::map<std::pair<std::string, std::string>, std::size_t> place;
  const bool pairs_are_noted = std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("periodic entities") != std::string::npos;
  });
  for (const std::string& note : notes) {
    if (pairs_are_noted && is_on_periodic_nodes(note)) continue;
    const Parts parts = parts_of(note);
    const auto [found, is_new] = place.try_emplace(parts.around, groups.size());
    if (is_new) {
      groups.push_back({note, {}});
    } else if (!parts.name.empty()) {
      groups[found->second].others.push_back(parts.name);
    }
  }
  Notes result;
  result.reserve(groups.size());
  for (const Group& group : groups)
    result.push_back(group.others.empty()
                         ? group.first
                         : fmt::format("{} (likewise {})", group.first, likewise(group.others)));
  return result;
}

}  // namespace meshorder::command
