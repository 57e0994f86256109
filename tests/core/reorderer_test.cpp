// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/reorderer_state.hpp"
#include "support/graph_views.hpp"
#include "support/refusal.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/changing.hpp>
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {
using test::refusal;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// Points in a square, joined to near ones; some are removed and others added. Like a caller, it keeps the
/// points in the order of the last update.
class Cloud {
 public:
  explicit Cloud(std::size_t count, std::uint64_t seed = 1) : random_(seed) {
    for (std::size_t i = 0; i < count; ++i) points_.push_back(anywhere());
  }

  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] const std::vector<Index>& previous() const { return previous_; }

  /// Moves each coordinate of the points by up to `by`.
  void stir(double by) {
    for (Point& point : points_) {
      for (std::size_t axis = 0; axis < 2; ++axis) point[axis] += by * (2 * unit() - 1);
    }
    same();
  }
  /// Removes `count` points, and adds as many at the end.
  void churn(std::size_t count) {
    same();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t gone = random_() % points_.size();
      points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(gone));
      previous_.erase(previous_.begin() + static_cast<std::ptrdiff_t>(gone));
    }
    for (std::size_t i = 0; i < count; ++i) {
      points_.push_back(anywhere());
      previous_.push_back(-1);
    }
  }
  void follow(const Update& update) { update.permutation.move_in_place(std::span(points_)); }

  /// Joins points that are nearer to each other than `reach`.
  [[nodiscard]] CsrGraph graph(double reach = 0.05) const {
    std::vector<Edge> edges;
    for (std::size_t a = 0; a < points_.size(); ++a) {
      for (std::size_t b = a + 1; b < points_.size(); ++b) {
        if (std::hypot(points_[a][0] - points_[b][0], points_[a][1] - points_[b][1]) < reach)
          edges.push_back({static_cast<Index>(a), static_cast<Index>(b)});
      }
    }
    return graph_from_edges(static_cast<Index>(points_.size()), edges);
  }

 private:
  void same() {
    previous_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) previous_[i] = static_cast<Index>(i);
  }
  double unit() { return static_cast<double>(random_() % (1U << 24U)) / (1U << 24U); }
  Point anywhere() { return {unit(), unit(), 0}; }

  std::mt19937_64 random_;
  std::vector<Point> points_;
  std::vector<Index> previous_;
};

Update updated(Reorderer& reorderer, Cloud& cloud) {
  const CsrGraph graph = cloud.graph();
  Update update = reorderer.update(test::view_of(graph), cloud.points(), cloud.previous());
  cloud.follow(update);
  return update;
}

TEST(Reorderer, OrdersFirstAndMovesNothingWhileNothingChanges) {
  Cloud cloud(800);
  Reorderer reorderer({.method = "hilbert"});
  const Update first = updated(reorderer, cloud);
  EXPECT_EQ(first.repair, Repair::fresh);
  EXPECT_EQ(first.added, 800);
  EXPECT_GT(first.span_log2, 0);
  EXPECT_EQ(first.span_log2, first.fresh_span_log2);
  for (int i = 0; i < 9; ++i) {
    const CsrGraph graph = cloud.graph();
    const Update next = reorderer.update(test::view_of(graph), cloud.points());
    EXPECT_EQ(next.repair, Repair::none);
    EXPECT_TRUE(next.permutation.is_identity());
    EXPECT_EQ(next.span_log2, first.span_log2);
    EXPECT_EQ(next.added + next.removed, 0);
    EXPECT_THAT(next.reason, HasSubstr("as close as in the last fresh order"));
  }
}

TEST(Reorderer, SpeaksOfPlacesOnTheCurveWhereOnlyPointsAreKnown) {
  Cloud cloud(800);
  Reorderer reorderer({.method = "hilbert", .slack = 0.1});
  cloud.follow(reorderer.update(PointsView(cloud.points())));
  EXPECT_EQ(reorderer.update(PointsView(cloud.points())).reason,
            "points are as close to their places on the curve as in the last fresh order");
  cloud.stir(0.5);
  EXPECT_THAT(reorderer.update(PointsView(cloud.points())).reason,
              StartsWith("points are too far from their places on the curve: the mean log2 distance is "));
}

