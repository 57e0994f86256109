// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "support/refusal.hpp"
#include "support/sample_graphs.hpp"
#include <meshorder/layouts.hpp>
#include <meshorder/mesh.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using test::refusal;
using testing::HasSubstr;

Mesh unordered_grid() {
  Mesh mesh = make_grid({.size = 15});
  (void)reorder(mesh, {.methods = {"scrambled", "hilbert"}});
  return mesh;
}

/// A layout's cost by definition. For each warp, corner and addition, a sector counts t times, where t is the
/// largest number of threads that add to one number in it.
GpuCost cost_by_definition(const Mesh& mesh, int record_bytes, int additions, int arrays) {
  GpuCost cost;
  for (Index begin = 0; begin < mesh.cell_count(); begin += 32) {
    for (int corner = 0; corner < 4; ++corner) {
      for (int k = 0; k < additions; ++k) {
        std::map<int, std::map<int, int>> threads;  // by sector and address
        for (Index c = begin; c < std::min(begin + 32, mesh.cell_count()); ++c) {
          const int address = record_bytes * mesh.cells[c][corner] + 4 * k;
          ++threads[address / 32][address];
        }
        for (const auto& [sector, at] : threads) {
          int most = 0;
          for (const auto& [address, count] : at) most = std::max(most, count);
          cost.sectors += Offset{most} * arrays;
        }
        cost.requests += arrays;
      }
    }
  }
  return cost;
}

TEST(GpuCost, CountsSectorsAndThreadsThatWait) {
  const Mesh mesh = unordered_grid();
  const CellsView cells = view(mesh).cells;
  for (const auto& [layout, expected] : {std::pair(GpuLayout::packed, cost_by_definition(mesh, 12, 3, 1)),
                                         std::pair(GpuLayout::apart, cost_by_definition(mesh, 4, 1, 3)),
                                         std::pair(GpuLayout::padded, cost_by_definition(mesh, 16, 1, 1))}) {
    const GpuCost cost = gpu_cost(cells, mesh.points.size(), layout);
    EXPECT_EQ(cost.sectors, expected.sectors);
    EXPECT_EQ(cost.requests, expected.requests);
    EXPECT_LT(cost.floor, cost.sectors);
    for (const int threads : {1, 2, 7})
      EXPECT_EQ(gpu_cost(cells, mesh.points.size(), layout, kGpuCacheBytes, {.threads = threads}), cost);
  }
}

TEST(GpuCost, IsNotBelowItsFloor) {
  std::vector<Index> vertices(100);
  std::iota(vertices.begin(), vertices.end(), Index{0});
  for (const GpuLayout layout : kGpuLayouts) {
    for (std::size_t n = 1; n <= vertices.size(); ++n) {
      const IndexView some(vertices.data(), n);
      const GpuCost cost = gpu_cost(CellsView::uniform(Shape::vertex, 1, some), 100, layout);
      EXPECT_GE(cost.sectors, cost.floor) << n;
      EXPECT_GE(cost.dram_bytes, cost.dram_floor) << n;
      if (n <= 32) {
        EXPECT_EQ(cost.sectors, cost.floor) << n;
      }
    }
  }
}

TEST(GpuCost, OfSimpleWarpsIsKnown) {
  std::vector<Index> apart(64);
  std::iota(apart.begin(), apart.end(), Index{0});
  const std::vector<Index> shared(64, 5);
  const auto of_points = [](const std::vector<Index>& vertices) {
    return gpu_cost(CellsView::uniform(Shape::vertex, 1, vertices), 64, GpuLayout::padded);
  };
  // 64 numbers of cells, and 16 bytes of each vertex in two arrays
  const Offset bytes = 64 * (4 + 2 * 16);
  EXPECT_EQ(of_points(apart), (GpuCost{2, 32, 32, bytes, bytes}));
  const Offset of_one = 64 * 4 + 2 * 32;
  EXPECT_EQ(of_points(shared), (GpuCost{2, 64, 32, of_one, of_one})) << "all wait";
}

