// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "kernels/half_block_csr.hpp"

#include <cstdint>
#include <span>

namespace meshorder {

class Preconditioner;

/// How a linear solve ended.
enum class SolveStatus : std::uint8_t {
  converged,
  iteration_limit,     ///< x is the last iterate, the best so far in the energy norm
  negative_curvature,  ///< pᵀAp ≤ 0 for the search direction p: A is not positive definite
  breakdown,   ///< rᵀM⁻¹r ≤ 0 for the residual r: the preconditioner M is not positive definite
  not_finite,  ///< NaN or infinity in the matrix, the right-hand side or an iterate
};

template <>
struct EnumNames<SolveStatus> {
  static constexpr std::string_view kind = "solve status";
  static constexpr std::array names{std::pair{SolveStatus::converged, "converged"},
                                    std::pair{SolveStatus::iteration_limit, "iteration limit"},
                                    std::pair{SolveStatus::negative_curvature, "negative curvature"},
                                    std::pair{SolveStatus::breakdown, "breakdown"},
                                    std::pair{SolveStatus::not_finite, "not finite"}};
};

struct SolveOptions {
  double tolerance = 1e-6;  ///< bound of ‖b − A x‖ / ‖b − A x₀‖ with the first guess x₀
  int max_iterations = 10'000;
};

struct SolveReport {
  SolveStatus status = SolveStatus::converged;
  int iterations = 0;
  double residual = 0.0;  ///< ‖b − A x‖ / ‖b − A x₀‖; conjugate_gradients updates b − A x by recurrence
  /// The vertex with the largest residual; after `not_finite`, the first vertex with a number that is not
  /// finite, if any. −1 if the solve converged.
  Index vertex = -1;
};

/// Returns the vertex with the largest absolute entry; −1 if the vector is empty. The vector has 3 doubles
/// for each vertex. O(n).
Index largest_vertex(std::span<const double> vector);

/// Solves A x = b by preconditioned conjugate gradients (Hestenes, Stiefel 1952). A must be symmetric and
/// positive definite. x is the first guess and becomes the result; vectors have 3 doubles for each vertex.
/// The preconditioner must have been updated with the matrix. In all cases x ends as the last valid iterate;
/// a search direction of negative curvature is not added. The result has the same bits for any number of
/// threads. An iteration takes O(blocks) time; a solve allocates 4 times the size of b. Numbers whose squares
/// are too small for a double count as 0. Throws InvalidArgument if sizes differ or an option is negative.
///
/// `Matrix` is BlockCsrOf or HalfBlockCsrOf (results differ by rounding), of double or float. In float an
/// iteration reads about half as many bytes. The solution is that of the rounded matrix: its relative error
/// is up to 6e-8 times the condition number. Vectors and sums are in double. HalfBlockCsrOf stores half of
/// the matrix: in a good order an iteration reads little more than half as many bytes; at most 8 threads
/// share its 16 slabs.
template <class Matrix>
SolveReport conjugate_gradients(const Matrix& matrix, const Preconditioner& preconditioner,
                                std::span<const double> b, std::span<double> x,
                                const SolveOptions& options = {});

/// Solves A x = b to the same residual as conjugate_gradients(matrix, …), but iterates with `rounded`, the
/// same matrix in single precision, BlockCsrOf<float> or HalfBlockCsrOf<float>. While ‖b − A x‖ is too large,
/// the function solves for a correction, at most 10 times (iterative refinement, Wilkinson 1963). Reports the
/// sum of the iterations for all corrections. Measured in docs/evidence/benchmarks.md.
template <class Rounded>
SolveReport refined_conjugate_gradients(const BlockCsr& matrix, const Rounded& rounded,
                                        const Preconditioner& preconditioner, std::span<const double> b,
                                        std::span<double> x, const SolveOptions& options = {});

}  // namespace meshorder
