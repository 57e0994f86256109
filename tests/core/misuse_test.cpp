// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Calls every entry point of the library with every kind of wrong array. Each call must throw an Error and
// read or write nothing outside the arrays. These have exactly the lengths given to the call:
// AddressSanitizer finds any access beyond.
#include <meshorder/error.hpp>
#include <meshorder/fiedler.hpp>
#include <meshorder/order.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/quality.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr Offset kHuge = std::numeric_limits<Offset>::max();

using Numbers = std::vector<std::int64_t>;

/// A call and what is wrong with it.
struct Misuse {
  std::string what;
  std::function<void()> call;
};

/// EXPECTs that each call throws an Error with a message.
void expect_refused(const std::vector<Misuse>& misuses) {
  for (const Misuse& misuse : misuses) {
    SCOPED_TRACE(misuse.what);
    try {
      misuse.call();
      ADD_FAILURE() << "was not refused";
    } catch (const Error& error) {
      EXPECT_NE(error.code(), Code::internal);
      EXPECT_GT(std::string(error.what()).size(), 10U);
    }
  }
}

/// A cycle of four vertices; each test breaks one part of it.
struct Square {
  Numbers offsets{0, 2, 4, 6, 8};
  Numbers neighbours{1, 3, 0, 2, 1, 3, 0, 2};
  std::vector<double> weights = {};
  int base = 0;

  [[nodiscard]] GraphView view() const { return {offsets, neighbours, weights, base}; }
};

/// Graphs that every function refuses.
std::vector<std::pair<std::string, Square>> wrong_graphs() {
  const auto broken = [](const std::function<void(Square&)>& change) {
    Square square;
    change(square);
    return square;
  };
  return {
      {"offsets too short", broken([](Square& g) { g.offsets.pop_back(); })},
      {"offsets too long", broken([](Square& g) { g.offsets.push_back(9); })},
      {"no offsets", broken([](Square& g) { g.offsets.clear(); })},
      {"one offset", broken([](Square& g) { g.offsets.resize(1); })},
      {"decreasing offsets", broken([](Square& g) { g.offsets[2] = 1; })},
      {"an offset below 0", broken([](Square& g) { g.offsets[1] = -1; })},
      {"an offset beyond the neighbours", broken([](Square& g) { g.offsets[1] = 9; })},
      {"a huge offset", broken([](Square& g) { g.offsets[2] = kHuge; })},
      {"a huge last offset", broken([](Square& g) { g.offsets[4] = kHuge; })},
      {"the least last offset", broken([](Square& g) { g.offsets[4] = std::numeric_limits<Offset>::min(); })},
      {"a first offset other than the base", broken([](Square& g) { g.offsets[0] = 1; })},
      {"neighbours too short", broken([](Square& g) { g.neighbours.pop_back(); })},
      {"neighbours too long", broken([](Square& g) { g.neighbours.push_back(0); })},
      {"no neighbours", broken([](Square& g) { g.neighbours.clear(); })},
      {"a neighbour below 0", broken([](Square& g) { g.neighbours[3] = -1; })},
      {"a neighbour beyond", broken([](Square& g) { g.neighbours[3] = 4; })},
      {"a huge neighbour", broken([](Square& g) { g.neighbours[3] = kHuge; })},
      {"a neighbour that fits when cut to 32 bits",
       broken([](Square& g) { g.neighbours[3] += std::int64_t{1} << 32; })},
      {"numbers from 1 with base 0", broken([](Square& g) {
         for (std::int64_t& v : g.neighbours) ++v;
       })},
      {"numbers from 0 with base 1", broken([](Square& g) { g.base = 1; })},
      {"a base of 2", broken([](Square& g) { g.base = 2; })},
      {"a base of -1", broken([](Square& g) { g.base = -1; })},
      {"weights too short", broken([](Square& g) { g.weights.assign(7, 1.0); })},
      {"weights too long", broken([](Square& g) { g.weights.assign(9, 1.0); })},
      {"a weight of 0", broken([](Square& g) { g.weights = {1, 1, 1, 1, 1, 0, 1, 1}; })},
      {"a negative weight", broken([](Square& g) { g.weights = {1, 1, 1, 1, 1, -1, 1, 1}; })},
      {"a weight that is NaN", broken([](Square& g) { g.weights = {1, 1, 1, 1, 1, kNotANumber, 1, 1}; })},
      {"an infinite weight", broken([](Square& g) { g.weights = {1, 1, 1, 1, 1, kInfinite, 1, 1}; })},
      {"different weights of one edge", broken([](Square& g) { g.weights = {1, 1, 1, 1, 1, 2, 1, 1}; })},
      {"an entry without its counterpart", broken([](Square& g) {
         g.offsets = {0, 1, 3, 5, 7};
         g.neighbours = {1, 0, 2, 1, 3, 0, 2};
       })},
  };
}

