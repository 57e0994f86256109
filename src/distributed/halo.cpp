// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/halo.hpp"

#include <algorithm>
#include <utility>

namespace meshorder::distributed {

Parcels<GlobalIndex> by_owner(const Layout& layout, std::vector<GlobalIndex> numbers) {
  Parcels<GlobalIndex> parcels;
  parcels.starts.assign(1, 0);
  for (int rank = 0; rank < layout.ranks(); ++rank) {
    const auto from = numbers.begin() + parcels.starts.back();
    parcels.starts.push_back(std::lower_bound(from, numbers.end(), layout.end(rank)) - numbers.begin());
  }
  parcels.values = std::move(numbers);
  return parcels;
}

Halo::Halo(const Communicator& communicator, const Layout& layout, std::vector<GlobalIndex> numbers)
    : communicator_(communicator),
      first_(layout.begin(communicator.rank())),
      wanted_(by_owner(layout, std::move(numbers))),
      asked_(communicator.exchange(wanted_)) {}

std::size_t Halo::position(GlobalIndex number) const {
  const auto& numbers = wanted_.values;
  return static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin());
}

std::vector<GlobalIndex> distinct(std::vector<GlobalIndex> numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

}  // namespace meshorder::distributed
