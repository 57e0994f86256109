// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "support/graph_views.hpp"
#include "support/sample_graphs.hpp"
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>
#include <meshorder/registry.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task.h>
#include <tbb/task_group.h>

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace meshorder {
namespace {

using RunOfCall = meshorder::Run;  // gtest's tests have a Run of their own

/// What a user's function may throw.
struct Odd {
  int number;
};

TEST(ParallelLoop, ThrowsWithinALoopThatIsCancelled) {
  const auto none = [](Index) {};
  const std::vector<std::function<void()>> inner_loops{
      [&] { parallel_loop(100, none); },
      [&] { for_each_part(7, none); },
      [] { for_each_chunk(100, 3, [](Index, Index, Index) {}); },
      [] { for_each_range(Offset{100}, Offset{3}, [](Offset, Offset) {}); },
      [&] { take_turns(100, none); },
      [] { (void)sum_over_chunks<Offset>(100, 3, [](Index begin, Index end) { return end - begin; }); }};
  for (const std::function<void()>& inner : inner_loops) {
    bool returned = false;
    EXPECT_THROW(parallel_loop(1,
                               [&](int) {
                                 tbb::task::current_context()->cancel_group_execution();
                                 inner();
                                 returned = true;
                               }),
                 Stopped);
    EXPECT_FALSE(returned);
  }
}

TEST(ParallelLoop, DoesAllTurnsOrThrowsWhereAnotherThreadCancels) {
  constexpr Index kTurns = 300;
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 4);
  std::atomic<int> returned = 0;
  for (Index failing = 0; failing < 400; ++failing) {
    EXPECT_THROW(in_arena({.threads = 4},
                          [&] {
                            parallel_loop(Index{16}, [&](Index outer) {
                              if (outer == failing % 16) throw Odd{outer};
                              std::atomic<Index> sum = 0;
                              for_each_chunk(kTurns, 1, [&](Index, Index begin, Index) {
                                for_each_chunk(kTurns, kTurns / 2, [&](Index, Index from, Index to) {
                                  if (begin % 50 == 0) sum += to - from;
                                });
                              });
                              ++returned;
                              EXPECT_EQ(sum, kTurns * kTurns / 50);
                            });
                          }),
                 Odd);
  }
  RecordProperty("inner loops done", returned);
}

TEST(TakeTurns, DoesEachTurnOnceAndOneThreadDoesThemInOrder) {
  for (const int threads : {1, 2, 4}) {
    for (const Index turns : {0, 1, 2, 3, 100}) {
      std::vector<int> done(static_cast<std::size_t>(turns));
      std::atomic<Index> begun = 0;
      in_arena({.threads = threads}, [&] {
        take_turns(turns, [&](Index i) {
          EXPECT_TRUE(threads > 1 || begun == i);
          ++begun;
          ++done[i];
        });
      });
      EXPECT_EQ(std::count(done.begin(), done.end(), 1), turns) << threads << " threads";
    }
  }
}

TEST(TakeTurns, TheCallBeginsNoTurnAfterOneHasFailedOnAnotherThread) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 4);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> failed = false;
  std::atomic<int> begun_later = 0;
  RunOfCall run;
  run.threads = 4;
  run.progress = [](const Progress&) { return true; };  // without it, polls would end the caller's turns
  EXPECT_THROW(in_call(run,
                       [&] {
                         take_turns(20'000, [&](Index i) {
                           begun_later += failed ? 1 : 0;
                           if (std::this_thread::get_id() != caller) {
                             failed = true;
                             throw Odd{i};
                           }
                           std::this_thread::sleep_for(std::chrono::microseconds(10));
                         });
                       }),
               Odd);
  EXPECT_LT(begun_later, 100);
}

TEST(ParallelLoop, OfTheLibraryIsWholeWithinALoopOfTheCallersThatIsCancelled) {
  const CsrGraph graph = test::grid(100, 90);
  const Permutation expected = order_vertices(test::view_of(graph), "spectral").permutation;
  int whole = 0;
  tbb::parallel_for(0, 1, [&](int) {
    tbb::task::current_context()->cancel_group_execution();
    for (const int threads : {0, 1, 3}) {
      const Order order = order_vertices(test::view_of(graph), "spectral", {.run = {.threads = threads}});
      whole += order.permutation == expected ? 1 : 0;
    }
  });
  EXPECT_EQ(whole, 3);
}

class RunOptions : public testing::Test {
 protected:
  /// A user's method that works until `done()`. Its calls of the library belong to the outer call.
  [[nodiscard]] Registration patient(std::function<bool()> done) const {
    return register_vertex_method(
        {.name = "patient"},
        [this, done = std::move(done)](const VertexProblem& problem, const OrderOptions&) {
          while (!done()) (void)order_vertices(small_view_, "minla");
          return Permutation::identity(static_cast<Index>(problem.offsets.size() - 1));
        });
  }

  CsrGraph small_ = test::grid(40, 30);
  GraphView small_view_ = test::view_of(small_);
};

