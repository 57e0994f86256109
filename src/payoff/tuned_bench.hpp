// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/assembly.hpp"
#include "kernels/springs.hpp"
#include "payoff/kernel_bench.hpp"

#include <vector>

namespace meshorder {

/// The simulators' own kernels: elastic elements and springs in batches, a matrix of 3×3 blocks. Results have
/// 3 doubles a vertex for spmv, 4 for forces (see padded_positions), 9 a block for assembly.
class TunedBench final : public CopiedBench<TunedBench> {
 public:
  explicit TunedBench(const KernelInput& input);

  void share(int threads) override;
  [[nodiscard]] std::span<const double> result(Kernel kernel) const override;
  [[nodiscard]] double streamed_bytes(Kernel kernel) const override;
  [[nodiscard]] std::size_t bytes() const override;
  [[nodiscard]] double redundancy() const override;

 private:
  void compute(Kernel kernel) override;

  /// The work of one thread.
  struct Share {
    OwnedBatches elements;
    OwnedBlocks blocks;
    OwnedBatches springs;
  };

  void run_shared(Kernel kernel);

  BlockCsr matrix_;
  RestShapes rest_;
  AssemblyMap map_;
  Springs springs_;
  AlignedVector<double> positions_;
  AlignedVector<double> forces_;
  AlignedVector<double> x_;
  AlignedVector<double> y_;
  std::vector<Share> shares_;  ///< empty for one thread
};

}  // namespace meshorder
