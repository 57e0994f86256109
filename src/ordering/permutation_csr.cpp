// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/parallel.hpp"
#include "graph/examine.hpp"
#include "graph/graph_arrays.hpp"
#include <meshorder/error.hpp>
#include <meshorder/permutation.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// An entry of a moved row: its new column and its position in the old matrix. Sorting by both keeps the
/// order of repeated columns.
using MovedEntry = std::pair<Index, Offset>;

/// Converts and checks a matrix; its weights are ignored. Offsets and columns are in range afterwards.
GraphArrays matrix_arrays(const GraphView& matrix, Index n) {
  const GraphView pattern{matrix.offsets, matrix.neighbours, {}, matrix.base};
  GraphArrays arrays = graph_arrays(pattern);
  if (arrays.size() != n) {
    throw InvalidArgument("permutation: a matrix of " + std::to_string(arrays.size()) + " rows for " +
                          std::to_string(n) + " places");
  }
  refuse_faults(pattern, arrays, examine(arrays, false));
  return arrays;
}

/// Returns the offsets of the moved rows, from 0.
std::vector<Offset> moved_offsets(const GraphArrays& matrix, std::span<const Index> new_to_old) {
  std::vector<Offset> offsets(matrix.offsets.size(), 0);
  for (std::size_t k = 0; k < new_to_old.size(); ++k) {
    const Index old = new_to_old[k];
    offsets[k + 1] = offsets[k] + matrix.offsets[old + 1] - matrix.offsets[old];
  }
  return offsets;
}

/// Calls `take(begin, entries)` for every moved row, on all threads. `entries` has the row's entries by
/// ascending column; the first of them is entry `begin` of the moved matrix.
template <class Take>
void for_each_moved_row(const GraphArrays& matrix, const Permutation& order, std::span<const Offset> offsets,
                        const Take& take) {
  constexpr Offset kRows = 4096;  // rows that a thread moves at a time
  const std::span<const Index> new_to_old = order.new_to_old();
  const std::span<const Index> old_to_new = order.old_to_new();
  for_each_range(order.size(), kRows, [&](Offset first, Offset last) {
    std::vector<MovedEntry> entries;
    for (Offset row = first; row < last; ++row) {
      const Index old = new_to_old[row];
      entries.clear();
      for (Offset k = matrix.offsets[old]; k < matrix.offsets[old + 1]; ++k) {
        entries.emplace_back(old_to_new[matrix.neighbours[k]], k);
      }
      std::sort(entries.begin(), entries.end());
      take(offsets[row], std::span<const MovedEntry>(entries));
    }
  });
}

/// Throws TooLarge if the type of `numbers` cannot hold `largest`.
void check_fits(const IndexSpan& numbers, Offset largest, const char* what) {
  if (numbers.bytes() == 8) return;
  const Offset limit = numbers.is_signed() ? Offset{std::numeric_limits<std::int32_t>::max()}
                                           : Offset{std::numeric_limits<std::uint32_t>::max()};
  if (largest > limit) {
    throw TooLarge("permutation: " + std::string(what) + " up to " + std::to_string(largest) +
                   " do not fit integers of 32 bits");
  }
}

void check_output_size(std::size_t size, std::size_t wanted, const char* what) {
  if (size != wanted) {
    throw InvalidArgument("permutation: room for " + std::to_string(size) + " " + what + ", must be " +
                          std::to_string(wanted));
  }
}

struct ByteRange {
  const void* data;
  std::size_t bytes;
};

bool overlap(const ByteRange& a, const ByteRange& b) {
  const auto begin_a = reinterpret_cast<std::uintptr_t>(a.data);
  const auto begin_b = reinterpret_cast<std::uintptr_t>(b.data);
  return a.bytes > 0 && b.bytes > 0 && begin_a < begin_b + b.bytes && begin_b < begin_a + a.bytes;
}

void write_offsets(std::span<const Offset> offsets, int base, const IndexSpan& target) {
  with_type(target, [&](auto numbers) {
    using T = typename decltype(numbers)::value_type;
    for (std::size_t v = 0; v < offsets.size(); ++v) numbers[v] = static_cast<T>(offsets[v] + base);
  });
}

}  // namespace

void Permutation::move_csr(const GraphView& matrix, std::span<const std::byte> values, IndexSpan offsets,
                           IndexSpan columns, std::span<std::byte> moved) const {
  const std::size_t entries = matrix.neighbours.size();
  const std::size_t rows = new_to_old_.size();
  check_output_size(offsets.size(), rows + 1, "offsets");
  check_output_size(columns.size(), entries, "columns");
  check_output_size(moved.size(), values.size(), "bytes of values");
  const std::size_t width = entries > 0 ? values.size() / entries : 0;
  if (values.size() != width * entries) {
    throw InvalidArgument("permutation: " + std::to_string(values.size()) + " bytes of values for " +
                          std::to_string(entries) + " entries");
  }
  const auto range = [](const auto& view) {
    return ByteRange{view.data(), view.size() * static_cast<std::size_t>(view.bytes())};
  };
  const std::array<ByteRange, 3> inputs{
      {range(matrix.offsets), range(matrix.neighbours), {values.data(), values.size()}}};
  const std::array<ByteRange, 3> outputs{{range(offsets), range(columns), {moved.data(), moved.size()}}};
  for (std::size_t a = 0; a < outputs.size(); ++a) {
    const bool shared = std::any_of(inputs.begin(), inputs.end(),
                                    [&](const ByteRange& in) { return overlap(in, outputs[a]); }) ||
                        std::any_of(outputs.begin(), outputs.begin() + static_cast<std::ptrdiff_t>(a),
                                    [&](const ByteRange& out) { return overlap(out, outputs[a]); });
    if (shared) throw InvalidArgument("permutation: an output of move_csr overlaps another array");
  }
  check_fits(offsets, static_cast<Offset>(entries) + matrix.base, "offsets");
  in_arena({}, [&] {
    const GraphArrays arrays = matrix_arrays(matrix, size());
    const std::vector<Offset> starts = moved_offsets(arrays, new_to_old_);
    write_offsets(starts, matrix.base, offsets);
    with_type(columns, [&](auto numbers) {
      using T = typename decltype(numbers)::value_type;
      for_each_moved_row(arrays, *this, starts, [&](Offset place, std::span<const MovedEntry> row) {
        for (const auto& [column, entry] : row) {
          numbers[static_cast<std::size_t>(place)] = static_cast<T>(Offset{column} + matrix.base);
          if (width > 0) {
            std::memcpy(moved.data() + static_cast<std::size_t>(place) * width,
                        values.data() + static_cast<std::size_t>(entry) * width, width);
          }
          ++place;
        }
      });
    });
  });
}

std::vector<Offset> Permutation::csr_entry_map(const GraphView& matrix) const {
  return in_arena({}, [&] {
    const GraphArrays arrays = matrix_arrays(matrix, size());
    const std::vector<Offset> starts = moved_offsets(arrays, new_to_old_);
    std::vector<Offset> map(arrays.neighbours.size());
    for_each_moved_row(arrays, *this, starts, [&](Offset place, std::span<const MovedEntry> row) {
      for (const MovedEntry& entry : row) map[place++] = entry.second;
    });
    return map;
  });
}

}  // namespace meshorder