TEST(Reorderer, LooksForABetterOrderLessAndLessOftenWhereThereIsNone) {
  Cloud cloud(400);
  Reorderer reorderer({.method = "hilbert"});
  (void)updated(reorderer, cloud);
  std::vector<int> looks;
  for (int i = 1; i <= 80; ++i) {
    cloud.stir(0);
    if (updated(reorderer, cloud).reason.find("updates have passed") != std::string::npos) looks.push_back(i);
  }
  EXPECT_THAT(looks, testing::ElementsAre(10, 30, 70));
}

TEST(Reorderer, OrdersAnewWhenNeighboursHaveComeApart) {
  Cloud cloud(800);
  Reorderer reorderer({.method = "hilbert", .slack = 0.05});
  (void)updated(reorderer, cloud);
  int renewals = 0;
  for (int i = 0; i < 30; ++i) {
    cloud.stir(0.008);
    const Update update = updated(reorderer, cloud);
    EXPECT_LE(update.span_log2, 1.05 * update.fresh_span_log2) << i;
    renewals += update.repair == Repair::fresh ? 1 : 0;
  }
  EXPECT_GE(renewals, 3);
  EXPECT_LT(renewals, 30);
}

TEST(Reorderer, CarriesTheOrderAndPutsNewVerticesNextToTheirNeighbours) {
  Cloud cloud(800);
  Reorderer reorderer({.method = "hilbert", .slack = 10});
  const double fresh = updated(reorderer, cloud).span_log2;
  double last = 0;
  for (int i = 0; i < 9; ++i) {
    cloud.churn(16);
    const Update update = updated(reorderer, cloud);
    EXPECT_EQ(update.repair, Repair::carried);
    EXPECT_EQ(update.added, 16);
    EXPECT_EQ(update.removed, 16);
    last = update.span_log2;
  }
  EXPECT_LT(last, 1.1 * fresh) << "of the points 144 are new";
}

TEST(Reorderer, OfAMeshIsThatOfItsGraph) {
  const Mesh bar = test::tetrahedral_bar(120);
  std::vector<std::array<Index, 4>> cells;
  for (Index c = 0; c < bar.cells.size(); ++c) {
    const auto cell = bar.cells[c];
    if (cell.size() == 4) cells.push_back({cell[0], cell[1], cell[2], cell[3]});
  }
  const MeshView mesh{bar.points, CellsView::uniform(Shape::tetrahedron, 4, cells)};
  const Graph graph = vertex_graph(mesh.cells, bar.points.size());
  for (const char* const method : {"auto", "hilbert", "rcm", "fiedler", "hilbert-fronts"}) {
    Reorderer of_mesh({.method = method});
    Reorderer of_graph({.method = method});
    EXPECT_EQ(of_mesh.update(mesh).permutation, of_graph.update(graph, bar.points).permutation) << method;
  }
}

TEST(Reorderer, PutsNewVerticesOfAMeshBetweenThoseOfTheirCells) {
  // a strip of triangles; then vertex 12 is added, in a triangle with 4 and 5
  std::vector<std::array<Index, 3>> triangles;
  for (Index v = 0; v + 2 < 12; ++v) triangles.push_back({v, v + 1, v + 2});
  Reorderer reorderer({.method = "rcm"});
  const Update first = reorderer.update(MeshView{{}, CellsView::uniform(Shape::triangle, 3, triangles), 12});
  first.permutation.renumber(triangles);
  triangles.push_back({4, 5, 12});
  std::vector<Index> previous(13, -1);
  for (Index v = 0; v < 12; ++v) previous[v] = v;
  const Update next =
      reorderer.update(MeshView{{}, CellsView::uniform(Shape::triangle, 3, triangles), 13}, previous);
  EXPECT_EQ(next.repair, Repair::carried);
  EXPECT_EQ(next.permutation.old_to_new()[12], 5) << "after the first of its two neighbours";
}