/// The entries that a thread reads in a loop over `count` entries that NVIDIA's compiler has unrolled, by the
/// load instruction and the iteration.
std::map<std::pair<int, int>, Offset> unrolled(Offset count) {
  std::map<std::pair<int, int>, Offset> reads;
  Offset next = 0;
  for (int k = 0; k < count % 4; ++k) reads[{k, 0}] = next++;
  int turn = 0;
  for (; count - next > 12; ++turn)
    for (int k = 0; k < 16; ++k) reads[{10 + k, turn}] = next + k, next += k == 15 ? 16 : 0;
  if (count - next > 4)
    for (int k = 0; k < 8; ++k) reads[{30 + k, 0}] = next + k, next += k == 7 ? 8 : 0;
  if (count - next > 0)
    for (int k = 0; k < 4; ++k) reads[{40 + k, 0}] = next + k;
  return reads;
}

/// Sectors of 32 bytes that the warps of a kernel touch, by request.
using Requests = std::map<std::vector<Offset>, std::set<Offset>>;

Offset sectors_in(const Requests& requests) {
  Offset sum = 0;
  for (const auto& [request, sectors] : requests) sum += std::ssize(sectors);
  return sum;
}

/// The requests of threads that walk through lists: 0, 1: offsets, 2: an array along the lists, 3: records.
Requests requests_of(const std::vector<std::vector<Offset>>& lists, int lanes, int record_bytes) {
  Requests requests;
  Offset begin = 0;
  for (std::size_t list = 0; list < lists.size(); ++list) {
    for (int lane = 0; lane < lanes; ++lane) {
      const auto thread = static_cast<Offset>(list * lanes) + lane;
      const Offset warp = thread / 32;
      requests[{warp, 0}].insert(4 * static_cast<Offset>(list) / 32);
      requests[{warp, 1}].insert(4 * static_cast<Offset>(list + 1) / 32);
      const Offset count = (std::ssize(lists[list]) - lane + lanes - 1) / lanes;
      for (const auto& [place, k] : unrolled(std::max<Offset>(0, count))) {
        const Offset entry = lane + k * lanes;
        requests[{warp, 2, place.first, place.second}].insert(4 * (begin + entry) / 32);
        requests[{warp, 3, place.first, place.second}].insert(lists[list][entry] * record_bytes / 32);
      }
    }
    begin += std::ssize(lists[list]);
  }
  return requests;
}

TEST(GpuProductCost, CountsTheSectorsOfAllLoads) {
  for (const CsrGraph& graph : {test::random_connected(500, 3000, 1), test::grid(9, 11), test::star(70)}) {
    std::vector<std::vector<Offset>> rows;
    for (Index v = 0; v < graph.size(); ++v) {
      rows.emplace_back(graph[v].begin(), graph[v].end());
      rows.back().insert(std::ranges::lower_bound(rows.back(), v), v);
    }
    for (const int lanes : {1, 2, 4, 8, 16, 32}) {
      SCOPED_TRACE(lanes);
      const GpuCost cost = gpu_product_cost({graph.offsets, graph.neighbours}, lanes);
      const Requests requests = requests_of(rows, lanes, 4);
      Requests values;  // values are read like columns
      for (const auto& [request, sectors] : requests)
        if (request[1] == 2) values[request] = sectors;
      EXPECT_EQ(cost.sectors, sectors_in(requests) + sectors_in(values));
      EXPECT_EQ(cost.requests, std::ssize(requests) + std::ssize(values));
      const Offset entries = std::ssize(graph.neighbours) + graph.size();
      EXPECT_EQ(cost.dram_floor, 8 * entries + 4 * (graph.size() + 1) + 32 * ((graph.size() + 7) / 8));
      EXPECT_EQ(cost.dram_bytes, cost.dram_floor) << "all fits in the cache";
      EXPECT_EQ(gpu_product_cost({graph.offsets, graph.neighbours}, lanes, kGpuCacheBytes, {.threads = 1}),
                cost);
    }
  }
}

TEST(GpuCost, OfPatchesIsThatOfTheirVertices) {
  const Mesh mesh = unordered_grid();
  const CellsView cells = view(mesh).cells;
  const Patches cut = patches(cells, mesh.points.size());
  std::map<std::vector<Offset>, std::set<Offset>> requests;
  for (std::size_t p = 0; p < cut.count(); ++p) {
    const auto own = cut.vertices_of(p);
    for (std::size_t i = 0; i < own.size(); ++i)
      for (Offset k = 0; k < 3; ++k)
        requests[{static_cast<Offset>(p), static_cast<Offset>(i / 32), k}].insert((12 * own[i] + 4 * k) / 32);
  }
  const GpuCost cost = gpu_cost(cells, mesh.points.size(), GpuLayout::patches);
  EXPECT_EQ(cost.sectors, sectors_in(requests));
  EXPECT_EQ(cost.requests, std::ssize(requests));
  EXPECT_LT(cost.floor, cost.sectors);
  EXPECT_LT(cost.sectors, gpu_cost(cells, mesh.points.size(), GpuLayout::packed).sectors);
}

