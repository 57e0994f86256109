// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/block_csr.hpp"

#include <span>

namespace meshorder {

/// y = A x, the product that a conjugate gradient solver repeats, for a matrix in double or float; sums are
/// in double. x and y hold 3 doubles for each vertex and must not overlap. Throws InvalidArgument if a size
/// differs. O(blocks); each block is read once, so that memory bandwidth is the limit in a good order.
template <class Value>
void multiply(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y);

/// Computes the rows begin_row … end_row − 1 of that product only, so that threads can share the rows; the
/// same bits.
template <class Value>
void multiply_rows(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                   Index begin_row, Index end_row);

/// The same; returns the part of xᵀA x of these rows.
template <class Value>
double multiply_rows_dot(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                         Index begin_row, Index end_row);

}  // namespace meshorder
