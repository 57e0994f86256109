// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/local_elements.hpp"

#include "graph/incidence.hpp"
#include "kernels/springs.hpp"
#include "lab/admm/local_steps.hpp"
#include <meshorder/error.hpp>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace meshorder {
namespace {

bool is_hyperelastic(LocalModel model) { return model != LocalModel::springs && model != LocalModel::strain; }

void check_positive(double value, const std::string& what) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw InvalidArgument(fmt::format("local steps: {} is {}; it must be positive", what, value));
}

void check_lame(const Lame& lame, const std::string& whose) {
  check_positive(lame.mu, "mu" + whose);
  if (!std::isfinite(lame.lambda))
    throw InvalidArgument(fmt::format("local steps: lambda{} is {}", whose, lame.lambda));
  check_positive(lame.lambda + 2.0 / 3.0 * lame.mu, "the bulk modulus lambda + 2/3 mu" + whose);
}

void check_simplices(const Simplices& simplices, std::span<const Point> points) {
  if (simplices.dimension != 3 || simplices.vertices.empty() || simplices.vertices.size() % 4 != 0)
    throw InvalidArgument("local steps: the simplices must be tetrahedra, with four vertices each");
  for (const Index v : simplices.vertices) {
    if (v < 0 || v >= index_size(points)) {
      throw InvalidArgument(
          fmt::format("local steps: a tetrahedron at vertex {} of {} points", v, points.size()));
    }
  }
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (!std::all_of(points[v].begin(), points[v].end(), [](double x) { return std::isfinite(x); }))
      throw InvalidArgument(fmt::format("local steps: point {} is not finite", v));
  }
}

void check_law(const LocalLaw& law, std::size_t count) {
  const auto check_size = [&](const std::vector<double>& values, const char* what) {
    if (values.empty() || values.size() == count) return;
    throw InvalidArgument(
        fmt::format("local steps: {} values of {} for {} tetrahedra; give none or one "
                    "for each",
                    values.size(), what, count));
  };
  const auto of = [](std::size_t s) { return " of tetrahedron " + std::to_string(s); };
  if (is_hyperelastic(law.model)) {
    check_size(law.mu, "mu");
    if (law.mu.size() != law.lambda.size())
      throw InvalidArgument("local steps: mu and lambda must be given for the same tetrahedra");
    if (law.mu.empty()) check_lame(law.lame, "");
    for (std::size_t s = 0; s < law.mu.size(); ++s) check_lame({law.mu[s], law.lambda[s]}, of(s));
    return;
  }
  if (law.model == LocalModel::springs && !law.stiffnesses.empty())
    throw InvalidArgument("local steps: springs have one stiffness for all");
  check_size(law.stiffnesses, "the stiffness");
  if (law.stiffnesses.empty()) check_positive(law.stiffness, "the stiffness");
  for (std::size_t s = 0; s < law.stiffnesses.size(); ++s) {
    check_positive(law.stiffnesses[s], "the stiffness" + of(s));
  }
}

/// Returns the vertex graph of the elements.
CsrGraph graph_of(std::vector<Index> vertices, Index corners, Index n) {
  Incidence incidence;
  incidence.vertex_count = n;
  const auto count = static_cast<Offset>(vertices.size()) / corners;
  incidence.vertices = std::move(vertices);
  incidence.offsets.resize(count + 1);
  for (Offset s = 0; s <= count; ++s) incidence.offsets[s] = corners * s;
  return joined_vertices(incidence);
}

