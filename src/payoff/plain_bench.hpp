// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/plain.hpp"
#include "payoff/kernel_bench.hpp"

#include <vector>

namespace meshorder {

/// The plain kernels: a matrix of one number per entry, with 32-bit columns; elements one after another;
/// edges sorted by their smaller end. Results have 1 double per vertex for spmv, 3 per vertex for forces, 1
/// per entry for assembly.
class PlainBench final : public CopiedBench<PlainBench> {
 public:
  explicit PlainBench(const KernelInput& input);

  void share(int threads) override;
  [[nodiscard]] std::span<const double> result(Kernel kernel) const override;
  [[nodiscard]] double streamed_bytes(Kernel kernel) const override;
  [[nodiscard]] std::size_t bytes() const override;
  [[nodiscard]] double redundancy() const override;

 private:
  void compute(Kernel kernel) override;
  double compute_stretches(Kernel kernel) override;

  /// The elements and edges that one thread computes; it adds only to the vertices `owned`.
  struct Share {
    plain::VertexRange owned;
    std::vector<Index> simplices;
    std::vector<Index> ends;
    std::vector<double> lengths;
  };

  void prepare_matrix(const KernelInput& input);
  void prepare_edges(const KernelInput& input);
  void prepare_vertices(const KernelInput& input);

  /// Runs one thread's part of a kernel; if `in_stretches`, on one in `kEvery` elements (see for_stretches).
  template <class Owned>
  void run_part(Kernel kernel, const Owned& owned, const Share& share, bool in_stretches);
  void run_parts(Kernel kernel, bool in_stretches);

  int corners_;  ///< corners of each simplex; 1 if there are no simplices
  Share all_;    ///< the whole work, for one thread
  std::vector<Offset> starts_;
  std::vector<Index> columns_;
  std::vector<double> values_;
  std::vector<double> positions_;
  std::vector<double> forces_;
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<Share> shares_;  ///< empty for one thread
};

}  // namespace meshorder
