// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/half_block_csr.hpp"

namespace meshorder {

/// Returns whether repeated products with a symmetric matrix of this pattern are expected to be faster with
/// half of it stored (see HalfBlockCsr): the matrix must have 4 MiB or more, too large for a core's own
/// caches, and less than half of its blocks between slabs. The answer is the same on every machine, by the
/// measurements in docs/evidence/benchmarks.md. O(blocks); reads only the columns.
bool half_storage_pays(const BlockCsr& matrix);

}  // namespace meshorder
