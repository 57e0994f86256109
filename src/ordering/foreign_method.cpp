// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/foreign_method.hpp"

#include <meshorder/error.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Returns the coordinates as x y z x y z …
std::vector<double> coordinates(const PointsView& points) {
  std::vector<double> xyz;
  xyz.reserve(3 * points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (int axis = 0; axis < 3; ++axis) xyz.push_back(points(p, axis));
  }
  return xyz;
}

}  // namespace

VertexMethod foreign_vertex_method(std::string name, mo_method method, void* user) {
  return [name = std::move(name), method, user](const VertexProblem& problem, const OrderOptions&) {
    const std::vector<double> xyz = coordinates(problem.points);
    const std::size_t n = problem.offsets.size() - 1;
    std::vector<Index> new_to_old(n, -1);
    const std::int32_t failed =
        method(user, static_cast<std::int64_t>(n), problem.offsets.data(), problem.neighbours.data(),
               xyz.empty() ? nullptr : xyz.data(), new_to_old.data());
    if (failed != 0) {
      throw InternalError("the order '" + name + "' failed with " + std::to_string(failed));
    }
    try {
      return Permutation::from_new_to_old(std::move(new_to_old));
    } catch (const InvalidArgument& fault) {
      throw InternalError("the order '" + name + "' did not return a bijection: " + fault.what());
    }
  };
}

void register_foreign_method(const char* name, const char* description, std::int32_t needs_points,
                             mo_method method, void* user, const std::string& source) {
  if (name == nullptr) throw InvalidArgument("method: the name is null");
  if (method == nullptr) throw InvalidArgument("method '" + std::string(name) + "': the function is null");
  register_vertex_method({.name = name,
                          .description = description != nullptr ? description : "",
                          .needs_points = needs_points != 0,
                          .source = source},
                         foreign_vertex_method(name, method, user))
      .keep();
}

}  // namespace meshorder
