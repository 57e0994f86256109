// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/block_csr.hpp"

#include <span>

namespace meshorder {

/// Computes y = A x for a matrix in double or float; sums are in double. x and y hold 3 doubles for each
/// vertex and must not overlap. Throws InvalidArgument if a size differs. O(blocks); each block is read once,
/// so that memory bandwidth is the limit in a good order.
template <class Value>
void multiply(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y);

/// Computes only the rows begin_row … end_row − 1 of that product, with the same bits, so that threads can
/// share the rows.
template <class Value>
void multiply_rows(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                   Index begin_row, Index end_row);

/// As above; returns the part of xᵀA x that these rows contribute.
template <class Value>
double multiply_rows_dot(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                         Index begin_row, Index end_row);

}  // namespace meshorder
