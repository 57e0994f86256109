// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/moved_rows.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace meshorder::distributed {

RowMover::RowMover(const Communicator& communicator, const Layout& layout,
                   std::span<const GlobalIndex> places)
    : communicator_(communicator) {
  const std::vector<GlobalIndex> sent = communicator.together([&] {
    Parcels<Offset> rows = parcels_by_rank(
        places.size(), layout.ranks(), [&](std::size_t row) { return layout.owner(places[row]); },
        [](std::size_t row) { return static_cast<Offset>(row); });
    starts_ = std::move(rows.starts);
    sent_ = std::move(rows.values);
    std::vector<GlobalIndex> numbers(places.size());
    std::transform(sent_.begin(), sent_.end(), numbers.begin(),
                   [&](Offset row) { return places[static_cast<std::size_t>(row)]; });
    return numbers;
  });
  places_ = communicator.exchange(std::span<const GlobalIndex>(sent), starts_).values;
  const GlobalIndex first = layout.begin(communicator.rank());
  for (Offset& place : places_) place -= first;
}

std::vector<std::byte> RowMover::moved(std::span<const std::byte> rows, Offset width) const {
  Parcels<std::byte> parcels;
  communicator_.together([&] {
    for (const Offset start : starts_) parcels.starts.push_back(start * width);
    parcels.values.resize(rows.size());
    std::byte* to = parcels.values.data();
    for (const Offset row : sent_) {
      std::memcpy(to, rows.data() + row * width, static_cast<std::size_t>(width));
      to += width;
    }
  });
  const Parcels<std::byte> arrived = communicator_.exchange(parcels);
  return communicator_.together([&] {
    std::vector<std::byte> result(arrived.values.size());
    const std::byte* from = arrived.values.data();
    for (const Offset place : places_) {
      std::memcpy(result.data() + place * width, from, static_cast<std::size_t>(width));
      from += width;
    }
    return result;
  });
}

Rows RowMover::moved(Rows rows) const {
  Parcels<GlobalIndex> lengths;
  Parcels<GlobalIndex> entries;
  communicator_.together([&] {
    lengths.starts = starts_;
    entries.values.reserve(rows.entries.size());
    entries.starts.push_back(0);
    for (std::size_t rank = 0; rank + 1 < starts_.size(); ++rank) {
      for (Offset k = starts_[rank]; k < starts_[rank + 1]; ++k) {
        const auto row = rows[sent_[static_cast<std::size_t>(k)]];
        lengths.values.push_back(std::ssize(row));
        entries.values.insert(entries.values.end(), row.begin(), row.end());
      }
      entries.starts.push_back(static_cast<Offset>(entries.values.size()));
    }
    rows = {};
  });
  const std::vector<GlobalIndex> arrived_lengths = communicator_.exchange(lengths).values;
  lengths = {};
  const std::vector<GlobalIndex> arrived = communicator_.exchange(entries).values;
  entries = {};
  return communicator_.together([&] {
    Rows result;
    result.offsets.assign(places_.size() + 1, 0);
    for (std::size_t k = 0; k < places_.size(); ++k)
      result.offsets[static_cast<std::size_t>(places_[k]) + 1] = arrived_lengths[k];
    std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
    result.entries.resize(arrived.size());
    const GlobalIndex* from = arrived.data();
    for (std::size_t k = 0; k < places_.size(); ++k) {
      std::copy_n(from, arrived_lengths[k],
                  result.entries.begin() + result.offsets[static_cast<std::size_t>(places_[k])]);
      from += arrived_lengths[k];
    }
    return result;
  });
}

}  // namespace meshorder::distributed
