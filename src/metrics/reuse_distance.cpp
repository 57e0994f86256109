// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/reuse_distance.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>

namespace meshorder {
namespace {

// number of bins for each power of two
constexpr Index kFine = 128;
constexpr int kFineBits = 7;

constexpr std::uint32_t kWord = 64;
constexpr std::uint32_t kSisters = 16;

/// Entry i of row k is 1 if i < k. Subtracting row k in vector registers avoids a loop up to k, whose end the
/// processor would mispredict.
constexpr auto kOneBefore = [] {
  std::array<std::array<std::uint32_t, kSisters>, kSisters> rows{};
  for (std::uint32_t k = 0; k < kSisters; ++k) {
    for (std::uint32_t i = 0; i < k; ++i) rows[k][i] = 1;
  }
  return rows;
}();

/// Subtracts through a copy; without the copy, the compiler would handle one entry at a time.
void subtract(const std::array<std::uint32_t, kSisters>& what, std::array<std::uint32_t, kSisters>& from) {
  std::array<std::uint32_t, kSisters> rest;
  for (std::uint32_t i = 0; i < kSisters; ++i) rest[i] = from[i] - what[i];
  from = rest;
}

/// Counts ones without std::popcount, which calls a function if the instruction may be missing.
std::uint32_t count_ones(std::uint64_t word) {
  word -= word >> 1 & 0x5555555555555555U;
  word = (word & 0x3333333333333333U) + (word >> 2 & 0x3333333333333333U);
  word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fU;
  return static_cast<std::uint32_t>(word * 0x0101010101010101U >> 56);
}

}  // namespace

std::size_t ReuseHistogram::bin_of(Index distance) {
  const auto d = static_cast<std::uint32_t>(distance);
  const int shift = std::max(0, static_cast<int>(std::bit_width(d)) - kFineBits - 1);
  return static_cast<std::size_t>(kFine) * static_cast<std::size_t>(shift) + (d >> shift);
}

double ReuseHistogram::middle_of(std::size_t bin) {
  const int shift = std::max(0, static_cast<int>(bin / kFine) - 1);
  const double first = std::ldexp(static_cast<double>(bin) - kFine * shift, shift);
  return first + 0.5 * (std::ldexp(1.0, shift) - 1.0);
}

Offset ReuseHistogram::accesses() const { return std::accumulate(bins_.begin(), bins_.end(), cold_); }

Offset ReuseHistogram::misses(Offset lines) const {
  if (lines > kMaxIndex) return cold_;
  const auto first = static_cast<std::ptrdiff_t>(bin_of(static_cast<Index>(lines)));
  return std::accumulate(bins_.begin() + first, bins_.end(), cold_);
}

ReuseHistogram ReuseHistogram::scaled(int halvings, double times) const {
  ReuseHistogram result;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    if (bins_[bin] == 0) continue;
    // a sampled distance d means d · 2^halvings … (d + 1) · 2^halvings − 1 lines: take the middle
    const double distance = std::ldexp(middle_of(bin) + 0.5, halvings) - 0.5;
    const auto in_range = static_cast<Index>(std::min<double>(distance, kMaxIndex));
    result.bins_[bin_of(in_range)] += std::llround(times * static_cast<double>(bins_[bin]));
  }
  result.cold_ = std::llround(times * static_cast<double>(cold_));
  return result;
}

double ReuseHistogram::mean_log2() const {
  double sum = 0.0;
  Offset reuses = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    if (bins_[bin] == 0) continue;
    sum += static_cast<double>(bins_[bin]) * std::log2(middle_of(bin) + 1.0);
    reuses += bins_[bin];
  }
  return reuses > 0 ? sum / static_cast<double>(reuses) : 0.0;
}

ReuseDistance::ReuseDistance(Index lines, int halvings) : halvings_(halvings), last_access_of_line_(lines) {
  // at least half of the slots are free after the gaps are closed
  constexpr Slot kFewest = 2 * kWord;
  slot_count_ = std::max(kFewest, 2 * static_cast<Slot>(lines));
  std::size_t nodes = slot_count_ / kWord + 1;
  marks_.assign(nodes, 0);
  do {
    nodes = (nodes + kSisters - 1) / kSisters;
    levels_.emplace_back(nodes);
  } while (nodes > 1);
  marks_in_open_.assign(levels_.size(), 0);
  if (halvings > 0) {
    far_of_line_.resize(static_cast<std::size_t>(lines));
    far_of_block_.resize(static_cast<std::size_t>(lines) / kSampledBlock + 1);
  }
}

Index ReuseDistance::access(Index line, Access how, std::uint32_t streamed) {
  const Index distance = move_to_front(line);
  if (distance >= 0) {
    const bool jump = distance >= (kFar >> halvings_) && is_jump(line, how, streamed);
    if (counts(line)) {
      reuse_.all.add(distance);
      if (jump) reuse_.jumps.add(distance);
    }
    return distance;
  }
  first_accesses_.push_back(line);
  first_access_jumps_.push_back(is_jump(line, how, streamed));
  if (counts(line)) {
    reuse_.all.add_cold();
    if (first_access_jumps_.back()) reuse_.jumps.add_cold();
  }
  return distance;
}