/// Functions that take a graph of four vertices.
std::vector<std::pair<std::string, std::function<void(const GraphView&)>>> takers_of_graphs() {
  static const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  static const Permutation four = Permutation::identity(4);
  std::vector<std::pair<std::string, std::function<void(const GraphView&)>>> takers{
      {"check", [](const GraphView& g) { check(g); }},
      {"cleaned", [](const GraphView& g) { (void)cleaned(g, Symmetry::require); }},
      {"fiedler_vector", [](const GraphView& g) { (void)fiedler_vector(g); }},
      {"quality", [](const GraphView& g) { (void)quality(g); }},
      {"quality of an order", [](const GraphView& g) { (void)quality(g, four); }},
      {"span_histogram", [](const GraphView& g) { (void)span_histogram(g, four, 1); }},
      {"sparsity_pattern", [](const GraphView& g) { (void)sparsity_pattern(g, four, 2); }},
  };
  for (const std::string method :
       {"original", "scrambled", "bfs", "rcm", "hilbert", "morton", "fiedler", "spectral", "minla", "auto"}) {
    takers.emplace_back("order_vertices by " + method,
                        [method](const GraphView& g) { (void)order_vertices(g, method, {}, points); });
  }
  return takers;
}

TEST(Misuse, OfGraphsIsRefusedByEveryFunction) {
  std::vector<Misuse> misuses;
  const auto graphs = wrong_graphs();
  for (const auto& [function, take] : takers_of_graphs()) {
    ASSERT_NO_THROW(take(Square().view())) << function;
    for (const auto& [what, graph] : graphs)
      misuses.push_back({function + ": " + what, [take = take, graph = graph] { take(graph.view()); }});
  }
  expect_refused(misuses);
}

TEST(Misuse, OfMatricesToBeMovedIsRefused) {
  const Permutation four = Permutation::identity(4);
  std::vector<Misuse> misuses;
  for (const auto& [what, graph] : wrong_graphs()) {
    // these functions ignore weights, and patterns need not be symmetric
    if (!graph.weights.empty() || what == "an entry without its counterpart") continue;
    misuses.push_back(
        {"csr_entry_map: " + what, [&four, graph = graph] { (void)four.csr_entry_map(graph.view()); }});
    misuses.push_back({"move_csr: " + what, [&four, graph = graph] {
                         Numbers offsets(graph.offsets.size()), columns(graph.neighbours.size());
                         four.move_csr(graph.view(), {}, offsets, columns, {});
                       }});
  }
  const Square square;
  const auto move = [&](std::size_t offsets, std::size_t columns, std::size_t values, std::size_t moved) {
    Numbers new_offsets(offsets), new_columns(columns);
    const std::vector<std::byte> from(values);
    std::vector<std::byte> to(moved);
    four.move_csr(square.view(), from, new_offsets, new_columns, to);
  };
  ASSERT_NO_THROW(move(5, 8, 16, 16));
  misuses.push_back({"move_csr: room for too few offsets", [&] { move(4, 8, 16, 16); }});
  misuses.push_back({"move_csr: room for too many offsets", [&] { move(6, 8, 16, 16); }});
  misuses.push_back({"move_csr: no room for offsets", [&] { move(0, 8, 16, 16); }});
  misuses.push_back({"move_csr: room for too few columns", [&] { move(5, 7, 16, 16); }});
  misuses.push_back({"move_csr: room for too few values", [&] { move(5, 8, 16, 8); }});
  misuses.push_back({"move_csr: values that do not fit the entries", [&] { move(5, 8, 15, 15); }});
  misuses.push_back({"move_csr: an order of another size", [&] {
                       Numbers offsets(5), columns(8);
                       Permutation::identity(3).move_csr(square.view(), {}, offsets, columns, {});
                     }});
  misuses.push_back({"move_csr: columns into those that are read", [&] {
                       Square own;
                       Numbers offsets(5);
                       four.move_csr(own.view(), {}, offsets, own.neighbours, {});
                     }});
  expect_refused(misuses);
}

