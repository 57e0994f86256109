// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/nested_start.hpp"

#include "base/random.hpp"
#include "spectral/lowest.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace meshorder {

namespace {

constexpr Index kFewVertices = 300;          // a search on this many vertices takes a third of a millisecond
constexpr Index kSmallShare = 50;            // a search on a graph of n / 50 vertices costs little
constexpr double kSmoothedHides = 1.0 / 16;  // larger graphs: search if a value below this · λ may hide
constexpr double kNearlyEqual = 0.9;         // values above this share of an eigenvalue count as equal

}  // namespace

void fill_with_noise(StartBlock& x, int first_column, std::uint64_t seed) {
  Random random(seed);
  for (auto& row : x) {
    for (int m = first_column; m < kStartColumns; ++m) row[m] = random.unit() - 0.5;
  }
}

LobpcgOptions coarse_search(TimeLimit limit) {
  return {.tolerance = 1, .max_iterations = 30, .limit = limit};
}

StartBlock nested_start(const Hierarchy& hierarchy, std::uint64_t seed, TimeLimit limit) {
  const auto& levels = hierarchy.levels();
  int level = static_cast<int>(levels.size()) - 1;
  StartBlock x;
  int known = 0;  // number of columns of x that are set
  if (hierarchy.has_exact_coarsest()) {
    x = hierarchy.coarsest_eigenvectors<kStartColumns>();
    known = std::min(kStartColumns, static_cast<int>(x.size()) - 1);
    --level;
  } else {
    level = 0;
  }
  for (; level >= 0; --level) {
    StartBlock finer(levels[level].laplacian.size(), std::array<double, kStartColumns>{});
    if (known > 0) hierarchy.add_prolonged<kStartColumns>(level, 1, x, finer);
    x = std::move(finer);
    if (known == kStartColumns) {
      hierarchy.smooth<kStartColumns>(level, x);
    } else {
      fill_with_noise(x, known, seed);
      known = kStartColumns;
    }
    if (level == 0) break;
    const LobpcgResult found = lobpcg<kStartColumns>(hierarchy, level, coarse_search(limit), x);
    const bool is_small =
        levels[level].laplacian.size() <= std::max(kFewVertices, levels[0].laplacian.size() / kSmallShare);
    const double least = kNearlyEqual * found.eigenvalue;
    if (!hierarchy.may_hide(level, least * (is_small ? 1 : kSmoothedHides))) continue;
    LevelProblem problem(hierarchy, level);
    const LobpcgOptions search{.max_iterations = kSearchIterations, .limit = limit};
    find_lower(problem, least, search, seed + 1, x);
  }
  return x;
}

VectorBlock<1> column(const StartBlock& x, int m) {
  VectorBlock<1> result(x.size());
  for (std::size_t v = 0; v < x.size(); ++v) result[v][0] = x[v][m];
  return result;
}

}  // namespace meshorder
