// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Passes arrays of random contents, and valid ones with one fault, to all functions that take a caller's
// arrays. Each returns a complete result or refuses its input.
#include "support/sample_graphs.hpp"
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>
#include <meshorder/registry.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder {
namespace {

/// Seeded random choices.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}

  std::uint64_t bits() { return random_(); }
  /// 0 … bound − 1
  std::int64_t below(std::int64_t bound) {
    return static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(bound));
  }
  bool one_in(std::int64_t count) { return below(count) == 0; }
  template <class Range>
  auto of(const Range& choices) {
    return *(std::begin(choices) + below(std::ssize(choices)));
  }

  /// A number of any size, most often near 0 … `about`.
  std::int64_t integer(std::int64_t about) {
    using Limits = std::numeric_limits<std::int64_t>;
    if (!one_in(4)) return below(about + 3) - 1;
    if (one_in(2)) return static_cast<std::int64_t>(bits());
    return of(std::array<std::int64_t, 10>{-1, about, about + 1, Limits::min(), Limits::max(),
                                           std::numeric_limits<std::int32_t>::max(),
                                           std::numeric_limits<std::int32_t>::min(), std::int64_t{1} << 31U,
                                           std::int64_t{1} << 32U, (std::int64_t{1} << 32U) + 1});
  }

  double real() {
    using Limits = std::numeric_limits<double>;
    if (one_in(2)) return 1.0 + static_cast<double>(below(8)) / 4;
    if (one_in(2)) return std::bit_cast<double>(bits());
    return of(std::array<double, 10>{0, -0.0, -1, Limits::quiet_NaN(), Limits::infinity(),
                                     -Limits::infinity(), Limits::max(), Limits::lowest(),
                                     Limits::denorm_min(), Limits::min()});
  }

 private:
  std::mt19937_64 random_;
};

/// Numbers in one of the types that views take.
template <class... Types>
class AnyNumbers {
 public:
  template <class Numbers>
  AnyNumbers(Dice& dice, const Numbers& numbers) {
    fill(static_cast<std::size_t>(dice.below(sizeof...(Types))), numbers,
         std::index_sequence_for<Types...>{});
  }

  template <class View>
  [[nodiscard]] View view() const {
    return std::visit([](const auto& values) { return View(values); }, values_);
  }

 private:
  template <class Numbers, std::size_t... Is>
  void fill(std::size_t type, const Numbers& numbers, std::index_sequence<Is...> /*types*/) {
    ((type == Is ? assign<Types>(numbers) : void()), ...);
  }
  template <class T, class Numbers>
  void assign(const Numbers& numbers) {
    std::vector<T> values;
    values.reserve(numbers.size());
    for (const auto number : numbers) values.push_back(static_cast<T>(number));
    values_ = std::move(values);
  }

  std::variant<std::vector<Types>...> values_;
};

using AnyIntegers = AnyNumbers<std::int32_t, std::uint32_t, std::int64_t, std::uint64_t>;
using AnyReals = AnyNumbers<float, double>;

/// Damages an array in one place, or not at all.
template <class Number, class Fault>
void break_one(Dice& dice, std::vector<Number>& numbers, const Fault& fault) {
  switch (dice.below(4)) {
    case 0:
      if (!numbers.empty()) numbers[static_cast<std::size_t>(dice.below(std::ssize(numbers)))] = fault();
      break;
    case 1:
      if (!numbers.empty()) numbers.pop_back();
      break;
    case 2:
      numbers.push_back(fault());
      break;
    default:
      break;
  }
}

template <class Fill>
auto filled(std::int64_t size, const Fill& fill) {
  std::vector<decltype(fill())> numbers(static_cast<std::size_t>(size));
  for (auto& number : numbers) number = fill();
  return numbers;
}

/// Calls `work`, which may refuse its input with one of the documented errors.
template <class Work>
void expect_result_or_refusal(const Work& work, int& results) {
  try {
    work();
    ++results;
  } catch (const InvalidArgument& error) {
    EXPECT_STRNE(error.what(), "");
  } catch (const TooLarge& error) {
    EXPECT_STRNE(error.what(), "");
  }
}

void expect_order(const Order& order, std::size_t size) {
  ASSERT_EQ(order.permutation.size(), static_cast<Index>(size));
  std::vector<bool> seen(size);
  for (const Index old : order.permutation.new_to_old()) seen[static_cast<std::size_t>(old)] = true;
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), static_cast<std::ptrdiff_t>(size));
}

