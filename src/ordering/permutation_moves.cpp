// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/parallel.hpp"
#include <meshorder/error.hpp>
#include <meshorder/permutation.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace meshorder {
namespace {

constexpr Offset kNumbers = 262144;  // numbers that a thread takes at a time

template <std::size_t Bytes>
using Constant = std::integral_constant<std::size_t, Bytes>;

/// Calls `work` with the size of a row, for usual sizes as a constant: copies of a constant size need no
/// function call.
template <class Work>
void with_row_size(std::size_t bytes, const Work& work) {
  switch (bytes) {
    case 4:
      return work(Constant<4>{});
    case 8:
      return work(Constant<8>{});
    case 12:
      return work(Constant<12>{});
    case 16:
      return work(Constant<16>{});
    case 24:
      return work(Constant<24>{});
    case 32:
      return work(Constant<32>{});
    default:
      return work(bytes);
  }
}

}  // namespace

void Permutation::check_apart(const void* from, const void* to, std::size_t bytes) {
  const auto a = reinterpret_cast<std::uintptr_t>(from);
  const auto b = reinterpret_cast<std::uintptr_t>(to);
  if (bytes > 0 && a < b + bytes && b < a + bytes) {
    throw InvalidArgument("permutation: the arrays overlap; move_in_place moves within one array");
  }
}

void Permutation::move_rows(const void* from, Offset from_stride, void* to, Offset to_stride,
                            std::size_t row_bytes, const Run& run) const {
  constexpr Offset kRows = 16384;  // rows that a thread moves at a time
  const Offset n = size();
  if (n == 0 || row_bytes == 0) return;
  if (from == nullptr || to == nullptr)
    throw InvalidArgument("permutation: no array to move rows from or to");
  const auto dense = static_cast<Offset>(row_bytes);
  if (from_stride == dense && to_stride == dense) check_apart(from, to, old_to_new_.size() * row_bytes);
  const Index* const old = new_to_old_.data();
  with_row_size(row_bytes, [&](auto bytes) {
    const auto move_range = [&](Offset begin, Offset end) {
      const char* const source = static_cast<const char*>(from);
      char* target = static_cast<char*>(to) + begin * to_stride;
      for (Offset k = begin; k < end; ++k, target += to_stride) {
        std::memcpy(target, source + old[k] * from_stride, bytes);
      }
    };
    in_arena(run, [&] { for_each_range(n, kRows, move_range); });
  });
}

void Permutation::move_bytes_in_place(void* rows, std::size_t row_bytes) const {
  const std::size_t n = new_to_old_.size();
  if (n == 0 || row_bytes == 0) return;
  char* const base = static_cast<char*>(rows);
  std::vector<bool> moved(n);
  std::vector<char> first_row(row_bytes);
  with_row_size(row_bytes, [&](auto bytes) {
    for (std::size_t first = 0; first < n; ++first) {
      if (moved[first] || static_cast<std::size_t>(new_to_old_[first]) == first) continue;
      // along the cycle every place gets the row that belongs there; the last place gets the row that was at
      // the first
      std::memcpy(first_row.data(), base + first * bytes, bytes);
      std::size_t place = first;
      for (std::size_t old = new_to_old_[first]; old != first; old = new_to_old_[old]) {
        std::memcpy(base + place * bytes, base + old * bytes, bytes);
        moved[old] = true;
        place = old;
      }
      std::memcpy(base + place * bytes, first_row.data(), bytes);
    }
  });
}

void Permutation::renumber(IndexSpan numbers, int base) const {
  if (base != 0 && base != 1) throw InvalidArgument("permutation: the base must be 0 or 1");
  const Index* const places = old_to_new_.data();
  const auto n = static_cast<std::uint64_t>(size());
  with_type(numbers, [&](auto entries) {
    using T = typename decltype(entries)::value_type;
    const auto count = static_cast<Offset>(entries.size());
    // a number below the base wraps around and is too large
    const auto position = [base](T number) {
      return static_cast<std::uint64_t>(number) - static_cast<unsigned>(base);
    };
    std::atomic<bool> valid = true;
    const auto check_range = [&](Offset begin, Offset end) {
      bool good = true;
      for (Offset k = begin; k < end; ++k) good &= position(entries[k]) < n;
      if (!good) valid = false;
    };
    in_arena({}, [&] { for_each_range(count, kNumbers, check_range); });
    if (!valid) {
      Offset k = 0;
      while (position(entries[k]) < n) ++k;
      throw InvalidArgument("permutation: number " + std::to_string(entries[k]) + " at " + std::to_string(k) +
                            " is outside " + std::to_string(base) + " … " +
                            std::to_string(size() + Offset{base} - 1));
    }
    const auto replace = [&](Offset begin, Offset end) {
      for (Offset k = begin; k < end; ++k)
        entries[k] = static_cast<T>(Offset{places[position(entries[k])]} + base);
    };
    in_arena({}, [&] { for_each_range(count, kNumbers, replace); });
  });
}

}  // namespace meshorder
