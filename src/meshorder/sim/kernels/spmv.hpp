// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/sim/kernels/block_csr.hpp>

#include <span>

namespace meshorder {

/// y = A x, the product that a conjugate gradient solver repeats. x and y hold 3 doubles for each vertex and
/// must not overlap. Throws InvalidArgument when a size does not fit. O(blocks); each block is read once, so
/// that in a good order the memory's bandwidth is the limit.
void multiply(const BlockCsr& matrix, std::span<const double> x, std::span<double> y);

/// The rows begin_row … end_row − 1 of that product alone, for threads to share the rows; the same bits.
void multiply_rows(const BlockCsr& matrix, std::span<const double> x, std::span<double> y, Index begin_row,
                   Index end_row);

}  // namespace meshorder
