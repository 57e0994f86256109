// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"
#include "kernels/owned_batches.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <span>
#include <vector>

namespace meshorder {

/// The rows of a matrix for an iterative solver, which passes over them again and again: in chunks of about
/// as many blocks each, which depend on the matrix alone, so that sums over chunks are the same for any
/// number of threads. A thread has the same chunks in every pass. Each pass goes the other way than the one
/// before and so begins with what the caches still hold.
class RowSweeps {
 public:
  /// `offsets` are those of the matrix's compressed rows. O(chunks · log rows).
  explicit RowSweeps(std::span<const Offset> offsets)
      : bounds_(balanced_ranges(offsets, static_cast<Index>(1 + offsets.back() / kChunkBlocks))) {}

  /// One pass: `work(begin, end)` for the rows of each chunk, on all threads.
  template <class Work>
  void run(Work work) {
    run_chunks([&](Index chunk) { work(bounds_[chunk], bounds_[chunk + 1]); });
  }

  /// One pass: the sum of `part(begin, end)` over the chunks in their order.
  template <class Sum, class Part>
  Sum sum(Part part) {
    std::vector<Sum> parts(bounds_.size() - 1);
    run_chunks([&](Index chunk) { parts[chunk] = part(bounds_[chunk], bounds_[chunk + 1]); });
    Sum sum{};
    for (const Sum& p : parts) sum += p;
    return sum;
  }

 private:
  // 0.6 MB of a matrix in double: few enough chunks to cost nothing, many enough for any number of threads
  static constexpr Offset kChunkBlocks = 8192;

  template <class Work>
  void run_chunks(Work work) {
    const bool backwards = backwards_;
    backwards_ = !backwards_;
    const Index chunks = index_size(bounds_) - 1;
    const auto run_some = [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) work(backwards ? end - 1 - (i - begin) : i);
    };
    // a thread with one chunk would wait longer than it works
    const Index parts = std::clamp<Index>(chunks / 2, 1, tbb::this_task_arena::max_concurrency());
    if (parts == 1) return run_some(0, chunks);
    const auto bound = [&](Index part) { return static_cast<Index>(Offset{chunks} * part / parts); };
    for_each_part(parts, [&](Index part) { run_some(bound(part), bound(part + 1)); });
  }

  std::vector<Index> bounds_;
  bool backwards_ = false;
};

}  // namespace meshorder
