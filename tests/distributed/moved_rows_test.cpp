// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/moved_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>

namespace meshorder::distributed {
namespace {

/// The same permutation of 0 … count − 1 on all ranks.
std::vector<GlobalIndex> shuffled(GlobalIndex count, unsigned seed) {
  std::vector<GlobalIndex> places(static_cast<std::size_t>(count));
  std::iota(places.begin(), places.end(), GlobalIndex{0});
  std::shuffle(places.begin(), places.end(), std::mt19937(seed));
  return places;
}

TEST(RowMover, PutsEveryRowInItsPlace) {
  Communicator communicator;
  for (const Offset chunk : {Offset{1} << 30, Offset{24}}) {
    communicator.set_chunk_limit(chunk);
    for (const GlobalIndex count : {0, 1, 2, 7, 1000}) {
      const std::vector<GlobalIndex> places = shuffled(count, 5);
      const Layout layout = Layout::even(count, communicator.size());
      const GlobalIndex first = layout.begin(communicator.rank());
      const auto own = static_cast<std::size_t>(layout.size(communicator.rank()));
      const RowMover mover(communicator, layout, {places.data() + first, own});

      // a row of three bytes, and a row whose length depends on its number
      std::vector<std::byte> bytes;
      Rows rows;
      for (std::size_t k = 0; k < own; ++k) {
        const GlobalIndex row = first + static_cast<GlobalIndex>(k);
        for (int b = 0; b < 3; ++b) bytes.push_back(static_cast<std::byte>((row >> (8 * b)) & 0xFF));
        for (GlobalIndex e = 0; e < row % 4; ++e) rows.entries.push_back(row);
        rows.end_row();
      }
      const std::vector<std::byte> moved_bytes = mover.moved(bytes, 3);
      const Rows moved = mover.moved(rows);

      std::vector<GlobalIndex> row_at(places.size());
      for (std::size_t row = 0; row < places.size(); ++row)
        row_at[static_cast<std::size_t>(places[row])] = static_cast<GlobalIndex>(row);
      ASSERT_EQ(moved.size(), static_cast<Offset>(own));
      ASSERT_EQ(moved_bytes.size(), 3 * own);
      for (std::size_t k = 0; k < own; ++k) {
        const GlobalIndex row = row_at[static_cast<std::size_t>(first) + k];
        for (std::size_t b = 0; b < 3; ++b)
          ASSERT_EQ(moved_bytes[3 * k + b], static_cast<std::byte>((row >> (8 * b)) & 0xFF));
        const auto entries = moved[static_cast<Offset>(k)];
        ASSERT_EQ(std::ssize(entries), row % 4);
        ASSERT_TRUE(std::all_of(entries.begin(), entries.end(), [&](GlobalIndex e) { return e == row; }));
      }
    }
  }
}

}  // namespace
}  // namespace meshorder::distributed
