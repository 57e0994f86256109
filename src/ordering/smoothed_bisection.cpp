// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/all_methods.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kSmallestPiece = 16;  // smaller pieces are sorted, not cut
constexpr int kSmoothingSteps = 12;

/// A connected part of a piece; its vertices are sorted_[begin … end − 1].
struct Component {
  float push;  ///< −(mean pull of its vertices): the component with the largest pull comes first
  Index begin;
  Index end;
};

class Bisection {
 public:
  Bisection(CsrGraph graph, std::vector<float> pull)
      : graph_(std::move(graph)),
        pull_(std::move(pull)),
        row_end_(graph_.offsets.begin() + 1, graph_.offsets.end()),
        sequence_(graph_.size()),
        in_first_half_(graph_.size(), 0),
        reached_(graph_.size(), 0),
        distance_(graph_.size(), 0),
        value_(graph_.size(), 0),
        next_value_(graph_.size(), 0) {
    std::iota(sequence_.begin(), sequence_.end(), Index{0});
    queue_.reserve(graph_.size());
    sorted_.reserve(graph_.size());
  }

  std::vector<Index> run() {
    order(0, graph_.size());
    return std::move(sequence_);
  }

 private:
  /// Orders the piece at [begin, end) of the sequence; the rows of its vertices hold no neighbours outside
  /// the piece.
  void order(Index begin, Index end) {
    if (end - begin < 2) return;
    sort(begin, end);
    if (end - begin <= kSmallestPiece) return;
    const Index middle = begin + (end - begin) / 2;
    for (Index k = begin; k < end; ++k) in_first_half_[sequence_[k]] = k < middle ? 1 : 0;
    for (Index k = begin; k < end; ++k) drop_neighbours_in_other_half(sequence_[k]);
    order(begin, middle);
    order(middle, end);
  }

  /// Sorts a piece by components, each along its smooth function.
  void sort(Index begin, Index end) {
    components_.clear();
    sorted_.clear();
    const Index first_mark = ++mark_;
    for (Index k = begin; k < end; ++k) {
      if (reached_[sequence_[k]] < first_mark) add_component(sequence_[k]);
    }
    std::stable_sort(components_.begin(), components_.end(),
                     [](const Component& a, const Component& b) { return a.push < b.push; });
    Index place = begin;
    for (const Component& component : components_) {
      for (Index k = component.begin; k < component.end; ++k) sequence_[place++] = sorted_[k].second;
    }
  }

  void add_component(Index start) {
    // search from the start to a far end, from this end to the opposite end, and back
    search(start, mark_);
    search(queue_.back(), ++mark_);
    for (const Index v : queue_) value_[v] = static_cast<float>(distance_[v]);
    search(queue_.back(), ++mark_);
    for (const Index v : queue_) value_[v] -= static_cast<float>(distance_[v]);
    smooth();
    float pull = 0;
    float along = 0;
    for (const Index v : queue_) {
      pull += pull_[v];
      along += pull_[v] * value_[v];
    }
    const float sign = along > 0 ? -1.0F : 1.0F;
    const Index begin = index_size(sorted_);
    for (const Index v : queue_) sorted_.emplace_back(sign * value_[v], v);
    std::sort(sorted_.begin() + begin, sorted_.end());
    components_.push_back({-pull / static_cast<float>(queue_.size()), begin, index_size(sorted_)});
  }

  /// Searches the component of `start` breadth first, and puts its vertices into the queue by rising
  /// distance. `mark` must exceed the marks of these vertices.
  void search(Index start, Index mark) {
    queue_.assign(1, start);
    reached_[start] = mark;
    distance_[start] = 0;
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      const Index v = queue_[k];
      for (Offset m = graph_.offsets[v]; m < row_end_[v]; ++m) {
        const Index u = graph_.neighbours[m];
        if (reached_[u] == mark) continue;
        reached_[u] = mark;
        distance_[u] = distance_[v] + 1;
        queue_.push_back(u);
      }
    }
  }

  /// Moves the value of each vertex in the queue half way to the mean of its neighbours, several times. Keeps
  /// the mean, weighted by degree, at 0.
  void smooth() {
    if (queue_.size() < 3) return;
    float ends = 0;
    for (const Index v : queue_) ends += static_cast<float>(row_end_[v] - graph_.offsets[v]);
    for (int step = 0; step < kSmoothingSteps; ++step) {
      float sum_of_all = 0;
      for (const Index v : queue_) {
        float sum = 0;
        for (Offset m = graph_.offsets[v]; m < row_end_[v]; ++m) sum += value_[graph_.neighbours[m]];
        const auto degree = static_cast<float>(row_end_[v] - graph_.offsets[v]);
        next_value_[v] = 0.5F * (value_[v] + sum / degree);
        sum_of_all += next_value_[v] * degree;
      }
      const float mean = sum_of_all / ends;
      for (const Index v : queue_) value_[v] = next_value_[v] - mean;
    }
  }

  /// Removes neighbours in the other half of the piece from the row of v, and counts them in the pull of v.
  void drop_neighbours_in_other_half(Index v) {
    Offset kept = graph_.offsets[v];
    for (Offset m = kept; m < row_end_[v]; ++m) {
      const Index u = graph_.neighbours[m];
      if (in_first_half_[u] == in_first_half_[v]) graph_.neighbours[kept++] = u;
    }
    const auto dropped = static_cast<float>(row_end_[v] - kept);
    pull_[v] += in_first_half_[v] != 0 ? -dropped : dropped;
    row_end_[v] = kept;
  }

  CsrGraph graph_;
  std::vector<float> pull_;
  std::vector<Offset> row_end_;  ///< end of each vertex's neighbours within its piece
  std::vector<Index> sequence_;
  std::vector<char> in_first_half_;
  std::vector<Index> reached_;  ///< the mark of the last search that reached each vertex
  std::vector<Index> distance_;
  std::vector<float> value_;
  std::vector<float> next_value_;
  std::vector<Index> queue_;
  std::vector<Component> components_;
  std::vector<std::pair<float, Index>> sorted_;  ///< values and vertices
  Index mark_ = 0;
};

}  // namespace

std::vector<Index> smoothed_bisection(CsrGraph graph, std::vector<float> pull) {
  return Bisection(std::move(graph), std::move(pull)).run();
}

}  // namespace meshorder