/// The edges of the cloud's graph as cells.
std::vector<std::array<Index, 2>> lines_of(const Cloud& cloud) {
  const CsrGraph graph = cloud.graph(0.1);
  std::vector<std::array<Index, 2>> lines;
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) {
      if (u < v) lines.push_back({u, v});
    }
  }
  return lines;
}

Update updated_cells(Reorderer& reorderer, Cloud& cloud, const std::vector<std::array<Index, 2>>& lines) {
  Update update =
      reorderer.update(MeshView{cloud.points(), CellsView::uniform(Shape::line, 2, lines)}, cloud.previous());
  cloud.follow(update);
  return update;
}

TEST(Reorderer, SortsThePointsOfCellsAnewWhereVerticesComeAndGo) {
  for (const char* const method : {"hilbert", "morton"}) {
    Cloud cloud(800);
    Reorderer reorderer({.method = method, .slack = 10});
    for (int i = 0; i < 8; ++i) {
      const Permutation sorted = Reorderer({.method = method}).update(PointsView(cloud.points())).permutation;
      const Update update = updated_cells(reorderer, cloud, lines_of(cloud));
      EXPECT_EQ(update.repair, Repair::fresh) << update.reason;
      EXPECT_EQ(update.permutation, sorted) << method;
      cloud.churn(40);
    }
  }
}

TEST(Reorderer, PutsVerticesWithoutACellLastInOrdersAlongACurve) {
  const Cloud cloud(800);
  std::vector<std::array<Index, 2>> lines = lines_of(cloud);
  std::erase_if(lines, [](const auto& line) { return line[0] < 5 || line[1] > 790; });
  const MeshView mesh{cloud.points(), CellsView::uniform(Shape::line, 2, lines)};
  EXPECT_EQ(Reorderer({.method = "hilbert"}).update(mesh).permutation,
            order_mesh(mesh, {"hilbert", "original"}).vertices.permutation);
}

TEST(Reorderer, KeepsParticlesAlongTheCurve) {
  Cloud cloud(5000);
  Reorderer reorderer;
  const auto updated_points = [&] {
    Update update = reorderer.update(cloud.points(), cloud.previous());
    cloud.follow(update);
    return update;
  };
  const Update first = updated_points();
  EXPECT_EQ(first.repair, Repair::fresh);
  EXPECT_NEAR(first.span_log2, 0, 1e-12);
  int renewals = 0;
  for (int i = 0; i < 20; ++i) {
    cloud.stir(0.002);
    const Update update = updated_points();
    renewals += update.repair == Repair::fresh ? 1 : 0;
    EXPECT_LT(update.span_log2, 0.02 * std::log2(5001) + 1e-9);
  }
  EXPECT_GT(renewals, 0);
  EXPECT_THAT(refusal([&] { (void)Reorderer({.method = "rcm"}).update(cloud.points()); }),
              HasSubstr("'rcm' needs a graph or cells"));
}

TEST(Reorderer, RenewsFiedlerOrdersFromTheLastVector) {
  Cloud cloud(2500);
  Reorderer reorderer({.method = "fiedler", .slack = 0.01});
  EXPECT_EQ(updated(reorderer, cloud).repair, Repair::fresh);
  std::vector<Repair> repairs;
  for (int i = 0; i < 12; ++i) {
    cloud.stir(0.01);
    const CsrGraph graph = cloud.graph();
    const Update update = reorderer.update(test::view_of(graph), cloud.points(), cloud.previous());
    const Order fresh = order_vertices(test::view_of(graph), "fiedler");
    cloud.follow(update);
    repairs.push_back(update.repair);
    if (update.repair != Repair::warm) continue;
    EXPECT_LT(quality(test::view_of(graph), update.permutation).mean_log2_span,
              1.03 * quality(test::view_of(graph), fresh.permutation).mean_log2_span);
  }
  EXPECT_THAT(repairs, testing::Contains(Repair::warm));
  EXPECT_THAT(repairs, testing::Not(testing::Contains(Repair::fresh)));
}

