// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/nastran/lists.hpp"

#include "io/deck/numbers.hpp"
#include "io/stream/read_limits.hpp"

#include <algorithm>
#include <unordered_set>

namespace meshorder::nastran {

std::vector<std::int64_t> numbers_in_list(const std::vector<NumberRange>& ranges, const IdMap& items,
                                          const std::vector<std::int64_t>& others,
                                          std::vector<Index>& found) {
  std::vector<std::int64_t> numbers;
  std::unordered_set<Index> seen;
  const bool may_repeat = ranges.size() > 1;
  for (const auto& [from, to, step] : ranges) {
    const std::vector<Index> in_range = items_in_range(items, from, to, step);
    if (may_repeat) claim_memory(in_range.size() * 8 * sizeof(Index), "a list of numbers");
    for (const Index item : in_range) {
      if (!may_repeat || seen.insert(item).second) found.push_back(item);
    }
    for (auto at = std::lower_bound(others.begin(), others.end(), from); at != others.end() && *at <= to;
         ++at) {
      if ((*at - from) % step == 0) numbers.push_back(*at);
    }
  }
  return numbers;
}

}  // namespace meshorder::nastran