TEST(Misuse, OfOptionsIsRefused) {
  const Square square;
  const std::vector<Point> points(4, Point{});
  const auto order = [&](const std::string& method, const OrderOptions& options) {
    return [&square, method, options] { (void)order_vertices(square.view(), method, options); };
  };
  const auto place = [&](const std::string& method, const PointsView& view) {
    return [&square, method, view] { (void)order_vertices(square.view(), method, {}, view); };
  };
  const std::vector<double> three(3, 0.5), five(5, 0.5), with_nan{0, kNotANumber, 0, 1},
      with_infinity{0, kInfinite, 0, 1};
  const Numbers groups(3), more_groups(5);
  const std::vector<Point> few(3), many(5);
  std::vector<Point> nan_points = points;
  nan_points[2][1] = kNotANumber;
  std::vector<Point> infinite_points = points;
  infinite_points[2][1] = -kInfinite;
  expect_refused({
      {"an unknown method", order("best", {})},
      {"no method", order("", {})},
      {"a tolerance of 0", order("fiedler", {.tolerance = 0})},
      {"a tolerance that is NaN", order("fiedler", {.tolerance = kNotANumber})},
      {"no iterations", order("fiedler", {.max_iterations = 0})},
      {"negative threads", order("fiedler", {.run = {.threads = -1}})},
      {"a time limit that is NaN", order("fiedler", {.run = {.time_limit = kNotANumber}})},
      {"start too short", order("fiedler", {.start = three})},
      {"start too long", order("fiedler", {.start = five})},
      {"start with NaN", order("fiedler", {.start = with_nan})},
      {"start with infinity", order("fiedler", {.start = with_infinity})},
      {"start of fiedler_vector too short", [&] { (void)fiedler_vector(square.view(), {.start = three}); }},
      {"groups too short", order("rcm", {.groups = groups})},
      {"groups too long", order("rcm", {.groups = more_groups})},
      {"no points", place("hilbert", {})},
      {"points too short", place("hilbert", few)},
      {"points too long", place("morton", many)},
      {"points that are NaN", place("hilbert", nan_points)},
      {"points that are infinite", place("morton", infinite_points)},
      {"an order too short", [&] { (void)quality(square.view(), Permutation::identity(3)); }},
      {"an order too long", [&] { (void)quality(square.view(), Permutation::identity(5)); }},
      {"an order of nothing", [&] { (void)span_histogram(square.view(), {}, 1); }},
      {"bins of no width", [&] { (void)span_histogram(square.view(), Permutation::identity(4), 0); }},
      {"bins of negative width", [&] { (void)span_histogram(square.view(), Permutation::identity(4), -1); }},
      {"tiles that are none", [&] { (void)sparsity_pattern(square.view(), Permutation::identity(4), 0); }},
      {"an order of another size for tiles",
       [&] { (void)sparsity_pattern(square.view(), Permutation::identity(3), 1); }},
  });
}

/// Two triangles on four vertices.
struct Triangles {
  Numbers offsets{0, 3, 6};
  Numbers vertices{0, 1, 2, 2, 1, 3};
  std::vector<std::uint8_t> types{5, 5};
  int base = 0;

  [[nodiscard]] CellsView view() const { return CellsView::mixed(offsets, vertices, types, base); }
};

std::vector<std::pair<std::string, Triangles>> wrong_cells() {
  const auto broken = [](const std::function<void(Triangles&)>& change) {
    Triangles triangles;
    change(triangles);
    return triangles;
  };
  return {
      {"offsets too short", broken([](Triangles& c) { c.offsets.pop_back(); })},
      {"offsets too long", broken([](Triangles& c) { c.offsets.push_back(7); })},
      {"decreasing offsets", broken([](Triangles& c) {
         c.offsets = {0, 7, 6};
       })},
      {"a negative offset", broken([](Triangles& c) { c.offsets[1] = -3; })},
      {"a huge offset", broken([](Triangles& c) { c.offsets[1] = kHuge; })},
      {"a huge last offset", broken([](Triangles& c) { c.offsets[2] = kHuge; })},
      {"a first offset other than the base", broken([](Triangles& c) { c.offsets[0] = 1; })},
      {"no offsets", broken([](Triangles& c) { c.offsets.clear(); })},
      {"vertices too short", broken([](Triangles& c) { c.vertices.pop_back(); })},
      {"vertices too long", broken([](Triangles& c) { c.vertices.push_back(0); })},
      {"no vertices", broken([](Triangles& c) { c.vertices.clear(); })},
      {"a vertex below 0", broken([](Triangles& c) { c.vertices[4] = -1; })},
      {"a vertex beyond", broken([](Triangles& c) { c.vertices[4] = 4; })},
      {"a huge vertex", broken([](Triangles& c) { c.vertices[4] = kHuge; })},
      {"a vertex that fits when cut to 32 bits",
       broken([](Triangles& c) { c.vertices[4] += std::int64_t{1} << 32; })},
      {"types too short", broken([](Triangles& c) { c.types.pop_back(); })},
      {"types too long", broken([](Triangles& c) { c.types.push_back(5); })},
      {"an unknown type", broken([](Triangles& c) { c.types[1] = 200; })},
      {"a type with more corners", broken([](Triangles& c) { c.types[1] = 10; })},
      {"a cell without vertices", broken([](Triangles& c) {
         c.offsets = {0, 0, 6};
       })},
      {"a base of 2", broken([](Triangles& c) { c.base = 2; })},
      {"numbers from 0 with base 1", broken([](Triangles& c) { c.base = 1; })},
  };
}