/// Whether the stored start vector is sorted along the arrays, as after a Fiedler order.
bool vector_is_sorted(const Reorderer& reorderer) {
  const std::vector<double> vector = reorderer_state(reorderer.state()).vector;
  return !vector.empty() &&
         (std::ranges::is_sorted(vector) || std::ranges::is_sorted(vector, std::ranges::greater()));
}

TEST(Reorderer, KeepsTheFiedlerVectorByThePlacesOfTheArrays) {
  const CsrGraph sheet = test::grid(30, 20);
  CsrGraph graph = renumbered(sheet, test::shuffled(sheet.size(), 1).old_to_new());
  Reorderer reorderer({.method = "fiedler", .slack = 100});
  const auto update = [&](const std::vector<Index>& previous) {
    const Update made = reorderer.update(test::view_of(graph), {}, previous);
    graph = renumbered(graph, made.permutation.old_to_new());
    return made.repair;
  };
  EXPECT_EQ(update({}), Repair::fresh);
  EXPECT_TRUE(vector_is_sorted(reorderer));
  // the caller passes the arrays in another order
  const Permutation moved = test::shuffled(sheet.size(), 2);
  graph = renumbered(graph, moved.old_to_new());
  EXPECT_EQ(update({moved.new_to_old().begin(), moved.new_to_old().end()}), Repair::carried);
  EXPECT_TRUE(vector_is_sorted(reorderer));
  EXPECT_EQ(update({}), Repair::none);
  EXPECT_TRUE(vector_is_sorted(reorderer));
}

TEST(Reorderer, LeavesALatticeAsItIs) {
  const CsrGraph lattice = test::grid(20, 20, 20);
  Reorderer reorderer;
  const Update first = reorderer.update(test::view_of(lattice));
  EXPECT_EQ(first.repair, Repair::none);
  EXPECT_THAT(first.reason, HasSubstr("already reads memory forward"));
  for (int i = 0; i < 25; ++i) EXPECT_EQ(reorderer.update(test::view_of(lattice)).repair, Repair::none);
}

TEST(Reorderer, LeavesANumberingThatIsReadForwardUntilItIsNot) {
  // a lattice without a third of its edges: its vertices have different numbers of neighbours
  const CsrGraph lattice = test::grid(40, 40, 40);
  std::mt19937_64 random(5);
  std::vector<Edge> edges;
  for (Index v = 0; v < lattice.size(); ++v) {
    for (const Index u : lattice[v]) {
      if (u < v && random() % 3 > 0) edges.push_back({u, v});
    }
  }
  CsrGraph graph = graph_from_edges(lattice.size(), edges);
  Reorderer reorderer;
  for (int i = 0; i < 25; ++i) {
    const Update update = reorderer.update(test::view_of(graph));
    EXPECT_EQ(update.repair, Repair::none) << update.reason;
    EXPECT_THAT(update.reason, i == 0 ? HasSubstr("already reads memory forward") : HasSubstr(""));
  }
  // then the vertices are numbered at random
  std::vector<Index> places(static_cast<std::size_t>(graph.size()));
  std::iota(places.begin(), places.end(), Index{0});
  std::shuffle(places.begin(), places.end(), random);
  for (auto& [u, v] : edges) {
    u = places[u];
    v = places[v];
  }
  graph = graph_from_edges(lattice.size(), edges);
  EXPECT_EQ(reorderer.update(test::view_of(graph)).repair, Repair::fresh);
}

TEST(Reorderer, GivesTheSameOnAnyNumberOfThreads) {
  for (const char* const method : {"auto", "hilbert", "fiedler", "spectral", "bfs"}) {
    std::vector<Permutation> permutations;
    for (const int threads : {1, 3}) {
      Cloud cloud(500, 7);
      Reorderer reorderer({.method = method, .order = {.run = {.threads = threads}}});
      for (int i = 0; i < 15; ++i) {
        permutations.push_back(updated(reorderer, cloud).permutation);
        i % 3 == 2 ? cloud.churn(20) : cloud.stir(0.02);
      }
    }
    EXPECT_TRUE(std::equal(permutations.begin(), permutations.begin() + 15, permutations.begin() + 15))
        << method;
  }
}