Index ReuseDistance::move_to_front(Index line) {
  assert(line >= 0 && line < index_size(last_access_of_line_));
  Slot& slot = last_access_of_line_[line].slot;
  if (slot == next_ - 1 && slot != kNever) return 0;
  if (next_ == slot_count_) close_gaps();
  if (next_ % kWord == 0 && next_ > 0) close_word(next_ / kWord - 1);
  Index distance = -1;
  if (slot == kNever) {
    mark_first(next_);
  } else {
    distance = move_mark(slot, next_);
  }
  slot = next_++;
  return distance;
}

/// Counts a far access, and returns whether it is a jump.
bool ReuseDistance::is_jump(Index line, Access how, std::uint32_t streamed) {
  if (halvings_ > 0) return is_jump_in_sample(line, how, streamed);
  ++far_accesses_;
  bool jump = how == Access::gathered;
  for (Index before = std::max(0, line - 2); before < line; ++before) {
    jump = jump && far_accesses_ - last_access_of_line_[before].far > kFollowing;
  }
  last_access_of_line_[line].far = far_accesses_;
  return jump;
}

bool ReuseDistance::is_jump_in_sample(Index line, Access how, std::uint32_t streamed) {
  std::uint32_t& of_block = far_of_block_[line / kSampledBlock];
  if (how == Access::gathered) {
    ++far_accesses_;
    ++of_block;
  }
  const FarOfSample now{far_accesses_, of_block, streamed};
  bool jump = how == Access::gathered;
  for (Index before = std::max(0, line - 2); before < line; ++before) {
    const FarOfSample& then = far_of_line_[before];
    const std::uint32_t own = now.own - then.own;
    const std::uint64_t others = now.gathered - then.gathered - own;
    jump = jump && now.streamed - then.streamed + own + (others << halvings_) > kFollowing;
  }
  far_of_line_[line] = now;
  return jump;
}

void ReuseDistance::mark_first(Slot slot) {
  marks_[slot / kWord] |= std::uint64_t{1} << slot % kWord;
  for (std::uint32_t& marks : marks_in_open_) ++marks;
}

/// Moves the mark at `from` to `to`, which comes after all marks; returns the number of marks between them.
Index ReuseDistance::move_mark(Slot from, Slot to) {
  std::uint32_t a = from / kWord;
  std::uint32_t b = to / kWord;
  const std::uint64_t mark = std::uint64_t{1} << from % kWord;
  // the bits above the mark
  std::uint32_t between = count_ones(marks_[a] & ~(mark | (mark - 1)));
  marks_[a] &= ~mark;
  marks_[b] |= std::uint64_t{1} << to % kWord;
  std::uint32_t in_open = 0;
  for (std::size_t level = 0; a != b; ++level) {
    auto& marks_after = levels_[level][a / kSisters].marks_after;
    between += marks_after[a % kSisters];
    subtract(kOneBefore[a % kSisters], marks_after);
    in_open = marks_in_open_[level]++;
    a /= kSisters;
    b /= kSisters;
  }
  return static_cast<Index>(between + in_open);
}

/// Completes a word that ends before the next slot, and each node that ends with this word.
void ReuseDistance::close_word(std::size_t word) {
  std::size_t node = word;
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    auto& marks_after = levels_[level][node / kSisters].marks_after;
    for (std::size_t i = 0; i < node % kSisters; ++i) marks_after[i] += marks_in_open_[level];
    marks_in_open_[level] = 0;
    if (node % kSisters + 1 < kSisters) return;
    node /= kSisters;
  }
}

/// Moves all marks to the first slots, in their order.
void ReuseDistance::close_gaps() {
  std::vector<Slot> marks_before(marks_.size());
  std::transform_exclusive_scan(marks_.begin(), marks_.end(), marks_before.begin(), Slot{0}, std::plus<>(),
                                count_ones);
  for (LastAccess& last : last_access_of_line_) {
    if (last.slot == kNever) continue;
    const std::uint32_t word = last.slot / kWord;
    last.slot = marks_before[word] + count_ones(marks_[word] & ((std::uint64_t{1} << last.slot % kWord) - 1));
  }
  next_ = static_cast<Slot>(distinct());
  std::fill(marks_.begin(), marks_.end(), 0);
  for (std::vector<Sisters>& level : levels_) std::fill(level.begin(), level.end(), Sisters());
  std::fill(marks_in_open_.begin(), marks_in_open_.end(), 0);
  const std::size_t full = next_ / kWord;
  for (std::size_t word = 0; word <= full; ++word) {
    const std::uint32_t marks = word < full ? kWord : next_ % kWord;
    marks_[word] = word < full ? ~std::uint64_t{0} : (std::uint64_t{1} << marks) - 1;
    for (std::uint32_t& in_open : marks_in_open_) in_open += marks;
    if (word < full) close_word(word);
  }
}

Reuse ReuseDistance::repeated() && {
  // In each repetition, the accesses have the same distances, except the first access to each line. The
  // distance of that access reaches back into the repetition before; each line accessed in between counts
  // once.
  reuse_.all.forget_cold();
  reuse_.jumps.forget_cold();
  for (std::size_t k = 0; k < first_accesses_.size(); ++k) {
    const Index distance = move_to_front(first_accesses_[k]);
    if (!counts(first_accesses_[k])) continue;
    reuse_.all.add(distance);
    if (distance >= (kFar >> halvings_) && first_access_jumps_[k]) reuse_.jumps.add(distance);
  }
  return std::move(reuse_);
}

}  // namespace meshorder