TEST_F(RunOptions, ReportsProgressOnTheCallingThread) {
  const std::set<std::string_view> known{"check",   "graph", "coarsen", "eigenvector",
                                         "improve", "sort",  "move",    "metis"};
  int calls = 0;
  int inside = 0;
  Progress last;
  const std::thread::id caller = std::this_thread::get_id();
  const Registration registration = patient([&] { return calls >= 5; });
  const auto progress = [&](const Progress& now) {
    ++calls;
    EXPECT_EQ(inside++, 0);
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(known.count(now.stage), 1U) << now.stage;
    EXPECT_GE(now.fraction, last.fraction);
    EXPECT_LE(now.fraction, 1);
    EXPECT_GE(now.seconds, last.seconds);
    last = now;
    --inside;
    return true;
  };
  for (const int threads : {1, 4}) {
    calls = 0;
    last = {};
    const Order order =
        order_vertices(small_view_, "patient", {.run = {.threads = threads, .progress = progress}});
    EXPECT_TRUE(order.permutation.is_identity());
    EXPECT_GE(calls, 5);
  }
}

TEST_F(RunOptions, StopsWhenAskedTo) {
  const Order expected = order_vertices(small_view_, "spectral");
  const Registration registration = patient([] { return false; });
  for (const int threads : {1, 2, 4}) {
    for (int allowed = 0; allowed < 3; ++allowed) {
      int calls = 0;
      const auto progress = [&](const Progress&) { return calls++ < allowed; };
      EXPECT_THROW(
          (void)order_vertices(small_view_, "patient", {.run = {.threads = threads, .progress = progress}}),
          Stopped);
      EXPECT_EQ(calls, allowed + 1);
      EXPECT_EQ(order_vertices(small_view_, "spectral", {.run = {.threads = threads}}).permutation,
                expected.permutation);
    }
  }
}

TEST_F(RunOptions, LetsExceptionsOfTheCallbackThrough) {
  const Registration registration = patient([] { return false; });
  for (const int threads : {1, 4}) {
    try {
      (void)order_vertices(
          small_view_, "patient",
          {.run = {.threads = threads, .progress = [](const Progress&) -> bool { throw Odd{3}; }}});
      FAIL() << "nothing thrown";
    } catch (const Odd& odd) {
      EXPECT_EQ(odd.number, 3);
    }
  }
}

TEST_F(RunOptions, MayCallTheLibraryInTheCallback) {
  using Clock = std::chrono::steady_clock;
  const Order expected = order_vertices(small_view_, "minla");
  int calls = 0;
  int inside = 0;
  const Registration registration = patient([&] { return calls >= 2; });
  const auto progress = [&](const Progress&) {
    EXPECT_EQ(inside++, 0) << "called while it runs";
    // longer than it takes until the next call is due
    for (const auto end = Clock::now() + std::chrono::milliseconds(120); Clock::now() < end;) {
      EXPECT_EQ(order_vertices(small_view_, "minla").permutation, expected.permutation);
    }
    ++calls;
    --inside;
    return true;
  };
  EXPECT_TRUE(
      order_vertices(small_view_, "patient", {.run = {.progress = progress, .time_limit = 1e6}}).complete);
  EXPECT_GE(calls, 2);
}

TEST_F(RunOptions, ServesSeveralThreadsAtOnce) {
  const Registration registration = patient([] { return false; });
  std::atomic<int> right = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      const std::thread::id own = std::this_thread::get_id();
      int calls = 0;
      bool by_own = true;
      const auto progress = [&](const Progress&) {
        by_own = by_own && std::this_thread::get_id() == own;
        return ++calls < 2;
      };
      try {
        (void)order_vertices(small_view_, "patient", {.run = {.threads = 1 + t % 2, .progress = progress}});
      } catch (const Stopped&) {
        if (by_own && calls == 2) ++right;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 4);
}

/// The graph with its vertices in random order.
CsrGraph scattered(const CsrGraph& graph) {
  return renumbered(graph, order_vertices(test::view_of(graph), "scrambled").permutation.old_to_new());
}

/// Calls `work` with a progress function that stops it at the k-th call. It must then throw Stopped, or else
/// complete.
template <class Work>
void expect_stopped_or_done(int k, int threads, const Work& work) {
  int calls = 0;
  bool stopped = false;
  try {
    work(Run{.threads = threads, .progress = [&](const Progress&) { return ++calls < k; }});
  } catch (const Stopped&) {
    stopped = true;
  }
  EXPECT_EQ(stopped, calls == k) << calls << " calls";
  EXPECT_LE(calls, k);
}