TEST(Misuse, OfCellsIsRefusedByEveryFunction) {
  static const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const Permutation four = Permutation::identity(4);
  std::vector<std::pair<std::string, std::function<void(const CellsView&)>>> takers{
      {"vertex_graph", [](const CellsView& c) { (void)vertex_graph(c, 4); }},
      {"dual_graph by facet", [](const CellsView& c) { (void)dual_graph(c, 4); }},
      {"dual_graph by vertex", [](const CellsView& c) { (void)dual_graph(c, 4, false); }},
      {"order_mesh", [](const CellsView& c) { (void)order_mesh({.points = points, .cells = c}); }},
      {"order_mesh without points",
       [](const CellsView& c) { (void)order_mesh({.cells = c, .vertex_count = 4}); }},
  };
  for (const std::string method :
       {"original", "scrambled", "lexmax", "mean", "min", "max", "hilbert", "fiedler", "auto"}) {
    takers.emplace_back("order_elements by " + method, [method, &four](const CellsView& c) {
      (void)order_elements(c, four, method, {}, points);
    });
  }
  std::vector<Misuse> misuses;
  for (const auto& [function, take] : takers) {
    ASSERT_NO_THROW(take(Triangles().view())) << function;
    for (const auto& [what, cells] : wrong_cells())
      misuses.push_back({function + ": " + what, [take = take, cells = cells] { take(cells.view()); }});
  }
  const Triangles right;
  const std::vector<Point> few(3);
  const Numbers groups(1);
  const Numbers five{0, 1, 2, 2, 1};
  misuses.push_back({"order_elements: an order too short",
                     [&] { (void)order_elements(right.view(), Permutation::identity(3), "lexmax"); }});
  misuses.push_back({"order_elements: no order", [&] { (void)order_elements(right.view(), {}, "lexmax"); }});
  misuses.push_back({"order_elements: points too short",
                     [&] { (void)order_elements(right.view(), four, "hilbert", {}, few); }});
  misuses.push_back({"order_elements: groups too short",
                     [&] { (void)order_elements(right.view(), four, "lexmax", {.cell_groups = groups}); }});
  misuses.push_back({"order_mesh: other numbers of points and vertices",
                     [&] { (void)order_mesh({.points = few, .cells = right.view(), .vertex_count = 4}); }});
  misuses.push_back({"vertex_graph: too few vertices", [&] { (void)vertex_graph(right.view(), 3); }});
  misuses.push_back(
      {"vertex_graph: too many vertices", [&] { (void)vertex_graph(right.view(), std::size_t{1} << 40); }});
  misuses.push_back({"uniform cells that are not whole",
                     [&] { (void)vertex_graph(CellsView::uniform(Shape::triangle, 3, five), 4); }});
  misuses.push_back({"uniform cells of no vertices",
                     [&] { (void)vertex_graph(CellsView::uniform(Shape::triangle, 0, five), 4); }});
  misuses.push_back({"uniform cells of a negative size",
                     [&] { (void)vertex_graph(CellsView::uniform(Shape::triangle, -3, five), 4); }});
  misuses.push_back({"uniform cells of a huge size", [&] {
                       (void)vertex_graph(
                           CellsView::uniform(Shape::triangle, std::numeric_limits<int>::max(), five), 4);
                     }});
  misuses.push_back({"uniform cells of an unknown shape",
                     [&] { (void)vertex_graph(CellsView::uniform(static_cast<Shape>(99), 5, five), 4); }});
  misuses.push_back({"uniform cells with fewer vertices than corners",
                     [&] { (void)vertex_graph(CellsView::uniform(Shape::hexahedron, 5, five), 4); }});
  expect_refused(misuses);
}

