// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "graph/row_access.hpp"
#include "metrics/measures.hpp"

#include <algorithm>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kEntriesInLine = 8;  // doubles in a cache line
constexpr Index kLinesBefore = 3;
constexpr Index kRecent = 32;         // number of first touches that count as recent
constexpr Index kWindow = 4096;       // rows in a window
constexpr Index kWindowsForOne = 16;  // on small graphs, one window in this many is counted
constexpr Index kWindows = 8;         // number of windows of large graphs; sometimes there is one more

struct Touches {
  Index lines = 0;  ///< number of first touches of a line
  Index jumps = 0;  ///< number of first touches that are jumps

  Touches& operator+=(const Touches& other) {
    lines += other.lines;
    jumps += other.jumps;
    return *this;
  }
  [[nodiscard]] double jump_share() const { return lines > 0 ? static_cast<double>(jumps) / lines : 0; }
};

/// Counts the first touches of lines in a window of rows, and how many of them are jumps.
class FirstTouches {
 public:
  FirstTouches(GraphRef graph, const Permutation& order)
      : graph_(graph), order_(order), touched_((std::size_t(graph.size()) + 7) / kEntriesInLine, -1) {}

  Touches sweep(Index begin, Index end) {
    Touches result;
    for (Index row = begin; row < end; ++row) {
      poll_in_loop(row);
      prefetch_row(graph_, order_.new_to_old(), row);
      found_.assign(1, row / kEntriesInLine);
      for (const Index u : graph_[order_.new_to_old()[row]]) {
        const Index line = order_.old_to_new()[u] / kEntriesInLine;
        if (touched_[line] < 0) found_.push_back(line);
      }
      std::sort(found_.begin(), found_.end());
      for (const Index line : found_) {
        if (touched_[line] >= 0) continue;
        if (is_read_before(line, begin)) {
          touched_[line] = 0;
          continue;
        }
        result.jumps += is_jump(line) ? 1 : 0;
        ++result.lines;
        touched_[line] = time_++;
      }
    }
    return result;
  }

 private:
  /// Returns whether any row before `begin` reads the line.
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
  std::vector<Index> touched_;  ///< time of each line's first touch; −1: never, 0: before the window
  Index time_ = kRecent + 1;
  std::vector<Index> found_;
};

}  // namespace

double jump_share(GraphRef graph, const Permutation& order) {
  return FirstTouches(graph, order).sweep(0, graph.size()).jump_share();
}

double sampled_jump_share(GraphRef graph, const Permutation& order) {
  const Offset apart =
      Offset{kWindow} * std::max(kWindowsForOne, chunk_count(graph.size(), kWindow) / kWindows);
  const auto windows = static_cast<Index>((graph.size() + apart - 1) / apart);
  return sum_over_chunks<Touches>(windows, 1,
                                  [&](Index window, Index /*end*/) {
                                    const auto begin = static_cast<Index>(window * apart);
                                    FirstTouches touches(graph, order);
                                    return touches.sweep(begin,
                                                         begin + std::min(kWindow, graph.size() - begin));
                                  })
      .jump_share();
}

}  // namespace meshorder
