// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meshorder {

/// Counts how often each reuse distance occurs in a stream of accesses to cache lines. The reuse distance is
/// the number of different other lines accessed since the line's last access. A fully associative cache of c
/// lines that replaces the least recently used line misses the accesses of distance c and more, and the cold
/// accesses: the first access to each line (Mattson, Gecsei, Slutz and Traiger 1970: Evaluation techniques
/// for storage hierarchies).
///
/// Distances below 256 are counted one by one, larger ones in 128 bins to each power of two.
class ReuseHistogram {
 public:
  /// Counts an access of that distance, ≥ 0. O(1).
  void add(Index distance) { ++bins_[bin_of(distance)]; }
  void add_cold() noexcept { ++cold_; }
  void forget_cold() noexcept { cold_ = 0; }

  /// Returns the histogram with every distance times 2^`halvings` and every count times `times`. O(bins).
  [[nodiscard]] ReuseHistogram scaled(int halvings, double times) const;

  /// Returns the number of all accesses, including cold ones. O(bins).
  [[nodiscard]] Offset accesses() const;
  [[nodiscard]] Offset cold() const noexcept { return cold_; }

  /// Returns the misses of a cache of that many lines, ≥ 0. Exact if the number of lines has at most 8
  /// significant bits, as for real caches; otherwise that number is rounded down to 8 bits, by less than 1 %.
  /// O(bins).
  [[nodiscard]] Offset misses(Offset lines) const;

  /// Returns the mean of log₂(distance + 1) over the accesses that are not cold; 0 if there are none. Every
  /// factor of two in distance counts the same, whatever the caches. O(bins).
  [[nodiscard]] double mean_log2() const;

  bool operator==(const ReuseHistogram&) const = default;

 private:
  static std::size_t bin_of(Index distance);
  static double middle_of(std::size_t bin);

  std::vector<Offset> bins_ = std::vector<Offset>(3200, 0);
  Offset cold_ = 0;
};

/// How a program reaches a cache line. streamed: as the next line of an array that the program reads from
/// front to back; gathered: at a place that depends on the mesh.
enum class Access : bool { streamed, gathered };

/// Histograms of a stream: of all accesses, and of jumps.
struct Reuse {
  ReuseHistogram all;
  /// Gathered accesses that are far (cold, or of distance 512 or more, so that an L1 cache of 32 KB misses
  /// them) and do not continue a stream: neither of the two lines before the line is among the last 64 far
  /// accesses. Processors prefetch the lines that continue a stream; a jump waits for the memory.
  ReuseHistogram jumps;

  bool operator==(const Reuse&) const = default;
};

/// Measures the reuse distances of a stream, access by access, without storing the stream.
///
/// Each access takes the next slot; the slot of each line's last access is marked. A distance is then the
/// number of marks after the line's own (Bennett and Kruskal 1975, LRU stack processing). The marks are bits,
/// counted by a tree with 16 children a node. An access goes up the tree only until the paths of its line's
/// old and new slots meet: O(log distance) steps. When there are no more free slots, the marks are moved to
/// the first slots. Memory: 13 bytes for each line.
class ReuseDistance {
 public:
  /// For accesses to lines 0 … lines − 1. If `halvings` > 0, these lines are a sample that ReuseSample has
  /// drawn, 2^-halvings of all lines. In each block of eleven lines only the last nine count, and an access
  /// is far from a distance of 512 / 2^halvings on.
  explicit ReuseDistance(Index lines, int halvings = 0);

  /// Counts an access; returns its distance, −1 if cold. Amortised O(1 + log distance).
  ///
  /// @param streamed  in a sample: number of streamed accesses so far, to all lines
  Index access(Index line, Access how = Access::gathered, std::uint32_t streamed = 0);

  /// Prefetches the data of a line that `access` needs in a sample.
  void prefetch(Index line) const {
    __builtin_prefetch(&last_access_of_line_[line]);
    __builtin_prefetch(&far_of_line_[line]);
    __builtin_prefetch(&far_of_block_[line / kSampledBlock]);
  }

  /// Returns the accesses so far. The first access to each line is cold.
  [[nodiscard]] const Reuse& reuse() const noexcept { return reuse_; }

  /// Returns the number of lines accessed so far.
  [[nodiscard]] Index distinct() const noexcept { return index_size(first_accesses_); }

  /// Returns the counts of each later repetition if the stream so far is repeated for ever. No access is
  /// cold: the first access to a line in a repetition reuses the line from the repetition before.
  /// Such an access is a jump if it is far and the line's cold access was a jump. Ends the measurement.
  /// O(distinct lines · log distance).
  [[nodiscard]] Reuse repeated() &&;

 private:
  using Slot = std::uint32_t;
  static constexpr Slot kNever = ~Slot{0};
  static constexpr Index kFar = 512;
  static constexpr std::uint32_t kFollowing = 64;
  static constexpr Index kSampledBlock = 11;
  static constexpr Index kUncounted = 2;  ///< number of lines at the start of a block that do not count

  /// The last access to a line. Its two numbers are read together, mostly from memory: one record holds both.
  struct LastAccess {
    Slot slot = kNever;
    std::uint32_t far = 0;  ///< ordinal number of the line's last far access; cold accesses are far, too
  };

  /// In a sample: counts of far accesses up to a line's last far access. A block is sampled as a whole, so
  /// gathered accesses to the line's own block are counted exactly; gathered accesses to other blocks are
  /// estimated by the accesses to sampled blocks. Streamed accesses count as far.
  struct FarOfSample {
    std::uint32_t gathered = 0;
    std::uint32_t own = 0;  ///< gathered accesses to the line's block
    std::uint32_t streamed = 0;
  };

  /// For each of 16 sister nodes, the number of marks in the sisters after it.
  struct alignas(64) Sisters {
    std::array<std::uint32_t, 16> marks_after{};
  };

  Index move_to_front(Index line);
  void mark_first(Slot slot);
  Index move_mark(Slot from, Slot to);
  void close_word(std::size_t word);
  void close_gaps();
  bool is_jump(Index line, Access how, std::uint32_t streamed);
  bool is_jump_in_sample(Index line, Access how, std::uint32_t streamed);

  [[nodiscard]] bool counts(Index line) const noexcept {
    return halvings_ == 0 || line % kSampledBlock >= kUncounted;
  }

  int halvings_;
  std::vector<LastAccess> last_access_of_line_;
  std::vector<Index> first_accesses_;  ///< lines in the order of their first accesses
  std::vector<std::uint64_t> marks_;   ///< a bit for each slot
  /// One vector for each level above the words of marks_. The nodes that hold the next slot count as empty
  /// here.
  std::vector<std::vector<Sisters>> levels_;
  std::vector<std::uint32_t> marks_in_open_;  ///< for each level, marks in the node that holds the next slot
  Slot slot_count_ = 0;
  Slot next_ = 0;
  std::uint32_t far_accesses_ = kFollowing;  ///< number of far accesses; in a sample, of gathered ones only
  std::vector<FarOfSample> far_of_line_;     ///< empty unless this is a sample
  std::vector<std::uint32_t> far_of_block_;  ///< only in a sample: number of gathered far accesses
  std::vector<bool> first_access_jumps_;     ///< for each entry of first_accesses_, whether it is a jump
  Reuse reuse_;
  friend class ReuseSample;
};

}  // namespace meshorder