TEST(Reorderer, GoesOnFromAState) {
  for (const char* const method : {"hilbert", "fiedler"}) {
    Cloud cloud(500, 3);
    Reorderer reorderer({.method = method});
    for (int i = 0; i < 7; ++i) {
      (void)updated(reorderer, cloud);
      cloud.stir(0.02);
    }
    Cloud other = cloud;
    Reorderer restored({.method = method});
    restored.restore(reorderer.state());
    for (int i = 0; i < 12; ++i) {
      EXPECT_EQ(updated(reorderer, cloud).permutation, updated(restored, other).permutation) << method;
      cloud.churn(10);
      other.churn(10);
    }
  }
}

TEST(Reorderer, RefusesStatesThatAreNotWholeOrOfAnotherMethod) {
  Cloud cloud(300);
  Reorderer reorderer({.method = "fiedler"});
  (void)updated(reorderer, cloud);
  const std::vector<std::byte> state = reorderer.state();
  Reorderer other({.method = "fiedler"});
  const std::vector<std::byte> before = other.state();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{7}, std::size_t{20}, state.size() / 2, state.size() - 1})
    EXPECT_THROW(other.restore(std::span(state).first(size)), InvalidArgument) << size;
  for (const std::size_t at : {std::size_t{1}, std::size_t{12}, state.size() / 3, state.size() - 2}) {
    std::vector<std::byte> damaged = state;
    damaged[at] ^= std::byte{1};
    EXPECT_THROW(other.restore(damaged), InvalidArgument) << at;
  }
  EXPECT_EQ(refusal([&] { Reorderer({.method = "rcm"}).restore(state); }),
            "state: it is of the method 'fiedler', not 'rcm'");
  EXPECT_EQ(other.state(), before) << "unchanged";
  other.restore(state);
  EXPECT_EQ(other.state(), state);
}

