// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/cg/solve.hpp"
#include "lab/linear/preconditioners/preconditioner.hpp"

namespace meshorder {

/// Solves A x = b to the same residual as conjugate_gradients(matrix, …), while its iterations read
/// `rounded`, the same matrix in single precision: where the residual that A itself leaves is still too
/// large, the correction is solved for in the same way (iterative refinement, Wilkinson 1963). Iterations are
/// those of all corrections together.
SolveReport refined_conjugate_gradients(const BlockCsr& matrix, const BlockCsrOf<float>& rounded,
                                        const Preconditioner& preconditioner, std::span<const double> b,
                                        std::span<double> x, const SolveOptions& options = {});

}  // namespace meshorder
