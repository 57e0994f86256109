// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/parallel.hpp"
#include <meshorder/error.hpp>
#include <meshorder/permutation.hpp>

#include <atomic>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

[[noreturn]] void fail_range(Offset entry, const std::string& value, Offset n) {
  throw InvalidArgument("permutation: entry " + std::to_string(entry) + " is " + value + ", outside 0 … " +
                        std::to_string(n - 1));
}

/// Throws an InvalidArgument that names the first entry that keeps `map` from being a bijection of 0 … n−1.
[[noreturn]] void fail(std::span<const Index> map) {
  const auto n = static_cast<Offset>(map.size());
  std::vector<Index> inverse(map.size(), -1);
  for (Offset i = 0; i < n; ++i) {
    const Index target = map[i];
    if (target < 0 || target >= n) fail_range(i, std::to_string(target), n);
    Index& source = inverse[target];
    if (source >= 0) {
      throw InvalidArgument("permutation: entries " + std::to_string(source) + " and " + std::to_string(i) +
                            " are both " + std::to_string(target));
    }
    source = static_cast<Index>(i);
  }
  throw InvalidArgument("permutation: not a bijection");
}

/// Throws TooLarge if the number of places does not fit Index.
void check_count(std::size_t n) {
  if (n > static_cast<std::size_t>(std::numeric_limits<Index>::max())) {
    throw TooLarge("permutation: " + std::to_string(n) + " entries; at most 2,147,483,647 are possible");
  }
}

/// Returns the inverse of `map`, which is checked to be a bijection of 0 … n−1.
std::vector<Index> inverted(std::span<const Index> map) {
  constexpr Offset kEntries = 65536;  // entries that a thread takes at a time
  check_count(map.size());
  const auto n = static_cast<Offset>(map.size());
  std::vector<Index> inverse(map.size(), -1);
  std::atomic<bool> bijection = true;
  in_arena({}, [&] {
    for_each_range(n, kEntries, [&](Offset begin, Offset end) {
      for (Offset i = begin; i < end; ++i) {
        const Index target = map[i];
        if (target < 0 || target >= n) {
          bijection = false;
          return;
        }
        std::atomic_ref(inverse[target]).store(static_cast<Index>(i), std::memory_order_relaxed);
      }
    });
    if (!bijection) return;
    // of several equal entries, all but one fail this test
    for_each_range(n, kEntries, [&](Offset begin, Offset end) {
      for (Offset i = begin; i < end; ++i) {
        if (inverse[map[i]] != i) {
          bijection = false;
          return;
        }
      }
    });
  });
  if (!bijection) fail(map);
  return inverse;
}

/// Copies a map of any integer type. Throws for the first entry that does not fit Index.
std::vector<Index> copied(const IndexView& map) {
  check_count(map.size());
  std::vector<Index> result(map.size());
  with_type(map, [&](auto entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (!std::in_range<Index>(entries[i])) {
        fail_range(static_cast<Offset>(i), std::to_string(entries[i]), static_cast<Offset>(entries.size()));
      }
      result[i] = static_cast<Index>(entries[i]);
    }
  });
  return result;
}

}  // namespace

Permutation Permutation::identity(Index n) {
  if (n < 0) throw InvalidArgument("permutation: the size " + std::to_string(n) + " is negative");
  std::vector<Index> map(static_cast<std::size_t>(n));
  std::iota(map.begin(), map.end(), Index{0});
  std::vector<Index> inverse = map;
  return {std::move(map), std::move(inverse)};
}

Permutation Permutation::from_old_to_new(IndexView map) { return from_old_to_new(copied(map)); }

Permutation Permutation::from_old_to_new(std::vector<Index>&& map) {
  std::vector<Index> inverse = inverted(map);
  return {std::move(map), std::move(inverse)};
}

Permutation Permutation::from_new_to_old(IndexView map) { return from_new_to_old(copied(map)); }

Permutation Permutation::from_new_to_old(std::vector<Index>&& map) {
  std::vector<Index> inverse = inverted(map);
  return {std::move(inverse), std::move(map)};
}

bool Permutation::is_identity() const noexcept {
  for (Index i = 0; i < size(); ++i) {
    if (old_to_new_[i] != i) return false;
  }
  return true;
}

Permutation Permutation::inverse() const& { return {new_to_old_, old_to_new_}; }

Permutation Permutation::inverse() && noexcept { return {std::move(new_to_old_), std::move(old_to_new_)}; }

Permutation Permutation::then(const Permutation& next) const {
  if (next.size() != size()) {
    throw InvalidArgument("permutation: cannot chain " + std::to_string(size()) + " entries with " +
                          std::to_string(next.size()));
  }
  std::vector<Index> forward(old_to_new_.size());
  std::vector<Index> backward(old_to_new_.size());
  constexpr Offset kAtOnce = 65536;
  in_arena({}, [&] {
    for_each_range(size(), kAtOnce, [&](Offset begin, Offset end) {
      for (Offset i = begin; i < end; ++i) {
        forward[i] = next.old_to_new_[old_to_new_[i]];
        backward[i] = new_to_old_[next.new_to_old_[i]];
      }
    });
  });
  return {std::move(forward), std::move(backward)};
}

Permutation Permutation::repeated(Index components, bool node_major) const {
  if (components < 1) {
    throw InvalidArgument("permutation: " + std::to_string(components) + " components; at least 1 is needed");
  }
  const Offset n = size();
  check_count(static_cast<std::size_t>(n * components));
  const auto repeat = [&](const std::vector<Index>& map) {
    std::vector<Index> result(static_cast<std::size_t>(n * components));
    for (Offset i = 0; i < n; ++i) {
      for (Offset c = 0; c < components; ++c) {
        if (node_major) {
          result[components * i + c] = static_cast<Index>(Offset{map[i]} * components + c);
        } else {
          result[c * n + i] = static_cast<Index>(c * n + map[i]);
        }
      }
    }
    return result;
  };
  return {repeat(old_to_new_), repeat(new_to_old_)};
}

void Permutation::check_size(std::size_t values, std::size_t width) const {
  const std::size_t n = old_to_new_.size();
  const bool fits = n == 0 || width == 0 ? values == 0 : values % n == 0 && values / n == width;
  if (fits) return;
  const bool has_width = n > 0 && values > 0 && values % n == 0;
  throw InvalidArgument(
      "permutation: " + std::to_string(values) + " values, wanted " + std::to_string(n) + " rows of " +
      std::to_string(width) + "; " +
      (has_width ? "for rows of " + std::to_string(values / n) + " pass that width, and " : "") +
      "for lists of vertex numbers call renumber");
}

}  // namespace meshorder
