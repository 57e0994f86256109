// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/vertex_choice.hpp"

#include "base/text.hpp"
#include "mesh/groups.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace meshorder {
namespace {

/// A mark for every vertex of a mesh.
class Marks {
 public:
  explicit Marks(const Mesh& mesh) : mesh_(mesh), marked_(mesh.points.size(), 0) {}

  void mark(Index vertex) { marked_[vertex] = 1; }
  void mark_cell(Index cell) {
    for (const Index v : mesh_.cells[cell]) mark(v);
  }

  /// Returns the marked candidates.
  [[nodiscard]] std::vector<Index> among(std::span<const Index> candidates) const {
    std::vector<Index> result;
    std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(result),
                 [&](Index v) { return marked_[v] != 0; });
    return result;
  }

 private:
  const Mesh& mesh_;
  std::vector<char> marked_;
};

std::vector<Index> in_set(const Mesh& mesh, std::span<const Index> candidates, const std::string& name) {
  Marks marks(mesh);
  bool found = false;
  for (const EntitySet& set : mesh.sets) {
    if (set.name != name) continue;
    found = true;
    for (const Index member : set.members) {
      set.association == Association::vertices ? marks.mark(member) : marks.mark_cell(member);
    }
  }
  if (!found) {
    throw InvalidArgument(
        "the mesh has no set '" + name + "'; " +
        (mesh.sets.empty() ? "it has no sets" : "its sets are " + join(mesh.sets, [](const EntitySet& set) {
                                                  return set.name;
                                                })));
  }
  return marks.among(candidates);
}

std::vector<Index> in_group(const Mesh& mesh, std::span<const Index> candidates, const Grouping& groups,
                            Index group) {
  Marks marks(mesh);
  if (groups.association == Association::vertices) {
    for (const Index v : candidates) {
      if (groups.of_vertices[v] == group) marks.mark(v);
    }
  } else {
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      if (groups.of_cells[c] == group) marks.mark_cell(c);
    }
  }
  return marks.among(candidates);
}

/// Returns the arrays to search for a choice's label: the array that the choice names, else the label arrays
/// of vertices and cells.
std::vector<std::string> arrays_of_labels(const Mesh& mesh, const VertexChoice& choice) {
  std::vector<std::string> names;
  for (const Association association : {Association::vertices, Association::cells}) {
    if (choice.name.empty() && find_array(mesh, kLabel, association) != nullptr)
      names.push_back(fmt::format("{}:{}", to_string(association), kLabel));
  }
  if (names.empty()) names.push_back(choice.name.empty() ? std::string(kLabel) : choice.name);
  return names;
}

std::vector<Index> with_label(const Mesh& mesh, std::span<const Index> candidates,
                              const VertexChoice& choice) {
  std::string known;
  for (const std::string& array : arrays_of_labels(mesh, choice)) {
    const Grouping groups = grouping_by(mesh, array);
    const auto found = std::lower_bound(groups.values.begin(), groups.values.end(), choice.label);
    if (found == groups.values.end() || *found != choice.label) {
      constexpr std::size_t kShown = 8;
      known += fmt::format("{}labels of {} are ", known.empty() ? "" : "; ", to_string(groups.association));
      for (std::size_t i = 0; i < std::min(kShown, groups.values.size()); ++i)
        known += fmt::format("{}{}", i == 0 ? "" : ", ", groups.values[i]);
      if (groups.values.size() > kShown) known += ", …";
      continue;
    }
    return in_group(mesh, candidates, groups, static_cast<Index>(found - groups.values.begin()));
  }
  throw InvalidArgument(fmt::format("nothing has the label {}; {}", choice.label, known));
}

/// Returns a point relative to a box: 0 … 1 along each axis.
Point relative(const Point& point, const BoundingBox& box) {
  Point result{};
  for (int a = 0; a < 3; ++a) {
    const double side = box.high[a] - box.low[a];
    if (side > 0.0) result[a] = (point[a] - box.low[a]) / side;
  }
  return result;
}

std::vector<Index> in_box(const Mesh& mesh, std::span<const Index> candidates, const VertexChoice& choice) {
  const BoundingBox box = bounding_box(mesh.points, candidates);
  std::vector<Index> result;
  for (const Index v : candidates) {
    const Point at = relative(mesh.points[v], box);
    bool inside = true;
    for (int a = 0; a < 3; ++a) inside = inside && choice.low[a] <= at[a] && at[a] <= choice.high[a];
    if (inside) result.push_back(v);
  }
  return result;
}

std::vector<Index> nearest_to(const Mesh& mesh, std::span<const Index> candidates, const Point& relative_to) {
  const BoundingBox box = bounding_box(mesh.points, candidates);
  const auto squared_distance = [&](const Point& point) {
    double sum = 0.0;
    for (int a = 0; a < 3; ++a) {
      const double target = box.low[a] + relative_to[a] * (box.high[a] - box.low[a]);
      sum += (point[a] - target) * (point[a] - target);
    }
    return sum;
  };
  double least = std::numeric_limits<double>::infinity();
  Point nearest{};
  for (const Index v : candidates) {
    const double distance = squared_distance(mesh.points[v]);
    if (distance < least || (distance == least && mesh.points[v] < nearest)) {
      least = distance;
      nearest = mesh.points[v];
    }
  }
  std::vector<Index> result;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(result),
               [&](Index v) { return mesh.points[v] == nearest; });
  return result;
}

std::vector<Index> chosen(const Mesh& mesh, std::span<const Index> candidates, const VertexChoice& choice) {
  switch (choice.by) {
    case VertexChoice::By::all:
      return {candidates.begin(), candidates.end()};
    case VertexChoice::By::set:
      return in_set(mesh, candidates, choice.name);
    case VertexChoice::By::label:
      return with_label(mesh, candidates, choice);
    case VertexChoice::By::box:
      return in_box(mesh, candidates, choice);
    case VertexChoice::By::nearest:
      return nearest_to(mesh, candidates, choice.low);
  }
  return {};
}

}  // namespace

double BoundingBox::longest_side() const {
  return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

BoundingBox bounding_box(std::span<const Point> points, std::span<const Index> vertices) {
  BoundingBox box{points[vertices.front()], points[vertices.front()]};
  for (const Index v : vertices) {
    for (int a = 0; a < 3; ++a) {
      box.low[a] = std::min(box.low[a], points[v][a]);
      box.high[a] = std::max(box.high[a], points[v][a]);
    }
  }
  return box;
}

std::vector<Index> choose_vertices(const Mesh& mesh, std::span<const Index> candidates,
                                   const VertexChoice& choice, const std::string& file) {
  std::vector<Index> result;
  try {
    result = chosen(mesh, candidates, choice);
  } catch (const InvalidArgument& error) {
    throw InputError(file, choice.source_path + ": " + error.what(), "name vertices that the mesh has");
  }
  if (result.empty())
    throw InputError(file, choice.source_path + ": no vertex of a tetrahedron is chosen",
                     "name vertices that the mesh has");
  return result;
}

}  // namespace meshorder
