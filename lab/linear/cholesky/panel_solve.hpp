// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/cholesky/cholesky.hpp"
#include "lab/linear/cholesky/panel_factor.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Scratch memory of one solve; concurrent solves need a workspace each.
template <class Real>
struct PanelWorkspace {
  explicit PanelWorkspace(const PanelFactor<Real>& factor);

  AlignedVector<Real> x;      ///< kPaddedStride numbers for each place
  std::vector<Index> marked;  ///< for each panel, the last search that met it
  Index searches = 0;
};

/// Computes x = A⁻¹ b in the order of the matrix, kPaddedStride numbers a vertex; x may be b. Runs on all
/// threads, with the same bits for any number of threads. O(entries).
template <class Real>
void solve_panels(const PanelFactor<Real>& factor, const Real* b, Real* x, PanelWorkspace<Real>& workspace);

/// Returns the panels needed for right-hand sides that are 0 except at these vertices (Gilbert 1994).
/// O(panels reached, times the logarithm of their number).
template <class Real>
FactorReach panels_reached(const PanelFactor<Real>& factor, std::span<const Index> vertices,
                           PanelWorkspace<Real>& workspace);

/// Does the same as solve_panels for a b that is 0 except at the vertices of `reach`; reads b and writes x
/// only there. O(reach.entries).
template <class Real>
void solve_panels(const PanelFactor<Real>& factor, const FactorReach& reach, const Real* b, Real* x,
                  PanelWorkspace<Real>& workspace);

}  // namespace meshorder