template <class Real>
LocalElements<Real> springs_of(const LocalLaw& law, const Simplices& simplices,
                               std::span<const Point> points) {
  constexpr Index kBatchOf = kLocalBatch<Real>;
  const Springs springs = springs_on_edges(graph_of(simplices.vertices, 4, index_size(points)), points);
  LocalElements<Real> result;
  result.count = springs.count;
  result.corners = 2;
  result.stiffness = static_cast<Real>(law.stiffness);
  const Offset lanes = result.batches() * kBatchOf;
  result.vertices.resize(2 * lanes);
  result.rest.resize(lanes, 0);
  result.directions.resize(3 * lanes, 0);
  for (Offset s = 0; s < lanes; ++s) {
    const Offset from = std::min(s, springs.count - 1);
    const Offset source = 2 * (from / kBatch) * kBatch + from % kBatch;
    const Index b = springs.ends[source + kBatch];
    // springs that fill the last batch join a vertex to itself
    const Index a = s < springs.count ? springs.ends[source] : b;
    Index* const ends = result.vertices.data() + LocalElements<Real>::place(s, 2);
    ends[0] = a;
    ends[kBatchOf] = b;
    Real* const direction = result.directions.data() + LocalElements<Real>::place(s, 3);
    const double length = s < springs.count ? springs.rest_lengths[s] : 0.0;
    result.rest[s] = static_cast<Real>(length);
    direction[0] = 1;
    for (int c = 0; length > 0.0 && c < 3; ++c) {
      direction[c * kBatchOf] = static_cast<Real>((points[a][c] - points[b][c]) / length);
    }
  }
  return result;
}

/// Computes Dₘ⁻¹ of a tetrahedron that is not flat, row by row: the shape gradients of corners 1, 2 and 3.
void shape_gradients(const Index* corner, std::span<const Point> points, double (&g)[3][3]) {
  double e[3][3];
  for (int a = 0; a < 3; ++a) {
    for (int c = 0; c < 3; ++c) e[a][c] = points[corner[a + 1]][c] - points[corner[0]][c];
  }
  for (int a = 0; a < 3; ++a) {
    const double* const p = e[(a + 1) % 3];
    const double* const q = e[(a + 2) % 3];
    for (int c = 0; c < 3; ++c) g[a][c] = p[(c + 1) % 3] * q[(c + 2) % 3] - p[(c + 2) % 3] * q[(c + 1) % 3];
  }
  const double determinant = e[0][0] * g[0][0] + e[0][1] * g[0][1] + e[0][2] * g[0][2];
  for (auto& row : g) {
    for (double& value : row) value /= determinant;
  }
}

template <class Real>
LocalElements<Real> tetrahedra_of(const LocalLaw& law, const Simplices& simplices,
                                  std::span<const Point> points) {
  constexpr Index kBatchOf = kLocalBatch<Real>;
  const RestShapes shapes = rest_shapes(simplices, points);
  LocalElements<Real> result;
  result.count = simplices.size();
  result.corners = 4;
  const Offset lanes = result.batches() * kBatchOf;
  result.vertices.resize(4 * lanes);
  result.rest.resize(kTetrahedronNumbers * lanes);
  const bool hyperelastic = is_hyperelastic(law.model);
  const auto lame = [&](Offset s) { return law.mu.empty() ? law.lame : Lame{law.mu[s], law.lambda[s]}; };
  const auto bulk = [&](Offset s) { return lame(s).lambda + 2.0 / 3.0 * lame(s).mu; };
  const auto modulus = [&](Offset s) {
    if (hyperelastic) return bulk(s);
    return law.stiffnesses.empty() ? law.stiffness : law.stiffnesses[s];
  };
  if (hyperelastic) {
    result.softness_stride = law.mu.empty() ? 0 : kBatchOf;
    result.softness.resize(law.mu.empty() ? kBatchOf : lanes);
    for (Offset s = 0; s < static_cast<Offset>(result.softness.size()); ++s) {
      const Offset from = std::min(s, result.count - 1);
      result.softness[s] = static_cast<Real>(lame(from).mu / bulk(from));
    }
  }
  const auto is_flat = [&](Offset s) { return shapes.volume(s) <= 0.0; };
  // a flat tetrahedron gets the shape of the last earlier tetrahedron that is not flat; if there is none,
  // that of the first tetrahedron that is not flat
  Offset shape = 0;
  while (shape + 1 < result.count && is_flat(shape)) ++shape;
  for (Offset s = 0; s < lanes; ++s) {
    if (s < result.count && !is_flat(s)) shape = s;
    const Index* const corner = simplices.vertices.data() + 4 * shape;
    double g[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if (!is_flat(shape)) shape_gradients(corner, points, g);
    Real* const rest = result.rest.data() + LocalElements<Real>::place(s, kTetrahedronNumbers);
    for (int k = 0; k < 9; ++k) rest[k * kBatchOf] = static_cast<Real>(g[k / 3][k % 3]);
    rest[9 * kBatchOf] = s < result.count ? static_cast<Real>(modulus(s) * shapes.volume(s)) : Real{0};
    Index* const vertices = result.vertices.data() + LocalElements<Real>::place(s, 4);
    for (int a = 0; a < 4; ++a) vertices[a * kBatchOf] = corner[a];
  }
  return result;
}

}  // namespace