void check_of(const Graph& graph) { check(graph); }

/// The arrays of a graph of a few vertices, good, with a fault or altogether random.
struct RandomGraph {
  std::vector<std::int64_t> offsets;
  std::vector<std::int64_t> neighbours;
  std::vector<double> weights;
  int base = 0;

  explicit RandomGraph(Dice& dice) {
    base = static_cast<int>(dice.below(2));
    const bool weighted = dice.one_in(2);
    if (dice.one_in(4)) {
      const std::int64_t entries = dice.below(12);
      offsets = filled(dice.below(8), [&] { return dice.integer(entries); });
      neighbours = filled(entries, [&] { return dice.integer(7); });
      if (weighted) weights = filled(entries, [&] { return dice.real(); });
    } else {
      const auto size = static_cast<Index>(1 + dice.below(dice.one_in(8) ? 90 : 12));
      const CsrGraph graph =
          test::random_connected(size, static_cast<Index>(dice.below(size + 1)), dice.bits());
      for (const Offset offset : graph.offsets) offsets.push_back(offset + base);
      for (const Index u : graph.neighbours) neighbours.push_back(Offset{u} + base);
      const double weight = dice.of(std::array{0.5, 1.0, 1e-300, 1e308, 5e-324});
      if (weighted) weights.assign(neighbours.size(), weight);
      if (dice.one_in(3)) break_one(dice, offsets, [&] { return dice.integer(std::ssize(neighbours)); });
      if (dice.one_in(2)) break_one(dice, neighbours, [&] { return dice.integer(size); });
      if (weighted && dice.one_in(3)) break_one(dice, weights, [&] { return dice.real(); });
    }
    if (dice.one_in(20)) base = static_cast<int>(dice.below(5)) - 2;
  }
};

OrderOptions random_options(Dice& dice) {
  OrderOptions options;
  options.seed = dice.bits();
  options.check = dice.one_in(2) ? Check::full : Check::fast;
  options.symmetry = dice.one_in(2) ? Symmetry::require : Symmetry::mirror;
  options.workload = dice.of(kWorkloads);
  options.run.threads = 1;
  if (dice.one_in(10)) options.tolerance = dice.real();
  if (dice.one_in(10)) options.max_iterations = static_cast<int>(dice.below(6)) - 1;
  if (dice.one_in(10)) options.run.time_limit = dice.real();
  return options;
}

std::string random_method(Dice& dice, const std::vector<MethodInfo>& methods) {
  return dice.one_in(50) ? "?" : dice.of(methods).name;
}

TEST(RandomBytes, AsGraphs) {
  const std::vector<MethodInfo> methods = vertex_methods();
  int results = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const RandomGraph graph(dice);
    const AnyIntegers offsets(dice, graph.offsets);
    const AnyIntegers neighbours(dice, graph.neighbours);
    const AnyReals weights(dice, graph.weights);
    const GraphView view{offsets.view<IndexView>(), neighbours.view<IndexView>(), weights.view<RealView>(),
                         graph.base};
    const std::size_t size = graph.offsets.empty() ? 0 : graph.offsets.size() - 1;
    std::vector<double> coordinates =
        filled(3 * static_cast<std::int64_t>(size), [&] { return dice.real(); });
    if (dice.one_in(8)) break_one(dice, coordinates, [&] { return dice.real(); });
    if (dice.one_in(2)) {
      for (double& x : coordinates) x = std::isfinite(x) ? x : 0;
    }
    OrderOptions options = random_options(dice);
    auto start = filled(dice.one_in(5) ? static_cast<std::int64_t>(size) : 0, [&] { return dice.real(); });
    if (dice.one_in(20)) break_one(dice, start, [&] { return dice.real(); });
    auto groups =
        filled(dice.one_in(5) ? static_cast<std::int64_t>(size) : 0, [&] { return dice.integer(2); });
    if (dice.one_in(20)) break_one(dice, groups, [&] { return dice.integer(2); });
    const AnyReals any_start(dice, start);
    const AnyIntegers any_groups(dice, groups);
    options.start = any_start.view<RealView>();
    options.groups = any_groups.view<IndexView>();

    expect_result_or_refusal(
        [&] {
          const PointsView points(coordinates.data(), coordinates.size() / 3);
          expect_order(order_vertices(view, random_method(dice, methods), options, points), size);
        },
        results);
    expect_result_or_refusal([&] { check(view, options.check); }, results);
    expect_result_or_refusal([&] { check_of(cleaned(view, options.symmetry)); }, results);
    expect_result_or_refusal([&] { EXPECT_GE(quality(view, options.run).edges, 0); }, results);
    expect_result_or_refusal(
        [&] {
          for (const double value : fiedler_vector(view, options).values) EXPECT_TRUE(std::isfinite(value));
        },
        results);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(results, 4000);
  EXPECT_LT(results, 19000);
}

