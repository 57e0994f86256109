// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/half_block_csr.hpp"

namespace meshorder {

/// Returns whether repeated products with a symmetric matrix of this pattern are expected to be faster with
/// half of it stored (see HalfBlockCsr): where the matrix is too large for a core's own caches, and its order
/// leaves less than half of the blocks between slabs. The same on every machine, by the measurements in
/// docs/evidence/benchmarks.md. O(blocks), of which only the columns are read.
bool half_storage_pays(const BlockCsr& matrix);

}  // namespace meshorder
