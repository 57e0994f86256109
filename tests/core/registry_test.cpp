// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/graph_views.hpp"
#include "support/refusal.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>
#include <meshorder/registry.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace meshorder {
namespace {
using test::refusal;

using testing::HasSubstr;

/// The permutation that reverses the order.
Permutation reversed(std::size_t n) {
  std::vector<Index> map(n);
  std::iota(map.rbegin(), map.rend(), 0);
  return Permutation::from_old_to_new(std::move(map));
}

Permutation reversed_vertices(const VertexProblem& problem, const OrderOptions& /*options*/) {
  return reversed(problem.offsets.size() - 1);
}

Permutation reversed_elements(const ElementProblem& problem, const OrderOptions& /*options*/) {
  return reversed(problem.offsets.size() - 1);
}

std::optional<MethodInfo> find(const std::vector<MethodInfo>& methods, const std::string& name) {
  const auto found = std::find_if(methods.begin(), methods.end(),
                                  [&](const MethodInfo& method) { return method.name == name; });
  return found != methods.end() ? std::optional(*found) : std::nullopt;
}

class Registry : public testing::Test {
 protected:
  CsrGraph graph_ = test::grid(5, 4);
  GraphView view_ = test::view_of(graph_);
};

TEST_F(Registry, ListsAndCallsMethodsWhileTheyAreRegistered) {
  {
    const Registration vertices =
        register_vertex_method({.name = "my-turn", .description = "turned round"}, reversed_vertices);
    const Registration elements = register_element_method({.name = "my-turn"}, reversed_elements);
    const auto info = find(vertex_methods(), "my-turn");
    ASSERT_TRUE(info.has_value());
    EXPECT_EQ(info->description, "turned round");
    EXPECT_EQ(info->source, "registered");
    EXPECT_EQ(vertex_methods().back().name, "my-turn");
    EXPECT_TRUE(find(element_methods(), "my-turn").has_value());

    const Order order = order_vertices(view_, "my-turn");
    EXPECT_EQ(order.permutation, reversed(20));
    EXPECT_EQ(order.method, (MethodChoice{"my-turn", ""}));
    const Mesh mesh = test::tetrahedral_bar(2);
    const CellsView cells = CellsView::uniform(Shape::tetrahedron, 4, mesh.cells.vertices);
    const MeshOrder both = order_mesh({.points = mesh.points, .cells = cells}, {"my-turn", "my-turn"});
    EXPECT_EQ(both.vertices.permutation, reversed(mesh.points.size()));
    EXPECT_EQ(both.cells.permutation, reversed(cells.size()));
  }
  EXPECT_FALSE(find(vertex_methods(), "my-turn").has_value());
  EXPECT_FALSE(find(element_methods(), "my-turn").has_value());
  EXPECT_THAT(refusal([&] { (void)order_vertices(view_, "my-turn"); }),
              HasSubstr("unknown vertex order 'my-turn'"));
}

TEST_F(Registry, HandsOverACleanProblem) {
  const std::vector<std::int64_t> offsets{1, 4, 6};
  const std::vector<std::int64_t> neighbours{2, 1, 2, 1, 1};
  const std::vector<float> weights{1, 9, 2, 1, 2};
  const std::vector<std::array<float, 2>> points{{1, 2}, {3, 4}};
  int calls = 0;
  const Registration registration = register_vertex_method(
      {.name = "looks"}, [&](const VertexProblem& problem, const OrderOptions& options) {
        ++calls;
        EXPECT_THAT(problem.offsets, testing::ElementsAre(0, 1, 2));
        EXPECT_THAT(problem.neighbours, testing::ElementsAre(1, 0));
        EXPECT_THAT(problem.weights, testing::ElementsAre(3, 3));
        EXPECT_EQ(problem.points(1, 1), 4);
        EXPECT_EQ(options.seed, 7U);
        return Permutation::identity(2);
      });
  const Order order = order_vertices({offsets, neighbours, weights, 1}, "looks", {.seed = 7}, points);
  EXPECT_EQ(calls, 1);
  EXPECT_FALSE(order.notes.empty());

  const std::vector<int> edges{0, 1, 1, 2};
  const Permutation vertices = Permutation::from_old_to_new({2, 0, 1});
  const Registration of_elements =
      register_element_method({.name = "looks"}, [&](const ElementProblem& problem, const OrderOptions&) {
        ++calls;
        EXPECT_THAT(problem.offsets, testing::ElementsAre(0, 2, 4));
        EXPECT_THAT(problem.vertices, testing::ElementsAre(0, 1, 1, 2));
        EXPECT_THAT(problem.vertex_ranks, testing::ElementsAre(2, 0, 1));
        EXPECT_TRUE(problem.points.empty());
        return Permutation::identity(2);
      });
  EXPECT_EQ(order_elements(CellsView::uniform(Shape::line, 2, edges), vertices, "looks").permutation.size(),
            2);
  EXPECT_EQ(calls, 2);
}

TEST_F(Registry, OrdersGroupAfterGroup) {
  const Registration registration = register_vertex_method({.name = "my-turn"}, reversed_vertices);
  std::vector<int> groups(20, 1);
  std::fill(groups.begin() + 15, groups.end(), -1);
  const Order order = order_vertices(view_, "my-turn", {.groups = groups});
  std::vector<Index> expected(20);
  std::iota(expected.rbegin(), expected.rend(), 0);
  EXPECT_THAT(order.permutation.new_to_old(), testing::ElementsAreArray(expected));
}

TEST_F(Registry, RefusesResultsOfAnotherSize) {
  const Registration vertices = register_vertex_method(
      {.name = "short"}, [](const VertexProblem&, const OrderOptions&) { return Permutation::identity(3); });
  const Registration elements = register_element_method(
      {.name = "short"}, [](const ElementProblem&, const OrderOptions&) { return Permutation(); });
  EXPECT_EQ(refusal([&] { (void)order_vertices(view_, "short"); }),
            "the registered order 'short' returned 3 places for 20");
  const std::vector<int> cell{0, 1, 2};
  EXPECT_EQ(refusal([&] {
              (void)order_elements(CellsView::uniform(Shape::triangle, 3, cell), Permutation::identity(3),
                                   "short");
            }),
            "the registered order 'short' returned 0 places for 1");
}

TEST_F(Registry, LetsExceptionsOfMethodsThrough) {
  struct Odd {
    int number;
  };
  const Registration odd = register_vertex_method(
      {.name = "odd"}, [](const VertexProblem&, const OrderOptions&) -> Permutation { throw Odd{5}; });
  const Registration no_bijection =
      register_element_method({.name = "twice"}, [](const ElementProblem&, const OrderOptions&) {
        return Permutation::from_new_to_old({0, 0});
      });
  try {
    (void)order_vertices(view_, "odd");
    FAIL() << "nothing thrown";
  } catch (const Odd& exception) {
    EXPECT_EQ(exception.number, 5);
  }
  const std::vector<int> cells{0, 1, 1, 2};
  EXPECT_EQ(refusal([&] {
              (void)order_elements(CellsView::uniform(Shape::line, 2, cells), Permutation::identity(3),
                                   "twice");
            }),
            "permutation: entries 0 and 1 are both 0");
}

TEST_F(Registry, LetsMethodsCallTheLibrary) {
  const Registration registration = register_vertex_method(
      {.name = "reversed-rcm"}, [](const VertexProblem& problem, const OrderOptions& options) {
        const GraphView graph{problem.offsets, problem.neighbours};
        return order_vertices(graph, "rcm", options).permutation.then(reversed(problem.offsets.size() - 1));
      });
  const Permutation rcm = order_vertices(view_, "rcm").permutation;
  for (const int threads : {1, 2}) {
    EXPECT_EQ(order_vertices(view_, "reversed-rcm", {.run = {.threads = threads}}).permutation,
              rcm.then(reversed(20)));
  }
}

TEST_F(Registry, AsksForThePointsThatAMethodNeeds) {
  const Registration vertices =
      register_vertex_method({.name = "pointed", .needs_points = true}, reversed_vertices);
  const Registration elements =
      register_element_method({.name = "pointed", .needs_points = true}, reversed_elements);
  EXPECT_EQ(refusal([&] { (void)order_vertices(view_, "pointed"); }),
            "order 'pointed' needs the coordinates of all 20 vertices (points), got none");
  const std::vector<Point> points(20);
  EXPECT_EQ(order_vertices(view_, "pointed", {}, points).permutation, reversed(20));
  const std::vector<int> cell{0, 1, 2};
  const CellsView cells = CellsView::uniform(Shape::triangle, 3, cell);
  const Permutation three = Permutation::identity(3);
  EXPECT_THAT(refusal([&] { (void)order_elements(cells, three, "pointed"); }),
              HasSubstr("coordinates of all 3"));
  const std::vector<Point> three_points(3);
  EXPECT_EQ(order_elements(cells, three, "pointed", {}, three_points).permutation.size(), 1);
}

TEST_F(Registry, RefusesNamesThatAreTakenOrFaultyAndNoMethod) {
  const auto refused = [](const std::string& name) {
    return refusal(
        [&] { const Registration none = register_vertex_method({.name = name}, reversed_vertices); });
  };
  for (const char* name : {"auto", "rcm", "original"})
    EXPECT_THAT(refused(name), HasSubstr("the name is taken"));
  for (const char* name : {"", "My", "a b", "a.b", "é"}) {
    EXPECT_THAT(refused(name), HasSubstr("lower case letters")) << name;
  }
  const Registration first = register_vertex_method({.name = "mine"}, reversed_vertices);
  EXPECT_THAT(refused("mine"), HasSubstr("the name is taken"));
  EXPECT_THAT(refusal([] { const Registration none = register_vertex_method({.name = "none"}, {}); }),
              HasSubstr("empty"));
  EXPECT_THAT(refusal([] {
                const Registration none = register_element_method({.name = "lexmax"}, reversed_elements);
              }),
              HasSubstr("the name is taken"));
  EXPECT_NO_THROW(const Registration other = register_element_method({.name = "mine"}, reversed_elements));
}

TEST_F(Registry, MovesRegistrations) {
  Registration first = register_vertex_method({.name = "first"}, reversed_vertices);
  Registration second = register_vertex_method({.name = "second"}, reversed_vertices);
  first = std::move(second);
  EXPECT_FALSE(find(vertex_methods(), "first").has_value());
  EXPECT_TRUE(find(vertex_methods(), "second").has_value());
  const Registration third = std::move(first);
  EXPECT_TRUE(find(vertex_methods(), "second").has_value());
}

TEST_F(Registry, TakesMethodsOutWhileTheyRun) {
  Registration registration;
  registration =
      register_vertex_method({.name = "brief"}, [&](const VertexProblem& problem, const OrderOptions&) {
        registration = {};
        return reversed(problem.offsets.size() - 1);
      });
  EXPECT_EQ(order_vertices(view_, "brief").permutation, reversed(20));
  EXPECT_FALSE(find(vertex_methods(), "brief").has_value());
}

TEST_F(Registry, TakesOutMethodsThatOwnAnother) {
  auto inner = std::make_shared<Registration>(register_vertex_method({.name = "inner"}, reversed_vertices));
  {
    const Registration outer = register_vertex_method(
        {.name = "outer"},
        [inner = std::move(inner)](const VertexProblem& problem, const OrderOptions& options) {
          return reversed_vertices(problem, options);
        });
    EXPECT_TRUE(find(vertex_methods(), "inner").has_value());
  }
  EXPECT_FALSE(find(vertex_methods(), "inner").has_value());
}

TEST_F(Registry, IsUsedByManyThreadsAtOnce) {
  constexpr int kThreads = 4;
  constexpr int kTurns = 200;
  std::atomic<int> done = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      const std::string name = "of-thread-" + std::to_string(t);
      for (int turn = 0; turn < kTurns; ++turn) {
        const Registration registration = register_vertex_method({.name = name}, reversed_vertices);
        const bool right = find(vertex_methods(), name).has_value() &&
                           order_vertices(view_, name, {.run = {.threads = 1}}).permutation == reversed(20);
        if (right) ++done;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(done, kThreads * kTurns);
}

TEST_F(Registry, KeepsWhatItsOwnerLeavesThere) {
  // in a separate process: such a method cannot be removed again
  const auto keep_and_find = [] {
    {
      Registration registration = register_vertex_method({.name = "kept-method"}, reversed_vertices);
      std::move(registration).keep();
    }
    std::_Exit(find(vertex_methods(), "kept-method") ? 0 : 1);
  };
  EXPECT_EXIT(keep_and_find(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace meshorder