/// Three graphs of n vertices with edges in one row only: a grid without a fifth of its entries, the upper
/// triangle of a grid, and random neighbours.
std::vector<CsrGraph> asymmetric_graphs(Index n) {
  Dice dice(77);
  const CsrGraph grid = test::grid(n / 60, 60);
  std::vector<CsrGraph> graphs(3);
  for (Index v = 0; v < grid.size(); ++v) {
    for (const Index u : grid[v]) {
      if (!dice.one_in(5)) graphs[0].neighbours.push_back(u);
      if (u > v) graphs[1].neighbours.push_back(u);
    }
    for (int k = 0; k < 4; ++k) graphs[2].neighbours.push_back(static_cast<Index>(dice.below(grid.size())));
    for (CsrGraph& graph : graphs) graph.offsets.push_back(static_cast<Offset>(graph.neighbours.size()));
  }
  return graphs;
}

TEST(RandomBytes, AsAsymmetricGraphsThatAreNotCheckedForIt) {
  for (const Index n : {180, 1200, test::large(6000)}) {
    for (const CsrGraph& graph : asymmetric_graphs(n)) {
      const GraphView view{graph.offsets, graph.neighbours};
      const std::vector<Point> points(static_cast<std::size_t>(graph.size()), Point{1, 2, 3});
      EXPECT_THROW((void)order_vertices(view, "rcm"), InvalidArgument);
      for (const MethodInfo& method : vertex_methods()) {
        SCOPED_TRACE(method.name + " on " + std::to_string(graph.size()) + " vertices");
        const OrderOptions options{.tolerance = 1e-3, .check = Check::fast};
        expect_order(order_vertices(view, method.name, options, points),
                     static_cast<std::size_t>(graph.size()));
      }
    }
  }
}

/// The arrays of a few cells, good, with a fault or altogether random.
struct RandomCells {
  std::vector<std::int64_t> offsets;
  std::vector<std::int64_t> vertices;
  std::vector<std::uint8_t> types;
  std::vector<Shape> shapes;

  RandomCells(Dice& dice, std::int64_t vertex_count, int base) {
    struct Type {
      std::uint8_t vtk;
      Shape shape;
      int vertices;
    };
    constexpr std::array kTypes{
        Type{1, Shape::vertex, 1},  Type{3, Shape::line, 2},           Type{5, Shape::triangle, 3},
        Type{8, Shape::quad, 4},    Type{10, Shape::tetrahedron, 4},   Type{11, Shape::hexahedron, 8},
        Type{7, Shape::polygon, 5}, Type{6, Shape::triangle_strip, 5}, Type{24, Shape::tetrahedron, 10}};
    offsets.push_back(base);
    const std::int64_t count = dice.below(7);
    for (std::int64_t c = 0; c < count; ++c) {
      const Type type = dice.of(kTypes);
      for (int k = 0; k < type.vertices; ++k) vertices.push_back(base + dice.below(vertex_count));
      offsets.push_back(static_cast<std::int64_t>(vertices.size()) + base);
      types.push_back(type.vtk);
      shapes.push_back(type.shape);
    }
    if (dice.one_in(3)) break_one(dice, offsets, [&] { return dice.integer(std::ssize(vertices)); });
    if (dice.one_in(3)) break_one(dice, vertices, [&] { return dice.integer(vertex_count); });
    if (dice.one_in(3)) break_one(dice, types, [&] { return static_cast<std::uint8_t>(dice.bits()); });
    if (dice.one_in(3)) break_one(dice, shapes, [&] { return static_cast<Shape>(dice.bits() % 256); });
  }
};

