// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/number_order.hpp"

#include "distributed/comm/sample_sort.hpp"

#include <algorithm>
#include <cstddef>

namespace meshorder::distributed {
namespace {

constexpr std::uint64_t kSign = std::uint64_t{1} << 63U;

/// Returns a key that ascends with the number; number_of is the inverse.
std::uint64_t key_of(std::int64_t number) { return static_cast<std::uint64_t>(number) ^ kSign; }
std::int64_t number_of(std::uint64_t key) { return static_cast<std::int64_t>(key ^ kSign); }

/// Facts about one rank's sorted numbers, from which all ranks find the smallest duplicate.
struct Ends {
  bool is_empty = true;
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  bool has_twice = false;
  std::uint64_t twice = 0;
};

}  // namespace

NumberOrder order_of_numbers(const Communicator& communicator, const Layout& layout,
                             const std::vector<std::int64_t>& numbers) {
  const GlobalIndex first = layout.begin(communicator.rank());
  std::vector<SortEntry> entries = communicator.together([&] {
    std::vector<SortEntry> result(numbers.size());
    for (std::size_t k = 0; k < numbers.size(); ++k)
      result[k] = {key_of(numbers[k]), first + static_cast<GlobalIndex>(k)};
    return result;
  });
  entries = sample_sorted(communicator, std::move(entries));
  const auto twice = std::adjacent_find(entries.begin(), entries.end(),
                                        [](const auto& a, const auto& b) { return a.key == b.key; });
  Ends own;
  if (!entries.empty()) {
    own = {false, entries.front().key, entries.back().key, twice != entries.end(),
           twice != entries.end() ? twice->key : 0};
  }
  NumberOrder order;
  std::optional<std::uint64_t> last;
  for (const Ends& ends : communicator.gathered(own)) {
    if (ends.is_empty || order.twice) continue;
    if (last == ends.first) {
      order.twice = number_of(ends.first);
    } else if (ends.has_twice) {
      order.twice = number_of(ends.twice);
    }
    last = ends.last;
  }
  order.sorted = communicator.together([&] {
    std::vector<GlobalIndex> places;
    places.reserve(entries.size());
    for (const SortEntry& entry : entries) places.push_back(entry.number);
    return places;
  });
  return order;
}

bool are_places(const Communicator& communicator, const Layout& layout,
                const std::vector<std::int64_t>& numbers) {
  GlobalIndex next = layout.begin(communicator.rank());
  const bool are_own =
      std::all_of(numbers.begin(), numbers.end(), [&](std::int64_t number) { return number == ++next; });
  return communicator.sum(are_own ? 0 : 1) == 0;
}

}  // namespace meshorder::distributed
