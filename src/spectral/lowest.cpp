// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/lowest.hpp"

#include "spectral/nested_start.hpp"

#include <algorithm>
#include <utility>

namespace meshorder {

int find_lower(EigenProblem& problem, double least, const LobpcgOptions& options, std::uint64_t seed,
               VectorBlock<2>& x) {
  StartBlock block = x;
  fill_with_noise(block, 1, seed);
  LobpcgOptions search = options;
  search.max_iterations = std::min(kSearchIterations, options.max_iterations);
  search.until_calm = true;
  const LobpcgResult found = lobpcg<2, 0>(problem, search, block, {});
  if (!(found.eigenvalue < least)) return 0;
  x = std::move(block);
  return found.iterations;
}

LobpcgResult lowest_eigenvector(EigenProblem& problem, const LobpcgOptions& options, std::uint64_t seed,
                                VectorBlock<1>& x, VectorBlock<1> companion) {
  constexpr int kRounds = 5;  // maximum number of searches for a lower eigenvalue
  // the Rayleigh quotient of x is within the tolerance of an eigenvalue; an eigenvalue that is less than this
  // share of the quotient is therefore a different one
  const double nearly_equal = 1 - std::clamp(options.tolerance, 1e-6, 0.1);
  LobpcgResult result = lobpcg<1, 1>(problem, options, x, std::move(companion));
  for (std::uint64_t round = 1; round <= kRounds; ++round) {
    if (!result.converged || !problem.may_hide(nearly_equal * result.eigenvalue)) break;
    StartBlock block(x.size());
    for (std::size_t v = 0; v < x.size(); ++v) block[v][0] = x[v][0];
    const int more = find_lower(problem, nearly_equal * result.eigenvalue, options, seed + round, block);
    if (more == 0) break;
    const int before = result.iterations + more;
    LobpcgOptions rest = options;
    rest.max_iterations = std::max(0, options.max_iterations - before);
    x = column(block, 0);
    result = lobpcg<1, 1>(problem, rest, x, column(block, 1));
    result.iterations += before;
  }
  return result;
}

}  // namespace meshorder
