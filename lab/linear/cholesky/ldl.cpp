// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cholesky/ldl.hpp"

#include <meshorder/error.hpp>

#include <cholmod.h>
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

namespace meshorder {
namespace {

/// CHOLMOD's settings and workspace. The factor is simplicial: CHOLMOD's modules for that are under the LGPL.
struct Cholmod {
  cholmod_common common{};

  Cholmod() {
    cholmod_start(&common);
    common.print = 0;
    common.error_handler = nullptr;
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NESDIS;
    // size of the parts that are not dissected: smaller parts take longer and save hardly any entries
    common.method[0].nd_small = 400;
  }
  ~Cholmod() { cholmod_finish(&common); }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  Cholmod(Cholmod&&) = delete;
  Cholmod& operator=(Cholmod&&) = delete;

  /// Throws if CHOLMOD reports an error; a matrix that is not positive definite is only a warning.
  void check() const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status == CHOLMOD_TOO_LARGE) {
      throw InvalidArgument("the matrix or its factor has more entries than CHOLMOD counts with 32 bits");
    }
    if (common.status < CHOLMOD_OK) {
      throw std::runtime_error(fmt::format("CHOLMOD failed with {}", common.status));
    }
  }
};

double diagonal_entry(const SparseMatrix& matrix, Index row) {
  const auto begin = matrix.columns.begin() + matrix.offsets[row];
  const auto end = matrix.columns.begin() + matrix.offsets[row + 1];
  const auto place = std::lower_bound(begin, end, row);
  return place != end && *place == row ? matrix.values[place - matrix.columns.begin()] : 0.0;
}

/// Largest rounding error of a pivot that should be 0, relative to the diagonal entry of the matrix.
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

Ldl copy_of(const cholmod_factor& factor, const SparseMatrix& matrix) {
  const Index n = matrix.size();
  Ldl ldl;
  const auto* const order = static_cast<const int*>(factor.Perm);
  const auto* const starts = static_cast<const int*>(factor.p);
  const auto* const counts = static_cast<const int*>(factor.nz);
  const auto* const rows = static_cast<const int*>(factor.i);
  const auto* const values = static_cast<const double*>(factor.x);
  ldl.new_to_old.assign(order, order + n);
  ldl.offsets.reserve(std::size_t(n) + 1);
  ldl.pivots.reserve(n);
  Offset entries = 0;
  for (Index j = 0; j < n; ++j) entries += counts[j] - 1;
  ldl.rows.reserve(entries);
  ldl.values.reserve(entries);
  for (Index j = 0; j < n; ++j) {
    // a column begins with its pivot
    const int begin = starts[j];
    const int end = begin + counts[j];
    const bool failed = static_cast<std::size_t>(j) >= factor.minor;
    const double pivot = failed ? 0.0 : values[begin];
    const double before = diagonal_entry(matrix, order[j]);
    if (!(pivot > kRounding * before)) {
      throw InvalidArgument(
          fmt::format("the matrix is not positive definite: row {} with the diagonal entry {} has the pivot "
                      "{}, within rounding, after {} other rows",
                      order[j], before, pivot, j));
    }
    ldl.pivots.push_back(pivot);
    ldl.rows.insert(ldl.rows.end(), rows + begin + 1, rows + end);
    ldl.values.insert(ldl.values.end(), values + begin + 1, values + end);
    ldl.offsets.push_back(static_cast<Offset>(ldl.rows.size()));
  }
  return ldl;
}

}  // namespace

Ldl factor_ldl(const SparseMatrix& matrix) {
  if (matrix.size() == 0) return {};
  if (matrix.offsets.back() > std::numeric_limits<int>::max()) {
    throw InvalidArgument("CHOLMOD counts the entries of a matrix with 32 bits; this one has more");
  }
  // the upper half by rows is the lower half by columns
  std::vector<int> offsets(matrix.offsets.begin(), matrix.offsets.end());
  cholmod_sparse view{};
  view.nrow = view.ncol = offsets.size() - 1;
  view.nzmax = matrix.columns.size();
  view.p = offsets.data();
  view.i = const_cast<Index*>(matrix.columns.data());  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  view.x = const_cast<double*>(matrix.values.data());  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;

  Cholmod cholmod;
  const auto free_factor = [&cholmod](cholmod_factor* factor) {
    cholmod_free_factor(&factor, &cholmod.common);
  };
  const std::unique_ptr<cholmod_factor, decltype(free_factor)> factor(cholmod_analyze(&view, &cholmod.common),
                                                                      free_factor);
  cholmod.check();
  cholmod_factorize(&view, factor.get(), &cholmod.common);
  cholmod.check();
  return copy_of(*factor, matrix);
}

}  // namespace meshorder
