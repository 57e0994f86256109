// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/stored_matrix.hpp"
#include "payoff/kernel_bench.hpp"

#include <vector>

namespace meshorder {

/// The product with a matrix of exactly this pattern, in the storage of `PlainBench` (one number per entry).
/// All values of the matrix are 1, and entry i of the vector is i + 1; times do not depend on these numbers.
class ProductBench final : public CopiedBench<ProductBench> {
 public:
  explicit ProductBench(EntryPattern pattern);

  [[nodiscard]] std::span<const Kernel> kernels() const override;
  void share(int threads) override;
  [[nodiscard]] std::span<const double> result(Kernel kernel) const override;
  [[nodiscard]] double streamed_bytes(Kernel kernel) const override;
  [[nodiscard]] std::size_t bytes() const override;
  [[nodiscard]] double redundancy() const override { return 0; }

 private:
  /// Throws InvalidArgument for kernels other than spmv.
  void compute(Kernel kernel) override;
  void run_rows(Index begin, Index end);

  EntryPattern pattern_;
  std::vector<double> values_;
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<Index> bounds_;  ///< bounds of the threads' rows; empty for one thread
};

}  // namespace meshorder