template <class Real>
double LocalElements<Real>::load(Offset element, double (&d)[4][3]) const {
  constexpr Index kBatchOf = kLocalBatch<Real>;
  for (int c = 0; c < 3; ++c) {
    if (corners == 2) {
      d[0][c] = 1.0;
      d[1][c] = -1.0;
      continue;
    }
    d[0][c] = 0.0;
    for (int a = 0; a < 3; ++a) {
      d[a + 1][c] = static_cast<double>(rest[place(element, kTetrahedronNumbers) + (3 * a + c) * kBatchOf]);
      d[0][c] -= d[a + 1][c];
    }
  }
  if (corners == 2) return static_cast<double>(stiffness);
  return static_cast<double>(rest[place(element, kTetrahedronNumbers) + 9 * kBatchOf]);
}

template <class Real>
LocalElements<Real> local_elements(const LocalLaw& law, const Simplices& simplices,
                                   std::span<const Point> points) {
  check_simplices(simplices, points);
  check_law(law, static_cast<std::size_t>(simplices.size()));
  return law.model == LocalModel::springs ? springs_of<Real>(law, simplices, points)
                                          : tetrahedra_of<Real>(law, simplices, points);
}

template <class Real>
SparseMatrix stiffness_of(const LocalElements<Real>& elements, Index n) {
  std::vector<Index> vertices;
  vertices.reserve(elements.count * elements.corners);
  for (Offset s = 0; s < elements.count; ++s) {
    for (Index a = 0; a < elements.corners; ++a) vertices.push_back(elements.vertex(s, a));
  }
  const CsrGraph graph = graph_of(std::move(vertices), elements.corners, n);
  SparseMatrix matrix;
  matrix.offsets.reserve(static_cast<std::size_t>(n) + 1);
  for (Index v = 0; v < n; ++v) {
    const auto neighbours = graph[v];
    const auto behind = std::lower_bound(neighbours.begin(), neighbours.end(), v);
    matrix.columns.insert(matrix.columns.end(), neighbours.begin(), behind);
    matrix.columns.push_back(v);
    matrix.columns.insert(matrix.columns.end(), behind, neighbours.end());
    matrix.offsets.push_back(static_cast<Offset>(matrix.columns.size()));
  }
  matrix.values.assign(matrix.columns.size(), 0.0);
  for (Offset s = 0; s < elements.count; ++s) {
    double d[4][3];
    const double weight = elements.load(s, d);
    for (Index a = 0; a < elements.corners; ++a) {
      const Index row = elements.vertex(s, a);
      for (Index b = 0; b < elements.corners; ++b) {
        const auto begin = matrix.columns.begin();
        const auto place = std::lower_bound(begin + matrix.offsets[row], begin + matrix.offsets[row + 1],
                                            elements.vertex(s, b));
        double entry = d[a][0] * d[b][0];
        if (elements.corners == 4) entry += d[a][1] * d[b][1] + d[a][2] * d[b][2];
        matrix.values[place - begin] += weight * entry;
      }
    }
  }
  return matrix;
}

template struct LocalElements<double>;
template struct LocalElements<float>;
template LocalElements<double> local_elements(const LocalLaw&, const Simplices&, std::span<const Point>);
template LocalElements<float> local_elements(const LocalLaw&, const Simplices&, std::span<const Point>);
template SparseMatrix stiffness_of(const LocalElements<double>&, Index);
template SparseMatrix stiffness_of(const LocalElements<float>&, Index);

}  // namespace meshorder
