// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/kernel_timing.hpp"

#include "kernels/positions.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

namespace meshorder {
namespace {

TimingOptions quick() {
  return {.budget_seconds = 0.0, .min_rounds = 4, .max_rounds = 9, .sample_seconds = 1e-5};
}

double largest(std::span<const double> values) {
  double result = 0.0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

/// EXPECTs the row at v's new place in `actual` to be row v of `expected`.
void expect_same_rows(std::span<const double> actual, std::span<const double> expected, Index width,
                      const Permutation& vertices) {
  ASSERT_EQ(actual.size(), expected.size());
  const double scale = largest(expected);
  EXPECT_GT(scale, 0.0);
  for (Index v = 0; v < vertices.size(); ++v) {
    for (Index c = 0; c < width; ++c) {
      ASSERT_NEAR(actual[Offset{width} * vertices.old_to_new()[v] + c], expected[Offset{width} * v + c],
                  1e-9 * scale);
    }
  }
}

std::unique_ptr<KernelBench> prepared(const Mesh& mesh, KernelSet kernels = KernelSet::plain,
                                      int threads = 1) {
  return prepare_kernels(kernels, mesh, vertex_graph(mesh), threads);
}

class KernelBenches : public testing::TestWithParam<KernelSet> {};

INSTANTIATE_TEST_SUITE_P(Both, KernelBenches, testing::Values(KernelSet::plain, KernelSet::tuned),
                         [](const auto& set) { return std::string(to_string(set.param)); });

TEST_P(KernelBenches, ComputeTheSamePhysicsInEveryOrder) {
  for (const Mesh& before :
       {test::tetrahedral_bar(9), test::mixed_mesh(), test::cells_of_type(Shape::triangle, 3, 7)}) {
    Mesh after = before;
    const Permutation vertices = test::shuffled(before.vertex_count(), 3);
    apply_reordering(after, vertices, test::shuffled_cells(before, 4));
    const auto a = prepared(before, GetParam());
    const auto b = prepared(after, GetParam());
    const bool plain = GetParam() == KernelSet::plain;
    for (const Kernel kernel : {Kernel::spmv, Kernel::element, Kernel::springs}) {
      SCOPED_TRACE(to_string(kernel));
      a->run(kernel);
      b->run(kernel);
      const Index of_product = plain ? 1 : 3;
      expect_same_rows(b->result(kernel), a->result(kernel),
                       kernel == Kernel::spmv ? of_product
                       : plain                ? 3
                                              : kPaddedStride,
                       vertices);
    }
  }
}

TEST_P(KernelBenches, ComputeTheSameBitsOnAnyNumberOfThreads) {
  std::vector<Mesh> meshes{test::tetrahedral_bar(30), test::mixed_mesh(),
                           test::cells_of_type(Shape::quad, 4, 50), test::cells_of_type(Shape::line, 2, 50)};
  meshes.push_back(meshes.front());  // scrambled: most elements touch several shares
  apply_reordering(meshes.back(), test::shuffled(meshes.back().vertex_count(), 3),
                   test::shuffled_cells(meshes.back(), 4));
  for (const Mesh& mesh : meshes) {
    const auto serial = prepared(mesh, GetParam());
    EXPECT_EQ(serial->redundancy(), 0.0);
    for (const int threads : {2, 3, 8}) {
      const auto shared = prepared(mesh, GetParam(), threads);
      for (const Kernel kernel : kKernels) {
        SCOPED_TRACE(std::string(to_string(kernel)) + " on " + std::to_string(threads));
        serial->run(kernel);
        shared->run(kernel);
        shared->run(kernel);  // results of the first run must be cleared
        const auto expected = serial->result(kernel);
        const auto actual = shared->result(kernel);
        ASSERT_EQ(actual.size(), expected.size());
        EXPECT_TRUE(std::equal(actual.begin(), actual.end(), expected.begin()));
        EXPECT_GT(largest(expected), 0.0);
      }
    }
  }
  EXPECT_LT(prepared(meshes.front(), GetParam(), 2)->redundancy(), 0.15);
  EXPECT_GT(prepared(meshes.back(), GetParam(), 2)->redundancy(), 0.8);
  const auto empty = prepared(Mesh{}, GetParam(), 2);
  for (const Kernel kernel : kKernels) empty->run(kernel);
}

TEST_P(KernelBenches, RunOnCellsOfEveryType) {
  const test::CellTypes types = test::common_types({{Shape::polygon, 5},
                                                    {Shape::polyline, 4},
                                                    {Shape::triangle_strip, 6},
                                                    {Shape::poly_vertex, 3},
                                                    {Shape::polyhedron, 9}});
  for (const auto& [shape, vertices] : types) {
    SCOPED_TRACE(type_name(shape, vertices));
    const auto bench = prepared(test::cells_of_type(shape, vertices, 5), GetParam());
    for (const Kernel kernel : kKernels) {
      bench->run(kernel);
      for (const double value : bench->result(kernel)) EXPECT_TRUE(std::isfinite(value));
    }
  }
  const auto empty = prepared(Mesh{}, GetParam());
  for (const Kernel kernel : kKernels) empty->run(kernel);
}

TEST_P(KernelBenches, KnowTheMemoryThatTheyHoldAndMove) {
  const auto small = prepared(test::tetrahedral_bar(10), GetParam());
  const auto large = prepared(test::tetrahedral_bar(100), GetParam());
  EXPECT_GT(large->bytes(), 8 * small->bytes());
  EXPECT_LT(large->bytes(), 12 * small->bytes());
  for (const Kernel kernel : kKernels) {
    EXPECT_GT(small->streamed_bytes(kernel), 0.0);
    EXPECT_LT(large->streamed_bytes(kernel), 3.0 * static_cast<double>(large->bytes()));
  }
}

TEST_P(KernelBenches, RefuseTheGraphOfAnotherMesh) {
  EXPECT_THROW(
      (void)prepare_kernels(GetParam(), test::tetrahedral_bar(3), vertex_graph(test::tetrahedral_bar(4))),
      InvalidArgument);
}

TEST(TimeInterleaved, TimesEveryKernelInEveryOrder) {
  const auto a = prepared(test::tetrahedral_bar(5));
  const auto b = prepared(test::tetrahedral_bar(50));
  const std::vector<KernelBench*> benches{a.get(), b.get()};
  const std::vector<OrderTimes> times = time_interleaved(benches, quick()).orders;
  ASSERT_EQ(times.size(), 2U);
  for (const Kernel kernel : kKernels) {
    SCOPED_TRACE(to_string(kernel));
    for (const OrderTimes& order : times) {
      EXPECT_GT(order[kernel].best_ms, 0.0);
      EXPECT_LE(order[kernel].best_ms, order[kernel].median_ms);
      EXPECT_EQ(order[kernel].samples, 4);  // the budget allows no more
    }
    EXPECT_EQ(times[0][kernel].gain.ratio, 1.0);
    // ten times the work: slower, whatever else the machine does
    EXPECT_LT(times[0][kernel].best_ms, 0.6 * times[1][kernel].best_ms);
    EXPECT_LT(times[1][kernel].gain.low, times[1][kernel].gain.ratio);
    EXPECT_GT(times[1][kernel].gain.high, times[1][kernel].gain.ratio);
  }
}

TEST_P(KernelBenches, RunStretchesOnlyOfLargeMeshes) {
  const auto bench = prepared(test::tetrahedral_bar(9), GetParam());
  for (const Kernel kernel : kKernels) {
    EXPECT_EQ(bench->run_stretches(kernel), 0);
    EXPECT_EQ(largest(bench->result(kernel)), 0);
  }
}

TEST(PlainBench, ComputesAnEighthOfTheElementsInStretches) {
  const Mesh mesh = test::tetrahedral_bar(200'000);
  const CsrGraph graph = vertex_graph(mesh);
  ASSERT_GT(cut_into_simplices(mesh).size(), 1'000'000);
  for (const int threads : {1, 2}) {
    const auto whole = prepare_kernels(KernelSet::plain, mesh, graph, threads);
    const auto part = prepare_kernels(KernelSet::plain, mesh, graph, threads);
    EXPECT_EQ(part->run_stretches(Kernel::spmv), 0);
    EXPECT_EQ(part->run_stretches(Kernel::springs), 0);
    for (const Kernel kernel : {Kernel::element, Kernel::assembly}) {
      SCOPED_TRACE(std::string(to_string(kernel)) + " on " + std::to_string(threads));
      whole->run(kernel);
      EXPECT_EQ(part->run_stretches(kernel), 1.0 / 8);
      const std::span<const double> some = part->result(kernel);
      EXPECT_LE(largest(some), 2 * largest(whole->result(kernel)));
      // the stretches lie in all sixteenths of the mesh
      const std::size_t size = some.size() / 16;
      for (std::size_t i = 0; i < 16; ++i) {
        const std::span<const double> sixteenth = some.subspan(i * size, size);
        const auto computed = std::ranges::count_if(sixteenth, [](double value) { return value != 0; });
        EXPECT_NEAR(static_cast<double>(computed), static_cast<double>(size) / 8,
                    static_cast<double>(size) / 80);
      }
    }
  }
}

/// Runs that take a given time, and an eighth of it in stretches.
class SleepingBench final : public CopiedBench<SleepingBench> {
 public:
  explicit SleepingBench(std::chrono::milliseconds time) : time_(time) {}

  [[nodiscard]] std::span<const Kernel> kernels() const override { return kProductsAlone; }
  void share(int /*threads*/) override {}
  [[nodiscard]] std::span<const double> result(Kernel /*kernel*/) const override { return {}; }
  [[nodiscard]] double streamed_bytes(Kernel /*kernel*/) const override { return 0; }
  [[nodiscard]] std::size_t bytes() const override { return 0; }
  [[nodiscard]] double redundancy() const override { return 0; }

  [[nodiscard]] int runs() const { return *runs_; }

 private:
  void compute(Kernel /*kernel*/) override {
    ++*runs_;
    std::this_thread::sleep_for(time_);
  }
  double compute_stretches(Kernel /*kernel*/) override {
    std::this_thread::sleep_for(time_ / 8);
    return 1.0 / 8;
  }

  std::chrono::milliseconds time_;
  std::shared_ptr<int> runs_ = std::make_shared<int>(0);  ///< of all copies
};

TEST(TimeInterleaved, RunsAPlainlySlowOrderOnce) {
  using std::chrono_literals::operator""ms;
  SleepingBench slow(400ms);
  SleepingBench fast(20ms);
  const std::vector<KernelBench*> benches{&slow, &fast};
  const std::vector<OrderTimes> times = time_interleaved(benches, quick()).orders;
  EXPECT_EQ(slow.runs(), 1);
  EXPECT_EQ(times[0][Kernel::spmv].samples, 1);
  EXPECT_GE(times[0][Kernel::spmv].best_ms, 400.0);
  EXPECT_EQ(times[1][Kernel::spmv].samples, 4);
  EXPECT_GT(times[1][Kernel::spmv].gain.ratio, 3.0);
}

TEST(TimeInterleaved, TimesAPlainlySlowOrderByStretches) {
  using std::chrono_literals::operator""ms;
  SleepingBench slow(800ms);
  SleepingBench fast(40ms);
  const std::vector<KernelBench*> benches{&slow, &fast};
  TimingOptions options = quick();
  options.in_stretches = true;
  const std::vector<OrderTimes> times = time_interleaved(benches, options).orders;
  EXPECT_EQ(slow.runs(), 0);
  EXPECT_EQ(times[0][Kernel::spmv].samples, 1);
  EXPECT_EQ(times[0][Kernel::spmv].share, 1.0 / 8);
  EXPECT_GE(times[0][Kernel::spmv].best_ms, 800.0);
  EXPECT_EQ(times[1][Kernel::spmv].samples, 4);
  EXPECT_EQ(times[1][Kernel::spmv].share, 1);
  EXPECT_DOUBLE_EQ(times[1][Kernel::spmv].gain.ratio,
                   times[0][Kernel::spmv].best_ms / times[1][Kernel::spmv].best_ms);
}

TEST(TimeInterleaved, CountsTheRunThatShowsThatRunsAreLong) {
  using std::chrono_literals::operator""ms;
  SleepingBench bench(20ms);
  const std::vector<KernelBench*> benches{&bench};
  const std::vector<OrderTimes> times = time_interleaved(benches, quick()).orders;
  EXPECT_EQ(times[0][Kernel::spmv].samples, 4);
  EXPECT_EQ(bench.runs(), 8) << "the first order is timed twice";
}

/// Whose time depends on where its memory is: the copy that time_interleaved makes is the only fast one.
class PlacedBench final : public CopiedBench<PlacedBench> {
 public:
  PlacedBench() = default;
  PlacedBench(const PlacedBench&) : is_copy_(true) {}
  PlacedBench& operator=(const PlacedBench&) { return *this; }
  ~PlacedBench() override = default;

  [[nodiscard]] std::span<const Kernel> kernels() const override { return kProductsAlone; }
  void share(int /*threads*/) override {}
  [[nodiscard]] std::span<const double> result(Kernel /*kernel*/) const override { return {}; }
  [[nodiscard]] double streamed_bytes(Kernel /*kernel*/) const override { return 0; }
  [[nodiscard]] std::size_t bytes() const override { return bytes_; }
  [[nodiscard]] double redundancy() const override { return 0; }

  std::size_t bytes_ = 0;

 private:
  void compute(Kernel /*kernel*/) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(is_copy_ ? 20 : 60));
  }

  bool is_copy_ = false;
};

TEST(TimeInterleaved, RunsAllOrdersInTheSameMemoryAndTheFirstOneTwice) {
  PlacedBench first;
  PlacedBench second;
  const std::vector<KernelBench*> benches{&first, &second};
  const Timings small = time_interleaved(benches, quick());
  for (const OrderTimes& order : small.orders) EXPECT_LT(order[Kernel::spmv].best_ms, 50);
  EXPECT_EQ(small.again[Kernel::spmv].samples, 4);
  second.bytes_ = kMostCopied + 1;
  for (const OrderTimes& order : time_interleaved(benches, quick()).orders)
    EXPECT_GE(order[Kernel::spmv].best_ms, 60) << "too large to be copied";
}

TEST_P(KernelBenches, AreTheSameInTheMemoryOfAnother) {
  const Mesh mesh = test::tetrahedral_bar(30);
  Mesh other = mesh;
  apply_reordering(other, test::shuffled(mesh.vertex_count(), 3), test::shuffled_cells(mesh, 4));
  const auto expected = prepared(other, GetParam());
  const auto actual = prepared(mesh, GetParam());
  const double* const place = actual->result(Kernel::spmv).data();
  actual->take(*expected);
  EXPECT_EQ(actual->result(Kernel::spmv).data(), place);
  for (const Kernel kernel : kKernels) {
    expected->run(kernel);
    actual->run(kernel);
    EXPECT_TRUE(std::ranges::equal(actual->result(kernel), expected->result(kernel))) << to_string(kernel);
  }
}

TEST(TimeInterleaved, StopsAtTheMostRounds) {
  const auto bench = prepared(test::tetrahedral_bar(2));
  TimingOptions options = quick();
  options.budget_seconds = 60.0;
  const std::vector<KernelBench*> benches{bench.get()};
  EXPECT_EQ(time_interleaved(benches, options).orders[0][Kernel::spmv].samples, 9);
  EXPECT_TRUE(time_interleaved({}, options).orders.empty());
}

TEST(TimeOrders, PreparesEachOrderOnceAndAsManyAtATimeAsFit) {
  const Mesh mesh = test::tetrahedral_bar(20);
  const std::size_t bytes = prepared(mesh)->bytes();
  for (const std::size_t fitting : {std::size_t{1}, std::size_t{3}, std::size_t{100}}) {
    SCOPED_TRACE(fitting);
    TimingOptions options = quick();
    options.memory_bytes = fitting * bytes;
    std::vector<Index> seen;
    const auto times = time_orders(
                           6,
                           [&](Index order) {
                             seen.push_back(order);
                             return prepared(mesh);
                           },
                           options)
                           .orders;
    EXPECT_EQ(seen, (std::vector<Index>{0, 1, 2, 3, 4, 5}));
    ASSERT_EQ(times.size(), 6U);
    for (const OrderTimes& order : times) EXPECT_GT(order[Kernel::element].best_ms, 0.0);
    // the reference is timed with every group of other orders; a group has one order, two or all
    const int groups = fitting == 1 ? 5 : fitting == 3 ? 3 : 1;
    EXPECT_EQ(times[0][Kernel::spmv].samples, 4 * groups);
    EXPECT_EQ(times[5][Kernel::spmv].samples, 4);
  }
}

TEST(TimeOrders, NeedsNoOtherOrderThanTheReference) {
  const auto prepare = [](Index) { return prepared(test::tetrahedral_bar(3)); };
  EXPECT_TRUE(time_orders(0, prepare, quick()).orders.empty());
  const auto times = time_orders(1, prepare, quick()).orders;
  ASSERT_EQ(times.size(), 1U);
  EXPECT_EQ(times[0][Kernel::spmv].samples, 4);
  EXPECT_EQ(times[0][Kernel::spmv].gain.ratio, 1.0);
}

}  // namespace
}  // namespace meshorder