TEST(GpuCost, OfGatherListsIsThatOfBothPasses) {
  const Mesh mesh = unordered_grid();
  std::vector<std::vector<Offset>> lists(mesh.points.size());
  for (Index c = 0; c < mesh.cell_count(); ++c)
    for (int a = 0; a < 4; ++a) lists[mesh.cells[c][a]].push_back(4 * c + a);
  const Requests loads = requests_of(lists, 1, 16);
  const Offset stores = 2 * mesh.cell_count();
  const GpuCost cost = gpu_cost(view(mesh).cells, mesh.points.size(), GpuLayout::gathered);
  EXPECT_EQ(cost.sectors, sectors_in(loads) + stores);
  EXPECT_EQ(cost.requests, std::ssize(loads) + 4 * ((mesh.cell_count() + 31) / 32));
  EXPECT_LE(cost.floor, cost.sectors);
}

TEST(GpuCost, FetchesASectorOnceInEachFillingOfTheCache) {
  const Mesh mesh = unordered_grid();
  const CellsView cells = view(mesh).cells;
  const std::size_t n = mesh.points.size();
  constexpr Offset kCache = 20'000;
  Offset bytes = 0;
  Offset filled = 0;
  std::set<Offset> held;
  const auto fetch = [&](Offset more) {
    bytes += more;
    filled += more;
    if (filled < kCache) return;
    filled = 0;
    held.clear();
  };
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    fetch(16);
    for (const Index v : mesh.cells[c]) {
      for (const Offset sector : std::set<Offset>{12 * Offset{v} / 32, (12 * Offset{v} + 11) / 32}) {
        if (held.count(sector) > 0) continue;
        held.insert(sector);
        fetch(2 * 32);
      }
    }
  }
  const GpuCost cost = gpu_cost(cells, n, GpuLayout::packed, kCache);
  EXPECT_EQ(cost.dram_bytes, bytes);
  EXPECT_GT(cost.dram_bytes, 2 * cost.dram_floor);
  for (const GpuLayout layout : kGpuLayouts) {
    const GpuCost small = gpu_cost(cells, n, layout, kCache);
    const GpuCost large = gpu_cost(cells, n, layout);
    EXPECT_GT(small.dram_bytes, large.dram_bytes);
    const Offset of_lists = 4 * (std::ssize(patches(cells, n).vertices) - static_cast<Offset>(n));
    EXPECT_EQ(large.dram_bytes, large.dram_floor + (layout == GpuLayout::patches ? of_lists : 0))
        << "all fits in the cache";
    EXPECT_EQ(small.dram_floor, large.dram_floor);
    EXPECT_EQ(small.sectors, large.sectors);
  }
}

TEST(GpuCost, LayoutsAreKnownByName) {
  for (const GpuLayout layout : kGpuLayouts) EXPECT_EQ(parse_gpu_layout(to_string(layout)), layout);
  EXPECT_THAT(refusal([] { (void)parse_gpu_layout("paded"); }), HasSubstr("padded"));
}

TEST(GpuCost, OfNothingIsNothing) {
  for (const GpuLayout layout : kGpuLayouts) EXPECT_EQ(gpu_cost({}, 0, layout), GpuCost{});
  EXPECT_EQ(gpu_product_cost({}), GpuCost{});
}

TEST(GpuCost, IsRefusedWithTheFault) {
  const Mesh mesh = unordered_grid();
  const CellsView cells = view(mesh).cells;
  const std::size_t n = mesh.points.size();
  EXPECT_THAT(refusal([&] { (void)gpu_cost(cells, n, GpuLayout::packed, 0); }),
              HasSubstr("a cache of 0 bytes"));
  const CsrGraph graph = test::grid(3, 3);
  const GraphView view{graph.offsets, graph.neighbours};
  EXPECT_THAT(refusal([&] { (void)gpu_product_cost(view, 1, 0); }), HasSubstr("a cache of 0 bytes"));
  for (const int lanes : {-1, 0, 3, 64})
    EXPECT_THAT(refusal([&] { (void)gpu_product_cost(view, lanes); }),
                HasSubstr("give 1, 2, 4, 8, 16 or 32"));
}

}  // namespace
}  // namespace meshorder
