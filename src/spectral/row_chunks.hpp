// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"
#include "graph/laplacian.hpp"

#include <algorithm>
#include <vector>

namespace meshorder {

constexpr Index kRowsOfPiece = 4096;

/// Returns a function that calls `work(begin, end)` for pieces of a range of rows, the first piece first, and
/// calls `poll` between them: a chunk of a large graph may take a second.
template <class Work>
auto in_rising_pieces(Work work) {
  return [work](Index begin, Index end) {
    for (; end - begin > kRowsOfPiece; begin += kRowsOfPiece) {
      work(begin, begin + kRowsOfPiece);
      poll();
    }
    work(begin, end);
  };
}

/// The same with the last piece first.
template <class Work>
auto in_falling_pieces(Work work) {
  return [work](Index begin, Index end) {
    for (; end - begin > kRowsOfPiece; end -= kRowsOfPiece) {
      work(end - kRowsOfPiece, end);
      poll();
    }
    work(begin, end);
  };
}

/// The rows of a Laplacian in contiguous chunks for threads, coloured so that no edge joins two chunks of one
/// colour: a sweep colour by colour gives the same numbers on any number of threads. If the graph is numbered
/// breadth first, each chunk has edges only to adjacent chunks, and two colours suffice.
class RowChunks {
 public:
  static constexpr Index kLeastRows = 8192;  ///< work on a chunk should take longer than starting a task

  RowChunks() = default;

  /// Cuts the rows of a graph into up to 16 chunks of at least `least_rows` rows, the same for any number of
  /// threads. Makes one chunk if so many chunks touch each other that threads would gain nothing. O(edges).
  explicit RowChunks(const Laplacian& laplacian, Index least_rows = kLeastRows);

  /// Returns one chunk of all rows.
  static RowChunks whole(Index rows);

  /// Returns the number of rows in a chunk, a power of two; the last chunk may have fewer.
  [[nodiscard]] Index size() const noexcept {
    return static_cast<Index>(std::min(Offset{1} << shift_, Offset{kMaxIndex}));
  }
  [[nodiscard]] Index count() const noexcept { return chunk_count(rows_, size()); }
  [[nodiscard]] Index chunk_of(Index row) const noexcept { return row >> shift_; }

  /// Returns the chunks of each colour, rising.
  [[nodiscard]] const std::vector<std::vector<Index>>& colours() const noexcept { return colours_; }

  /// Calls `work(chunk, begin, end)` for every chunk, on all threads.
  template <class Work>
  void for_each(Work work) const {
    for_each_chunk(rows_, size(), work);
  }

  /// Calls `work(begin, end)` for pieces of every chunk, rising within a chunk, on all threads.
  template <class Work>
  void for_each_piece(Work work) const {
    for_each([rise = in_rising_pieces(work)](Index, Index begin, Index end) { rise(begin, end); });
  }

  /// Calls `work(begin, end)` for every chunk, colour after colour; the chunks of one colour run at the same
  /// time.
  template <class Work>
  void for_each_forwards(Work work) const {
    for (const std::vector<Index>& chunks : colours_) run(chunks, work);
  }

  /// The same with the last colour first.
  template <class Work>
  void for_each_backwards(Work work) const {
    for (std::size_t colour = colours_.size(); colour-- > 0;) run(colours_[colour], work);
  }

 private:
  template <class Work>
  void run(const std::vector<Index>& chunks, Work work) const {
    for_each_chunk(index_size(chunks), 1, [&](Index k, Index, Index) {
      const Index begin = chunks[k] << shift_;
      work(begin, std::min(rows_ - begin, size()) + begin);
    });
  }

  Index rows_ = 0;
  int shift_ = 0;
  std::vector<std::vector<Index>> colours_;
};

}  // namespace meshorder
