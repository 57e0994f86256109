// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cg/solve.hpp"

#include "base/parallel.hpp"
#include "kernels/block_csr.hpp"
#include "kernels/owned_batches.hpp"
#include "lab/linear/cg/vector_passes.hpp"
#include "lab/linear/preconditioners/jacobi.hpp"
#include <meshorder/error.hpp>

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Repeated passes over the rows of a matrix, in chunks of about equal numbers of blocks. The chunks depend
/// only on the matrix, so that sums over them are the same for any number of threads. A thread has the same
/// chunks in every pass. Passes alternate their direction, so that each begins with the rows that are still
/// in the caches.
class RowSweeps {
 public:
  explicit RowSweeps(std::vector<Index> bounds) : bounds_(std::move(bounds)) {}

  /// Calls `work(begin, end)` for the rows of each chunk, on all threads.
  template <class Work>
  void run(Work work) {
    run_chunks([&](Index chunk) { work(bounds_[chunk], bounds_[chunk + 1]); });
  }

  /// Returns the sum of `part(begin, end)` over the chunks, in their order.
  template <class Sum, class Part>
  Sum sum(Part part) {
    return sum_over<Sum>([&](Index chunk) { return part(bounds_[chunk], bounds_[chunk + 1]); });
  }

  /// Returns the sum of `part(chunk)` over the chunks, in their order.
  template <class Sum, class Part>
  Sum sum_over(Part part) {
    std::vector<Sum> parts(bounds_.size() - 1);
    run_chunks([&](Index chunk) { parts[chunk] = part(chunk); });
    Sum sum{};
    for (const Sum& p : parts) sum += p;
    return sum;
  }

  [[nodiscard]] Index begin(Index chunk) const { return bounds_[chunk]; }
  [[nodiscard]] Index end(Index chunk) const { return bounds_[chunk + 1]; }

 private:
  template <class Work>
  void run_chunks(Work work) {
    const bool backwards = backwards_;
    backwards_ = !backwards_;
    const Index chunks = index_size(bounds_) - 1;
    const auto run_some = [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) work(backwards ? end - 1 - (i - begin) : i);
    };
    // a thread with only one chunk would spend most of its time on start-up
    const Index parts = std::clamp<Index>(chunks / 2, 1, tbb::this_task_arena::max_concurrency());
    if (parts == 1) return run_some(0, chunks);
    const auto bound = [&](Index part) { return static_cast<Index>(Offset{chunks} * part / parts); };
    for_each_part(parts, [&](Index part) { run_some(bound(part), bound(part + 1)); });
  }

  std::vector<Index> bounds_;
  bool backwards_ = false;
};

/// Returns the bounds of the chunks of rows. O(chunks · log rows).
template <class Value>
std::vector<Index> chunks_of(const BlockCsrOf<Value>& matrix) {
  // 0.6 MB in double: a chunk's overhead is negligible, and there are enough chunks for all threads
  constexpr Offset kChunkBlocks = 8192;
  return balanced_ranges(matrix.offsets, static_cast<Index>(1 + matrix.block_count() / kChunkBlocks));
}

template <class Value>
std::vector<Index> chunks_of(const HalfBlockCsrOf<Value>& matrix) {
  return matrix.slabs;
}

/// Computes q = A p in the rows of a chunk; returns these rows' part of pᵀA p.
template <class Value>
double multiply_chunk(const BlockCsrOf<Value>& matrix, const RowSweeps& rows, Index chunk,
                      std::span<const double> p, std::span<double> q) {
  return multiply_rows_dot(matrix, p, q, rows.begin(chunk), rows.end(chunk));
}

template <class Value>
double multiply_chunk(const HalfBlockCsrOf<Value>& matrix, const RowSweeps& /*rows*/, Index chunk,
                      std::span<const double> p, std::span<double> q) {
  return multiply_slab_dot(matrix, p, q, chunk);
}

/// rᵀr and rᵀz of the residual r and z = M⁻¹ r.
struct Norms {
  double rr = 0.0, rz = 0.0;
  Norms& operator+=(const Norms& other) {
    rr += other.rr;
    rz += other.rz;
    return *this;
  }
  [[nodiscard]] bool finite() const { return std::isfinite(rr) && std::isfinite(rz); }
};

/// The vectors of the method, 3 doubles for each vertex.
struct Vectors {
  AlignedVector<double> r;  ///< the residual
  AlignedVector<double> z;  ///< M⁻¹ r
  AlignedVector<double> p;  ///< the search direction
  AlignedVector<double> q;  ///< A p

  explicit Vectors(std::size_t entries) : r(entries), z(entries), p(entries), q(entries) {}
};