TEST(Stopping, LeavesVertexOrdersWholeOrUndone) {
  const Index side = test::large(160);
  const CsrGraph ordered = test::grid(side, 160);
  const CsrGraph graph = scattered(ordered);
  std::vector<Point> points;
  for (Index v = 0; v < graph.size(); ++v) points.push_back({1.0 * (v % 97), 1.0 * (v % 89), 1.0 * (v % 83)});
  int turn = 0;
  for (const MethodInfo& method : vertex_methods()) {
    for (const int threads : {1, 2, 4}) {
      SCOPED_TRACE(method.name + " on " + std::to_string(threads) + " threads");
      const auto order = [&](const RunOfCall& run) {
        return order_vertices(test::view_of(graph), method.name, {.run = run}, points);
      };
      expect_stopped_or_done(1 + turn++ % 4, threads, [&](const RunOfCall& run) {
        const Permutation done = order(run).permutation;
        if (threads > 1) {
          EXPECT_EQ(done, order({.threads = 1}).permutation);
        }
      });
    }
  }
  EXPECT_EQ(order_vertices(test::view_of(ordered), "original").permutation.size(), graph.size());
}

/// The triangles of a lattice of n × n vertices.
std::vector<std::array<Index, 3>> lattice_triangles(Index n) {
  std::vector<std::array<Index, 3>> triangles;
  for (Index y = 0; y + 1 < n; ++y) {
    for (Index x = 0; x + 1 < n; ++x) {
      const Index v = y * n + x;
      triangles.push_back({v, v + 1, v + n});
      triangles.push_back({v + 1, v + n + 1, v + n});
    }
  }
  return triangles;
}

TEST(Stopping, LeavesOrdersOfMeshesWholeOrUndone) {
  const Index side = test::kSanitized ? 60 : 250;
  const auto triangles = lattice_triangles(side);
  const CellsView cells = CellsView::uniform(Shape::triangle, 3, triangles);
  const auto n = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  std::vector<Point> points;
  for (std::size_t v = 0; v < n; ++v)
    points.push_back({1.0 * static_cast<double>(v % 97), 1.0 * static_cast<double>(v % 89), 0});
  int turn = 0;
  for (const MethodInfo& method : element_methods()) {
    for (const int threads : {1, 4}) {
      SCOPED_TRACE(method.name + " on " + std::to_string(threads) + " threads");
      expect_stopped_or_done(1 + turn++ % 3, threads, [&](const RunOfCall& run) {
        const MeshOrder order = order_mesh({points, cells}, {"rcm", method.name}, {.run = run});
        EXPECT_EQ(order.vertices.permutation.size(), static_cast<Index>(n));
        EXPECT_EQ(order.cells.permutation.size(), index_size(triangles));
      });
    }
  }
}

TEST(Stopping, LeavesGraphsAndNumbersWholeOrUndone) {
  const Index side = test::kSanitized ? 60 : 250;
  const auto triangles = lattice_triangles(side);
  const CellsView cells = CellsView::uniform(Shape::triangle, 3, triangles);
  const auto n = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  const Graph graph = vertex_graph(cells, n);
  const Graph dual = dual_graph(cells, n, false);
  for (const int threads : {1, 4}) {
    expect_stopped_or_done(1, threads,
                           [&](const RunOfCall& run) { EXPECT_EQ(vertex_graph(cells, n, run), graph); });
    expect_stopped_or_done(1, threads,
                           [&](const RunOfCall& run) { EXPECT_EQ(dual_graph(cells, n, false, run), dual); });
    expect_stopped_or_done(
        1, threads, [&](const RunOfCall& run) { EXPECT_EQ(quality(graph, run).edges, graph.edge_count()); });
    expect_stopped_or_done(2, threads, [&](const RunOfCall& run) {
      EXPECT_TRUE(fiedler_vector(graph, {.tolerance = 1e-7, .run = run}).complete);
    });
  }
}

TEST(TimeLimit, EndsIterativeMethodsWithTheBestOrderSoFar) {
  const Index side = test::large(150);
  const CsrGraph ordered = test::grid(side, 150);
  const CsrGraph graph = scattered(ordered);
  for (const char* method : {"minla", "spectral", "fiedler"}) {
    for (const double limit : {0.0, 1e-9}) {
      for (const int threads : {1, 4}) {
        const Order order =
            order_vertices(test::view_of(graph), method,
                           {.tolerance = 1e-9, .run = {.threads = threads, .time_limit = limit}});
        EXPECT_FALSE(order.complete) << method;
        EXPECT_EQ(order.permutation.size(), graph.size());
      }
    }
    const Order whole = order_vertices(test::view_of(graph), method, {.run = {.time_limit = 1e9}});
    EXPECT_TRUE(whole.complete) << method;
    EXPECT_EQ(whole.permutation, order_vertices(test::view_of(graph), method).permutation) << method;
  }
  EXPECT_FALSE(fiedler_vector(test::view_of(graph), {.tolerance = 1e-9, .run = {.time_limit = 0}}).complete);
}

TEST(TimeLimit, IsIgnoredByMethodsThatDoNotIterate) {
  const CsrGraph graph = test::grid(20, 10);
  for (const char* method : {"rcm", "bfs", "scrambled", "original"}) {
    const Order order = order_vertices(test::view_of(graph), method, {.run = {.time_limit = 0}});
    EXPECT_TRUE(order.complete) << method;
    EXPECT_EQ(order.permutation, order_vertices(test::view_of(graph), method).permutation) << method;
  }
}

}  // namespace
}  // namespace meshorder
