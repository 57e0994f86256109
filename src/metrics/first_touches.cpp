// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "graph/row_access.hpp"
#include "metrics/measures.hpp"

#include <algorithm>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kEntriesInLine = 8;  // doubles
constexpr Index kLinesBefore = 3;
constexpr Index kRecent = 32;         // first touches
constexpr Index kWindow = 4096;       // rows
constexpr Index kWindowsForOne = 16;  // step between windows of small graphs
constexpr Index kWindows = 8;         // number of windows of large graphs; sometimes there is one more

/// Counts, window by window, the first touches of lines, and those first touches that are jumps.
class FirstTouches {
 public:
  FirstTouches(GraphRef graph, const Permutation& order)
      : graph_(graph), order_(order), touched_((std::size_t(graph.size()) + 7) / kEntriesInLine, -1) {}

  void sweep(Index begin, Index end) {
    const Index before = time_;  // lines that were touched by rows before the window get this time
    time_ += kRecent + 1;
    for (Index row = begin; row < end; ++row) {
      poll_in_loop(row);
      prefetch_row(graph_, order_.new_to_old(), row);
      found_.assign(1, row / kEntriesInLine);
      for (const Index u : graph_[order_.new_to_old()[row]]) {
        const Index line = order_.old_to_new()[u] / kEntriesInLine;
        if (touched_[line] < before) found_.push_back(line);
      }
      std::sort(found_.begin(), found_.end());
      for (const Index line : found_) {
        if (touched_[line] >= before) continue;
        if (is_read_before(line, begin)) {
          touched_[line] = before;
          continue;
        }
        jumps_ += is_jump(line) ? 1 : 0;
        ++lines_;
        touched_[line] = time_++;
      }
    }
  }

  [[nodiscard]] double share() const { return lines_ > 0 ? static_cast<double>(jumps_) / lines_ : 0; }

 private:
  /// Returns whether a row before `begin` reads a line.
  [[nodiscard]] bool is_read_before(Index line, Index begin) const {
    if (begin == 0) return false;
    const Index first = line * kEntriesInLine;
    if (first < begin) return true;
    const auto is_before = [&](Index u) { return order_.old_to_new()[u] < begin; };
    for (Index row = first; row < std::min(first + kEntriesInLine, graph_.size()); ++row) {
      if (std::ranges::any_of(graph_[order_.new_to_old()[row]], is_before)) return true;
    }
    return false;
  }

  [[nodiscard]] bool is_jump(Index line) const {
    for (Index near = std::max(0, line - kLinesBefore); near < line; ++near) {
      if (touched_[near] >= time_ - kRecent) return false;
    }
    return true;
  }

  GraphRef graph_;
  const Permutation& order_;
  std::vector<Index> touched_;  ///< time when each line was first touched, −1 for never
  Index time_ = 0;
  Index lines_ = 0;
  Index jumps_ = 0;
  std::vector<Index> found_;
};

}  // namespace

double jump_share(GraphRef graph, const Permutation& order) {
  FirstTouches touches(graph, order);
  touches.sweep(0, graph.size());
  return touches.share();
}

double sampled_jump_share(GraphRef graph, const Permutation& order) {
  FirstTouches touches(graph, order);
  const Offset apart =
      Offset{kWindow} * std::max(kWindowsForOne, chunk_count(graph.size(), kWindow) / kWindows);
  for (Offset begin = 0; begin < graph.size(); begin += apart) {
    const auto first = static_cast<Index>(begin);
    touches.sweep(first, first + std::min(kWindow, graph.size() - first));
  }
  return touches.share();
}

}  // namespace meshorder