/// Returns the first vertex with an entry that is not finite; −1 if all entries are finite.
Index first_not_finite(std::span<const double> vector) {
  const auto found =
      std::find_if(vector.begin(), vector.end(), [](double entry) { return !std::isfinite(entry); });
  return found == vector.end() ? -1 : static_cast<Index>((found - vector.begin()) / 3);
}

template <class Matrix>
class ConjugateGradients {
 public:
  ConjugateGradients(const Matrix& matrix, const Preconditioner& preconditioner, std::span<const double> b,
                     std::span<double> x, const SolveOptions& options)
      : matrix_(matrix),
        preconditioner_(preconditioner),
        local_(dynamic_cast<const LocalPreconditioner*>(&preconditioner)),
        b_(b),
        x_(x),
        options_(options),
        rows_(chunks_of(matrix)),
        v_(x.size()) {}

  SolveReport run() {
    start();
    if (!std::isfinite(norms_.rr)) return not_finite();
    if (norms_.rr == 0.0) return report(SolveStatus::converged);
    precondition();
    if (!norms_.finite()) return not_finite();
    if (norms_.rz <= 0.0) return report(SolveStatus::breakdown);
    if (options_.max_iterations == 0) return report(SolveStatus::iteration_limit);
    v_.p = v_.z;
    for (;;) {
      const double curvature = multiply_direction();
      if (!std::isfinite(curvature)) return not_finite();
      if (curvature <= 0.0) return report(SolveStatus::negative_curvature);
      const double alpha = norms_.rz / curvature;
      const Norms before = norms_;
      reduce_residual(alpha);
      if (!std::isfinite(alpha) || !norms_.finite()) {
        norms_ = before;
        return not_finite();
      }
      ++iterations_;
      const bool converged = residual() <= options_.tolerance;
      if (converged || norms_.rz <= 0.0 || iterations_ >= options_.max_iterations) {
        rows_.run([&](Index begin, Index end) { passes::add(alpha, v_.p, x_, begin, end); });
        if (converged) return report(SolveStatus::converged);
        return report(norms_.rz <= 0.0 ? SolveStatus::breakdown : SolveStatus::iteration_limit);
      }
      const double beta = norms_.rz / before.rz;
      rows_.run([&](Index begin, Index end) { passes::step(alpha, beta, v_.z, v_.p, x_, begin, end); });
    }
  }

 private:
  // number of rows whose r, z, q and preconditioner data fit into the L1 cache together
  static constexpr Index kTile = 128;

  /// Computes r = b − A x.
  void start() {
    norms_.rr = rows_.sum_over<double>([&](Index chunk) {
      (void)multiply_chunk(matrix_, rows_, chunk, x_, v_.r);
      return passes::subtract_from(b_, v_.r, rows_.begin(chunk), rows_.end(chunk));
    });
    first_rr_ = norms_.rr;
  }

  /// Computes z = M⁻¹ r.
  void precondition() {
    preconditioner_.apply(v_.r, v_.z);
    norms_.rz =
        rows_.sum<double>([&](Index begin, Index end) { return passes::dot(v_.r, v_.z, begin, end); });
  }

  /// Computes q = A p; returns pᵀq.
  double multiply_direction() {
    return rows_.sum_over<double>(
        [&](Index chunk) { return multiply_chunk(matrix_, rows_, chunk, v_.p, v_.q); });
  }

  /// Computes r −= α q and z = M⁻¹ r.
  void reduce_residual(double alpha) {
    if (local_ == nullptr) {
      norms_.rr = rows_.sum<double>(
          [&](Index begin, Index end) { return passes::subtract(alpha, v_.q, v_.r, begin, end); });
      precondition();
      return;
    }
    norms_ = rows_.sum<Norms>([&](Index begin, Index end) {
      Norms norms;
      for (Index first = begin; first < end; first += kTile) {
        const Index last = std::min(first + kTile, end);
        norms.rr += passes::subtract(alpha, v_.q, v_.r, first, last);
        local_->apply_rows(v_.r.data(), v_.z.data(), first, last);
        norms.rz += passes::dot(v_.r, v_.z, first, last);
      }
      return norms;
    });
  }

  [[nodiscard]] double residual() const {
    return first_rr_ > 0.0 ? std::sqrt(norms_.rr) / std::sqrt(first_rr_) : 0.0;
  }

  [[nodiscard]] SolveReport report(SolveStatus status) const {
    const bool converged = status == SolveStatus::converged;
    return {status, iterations_, residual(), converged ? Index{-1} : largest_vertex(v_.r)};
  }

