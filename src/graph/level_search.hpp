// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <limits>
#include <span>
#include <vector>

namespace meshorder {

/// Breadth-first searches of one graph, level after level. All threads share large levels. For any number of
/// threads, the vertices of a level are sorted by the first vertex that finds them, then by their place in
/// its row.
///
/// On several threads each vertex of a level claims its neighbours. A neighbour goes to the vertex with the
/// smallest place; the other vertices drop it.
class LevelSearch {
 public:
  /// Sorts the vertices that one vertex has found, in place.
  using Arrange = void (*)(GraphRef graph, std::span<Index> found);

  explicit LevelSearch(GraphRef graph)
      : graph_(graph), found_by_(static_cast<std::size_t>(graph.size()), kNobody) {}

  /// Finds the component of a vertex that was not found before. O(component).
  ///
  /// @param places   receives the vertices in their order; must be longer than the component by at least one
  /// @param arrange  null: keeps the order of the rows
  /// @return how many vertices there are
  Index run(Index start, std::span<Index> places, Arrange arrange = nullptr);

  /// Returns where each level of the last search begins in its places, and the number of places.
  [[nodiscard]] std::span<const Index> level_start() const noexcept { return level_start_; }
  /// Returns how many levels come after the first.
  [[nodiscard]] Index depth() const noexcept { return index_size(level_start_) - 2; }

  [[nodiscard]] bool has_found(Index v) const { return found_by_[v] != kNobody; }
  /// Lets a search find the vertices first … end − 1 again. They must be whole components.
  void forget(Index first, Index end);

 private:
  static constexpr Index kNobody = std::numeric_limits<Index>::max();

  /// A vertex, and the place of the vertex that found it.
  struct Finding {
    Index vertex;
    Index by;
  };

  Index find_next_level(std::span<Index> places, Index begin, Index end, Arrange arrange);
  Index find_next_level_together(std::span<Index> places, Index begin, Index end, Arrange arrange);

  GraphRef graph_;
  std::vector<Index> found_by_;  ///< for each vertex, the place of the vertex that found it
  std::vector<Index> level_start_;
  std::vector<std::vector<Finding>> findings_;  ///< the findings of each chunk of a level
};

}  // namespace meshorder
