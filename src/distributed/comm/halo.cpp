// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/halo.hpp"

#include <algorithm>
#include <cstring>

namespace meshorder::distributed {

namespace {

/// Returns where each owner's numbers begin in an ascending list, then the size of the list.
std::vector<Offset> starts_by_owner(const Layout& layout, const std::vector<GlobalIndex>& numbers) {
  std::vector<Offset> starts(1, 0);
  for (int rank = 0; rank < layout.ranks(); ++rank) {
    const auto from = numbers.begin() + starts.back();
    starts.push_back(std::lower_bound(from, numbers.end(), layout.end(rank)) - numbers.begin());
  }
  return starts;
}

}  // namespace

Halo::Halo(const Communicator& communicator, const Layout& layout, std::span<const GlobalIndex> numbers)
    : communicator_(communicator),
      first_(layout.begin(communicator.rank())),
      wanted_(communicator.together([&] { return NumberSet(numbers); })),
      asked_(communicator.exchange(std::span<const GlobalIndex>(wanted_.numbers()),
                                   starts_by_owner(layout, wanted_.numbers()))) {}

std::vector<std::byte> Halo::fetch_rows(std::span<const std::byte> own, Offset width) const {
  Parcels<std::byte> answers;
  communicator_.together([&] {
    for (const Offset start : asked_.starts) answers.starts.push_back(start * width);
    answers.values.resize(static_cast<std::size_t>(answers.starts.back()));
    std::byte* to = answers.values.data();
    for (const GlobalIndex number : asked_.values) {
      std::memcpy(to, own.data() + (number - first_) * width, static_cast<std::size_t>(width));
      to += width;
    }
  });
  return communicator_.exchange(answers).values;
}

}  // namespace meshorder::distributed
