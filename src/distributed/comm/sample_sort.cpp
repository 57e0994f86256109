// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/sample_sort.hpp"

#include "ordering/sorted.hpp"

#include <algorithm>
#include <cstddef>

namespace meshorder::distributed {
namespace {

constexpr Offset kSamplesPerRank = 64;  // enough for shares of the ranks that differ by only a few %

/// Returns the entries at which the ranges of ranks 1, 2, … begin, chosen from samples of all ranks.
std::vector<SortEntry> splitters(const Communicator& communicator, const std::vector<SortEntry>& sorted) {
  const auto count = static_cast<Offset>(sorted.size());
  const Offset ranks = communicator.size();
  // take every step-th entry, so that ranks with more entries contribute more samples
  const Offset step = std::max<Offset>(1, communicator.sum(count) / (ranks * kSamplesPerRank));
  std::vector<SortEntry> samples;
  for (Offset k = step / 2; k < count; k += step) samples.push_back(sorted[static_cast<std::size_t>(k)]);
  samples = communicator.gathered_at_root(samples);
  std::sort(samples.begin(), samples.end());
  std::vector<SortEntry> result;
  for (Offset r = 1; r < ranks && !samples.empty(); ++r) {
    const auto at = static_cast<Offset>(samples.size()) * r / ranks;
    result.push_back(samples[static_cast<std::size_t>(at)]);
  }
  return communicator.broadcast(std::move(result));
}

}  // namespace

std::vector<SortEntry> sample_sorted(const Communicator& communicator, std::vector<SortEntry> entries) {
  communicator.together([&] { sort_distinct(entries); });
  const std::vector<SortEntry> bounds = splitters(communicator, entries);
  Parcels<SortEntry> parcels;
  parcels.starts.assign(1, 0);
  for (const SortEntry& bound : bounds)
    parcels.starts.push_back(std::lower_bound(entries.begin(), entries.end(), bound) - entries.begin());
  parcels.starts.resize(static_cast<std::size_t>(communicator.size()) + 1,
                        static_cast<Offset>(entries.size()));
  parcels.values = std::move(entries);
  std::vector<SortEntry> received = communicator.exchange(parcels).values;
  communicator.together([&] { sort_distinct(received); });
  return received;
}

}  // namespace meshorder::distributed
