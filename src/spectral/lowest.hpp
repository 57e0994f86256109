// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "spectral/lobpcg.hpp"

#include <cstdint>

namespace meshorder {

constexpr int kSearchIterations = 40;  ///< limit on the iterations of `find_lower`; about six are needed

/// Looks for an eigenvalue below `least`: iterates column 0 of `x` together with a random vector until
/// neither changes. The random vector grows towards lower eigenvectors, even if symmetry keeps column 0
/// orthogonal to them. Returns the number of iterations and puts the result in `x`; if it finds no such
/// eigenvalue, returns 0 and leaves `x` unchanged. O(graph) time for each iteration.
///
/// @param options  only max_iterations and limit are used
int find_lower(EigenProblem& problem, double least, const LobpcgOptions& options, std::uint64_t seed,
               VectorBlock<2>& x);

/// Improves `x` by `lobpcg` towards the eigenvector of the smallest eigenvalue after that of the constant
/// vector. If there may be a smaller eigenvalue, searches for it.
///
/// A small residual shows that λ is near an eigenvalue, but not near which one: if most eigenvalues are about
/// equal, as for cliques, even random vectors have a small residual. Coarse graphs find the right eigenvalue
/// unless an aggregate hides it (see `EigenProblem::may_hide`). If that is possible, `find_lower` searches,
/// and the iteration continues from its result. The search takes about as long as the iteration; finding that
/// no search is needed costs little.
///
/// @param seed   of the random vectors
/// @return `iterations` includes those of searches that found a lower eigenvalue
LobpcgResult lowest_eigenvector(EigenProblem& problem, const LobpcgOptions& options, std::uint64_t seed,
                                VectorBlock<1>& x, VectorBlock<1> companion);

}  // namespace meshorder
