// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/fluid/scalar_system.hpp"

#include "base/parallel.hpp"
#include "kernels/plain.hpp"

#include <algorithm>
#include <cmath>

namespace meshorder {
namespace {

std::span<const double> coordinates(std::span<const Point> points) {
  return {points.data()->data(), 3 * points.size()};
}

/// Calls `work(corners, gradients, owned)` for the tetrahedra that are not flat, in sequence. Each thread
/// visits those that have a corner among the vertices that it owns, and may add only to these vertices.
template <class Work>
void for_each_tetrahedron(const FluidMesh& mesh, std::span<const Point> points, const Work& work) {
  const auto pass = [&](const auto& owned) {
    for (std::size_t at = 0; at < mesh.corners.size(); at += 4) {
      const Index* const corners = mesh.corners.data() + at;
      if (std::none_of(corners, corners + 4, [&](Index v) { return owned.has(v); })) continue;
      const plain::Gradients<4> g = plain::gradients<4>(corners, coordinates(points));
      if (g.volume > mesh.flat) work(corners, g, owned);
    }
  };
  const auto count = static_cast<Index>(points.size());
  const Index parts = thread_count();
  if (parts == 1) return pass(plain::AllVertices{});
  const auto begin_of = [&](Index part) { return static_cast<Index>(Offset{count} * part / parts); };
  for_each_part(parts, [&](Index part) { pass(plain::VertexRange{begin_of(part), begin_of(part + 1)}); });
}

}  // namespace

ScalarSystem assemble(const FluidMesh& mesh, std::span<const Point> points) {
  ScalarSystem system;
  system.pattern = vertex_graph(mesh.view(), points.size());
  system.values.assign(system.pattern.neighbours().size(), 0);
  system.diagonal.assign(points.size(), 0);
  system.masses.assign(points.size(), 0);
  const std::span<const Offset> offsets = system.pattern.offsets();
  const std::span<const Index> neighbours = system.pattern.neighbours();
  for_each_tetrahedron(mesh, points, [&](const Index* corners, const auto& g, const auto& owned) {
    for (int i = 0; i < 4; ++i) {
      const Index row = corners[i];
      if (!owned.has(row)) continue;
      system.masses[row] += g.volume / 4;
      for (int j = 0; j < 4; ++j) {
        const double value = dot(g.of_corner[i], g.of_corner[j]) / g.volume;
        if (i == j) {
          system.diagonal[row] += value;
          continue;
        }
        Offset k = offsets[row];
        while (neighbours[k] != corners[j]) ++k;
        system.values[k] += value;
      }
    }
  });
  return system;
}

SolveReport solve(const ScalarSystem& system, double alpha, double beta, std::span<const std::uint8_t> held,
                  std::span<const double> b, std::span<double> x, const SolveOptions& options) {
  const Index n = system.size();
  const std::span<const Offset> offsets = system.pattern.offsets();
  const std::span<const Index> neighbours = system.pattern.neighbours();
  const auto diagonal = [&](Index i) { return alpha * system.diagonal[i] + beta * system.masses[i]; };
  const auto product = [&](std::span<const double> of, Index i) {
    double sum = 0;
    for (Offset k = offsets[i]; k < offsets[i + 1]; ++k) sum += system.values[k] * of[neighbours[k]];
    return diagonal(i) * of[i] + alpha * sum;
  };
  struct Norms {
    double rr = 0, rz = 0;
    Norms& operator+=(const Norms& other) {
      rr += other.rr;
      rz += other.rz;
      return *this;
    }
  };
  std::vector<double> r(n, 0);
  std::vector<double> d(n, 0);
  std::vector<double> q(n, 0);
  std::vector<double> inverse(n, 0);  // 1 / diagonal; 0 in rows that are not solved
  auto norms = sum_over_chunks<Norms>(n, kParticlesInChunk, [&](Index begin, Index end) {
    Norms part;
    for (Index i = begin; i < end; ++i) {
      if (held[i] != 0 || !(diagonal(i) > 0)) continue;
      inverse[i] = 1 / diagonal(i);
      r[i] = b[i] - product(x, i);
      d[i] = inverse[i] * r[i];
      part += {r[i] * r[i], r[i] * d[i]};
    }
    return part;
  });
  const double target = options.tolerance * options.tolerance *
                        sum_over_chunks<double>(n, kParticlesInChunk, [&](Index begin, Index end) {
                          double part = 0;
                          for (Index i = begin; i < end; ++i) part += inverse[i] > 0 ? b[i] * b[i] : 0;
                          return part;
                        });
  SolveReport report;
  const double first = norms.rr;
  while (!(norms.rr <= target)) {
    if (!std::isfinite(norms.rr)) {
      report.status = SolveStatus::not_finite;
      break;
    }
    if (report.iterations == options.max_iterations) {
      report.status = SolveStatus::iteration_limit;
      break;
    }
    const auto curvature = sum_over_chunks<double>(n, kParticlesInChunk, [&](Index begin, Index end) {
      double part = 0;
      for (Index i = begin; i < end; ++i) {
        q[i] = inverse[i] > 0 ? product(d, i) : 0;
        part += q[i] * d[i];
      }
      return part;
    });
    if (!(curvature > 0)) {
      report.status = std::isfinite(curvature) ? SolveStatus::negative_curvature : SolveStatus::not_finite;
      break;
    }
    const double step = norms.rz / curvature;
    const auto next = sum_over_chunks<Norms>(n, kParticlesInChunk, [&](Index begin, Index end) {
      Norms part;
      for (Index i = begin; i < end; ++i) {
        x[i] += step * d[i];
        r[i] -= step * q[i];
        part += {r[i] * r[i], r[i] * inverse[i] * r[i]};
      }
      return part;
    });
    const double ratio = next.rz / norms.rz;
    norms = next;
    for_each_chunk(n, kParticlesInChunk, [&](Index /*chunk*/, Index begin, Index end) {
      for (Index i = begin; i < end; ++i) d[i] = inverse[i] * r[i] + ratio * d[i];
    });
    ++report.iterations;
  }
  report.residual = first > 0 ? std::sqrt(norms.rr / first) : 0;
  return report;
}

std::vector<double> divergence(const FluidMesh& mesh, std::span<const Point> points,
                               std::span<const Point> u) {
  std::vector<double> result(points.size(), 0);
  for_each_tetrahedron(mesh, points, [&](const Index* corners, const auto& g, const auto& owned) {
    Point mean{};
    for (int i = 0; i < 4; ++i) mean = plus_scaled(mean, 0.25, u[corners[i]]);
    for (int i = 0; i < 4; ++i) {
      if (owned.has(corners[i])) result[corners[i]] += dot(g.of_corner[i], mean);
    }
  });
  return result;
}

std::vector<Point> gradient(const FluidMesh& mesh, std::span<const Point> points, std::span<const double> p) {
  std::vector<Point> result(points.size(), Point{});
  for_each_tetrahedron(mesh, points, [&](const Index* corners, const auto& g, const auto& owned) {
    Point sum{};
    for (int i = 0; i < 4; ++i) sum = plus_scaled(sum, p[corners[i]], g.of_corner[i]);
    for (int i = 0; i < 4; ++i) {
      if (owned.has(corners[i])) result[corners[i]] = plus_scaled(result[corners[i]], 0.25, sum);
    }
  });
  return result;
}

std::vector<std::array<Point, 3>> gradient(const FluidMesh& mesh, std::span<const Point> points,
                                           std::span<const Point> u) {
  std::vector<std::array<Point, 3>> result(points.size(), std::array<Point, 3>{});
  for_each_tetrahedron(mesh, points, [&](const Index* corners, const auto& g, const auto& owned) {
    std::array<Point, 3> sum{};
    for (int i = 0; i < 4; ++i) {
      for (int c = 0; c < 3; ++c) sum[c] = plus_scaled(sum[c], u[corners[i]][c], g.of_corner[i]);
    }
    for (int i = 0; i < 4; ++i) {
      if (!owned.has(corners[i])) continue;
      for (int c = 0; c < 3; ++c) result[corners[i]][c] = plus_scaled(result[corners[i]][c], 0.25, sum[c]);
    }
  });
  return result;
}

}  // namespace meshorder
