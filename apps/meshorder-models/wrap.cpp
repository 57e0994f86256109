// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "surface.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <algorithm>
#include <cmath>

namespace meshorder::models {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

double box_diagonal(const std::vector<Point>& points) {
  const auto box = CGAL::bbox_3(points.begin(), points.end());
  return std::hypot(box.x_span(), box.y_span(), box.z_span());
}

}  // namespace

Surface wrap(const Surface& surface, const WrapOptions& options) {
  std::vector<Point> points;
  points.reserve(surface.points.size());
  for (const auto& [x, y, z] : surface.points) points.emplace_back(x, y, z);

  const auto degenerate = [&](const std::array<std::uint32_t, 3>& t) {
    return CGAL::collinear(points[t[0]], points[t[1]], points[t[2]]);
  };
  if (std::ranges::all_of(surface.triangles, degenerate)) {
    throw InputError("all triangles are degenerate; a surface should have an area");
  }
  const double diagonal = box_diagonal(points);
  if (!(diagonal > 1e-100 && diagonal < 1e100)) {
    throw InputError("squares of its size exceed the range of double precision; scale it to a size near 1");
  }

  Mesh mesh;
  CGAL::alpha_wrap_3(points, surface.triangles, diagonal / options.alpha_ratio,
                     diagonal / options.offset_ratio, mesh);
  if (mesh.is_empty()) throw std::runtime_error("the wrap is empty; try other ratios");

  Surface result;
  result.points.reserve(mesh.number_of_vertices());
  result.triangles.reserve(mesh.number_of_faces());
  for (const auto v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    result.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : mesh.faces()) {
    const auto h = mesh.halfedge(f);
    const auto corner = [&](auto halfedge) {
      return static_cast<std::uint32_t>(mesh.target(halfedge).idx());
    };
    result.triangles.push_back({corner(h), corner(mesh.next(h)), corner(mesh.next(mesh.next(h)))});
  }
  return result;
}

}  // namespace meshorder::models
