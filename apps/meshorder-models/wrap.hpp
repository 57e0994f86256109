// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "surface.hpp"

namespace meshorder::models {

/// Lengths of a wrap. Each is given by a ratio: the diagonal of the surface's bounding box divided by the
/// length. Larger ratios give finer wraps.
struct WrapOptions {
  double alpha_ratio = 200;  ///< diagonal / alpha; alpha bounds the size of the wrap's triangles
  double offset_ratio =
      2500;  ///< diagonal / offset; the wrap stays at about that distance outside the surface
};

/// Returns a closed, oriented, manifold surface without self-intersections around the given triangles,
/// which may intersect each other and leave holes smaller than alpha.
///
/// The same input gives the same output in every run.
/// Throws `InputError` if all triangles are degenerate, or if the size of their box is not in 1e-100 … 1e100.
/// CGAL's alpha wrap: Portaneri et al., "Alpha wrapping with an offset", ACM TOG 41(4), 2022.
/// Time and memory grow with the square of `alpha_ratio`.
Surface wrap(const Surface& surface, const WrapOptions& options);

}  // namespace meshorder::models
