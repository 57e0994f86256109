// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/communicator.hpp"

#include "distributed/comm/halo.hpp"
#include "distributed/comm/rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>
#include <numeric>
#include <stdexcept>

namespace meshorder::distributed {
namespace {

using testing::ElementsAre;

constexpr Offset kSmallChunk = 1024;  // bytes; a parcel of the tests takes up to 50 of them

/// How many values rank `from` sends to rank `to`: none, a few or more than a chunk.
Offset parcel_size(int from, int to) {
  return (from * 7 + to * 3) % 4 == 0 ? 0 : (from * 1009 + to * 499) % 6007;
}

std::int64_t value_of(int from, int to, Offset k) { return from * 1'000'000'000'000 + to * 1'000'000 + k; }

Parcels<std::int64_t> parcels_of(const Communicator& communicator) {
  Parcels<std::int64_t> sent;
  sent.starts.assign(1, 0);
  for (int to = 0; to < communicator.size(); ++to) {
    for (Offset k = 0; k < parcel_size(communicator.rank(), to); ++k)
      sent.values.push_back(value_of(communicator.rank(), to, k));
    sent.starts.push_back(static_cast<Offset>(sent.values.size()));
  }
  return sent;
}

class Exchange : public testing::TestWithParam<Offset> {};

TEST_P(Exchange, DeliversEveryParcel) {
  Communicator communicator;
  communicator.set_chunk_limit(GetParam());
  const Parcels<std::int64_t> received = communicator.exchange(parcels_of(communicator));
  for (int from = 0; from < communicator.size(); ++from) {
    const auto parcel = received[from];
    ASSERT_EQ(std::ssize(parcel), parcel_size(from, communicator.rank())) << "from rank " << from;
    for (std::size_t k = 0; k < parcel.size(); ++k)
      ASSERT_EQ(parcel[k], value_of(from, communicator.rank(), static_cast<Offset>(k)));
  }
}

TEST_P(Exchange, BroadcastsAndGathers) {
  Communicator communicator;
  communicator.set_chunk_limit(GetParam());
  std::vector<int> numbers(communicator.is_root() ? 3001 : 0);
  std::iota(numbers.begin(), numbers.end(), 5);
  const std::vector<int> everywhere = communicator.broadcast(numbers);
  ASSERT_EQ(everywhere.size(), 3001U);
  EXPECT_EQ(everywhere.back(), 3005);

  const std::vector<std::string> texts{"one", "", std::string(3000, 'x')};
  EXPECT_EQ(communicator.broadcast(communicator.is_root() ? texts : std::vector<std::string>{}), texts);

  const std::vector<int> own(static_cast<std::size_t>(500 * communicator.rank()), communicator.rank());
  const std::vector<int> all = communicator.gathered_at_root(own);
  const int ranks = communicator.size();
  ASSERT_EQ(std::ssize(all), communicator.is_root() ? 500 * ranks * (ranks - 1) / 2 : 0);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
}

TEST_P(Exchange, AddsUpEntryByEntry) {
  Communicator communicator;
  communicator.set_chunk_limit(GetParam());
  std::vector<std::int64_t> own(1000);
  std::iota(own.begin(), own.end(), communicator.rank());
  const std::vector<std::int64_t> sums = communicator.sums(own);
  const std::int64_t ranks = communicator.size();
  for (std::int64_t k = 0; k < 1000; ++k)
    ASSERT_EQ(sums[static_cast<std::size_t>(k)], ranks * k + ranks * (ranks - 1) / 2);
}

INSTANTIATE_TEST_SUITE_P(Chunks, Exchange, testing::Values(kSmallChunk, Offset{1} << 30));

TEST(Communicator, SharesAnExceptionOfOneRank) {
  const Communicator communicator;
  const int last = communicator.size() - 1;
  try {
    communicator.together([&] {
      if (communicator.rank() == last) throw InputError("mesh.vtu", "is short", "copy it again");
    });
    FAIL() << "rank " << communicator.rank() << " goes on";
  } catch (const SharedError& error) {
    EXPECT_EQ(error.code(), Code::bad_input);
    EXPECT_THAT(error.what(), testing::EndsWith("mesh.vtu: is short; copy it again"));
  }
}

TEST(Communicator, SharesTheLackOfMemory) {
  const Communicator communicator;
  const auto work = [&]() -> int {
    if (communicator.is_root()) throw std::bad_alloc();
    return 1;
  };
  try {
    (void)communicator.together(work);
    FAIL();
  } catch (const SharedError& error) {
    EXPECT_EQ(error.code(), Code::internal);
    EXPECT_STREQ(error.what(), "out of memory");
  }
}

TEST(Communicator, AddsUpInRankOrder) {
  const Communicator communicator;
  // in rank order each 1 is lost in 1e16; in other orders the ones can add up first
  const double own = communicator.rank() == 0 ? 1e16 : 1.0;
  double expected = 1e16;
  for (int r = 1; r < communicator.size(); ++r) expected += 1.0;
  EXPECT_EQ(communicator.sum(own), expected);
}

TEST(Layout, SharesNumbersEvenly) {
  const Layout layout = Layout::even(11, 4);
  EXPECT_THAT((std::vector{layout.size(0), layout.size(1), layout.size(2), layout.size(3)}),
              ElementsAre(3, 3, 3, 2));
  for (GlobalIndex k = 0; k < 11; ++k) {
    const int owner = layout.owner(k);
    EXPECT_TRUE(layout.begin(owner) <= k && k < layout.end(owner)) << k;
  }
  EXPECT_EQ(Layout::even(2, 4).owner(1), 1);  // ranks that own nothing
}

TEST(Layout, HoldsNumbersBeyond32Bits) {
  const GlobalIndex far = GlobalIndex{1} << 33;
  const Layout layout({far, far, far + 5, far + 7});
  EXPECT_EQ(layout.owner(far), 1);
  EXPECT_EQ(layout.owner(far + 6), 2);
}

TEST(Halo, FetchesTheOwnersValues) {
  const Communicator communicator;
  const GlobalIndex count = 1000;
  const Layout layout = Layout::even(count, communicator.size());
  std::vector<GlobalIndex> wanted;
  for (GlobalIndex k = communicator.rank(); k < count; k += 7) wanted.push_back(k);
  const Halo halo(communicator, layout, wanted);
  std::vector<double> own;
  for (GlobalIndex k = layout.begin(communicator.rank()); k < layout.end(communicator.rank()); ++k)
    own.push_back(0.5 * static_cast<double>(k));
  const std::vector<double> values = halo.fetch(own);
  ASSERT_EQ(values.size(), wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    EXPECT_EQ(values[k], 0.5 * static_cast<double>(wanted[k]));
    EXPECT_EQ(halo.position(wanted[k]), k);
  }
}

TEST(Delivered, HandsValuesToTheirOwners) {
  const Communicator communicator;
  const GlobalIndex count = 101;
  const Layout layout = Layout::even(count, communicator.size());
  std::vector<GlobalIndex> numbers;
  std::vector<int> values;
  for (GlobalIndex k = count - 1 - communicator.rank(); k >= 1; k -= communicator.size()) {  // all but 0
    numbers.push_back(k);
    values.push_back(static_cast<int>(3 * k));
  }
  const std::vector<int> own = delivered<int>(communicator, layout, numbers, values, -1);
  GlobalIndex number = layout.begin(communicator.rank());
  ASSERT_EQ(std::ssize(own), layout.size(communicator.rank()));
  for (const int value : own) {
    EXPECT_EQ(value, number == 0 ? -1 : 3 * number);
    ++number;
  }
}

TEST(Rows, ReachTheirRanksInOrder) {
  const Communicator communicator;
  Rows rows;
  std::vector<Dispatch> dispatches;
  for (int k = 0; k < 50; ++k) {  // k entries each, to two ranks
    rows.entries.insert(rows.entries.end(), static_cast<std::size_t>(k), 1000 * communicator.rank() + k);
    rows.end_row();
    dispatches.push_back({k % communicator.size(), k});
    if (communicator.size() > 1) dispatches.push_back({(k + 1) % communicator.size(), k});
  }
  const Rows received = send_rows(communicator, rows, dispatches);
  Rows expected;
  for (int from = 0; from < communicator.size(); ++from) {
    for (int k = 0; k < 50; ++k) {
      const int offset =
          (communicator.rank() - k % communicator.size() + communicator.size()) % communicator.size();
      if (offset > 1) continue;
      expected.entries.insert(expected.entries.end(), static_cast<std::size_t>(k), 1000 * from + k);
      expected.end_row();
    }
  }
  EXPECT_EQ(received, expected);
}

}  // namespace
}  // namespace meshorder::distributed
