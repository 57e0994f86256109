// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/metrics/reuse_distance.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

namespace meshorder {
namespace {

// bins to a power of two
constexpr Index kFine = 128;
constexpr int kFineBits = 7;

constexpr std::uint32_t kWord = 64;
constexpr std::uint32_t kChildren = 16;

/// std::popcount calls a function where the instruction set does not promise the instruction.
std::uint32_t count_ones(std::uint64_t word) {
  word -= word >> 1 & 0x5555555555555555U;
  word = (word & 0x3333333333333333U) + (word >> 2 & 0x3333333333333333U);
  word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fU;
  return static_cast<std::uint32_t>(word * 0x0101010101010101U >> 56);
}

/// The sum of those of the 16 entries that come after entry `k`.
std::uint32_t sum_after(const std::uint32_t* entries, std::uint32_t k) {
  std::uint32_t sum = 0;
  // all 16 in vector registers: cheaper than a loop of unforeseeable length
  for (std::uint32_t i = 0; i < kChildren; ++i) sum += i > k ? entries[i] : 0;
  return sum;
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

ReuseDistance::ReuseDistance(Index lines) : slot_of_line_(lines, kNever) {
  // closing the gaps then leaves at least half of the slots free
  constexpr Slot kFewest = 2 * kWord;
  slot_count_ = std::max(kFewest, 2 * static_cast<Slot>(lines));
  std::size_t entries = slot_count_ / kWord + 1;
  marks_.assign(entries, 0);
  while (true) {
    const std::size_t parents = (entries + kChildren - 1) / kChildren;
    counts_.emplace_back(parents * kChildren, 0);
    if (parents == 1) break;
    entries = parents;
  }
}

void ReuseDistance::access(Index line) {
  assert(line >= 0 && line < index_size(slot_of_line_));
  Slot& slot = slot_of_line_[line];
  if (slot == next_ - 1 && slot != kNever) {
    histogram_.add(0);
    return;
  }
  if (next_ == slot_count_) close_gaps();
  if (slot == kNever) {
    mark_first(next_);
    first_accesses_.push_back(line);
    histogram_.add_cold();
  } else {
    histogram_.add(move_mark(slot, next_));
  }
  slot = next_++;
}

void ReuseDistance::mark_first(Slot slot) {
  std::uint32_t entry = slot / kWord;
  marks_[entry] |= std::uint64_t{1} << slot % kWord;
  for (std::vector<std::uint32_t>& counts : counts_) {
    ++counts[entry];
    entry /= kChildren;
  }
}

/// Marks `to`, after all marks, instead of `from`; returns the marks between.
Index ReuseDistance::move_mark(Slot from, Slot to) {
  std::uint32_t a = from / kWord;
  std::uint32_t b = to / kWord;
  const std::uint64_t mark = std::uint64_t{1} << from % kWord;
  // the bits above the mark
  std::uint32_t between = count_ones(marks_[a] & ~(mark | (mark - 1)));
  marks_[a] &= ~mark;
  marks_[b] |= std::uint64_t{1} << to % kWord;
  for (std::size_t level = 0; a != b; ++level) {
    std::uint32_t* const counts = counts_[level].data();
    between += sum_after(counts + a / kChildren * kChildren, a % kChildren);
    --counts[a];
    ++counts[b];
    a /= kChildren;
    b /= kChildren;
  }
  return static_cast<Index>(between);
}

/// Moves all marks to the first slots, in their order.
void ReuseDistance::close_gaps() {
  std::vector<Slot> marks_before(marks_.size());
  std::exclusive_scan(counts_[0].begin(), counts_[0].begin() + static_cast<std::ptrdiff_t>(marks_.size()),
                      marks_before.begin(), Slot{0});
  for (Slot& slot : slot_of_line_) {
    if (slot == kNever) continue;
    const std::uint32_t word = slot / kWord;
    slot = marks_before[word] + count_ones(marks_[word] & ((std::uint64_t{1} << slot % kWord) - 1));
  }
  next_ = static_cast<Slot>(distinct());
  std::fill(marks_.begin(), marks_.end(), 0);
  std::fill_n(marks_.begin(), next_ / kWord, ~std::uint64_t{0});
  marks_[next_ / kWord] = (std::uint64_t{1} << next_ % kWord) - 1;
  std::transform(marks_.begin(), marks_.end(), counts_[0].begin(), count_ones);
  for (std::size_t level = 1; level < counts_.size(); ++level) {
    for (std::size_t i = 0; i < counts_[level - 1].size(); i += kChildren) {
      const auto first = counts_[level - 1].begin() + static_cast<std::ptrdiff_t>(i);
      counts_[level][i / kChildren] = std::accumulate(first, first + kChildren, std::uint32_t{0});
    }
  }
}

ReuseHistogram ReuseDistance::repeated() && {
  // within a run distances are the same in every run; across its start, a line that has been accessed in the
  // new run counts once, however often it was
  histogram_.forget_cold();
  for (const Index line : first_accesses_) access(line);
  return std::move(histogram_);
}

}  // namespace meshorder