TEST(Misuse, OfMapsIsRefused) {
  const auto map = [](Numbers numbers) {
    return std::vector<Misuse>{
        {"from_old_to_new", [numbers] { (void)Permutation::from_old_to_new(IndexView(numbers)); }},
        {"from_new_to_old", [numbers] { (void)Permutation::from_new_to_old(IndexView(numbers)); }}};
  };
  for (const Numbers& wrong :
       {Numbers{0, 0}, Numbers{0, 2}, Numbers{-1, 0}, Numbers{1}, Numbers{0, kHuge}, Numbers{0, 1, 2, 1},
        Numbers{std::numeric_limits<std::int64_t>::min(), 0}, Numbers{0, (std::int64_t{1} << 32) + 1}}) {
    expect_refused(map(wrong));
  }
  const Permutation three = Permutation::from_old_to_new({2, 0, 1});
  std::vector<int> two(2), values(3), target(3), six(6);
  Numbers numbers{0, 1, 3};
  expect_refused({
      {"identity of a negative size", [] { (void)Permutation::identity(-1); }},
      {"then: another size", [&] { (void)three.then(Permutation::identity(2)); }},
      {"repeated: none", [&] { (void)three.repeated(0); }},
      {"repeated: negative", [&] { (void)three.repeated(-1); }},
      {"repeated: too many", [&] { (void)three.repeated(std::numeric_limits<Index>::max()); }},
      {"move: from too short", [&] { three.move(two, target); }},
      {"move: to too short", [&] { three.move(values, two); }},
      {"move: a width that does not fit", [&] { three.move(six, six, 1); }},
      {"move: a width of 0", [&] { three.move(values, target, 0); }},
      {"move: a huge width", [&] { three.move(values, target, std::numeric_limits<std::size_t>::max()); }},
      {"move: onto itself", [&] { three.move(values, values); }},
      {"move: overlapping", [&] { three.move(std::span(six).first(3), std::span(six).subspan(1, 3)); }},
      {"move_in_place: too short", [&] { three.move_in_place(two); }},
      {"move_in_place: a width that does not fit", [&] { three.move_in_place(values, 2); }},
      {"move_rows: from is null", [&] { three.move_rows(nullptr, 4, target.data(), 4, 4); }},
      {"move_rows: to is null", [&] { three.move_rows(values.data(), 4, nullptr, 4, 4); }},
      {"renumber: a number beyond", [&] { three.renumber(numbers); }},
      {"renumber: a base of 2", [&] { three.renumber(values, 2); }},
      {"renumber: a base of -1", [&] { three.renumber(values, -1); }},
      {"renumber: numbers from 0 with base 1", [&] { three.renumber(values, 1); }},
  });
  EXPECT_EQ(numbers, (Numbers{0, 1, 3}));
}

TEST(Misuse, OfArraysWithoutDataIsRefused) {
  expect_refused({
      {"32-bit integers", [] { (void)IndexView(static_cast<const std::int32_t*>(nullptr), 5); }},
      {"64-bit integers", [] { (void)IndexView(static_cast<const std::uint64_t*>(nullptr), kHuge); }},
      {"integers to write", [] { (void)IndexSpan(static_cast<std::int64_t*>(nullptr), 5); }},
      {"single precision", [] { (void)RealView(static_cast<const float*>(nullptr), 5); }},
      {"double precision", [] { (void)RealView(static_cast<const double*>(nullptr), 5); }},
      {"points", [] { (void)PointsView(static_cast<const double*>(nullptr), 5, 3); }},
      {"points of dimension 0", [] { (void)PointsView(std::vector<double>(6), 0); }},
      {"points of dimension 4", [] { (void)PointsView(std::vector<double>(8), 4); }},
      {"numbers that make no points", [] { (void)PointsView(std::vector<double>(7), 3); }},
  });
  EXPECT_EQ(IndexView(static_cast<const std::int32_t*>(nullptr), 0).size(), 0U);
  EXPECT_EQ(PointsView(static_cast<const float*>(nullptr), -1, 2).size(), 0U);
}

}  // namespace
}  // namespace meshorder
