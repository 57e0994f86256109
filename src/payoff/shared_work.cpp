// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/shared_work.hpp"

#include "kernels/owned_batches.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace meshorder {
namespace {

/// Counts batches and the threads that compute each of them. Vertices come batch by batch.
class BatchCount {
 public:
  BatchCount(const CsrGraph& graph, int threads) {
    // a row of the matrix has a block for each neighbour and one for the diagonal
    std::vector<Offset> rows(graph.offsets.begin(), graph.offsets.end());
    for (std::size_t v = 0; v < rows.size(); ++v) rows[v] += static_cast<Offset>(v);
    bounds_ = balanced_ranges(rows, threads);
  }

  void add(std::span<const Index> batch) {
    owners_of(batch, bounds_, owners_);
    computed_ += static_cast<Offset>(owners_.size());
    ++batches_;
  }

  [[nodiscard]] double mean() const {
    return batches_ == 0 ? 1 : static_cast<double>(computed_) / static_cast<double>(batches_);
  }

 private:
  std::vector<Index> bounds_;
  std::vector<Index> owners_;
  Offset batches_ = 0;
  Offset computed_ = 0;
};

void add_simplices(SimplicesRef simplices, BatchCount& count) {
  const std::size_t size = static_cast<std::size_t>(simplices.dimension + 1) * kBatch;
  for (std::size_t first = 0; first < simplices.vertices.size(); first += size)
    count.add(simplices.vertices.subspan(first, std::min(size, simplices.vertices.size() - first)));
}

/// Springs stand in the order of their higher ends, as springs_on_edges has them.
void add_springs(const CsrGraph& graph, BatchCount& count) {
  std::vector<Index> batch;
  for (Index b = 0; b < graph.size(); ++b) {
    for (const Index a : graph[b]) {
      if (a > b) break;
      batch.push_back(a);
      batch.push_back(b);
      if (batch.size() < 2 * kBatch) continue;
      count.add(batch);
      batch.clear();
    }
  }
  if (!batch.empty()) count.add(batch);
}

}  // namespace

double times_computed(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int threads) {
  if (threads <= 1 || kernel == Kernel::spmv) return 1;
  BatchCount count(graph, threads);
  if (kernel == Kernel::springs) {
    add_springs(graph, count);
  } else {
    add_simplices(simplices, count);
  }
  return count.mean();
}

}  // namespace meshorder
