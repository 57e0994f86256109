// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/simplices.hpp"

#include "base/point.hpp"

#include <array>
#include <cmath>

namespace meshorder {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Returns Dₘ in an orthonormal frame of the edges (Gram–Schmidt; right-handed if D = 3): upper triangular,
/// D×D. Its determinant is D! times the volume, which has a sign for a tetrahedron. Sets `longest` to the
/// length of the longest edge.
Matrix edges_in_their_frame(int dimension, std::array<Point, 3> edges, double& longest) {
  Matrix result{};
  longest = 0.0;
  for (int a = 0; a < dimension; ++a) longest = std::max(longest, std::sqrt(dot(edges[a], edges[a])));
  std::array<Point, 3> frame{};
  for (int a = 0; a < dimension; ++a) {
    for (int i = 0; i < a; ++i) {
      result[i][a] = dot(frame[i], edges[a]);
      for (int c = 0; c < 3; ++c) edges[a][c] -= result[i][a] * frame[i][c];
    }
    result[a][a] = std::sqrt(dot(edges[a], edges[a]));
    if (result[a][a] > 0.0) {
      for (int c = 0; c < 3; ++c) frame[a][c] = edges[a][c] / result[a][a];
    }
  }
  if (dimension == 3 && dot(cross(frame[0], frame[1]), frame[2]) < 0.0) result[2][2] = -result[2][2];
  return result;
}

Matrix inverse_of_upper_triangular(int dimension, const Matrix& m) {
  Matrix inverse{};
  for (int j = 0; j < dimension; ++j) {
    inverse[j][j] = 1.0 / m[j][j];
    for (int i = j - 1; i >= 0; --i) {
      double sum = 0.0;
      for (int k = i + 1; k <= j; ++k) sum += m[i][k] * inverse[k][j];
      inverse[i][j] = -sum / m[i][i];
    }
  }
  return inverse;
}

}  // namespace

RestShapes rest_shapes(SimplicesRef simplices, std::span<const Point> points) {
  // heights below this fraction of the longest edge are rounding errors
  constexpr double kFlat = 1e-12;
  constexpr std::array<double, 4> kFactorial{1, 1, 2, 6};
  const int d = simplices.dimension;
  RestShapes rest;
  rest.dimension = d;
  const Offset quantities = rest.quantities();
  rest.count = d == 0 ? 0 : simplices.size();
  rest.vertices.assign(rest.batches() * (d + 1) * kBatch, 0);
  rest.geometry.assign(rest.batches() * quantities * kBatch, 0.0);
  for (Offset s = 0; s < rest.batches() * kBatch; ++s) {
    const Offset batch = s / kBatch;
    const Offset lane = s % kBatch;
    const Index* const corner = simplices.vertices.data() + (d + 1) * std::min(s, rest.count - 1);
    for (int a = 0; a <= d; ++a) rest.vertices[(batch * (d + 1) + a) * kBatch + lane] = corner[a];
    if (s >= rest.count) continue;
    std::array<Point, 3> edges{};
    for (int a = 0; a < d; ++a) {
      for (int c = 0; c < 3; ++c) edges[a][c] = points[corner[a + 1]][c] - points[corner[0]][c];
    }
    double longest = 0.0;
    const Matrix dm = edges_in_their_frame(d, edges, longest);
    double volume = 1.0 / kFactorial[d];
    bool flat = longest <= 0.0;
    for (int a = 0; a < d; ++a) {
      volume *= std::abs(dm[a][a]);
      flat = flat || std::abs(dm[a][a]) <= kFlat * longest;
    }
    if (flat) continue;
    const Matrix inverse = inverse_of_upper_triangular(d, dm);
    double* const geometry = rest.geometry.data() + batch * quantities * kBatch + lane;
    int q = 0;
    for (int i = 0; i < d; ++i) {
      for (int j = i; j < d; ++j) geometry[q++ * kBatch] = inverse[i][j];
    }
    geometry[q * kBatch] = volume;
  }
  return rest;
}

}  // namespace meshorder
