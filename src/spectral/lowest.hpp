// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "spectral/lobpcg.hpp"

#include <cstdint>

namespace meshorder {

constexpr int kSearchIterations = 40;  ///< of `find_lower`; about six are needed

/// Looks for an eigenvalue below `least`: iterates column 0 of `x` beside a random vector until nothing
/// changes. What is below column 0 grows in the random vector, also where symmetry keeps column 0 apart from
/// it. Returns the iterations that `x` went through; 0 where nothing was found, and `x` is as it was then.
/// O(graph) an iteration.
///
/// @param options  max_iterations and limit
int find_lower(EigenProblem& problem, double least, const LobpcgOptions& options, std::uint64_t seed,
               VectorBlock<2>& x);

/// Improves `x` by `lobpcg` towards the eigenvector of the smallest eigenvalue after that of the constant
/// vector, and makes sure that it is this one where that is in doubt.
///
/// A small residual says that λ is near an eigenvalue, not which: where most eigenvalues are about equal, as
/// those of cliques, even random vectors have one. Coarse graphs find the right one unless an aggregate hides
/// it, see `EigenProblem::may_hide`. There `find_lower` follows, and the solution goes on from what it finds.
/// That takes about as long as the solution; elsewhere little is added.
///
/// @param seed   of the random vectors
/// @return iterations: those that x went through
LobpcgResult lowest_eigenvector(EigenProblem& problem, const LobpcgOptions& options, std::uint64_t seed,
                                VectorBlock<1>& x, VectorBlock<1> companion);

}  // namespace meshorder