TEST(RandomBytes, AsCells) {
  const std::vector<MethodInfo> of_vertices = vertex_methods();
  const std::vector<MethodInfo> of_elements = element_methods();
  int results = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const std::int64_t n = 1 + dice.below(15);
    const int base = static_cast<int>(dice.below(2));
    const RandomCells random(dice, n, base);
    const AnyIntegers offsets(dice, random.offsets);
    const AnyIntegers vertices(dice, random.vertices);
    const IndexView entries = vertices.view<IndexView>();
    const Shape shape = random.shapes.empty() ? Shape::tetrahedron : random.shapes.front();
    const int width = static_cast<int>(dice.integer(5) % 16);
    const std::array<CellBlock, 2> blocks{
        {{shape, width, entries}, {Shape::line, 2, offsets.view<IndexView>()}}};
    CellsView cells = CellsView::mixed(offsets.view<IndexView>(), entries, random.types, base);
    switch (dice.below(5)) {
      case 0:
        cells = CellsView::uniform(shape, width, entries, base);
        break;
      case 1:
        cells = CellsView::blocks(blocks, base);
        break;
      case 2:
        cells = CellsView::mixed(offsets.view<IndexView>(), entries, std::span(random.shapes), base);
        break;
      default:
        break;
    }
    auto coordinates = filled(3 * n, [&] { return dice.real(); });
    if (dice.one_in(2)) {
      for (double& x : coordinates) x = std::isfinite(x) ? x : 0;
    }
    const PointsView points(coordinates, 3);
    OrderOptions options = random_options(dice);
    auto groups =
        filled(dice.one_in(5) ? static_cast<std::int64_t>(cells.size()) : 0, [&] { return dice.integer(2); });
    if (dice.one_in(20)) break_one(dice, groups, [&] { return dice.integer(2); });
    options.cell_groups = groups;

    const auto count = static_cast<std::size_t>(n);
    expect_result_or_refusal(
        [&] {
          const Permutation order = Permutation::identity(static_cast<Index>(n));
          expect_order(order_elements(cells, order, random_method(dice, of_elements), options, points),
                       cells.size());
        },
        results);
    expect_result_or_refusal(
        [&] {
          const MeshMethods methods{random_method(dice, of_vertices), random_method(dice, of_elements)};
          const MeshOrder order = order_mesh({points, cells, count}, methods, options);
          expect_order(order.vertices, count);
          expect_order(order.cells, cells.size());
        },
        results);
    expect_result_or_refusal([&] { check_of(vertex_graph(cells, count, {.threads = 1})); }, results);
    expect_result_or_refusal([&] { check_of(dual_graph(cells, count, dice.one_in(2), {.threads = 1})); },
                             results);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(results, 3000);
  EXPECT_LT(results, 11000);
}

TEST(RandomBytes, AsPermutationsAndMatrices) {
  int results = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const std::int64_t n = dice.below(9);
    std::vector<std::int64_t> map;
    for (std::int64_t k = 0; k < n; ++k) map.insert(map.begin() + dice.below(k + 1), k);
    if (dice.one_in(2)) break_one(dice, map, [&] { return dice.integer(n); });
    const AnyIntegers any(dice, map);
    Permutation order;
    expect_result_or_refusal(
        [&] {
          order = Permutation::from_old_to_new(any.view<IndexView>());
          EXPECT_EQ(Permutation::from_new_to_old(order.new_to_old()), order);
        },
        results);

    std::vector<std::int64_t> numbers = filled(dice.below(6), [&] { return dice.below(n + 1); });
    if (dice.one_in(2)) break_one(dice, numbers, [&] { return dice.integer(n); });
    const std::vector<std::int64_t> before = numbers;
    bool changed = false;
    expect_result_or_refusal(
        [&] {
          order.renumber(numbers, static_cast<int>(dice.below(3)));
          changed = true;
        },
        results);
    if (!changed) {
      EXPECT_EQ(numbers, before);
    }

    const RandomGraph graph(dice);
    const AnyIntegers offsets(dice, graph.offsets);
    const AnyIntegers neighbours(dice, graph.neighbours);
    const GraphView matrix{offsets.view<IndexView>(), neighbours.view<IndexView>(), {}, graph.base};
    const std::size_t rows = graph.offsets.empty() ? 0 : graph.offsets.size() - 1;
    order = Permutation::identity(static_cast<Index>(rows)).inverse();
    expect_result_or_refusal([&] { EXPECT_EQ(order.csr_entry_map(matrix).size(), graph.neighbours.size()); },
                             results);
    std::vector<int> moved_offsets(graph.offsets.size());
    std::vector<std::int64_t> columns(graph.neighbours.size());
    expect_result_or_refusal([&] { order.move_csr(matrix, {}, moved_offsets, columns, {}); }, results);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(results, 3000);
  EXPECT_LT(results, 11500);
}

}  // namespace
}  // namespace meshorder
