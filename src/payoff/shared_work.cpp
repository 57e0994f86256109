// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/shared_work.hpp"

#include "kernels/owned_batches.hpp"

#include <array>
#include <span>
#include <vector>

namespace meshorder {
namespace {

/// Counts elements or edges, and how often threads compute them.
class WorkCount {
 public:
  WorkCount(const CsrGraph& graph, int threads) {
    // a row of the matrix has an entry for each neighbour and one for the diagonal
    std::vector<Offset> rows(graph.offsets.begin(), graph.offsets.end());
    for (std::size_t v = 0; v < rows.size(); ++v) rows[v] += static_cast<Offset>(v);
    bounds_ = balanced_ranges(rows, threads);
  }

  void add(std::span<const Index> vertices) {
    owners_of(vertices, bounds_, owners_);
    computed_ += static_cast<Offset>(owners_.size());
    ++count_;
  }

  [[nodiscard]] double mean() const {
    return count_ == 0 ? 1 : static_cast<double>(computed_) / static_cast<double>(count_);
  }

 private:
  std::vector<Index> bounds_;
  std::vector<Index> owners_;
  Offset count_ = 0;
  Offset computed_ = 0;
};

}  // namespace

double times_computed(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int threads) {
  if (threads <= 1 || kernel == Kernel::spmv) return 1;
  WorkCount count(graph, threads);
  if (kernel == Kernel::springs) {
    for (Index a = 0; a < graph.size(); ++a) {
      for (const Index b : graph[a]) {
        if (b > a) count.add(std::array{a, b});
      }
    }
  } else {
    const std::size_t corners = static_cast<std::size_t>(simplices.dimension) + 1;
    for (std::size_t first = 0; first + corners <= simplices.vertices.size(); first += corners)
      count.add(simplices.vertices.subspan(first, corners));
  }
  return count.mean();
}

}  // namespace meshorder