TEST(Reorderer, RefusesStatesWithNumbersThatItNeverWrites) {
  const auto taken = [](auto change) {
    ReordererState state;
    state.begun = 1;
    state.count = 3;
    state.method = "auto\nbfs";
    change(state);
    Reorderer reorderer;
    return refusal([&] { reorderer.restore(to_bytes(state)); });
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(taken([](ReordererState&) {}), "");
  EXPECT_NE(taken([](ReordererState& s) { s.begun = 2; }), "");
  EXPECT_NE(taken([](ReordererState& s) { s.count = -1; }), "");
  EXPECT_NE(taken([](ReordererState& s) { s.since = -1; }), "");
  EXPECT_NE(taken([](ReordererState& s) { s.since = kMaxIndex; }), "");
  EXPECT_NE(taken([](ReordererState& s) { s.interval = 0; }), "");
  EXPECT_NE(taken([](ReordererState& s) { s.interval = kMaxIndex; }), "");
  EXPECT_NE(taken([](ReordererState& s) { s.fresh_span = kNan; }), "");
  EXPECT_NE(taken([](ReordererState& s) { s.warm_seconds = -1; }), "");
  EXPECT_NE(taken([](ReordererState& s) { s.observed.kt = kNan; }), "");
}

TEST(Reorderer, RefusesWhatDoesNotFitAndStaysAsItWas) {
  Cloud cloud(300);
  Reorderer reorderer({.method = "hilbert"});
  (void)updated(reorderer, cloud);
  const CsrGraph graph = cloud.graph();
  const std::vector<std::byte> before = reorderer.state();
  const auto refused = [&](const std::vector<Index>& previous) {
    return refusal([&] { (void)reorderer.update(test::view_of(graph), cloud.points(), previous); });
  };
  EXPECT_THAT(refused({0, 1}), HasSubstr("previous: 2 entries for 300 vertices"));
  EXPECT_THAT(refused(std::vector<Index>(300, 5)), HasSubstr("entries 0 and 1 are both 5"));
  std::vector<Point> wild = cloud.points();
  wild[17][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal([&] { (void)reorderer.update(test::view_of(graph), wild); }),
              HasSubstr("point 17 is not finite"));
  EXPECT_THROW(reorderer.observe(-1), InvalidArgument);
  EXPECT_THROW(reorderer.observe(std::numeric_limits<double>::infinity()), InvalidArgument);
  EXPECT_EQ(reorderer.state(), before);
  EXPECT_THAT(refusal([] { Reorderer({.method = "hilbrt"}); }), HasSubstr("did you mean 'hilbert'?"));
  EXPECT_THROW(Reorderer({.slack = -0.1}), InvalidArgument);
  EXPECT_THROW(Reorderer({.slack = std::numeric_limits<double>::quiet_NaN()}), InvalidArgument);
  EXPECT_THROW(Reorderer({.budget_seconds = -1}), InvalidArgument);
  const std::vector<int> groups(300);
  EXPECT_THROW(Reorderer({.order = {.groups = groups}}), InvalidArgument);
}

TEST(Reorderer, TakesMeshesThatVanishAndComeBack) {
  Reorderer reorderer({.method = "bfs"});
  EXPECT_EQ(reorderer.update(GraphView{}).permutation.size(), 0);
  const CsrGraph path = test::path(5);
  EXPECT_EQ(reorderer.update(test::view_of(path), {}, std::vector<Index>(5, -1)).repair, Repair::none);
  EXPECT_EQ(reorderer.update(GraphView{}, {}, std::vector<Index>{}).removed, 5);
  const CsrGraph apart = test::disjoint_union({test::path(1), test::path(4), test::path(1)});
  EXPECT_EQ(reorderer.update(test::view_of(apart), {}, std::vector<Index>(6, -1)).permutation.size(), 6);
  EXPECT_EQ(reorderer.update(GraphView{}, {}, std::vector<Index>{}).removed, 6);
  const Update again = reorderer.update(test::view_of(path));
  EXPECT_EQ(again.added, 5);
  EXPECT_EQ(again.reason, "this is the first order");
}

TEST(Reorderer, KeepsTheCarriedOrderWhereTheBudgetAllowsNoOther) {
  Cloud cloud(400);
  Reorderer reorderer({.method = "hilbert", .slack = 0, .budget_seconds = 0});
  EXPECT_EQ(updated(reorderer, cloud).repair, Repair::fresh) << "the first one is always made";
  cloud.stir(0.1);
  const Update update = updated(reorderer, cloud);
  EXPECT_EQ(update.repair, Repair::none);
  EXPECT_FALSE(update.complete);
  EXPECT_THAT(update.reason, HasSubstr("more than the budget"));
}

TEST(Reorderer, FindsTheNeighboursOfNewVerticesWhereTheBudgetAllowsNoSort) {
  Cloud cloud(800);
  Reorderer reorderer({.method = "hilbert", .budget_seconds = 0});
  (void)updated_cells(reorderer, cloud, lines_of(cloud));
  cloud.churn(1);
  EXPECT_LT(updated_cells(reorderer, cloud, {{3, 799}}).permutation.old_to_new()[799], 10);
}

TEST(Reorderer, RenewsSoonerWhereStepsGrowSlower) {
  const auto updates_until_a_renewal = [](double slope) {
    Cloud cloud(400);
    Reorderer reorderer({.method = "hilbert", .slack = 100});
    (void)updated(reorderer, cloud);
    for (int i = 1; i < 10; ++i) {
      reorderer.observe(1 + slope * i);
      cloud.stir(0);
      if (updated(reorderer, cloud).reason.find("have passed") != std::string::npos) return i;
    }
    return 10;
  };
  EXPECT_EQ(updates_until_a_renewal(0), 10);
  EXPECT_LE(updates_until_a_renewal(1), 6) << "five steps tell a slope";
}

}  // namespace
}  // namespace meshorder
