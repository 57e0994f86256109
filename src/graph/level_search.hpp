// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <limits>
#include <span>
#include <vector>

namespace meshorder {

/// Breadth-first searches of one graph, level after level. All threads share large levels. For any number of
/// threads, the vertices of a level are sorted by the first vertex that finds them, then by place in that
/// vertex's row.
class LevelSearch {
 public:
  /// Sorts the vertices that one vertex has found, in place.
  using Arrange = void (*)(GraphRef graph, std::span<Index> found);

  explicit LevelSearch(GraphRef graph);

  /// Finds the component of `start`, a vertex that no search has found. O(component).
  ///
  /// @param places   receives the component's vertices in the order of the search, from places[first] on
  /// @param arrange  null: keeps the order of the rows
  /// @return the place after the last vertex
  Index run(Index start, std::span<Index> places, Arrange arrange = nullptr, Index first = 0);

  /// Returns the place at which each level of the last search begins, and the end of the last level.
  [[nodiscard]] std::span<const Index> level_start() const noexcept { return level_start_; }
  /// Returns the number of levels after the first, in the last search.
  [[nodiscard]] Index depth() const noexcept { return index_size(level_start_) - 2; }

  [[nodiscard]] bool has_found(Index v) const { return place_of_[v] >= 0; }
  /// Returns the place of each vertex that a search has found.
  [[nodiscard]] std::span<const Index> place_of() const noexcept { return place_of_; }
  /// Lets searches find the vertices first … end − 1 again; these must be whole components.
  void forget(Index first, Index end);

 private:
  static constexpr Index kNotFound = std::numeric_limits<Index>::min();

  /// A vertex, and the mark of the row in which a thread found the vertex.
  struct Finding {
    Index vertex;
    Index mark;
  };

  Index find_next_level(std::span<Index> places, Index begin, Index end, Arrange arrange);
  Index find_next_level_together(std::span<Index> places, Index begin, Index end, Arrange arrange);
  void arrange_found(std::span<Index> places, Index first, Index end, Arrange arrange);

  GraphRef graph_;
  std::vector<Index> place_of_;
  std::vector<Index> level_start_;
  std::vector<std::vector<Finding>> findings_;  ///< the findings of each chunk of a level
};

}  // namespace meshorder
