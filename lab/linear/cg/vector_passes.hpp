// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <span>

namespace meshorder::passes {

// Vector operations of conjugate gradients for the vertices begin … end − 1, 3 doubles for each vertex. The
// order of each sum depends only on begin and end.

/// Returns aᵀb.
double dot(std::span<const double> a, std::span<const double> b, Index begin, Index end);

/// Computes y = b − y; returns yᵀy.
double subtract_from(std::span<const double> b, std::span<double> y, Index begin, Index end);

/// Computes r −= α q; returns rᵀr.
double subtract(double alpha, std::span<const double> q, std::span<double> r, Index begin, Index end);

/// Computes x += α p.
void add(double alpha, std::span<const double> p, std::span<double> x, Index begin, Index end);

/// Computes x += α p, then p = z + β p.
void step(double alpha, double beta, std::span<const double> z, std::span<double> p, std::span<double> x,
          Index begin, Index end);

}  // namespace meshorder::passes
