// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/half_storage.hpp"

namespace meshorder {

bool half_storage_pays(const BlockCsr& matrix) {
  // larger than most second-level caches; for a smaller matrix the copy does not pay
  constexpr Offset kMinBytes = Offset{4} << 20;
  // stored blocks are read at some 0.8 of the full matrix's rate, and (1 + share) / 2 of all are stored: the
  // break-even share is 0.6
  constexpr double kMaxShare = 0.5;
  constexpr Offset kBlockBytes = 9 * sizeof(double) + sizeof(Index);
  return kBlockBytes * matrix.block_count() >= kMinBytes && share_between_slabs(matrix) < kMaxShare;
}

}  // namespace meshorder
