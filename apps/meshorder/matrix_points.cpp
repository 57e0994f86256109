// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "matrix_points.hpp"

#include "base/text.hpp"
#include "io/matrix/matrix.hpp"
#include "mesh/stored_matrix.hpp"
#include "ordering/method.hpp"
#include <meshorder/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <utility>

namespace meshorder::command {

void add_points_option(CLI::App& subcommand, std::string& points) {
  subcommand
      .add_option("--points", points,
                  "Coordinates of the rows of a matrix or the vertices of a graph, for orders such as\n"
                  "hilbert: 2 or 3 numbers for each, as text, .npy or Matrix Market's array")
      ->type_name("FILE");
}

std::vector<std::string> named_files(const std::string& name) {
  return name.empty() ? std::vector<std::string>() : std::vector<std::string>{name};
}

void take_points(Mesh& mesh, const std::string& input, const std::string& points) {
  if (points.empty()) return;
  if (stored_matrix(mesh) == nullptr) {
    throw InvalidArgument(
        fmt::format("--points is for matrices and graphs: {} is a mesh, which has its own", input));
  }
  RowPoints given = read_points(points, mesh.vertex_count());
  mesh.points = std::move(given.points);
  mesh.dimension = given.dimension;
}

void require_points(const Mesh& mesh, const std::string& input, const std::string& vertices,
                    const std::string& elements) {
  const bool by_vertices = needs_points(vertex_methods(), vertices);
  if (!by_vertices && !needs_points(element_methods(), elements)) return;
  std::vector<std::string> others;
  for (const MethodInfo& method : vertex_methods()) {
    if (!method.needs_points) others.push_back(method.name);
  }
  require_coordinates(mesh, input, fmt::format("order '{}'", by_vertices ? vertices : elements), others);
}

void require_coordinates(const Mesh& mesh, const std::string& input, const std::string& by,
                         const std::vector<std::string>& others) {
  if (stored_matrix(mesh) == nullptr || has_places(mesh)) return;
  throw InvalidArgument(
      fmt::format("{} has no coordinates, which the {} needs; give them with --points FILE, or use an order "
                  "that needs none: {}",
                  input, by, join(others)));
}

}  // namespace meshorder::command
