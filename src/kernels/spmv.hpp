// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/block_csr.hpp"

#include <span>

namespace meshorder {

/// y = A x, the product that a conjugate gradient solver repeats, for a matrix in double or float; sums are
/// in double. x and y hold 3 doubles for each vertex and must not overlap. Throws InvalidArgument when a size
/// does not fit. O(blocks); each block is read once, so that in a good order the memory's bandwidth is the
/// limit.
template <class Value>
void multiply(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y);

/// The rows begin_row … end_row − 1 of that product alone, for threads to share the rows; the same bits.
template <class Value>
void multiply_rows(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                   Index begin_row, Index end_row);

/// The same, and the part of xᵀA x that these rows make up.
template <class Value>
double multiply_rows_dot(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                         Index begin_row, Index end_row);

}  // namespace meshorder
