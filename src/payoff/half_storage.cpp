// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/half_storage.hpp"

namespace meshorder {

bool half_storage_pays(const BlockCsr& matrix) {
  // larger than most second-level caches; what is copied for a smaller one is not worth its threads' start
  constexpr Offset kMinBytes = Offset{4} << 20;
  // what is stored is read at some 0.8 of the full matrix's rate: (1 + share) / 2 of it takes as long as all
  // at a share of 0.6
  constexpr double kMaxShare = 0.5;
  constexpr Offset kBlockBytes = 9 * sizeof(double) + sizeof(Index);
  return kBlockBytes * matrix.block_count() >= kMinBytes && share_between_slabs(matrix) < kMaxShare;
}

}  // namespace meshorder
