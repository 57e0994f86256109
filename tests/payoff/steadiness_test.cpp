// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/steadiness.hpp"

#include "base/stopwatch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace meshorder {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(Steadiness, KernelsSettleWhenTheyAreAboutAsFastAsTheyGet) {
  EXPECT_EQ(runs_to_settle({}), 1);
  EXPECT_EQ(runs_to_settle({3}), 1);
  EXPECT_EQ(runs_to_settle({3, 3, 3}), 1);
  EXPECT_EQ(runs_to_settle({5, 3.1, 3, 3.1}), 1);
  EXPECT_EQ(runs_to_settle({5.96, 7.29, 7.68, 4.27, 3.21, 2.96, 2.82, 2.77}), 6);
  EXPECT_EQ(runs_to_settle({1, 3, 3}), 1);
  EXPECT_FALSE(is_steady({}));
  EXPECT_FALSE(is_steady({3, 3, 3}));
  EXPECT_TRUE(is_steady({5, 3, 3.1, 3.1}));
  EXPECT_FALSE(is_steady({5.96, 7.29, 7.68, 7.5}));
  EXPECT_FALSE(is_steady({5.96, 7.29, 7.68, 4.27, 3.21, 2.96}));
  EXPECT_TRUE(is_steady({5.96, 7.29, 7.68, 4.27, 3.21, 2.96, 2.82, 2.82}));
}

TEST(Steadiness, IsDoubtedForEachSign) {
  EXPECT_THAT(reason_to_doubt({}), IsEmpty());
  EXPECT_THAT(reason_to_doubt({.waiting = 0.04, .pace = 0.09, .repeat = 0.04}), IsEmpty());
  EXPECT_THAT(reason_to_doubt({.waiting = 0.5}), HasSubstr("50 % used by others"));
  EXPECT_THAT(reason_to_doubt({.pace = 0.3}), HasSubstr("changes by 30 %"));
  EXPECT_THAT(reason_to_doubt({.repeat = 0.07}), HasSubstr("differs by 7 %"));
}

TEST(SteadinessWatch, TakesMediansAndShares) {
  SteadinessWatch watch;
  watch.add_sample(1, 1);
  watch.add_sample(3, 2);
  for (const double difference : {0.5, 0.01, 0.02}) watch.add_repeat(difference);
  EXPECT_DOUBLE_EQ(watch.result().waiting, 0.25);
  EXPECT_DOUBLE_EQ(watch.result().repeat, 0.02);
  EXPECT_EQ(watch.result().pace, 0);
  watch.tick();
  EXPECT_EQ(watch.result().pace, 0);  // only one piece has been timed
  watch.tick();
  EXPECT_GE(watch.result().pace, 0);
}

TEST(ThreadStopwatch, StopsWhileTheThreadSleeps) {
  const Stopwatch stopwatch;
  const ThreadStopwatch thread;
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_LT(thread.seconds(), 0.5 * stopwatch.seconds());
  while (thread.seconds() < 0.002) {
  }
  EXPECT_GE(stopwatch.seconds(), 0.03);
}

}  // namespace
}  // namespace meshorder
