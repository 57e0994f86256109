// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/view.hpp"

#include "lab/scenario/vertex_choice.hpp"
#include "mesh/simplices.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

namespace meshorder {
namespace {

constexpr float kAnyError = std::numeric_limits<float>::max();
/// The topology may change if keeping it would leave more than this many times the requested number of
/// triangles.
constexpr std::size_t kTooMany = 2;

/// Returns coordinates for the simplifier, relative to the box, so that floats do not lose digits to offsets.
std::vector<float> coordinates(const Mesh& mesh, const std::vector<Index>& vertices) {
  const BoundingBox box = bounding_box(mesh.points, vertices);
  const double longest = std::max(box.longest_side(), std::numeric_limits<double>::min());
  std::vector<float> result;
  result.reserve(3 * vertices.size());
  for (const Index v : vertices) {
    for (std::size_t c = 0; c < 3; ++c)
      result.push_back(static_cast<float>((mesh.points[v][c] - box.low[c]) / longest));
  }
  return result;
}

/// Returns fewer triangles; their corners are among those in `corners`.
std::vector<unsigned> simplified(const std::vector<unsigned>& corners, const std::vector<float>& places,
                                 std::size_t most_corners) {
  std::vector<unsigned> result(corners.size());
  constexpr std::size_t kStride = 3 * sizeof(float);
  const std::size_t vertices = places.size() / 3;
  std::size_t left = meshopt_simplify(result.data(), corners.data(), corners.size(), places.data(), vertices,
                                      kStride, most_corners, kAnyError);
  if (left > kTooMany * most_corners) {
    left = meshopt_simplifySloppy(result.data(), corners.data(), corners.size(), places.data(), vertices,
                                  kStride, most_corners, kAnyError);
  }
  result.resize(left);
  return result;
}

/// Puts neighbours next to each other, for a graphics card's cache and for the compression of the numbers.
void order_for_drawing(std::vector<unsigned>& corners, std::vector<Index>& vertices) {
  meshopt_optimizeVertexCache(corners.data(), corners.data(), corners.size(), vertices.size());
  std::vector<unsigned> places(vertices.size());
  const std::size_t used =
      meshopt_optimizeVertexFetchRemap(places.data(), corners.data(), corners.size(), vertices.size());
  std::vector<Index> kept(used);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (places[v] < used) kept[places[v]] = vertices[v];
  }
  for (unsigned& corner : corners) corner = places[corner];
  vertices = std::move(kept);
}

}  // namespace

SurfaceView surface_view(const Mesh& mesh, Index most_triangles) {
  const std::vector<std::array<Index, 3>> triangles = boundary_triangles(mesh);
  SurfaceView view;
  std::vector<unsigned> corners;
  std::vector<Index> numbers(mesh.points.size(), -1);  // of the mesh's vertices in the view
  for (const auto& triangle : triangles) {
    for (const Index v : triangle) {
      if (numbers[v] < 0) {
        numbers[v] = index_size(view.vertices);
        view.vertices.push_back(v);
      }
      corners.push_back(static_cast<unsigned>(numbers[v]));
    }
  }
  const auto most_corners = 3 * static_cast<std::size_t>(std::max(most_triangles, Index{1}));
  if (corners.size() > most_corners)
    corners = simplified(corners, coordinates(mesh, view.vertices), most_corners);
  order_for_drawing(corners, view.vertices);
  view.triangles.reserve(corners.size() / 3);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    view.triangles.push_back({static_cast<Index>(corners[i]), static_cast<Index>(corners[i + 1]),
                              static_cast<Index>(corners[i + 2])});
  }
  return view;
}

}  // namespace meshorder
