// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/component_numbering.hpp"

#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "graph/row_access.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kUnseen = std::numeric_limits<Index>::min();
constexpr Index kFound = -1;    // seen, not numbered yet
constexpr Index kBatch = 256;   // vertices whose discoveries are sorted together
constexpr Index kWave = 8;      // threads share the work if there are at least this many batches
constexpr Index kDegrees = 64;  // larger degrees are rare; they are sorted as this degree

/// Numbers the components one after another.
class Search {
 public:
  explicit Search(GraphRef graph) : graph_(graph) {
    resize_large(numbering_.order, graph.size());
    reserve_large(numbering_.number, graph.size());
    numbering_.number.assign(graph.size(), kUnseen);
  }

  ComponentNumbering number_all() {
    for (Index v = 0; v < graph_.size(); ++v) {
      if (numbering_.number[v] != kUnseen) continue;
      number_component(v);
      numbering_.starts.push_back(tail_);
    }
    return std::move(numbering_);
  }

 private:
  void number_component(Index start);
  void go_through_batch();
  void go_through_wave(Index batches);
  void claim_neighbours(Index batch, Index begin, Index end);
  void settle_claims(Index batch);
  void put_by_degree(const std::vector<Index>& found, Index tail);

  GraphRef graph_;
  ComponentNumbering numbering_;
  Index component_start_ = 0;
  Index head_ = 0;  ///< place, in the order, of the first vertex whose row is not yet read
  Index tail_ = 0;  ///< number of vertices in the order so far
  std::vector<std::vector<Index>> found_{1};  ///< the vertices that each batch found, in the order of its
                                              ///< rows
  /// For each batch: the vertices that it marked, with their marks.
  std::vector<std::vector<std::pair<Index, Index>>> claims_;
};

/// Numbers the component of `start`; its vertices go to order[tail_] and the places after it.
void Search::number_component(Index start) {
  component_start_ = head_ = tail_;
  numbering_.order[tail_++] = start;
  numbering_.number[start] = 0;
  const Index wave = thread_count() > 1 ? kWave : graph_.size();
  while (head_ < tail_) {
    poll();
    const Index full_batches = (tail_ - head_) / kBatch;
    if (full_batches >= wave) {
      go_through_wave(full_batches);
    } else {
      go_through_batch();
    }
  }
}

/// Reads the rows of the next batch, and appends the rows' new vertices.
void Search::go_through_batch() {
  std::vector<Index>& found = found_.front();
  found.clear();
  for (const Index end = std::min(tail_, head_ + kBatch); head_ < end; ++head_) {
    prefetch_row(graph_, {numbering_.order.data(), numbering_.order.data() + tail_}, head_,
                 numbering_.number.data());
    for_each_below(graph_[numbering_.order[head_]], numbering_.number, kFound, [&](Index u) {
      numbering_.number[u] = kFound;
      found.push_back(u);
    });
  }
  put_by_degree(found, tail_);
  tail_ += index_size(found);
}

/// Reads several batches at once; the result is the same as if they were read one after another. A vertex
/// belongs to the first row that contains it; its mark is kFound minus that row's place, counted from head_.
void Search::go_through_wave(Index batches) {
  if (index_size(found_) < batches) {
    found_.resize(batches);
    claims_.resize(batches);
  }
  for_each_chunk(batches * kBatch, kBatch,
                 [&](Index batch, Index begin, Index end) { claim_neighbours(batch, begin, end); });
  for_each_chunk(batches, 1, [&](Index batch, Index, Index) { settle_claims(batch); });
  for_each_chunk(batches, 1, [&](Index batch, Index, Index) {
    found_[batch].clear();
    for (const auto& [u, mark] : claims_[batch]) {
      if (numbering_.number[u] == mark) found_[batch].push_back(u);
    }
  });
  std::vector<Index> tails{tail_};
  for (Index batch = 0; batch < batches; ++batch) tails.push_back(tails.back() + index_size(found_[batch]));
  for_each_chunk(batches, 1, [&](Index batch, Index, Index) { put_by_degree(found_[batch], tails[batch]); });
  head_ += batches * kBatch;
  tail_ = tails.back();
}

/// Visits the rows of order[head_ + begin … head_ + end − 1], and marks their vertices that have no number
/// and no mark of an earlier row. If two threads mark a vertex at once, the mark that is written later stays;
/// both threads have the vertex among their claims (see `settle_claims`). An atomic exchange would make the
/// processor wait for one vertex at a time.
void Search::claim_neighbours(Index batch, Index begin, Index end) {
  const std::span<const Index> order(numbering_.order.data() + head_, tail_ - head_);
  claims_[batch].clear();
  for (Index k = begin; k < end; ++k) {
    prefetch_row(graph_, order, k, numbering_.number.data());
    const Index mark = kFound - k;
    for_each_below(graph_[order[k]], numbering_.number, mark, [&](Index u) {
      std::atomic_ref(numbering_.number[u]).store(mark, std::memory_order_relaxed);
      claims_[batch].emplace_back(u, mark);
    });
  }
}

/// Restores the mark of the earliest row if a later row's mark has replaced it.
void Search::settle_claims(Index batch) {
  for (const auto& [u, mark] : claims_[batch]) {
    const std::atomic_ref<Index> number(numbering_.number[u]);
    Index found = number.load(std::memory_order_relaxed);
    while (found < mark && !number.compare_exchange_weak(found, mark, std::memory_order_relaxed)) {
    }
  }
}

/// Puts the vertices into the order, from order[tail] on, and numbers them. They are sorted by rising degree;
/// vertices of the same degree keep their given sequence.
void Search::put_by_degree(const std::vector<Index>& found, Index tail) {
  const auto degree = [&](Index v) { return std::min(graph_.degree(v), kDegrees); };
  std::array<Index, std::size_t{kDegrees} + 2> place{};
  for (const Index v : found) ++place[degree(v) + 1];
  for (std::size_t d = 1; d < place.size(); ++d) place[d] += place[d - 1];
  for (const Index v : found) {
    const Index at = tail + place[degree(v)]++;
    numbering_.order[at] = v;
    numbering_.number[v] = at - component_start_;
  }
}

}  // namespace

ComponentNumbering number_components(GraphRef graph) { return Search(graph).number_all(); }

Laplacian component_laplacian(GraphRef graph, std::span<const double> weights,
                              const ComponentNumbering& numbering, Index c) {
  constexpr Index kRows = 4096;
  const auto vertices = numbering.component(c);
  const auto n = index_size(vertices);
  Laplacian result;
  result.offsets.resize(Offset{n} + 1);
  for_each_chunk(n, kRows, [&](Index, Index begin, Index end) {
    for (Index k = begin; k < end; ++k) result.offsets[k + 1] = graph.degree(vertices[k]);
  });
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.diagonal.resize(n);
  resize_large(result.neighbours, result.offsets[n]);
  if (!weights.empty()) result.weights.resize(result.offsets[n]);
  for_each_chunk(n, kRows, [&](Index, Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      prefetch_row(graph, vertices, k, numbering.number.data());
      const Index v = vertices[k];
      std::transform(graph[v].begin(), graph[v].end(), result.neighbours.begin() + result.offsets[k],
                     [&](Index u) { return numbering.number[u]; });
      result.diagonal[k] = graph.degree(v);
      if (weights.empty()) continue;
      const auto row = weights.subspan(graph.offsets[v], graph.degree(v));
      std::copy(row.begin(), row.end(), result.weights.begin() + result.offsets[k]);
      result.diagonal[k] = 0;
      for (const double weight : row) result.diagonal[k] += weight;
    }
  });
  return result;
}

}  // namespace meshorder