  /// Reports the first vertex with a number that is not finite. Searches b and x, then p, q, r and z: the
  /// order in which a bad row of the matrix spoils them.
  [[nodiscard]] SolveReport not_finite() const {
    Index vertex = first_not_finite(b_);
    if (vertex < 0) vertex = first_not_finite(x_);
    for (const auto* vector : {&v_.p, &v_.q, &v_.r, &v_.z}) {
      if (vertex < 0) vertex = first_not_finite(*vector);
    }
    // all entries are finite: only sums overflowed
    if (vertex < 0) vertex = largest_vertex(v_.r);
    return {SolveStatus::not_finite, iterations_, residual(), vertex};
  }

  const Matrix& matrix_;
  const Preconditioner& preconditioner_;
  const LocalPreconditioner* local_;
  std::span<const double> b_;
  std::span<double> x_;
  const SolveOptions& options_;
  RowSweeps rows_;
  Vectors v_;
  Norms norms_;
  double first_rr_ = 0.0;
  int iterations_ = 0;
};

/// Computes r = b − A x; returns ‖r‖.
double compute_residual(const BlockCsr& matrix, std::span<const double> b, std::span<const double> x,
                        std::span<double> r) {
  multiply(matrix, x, r);
  double sum = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    r[i] = b[i] - r[i];
    sum += r[i] * r[i];
  }
  return std::sqrt(sum);
}

}  // namespace

Index largest_vertex(std::span<const double> vector) {
  Index vertex = -1;
  double largest = -1.0;
  for (std::size_t i = 0; i < vector.size(); ++i) {
    if (std::abs(vector[i]) <= largest) continue;
    largest = std::abs(vector[i]);
    vertex = static_cast<Index>(i / 3);
  }
  return vertex;
}

template <class Matrix>
SolveReport conjugate_gradients(const Matrix& matrix, const Preconditioner& preconditioner,
                                std::span<const double> b, std::span<double> x, const SolveOptions& options) {
  const auto entries = 3 * static_cast<std::size_t>(matrix.size());
  if (b.size() != entries || x.size() != entries) {
    throw InvalidArgument("conjugate_gradients: b and x must hold 3 doubles for each of the matrix's " +
                          std::to_string(matrix.size()) + " vertices");
  }
  if (!(options.tolerance >= 0.0) || options.max_iterations < 0) {
    throw InvalidArgument("conjugate_gradients: tolerance and max_iterations must not be negative");
  }
  return ConjugateGradients(matrix, preconditioner, b, x, options).run();
}

template <class Rounded>
SolveReport refined_conjugate_gradients(const BlockCsr& matrix, const Rounded& rounded,
                                        const Preconditioner& preconditioner, std::span<const double> b,
                                        std::span<double> x, const SolveOptions& options) {
  constexpr int kCorrections = 10;
  constexpr double kMargin = 0.9;  // so that rounding seldom requires another correction
  std::vector<double> residual(b.size());
  std::vector<double> correction(b.size());
  const double start = compute_residual(matrix, b, x, residual);
  double norm = start;
  SolveReport total;
  if (start == 0.0) return total;
  for (int i = 0; i < kCorrections; ++i) {
    SolveOptions inner = options;
    inner.tolerance = std::min(0.5, kMargin * options.tolerance * start / norm);
    inner.max_iterations = options.max_iterations - total.iterations;
    std::fill(correction.begin(), correction.end(), 0.0);
    SolveReport report = conjugate_gradients(rounded, preconditioner, residual, correction, inner);
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += correction[k];
    report.iterations += total.iterations;
    norm = compute_residual(matrix, b, x, residual);
    report.residual = norm / start;
    total = report;
    if (report.status != SolveStatus::converged || norm <= options.tolerance * start) return total;
  }
  total.status = SolveStatus::iteration_limit;
  return total;
}

template SolveReport conjugate_gradients(const BlockCsr&, const Preconditioner&, std::span<const double>,
                                         std::span<double>, const SolveOptions&);
template SolveReport conjugate_gradients(const BlockCsrOf<float>&, const Preconditioner&,
                                         std::span<const double>, std::span<double>, const SolveOptions&);
template SolveReport conjugate_gradients(const HalfBlockCsr&, const Preconditioner&, std::span<const double>,
                                         std::span<double>, const SolveOptions&);
template SolveReport conjugate_gradients(const HalfBlockCsrOf<float>&, const Preconditioner&,
                                         std::span<const double>, std::span<double>, const SolveOptions&);
template SolveReport refined_conjugate_gradients(const BlockCsr&, const BlockCsrOf<float>&,
                                                 const Preconditioner&, std::span<const double>,
                                                 std::span<double>, const SolveOptions&);
template SolveReport refined_conjugate_gradients(const BlockCsr&, const HalfBlockCsrOf<float>&,
                                                 const Preconditioner&, std::span<const double>,
                                                 std::span<double>, const SolveOptions&);

}  // namespace meshorder
