// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/parallel.hpp>
#include <meshorder/sim/contact/halving.hpp>
#include <meshorder/sim/contact/inside_tetrahedron.hpp>
#include <meshorder/sim/contact/tetrahedron_leaves.hpp>
#include <meshorder/sim/contact/tetrahedron_search.hpp>
#include <meshorder/sim/contact/vectors.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>

namespace meshorder {
namespace {

constexpr Index kBranchesAtOnce = 16;  // and clusters: what a thread takes together
constexpr Index kLeavesAtOnce = 256;

/// The tetrahedra that are not flat at `points`, their corners turning like the unit tetrahedron's, in the
/// order of leaves.
struct SortedTetrahedra {
  std::vector<std::array<Index, 4>> corners;
  std::vector<Index> numbers;
};

SortedTetrahedra sorted_tetrahedra(const Simplices& simplices, std::span<const Point> points) {
  std::vector<std::array<Index, 4>> corners;
  std::vector<Index> numbers;
  std::vector<Point> centers;
  for (Index t = 0; t < static_cast<Index>(simplices.size()); ++t) {
    std::array<Index, 4> at{};
    std::copy_n(simplices.vertices.begin() + Offset{4} * t, 4, at.begin());
    const auto center_inside = [&] {
      const std::array<Point, 4> p{points[at[0]], points[at[1]], points[at[2]], points[at[3]]};
      Point center{};
      for (const Point& corner : p) center = plus_scaled(center, 0.25, corner);
      return weights_inside(center, p).has_value() ? std::optional(center) : std::nullopt;
    };
    std::optional<Point> center = center_inside();
    if (!center) {
      std::swap(at[2], at[3]);
      center = center_inside();
    }
    if (!center) continue;
    corners.push_back(at);
    numbers.push_back(t);
    centers.push_back(*center);
  }
  std::vector<Index> order(corners.size());
  std::iota(order.begin(), order.end(), Index{0});
  sort_into_runs(order, kLeaf * kLeaf, centers);
  for (std::size_t first = 0; first < order.size(); first += kLeaf * kLeaf) {
    const std::size_t count = std::min(order.size() - first, std::size_t{kLeaf * kLeaf});
    sort_into_runs(std::span(order).subspan(first, count), kLeaf, centers);
  }
  SortedTetrahedra result;
  for (const Index i : order) {
    result.corners.push_back(corners[i]);
    result.numbers.push_back(numbers[i]);
  }
  return result;
}

}  // namespace

struct TetrahedronSearch::State {
  State(const SortedTetrahedra& sorted, std::span<const Point> points, std::span<const Index> sought)
      : tetrahedra(sorted.corners, sorted.numbers), vertices(sought.begin(), sought.end()) {
    sort_into_runs(vertices, PointCluster::kMost, points);
    const Index count = (index_size(vertices) + PointCluster::kMost - 1) / PointCluster::kMost;
    searches.resize(count);
    for (Index c = 0; c < count; ++c) {
      const Index first = PointCluster::kMost * c;
      searches[c].cluster.vertices =
          std::span(vertices).subspan(first, std::min(PointCluster::kMost, index_size(vertices) - first));
    }
    places.assign(
        sorted.numbers.empty() ? 0 : *std::max_element(sorted.numbers.begin(), sorted.numbers.end()) + 1, -1);
    for (std::size_t i = 0; i < sorted.numbers.size(); ++i) places[sorted.numbers[i]] = static_cast<Index>(i);
    wanted = std::vector<std::atomic<bool>>(tetrahedra.leaves);
  }

  /// What is looked for together, and what was found.
  struct Search {
    PointCluster cluster;
    std::vector<Index> branches;
    std::vector<LeafTask> tasks;
    std::vector<LeafHit> hits;
    std::vector<VertexInside> inside;
  };

  TetrahedronLeaves tetrahedra;
  std::vector<Index> vertices;  ///< in clusters
  std::vector<Search> searches;
  std::vector<Index> places;  ///< of the tetrahedra by their numbers; −1 for those that are flat
  std::vector<std::atomic<bool>> wanted;  ///< leaves in whose box there are points

  void collect_tasks(Search& search, std::span<const double> positions) {
    update_cluster(search.cluster, positions);
    branches_at(tetrahedra, search.cluster, search.branches);
    search.tasks.clear();
    for (const Index branch : search.branches)
      leaves_at(tetrahedra, branch, search.cluster, ~std::uint64_t{0}, search.tasks);
    for (const LeafTask& task : search.tasks) wanted[task.leaf].store(true, std::memory_order_relaxed);
  }

  [[nodiscard]] std::array<Index, 4> corners_at(Index place) const {
    const Index* const first =
        tetrahedra.corners.data() + Offset{4} * kLeaf * (place / kLeaf) + place % kLeaf;
    return {first[0], first[kLeaf], first[2 * kLeaf], first[3 * kLeaf]};
  }

  void work_off(Search& search, std::span<const double> positions) const {
    search.hits.clear();
    search.inside.clear();
    for (const LeafTask& task : search.tasks)
      hits_of(tetrahedra, search.cluster, task, positions, search.hits);
    for (const LeafHit& hit : search.hits) {
      const Index vertex = search.cluster.vertices[hit.point];
      for (std::uint32_t lanes = hit.lanes; lanes != 0; lanes &= lanes - 1) {
        const Index place = kLeaf * hit.leaf + std::countr_zero(lanes);
        if (tetrahedra.numbers[place] < 0) continue;
        std::array<Point, 4> at{};
        const std::array<Index, 4> corners = corners_at(place);
        for (int k = 0; k < 4; ++k) at[k] = point_of(positions, corners[k]);
        if (const auto weights = weights_inside(point_of(positions, vertex), at))
          search.inside.push_back({vertex, tetrahedra.numbers[place], *weights});
      }
    }
  }
};

TetrahedronSearch::TetrahedronSearch(const Simplices& simplices, std::span<const Point> points,
                                     std::span<const Index> vertices)
    : state_(std::make_unique<State>(sorted_tetrahedra(simplices, points), points, vertices)) {}
TetrahedronSearch::~TetrahedronSearch() = default;
TetrahedronSearch::TetrahedronSearch(TetrahedronSearch&&) noexcept = default;
TetrahedronSearch& TetrahedronSearch::operator=(TetrahedronSearch&&) noexcept = default;

void TetrahedronSearch::find(std::span<const double> positions, std::vector<VertexInside>& inside) {
  State& state = *state_;
  TetrahedronLeaves& tetrahedra = state.tetrahedra;
  const Index searches = index_size(state.searches);
  for_each_chunk(tetrahedra.branches, kBranchesAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index branch = begin; branch < end; ++branch) update_boxes(tetrahedra, branch, positions);
  });
  for_each_chunk(searches, kBranchesAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index s = begin; s < end; ++s) state.collect_tasks(state.searches[s], positions);
  });
  for_each_chunk(tetrahedra.leaves, kLeavesAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index leaf = begin; leaf < end; ++leaf) {
      if (state.wanted[leaf].exchange(false, std::memory_order_relaxed))
        update_planes(tetrahedra, leaf, positions);
    }
  });
  for_each_chunk(searches, kBranchesAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index s = begin; s < end; ++s) state.work_off(state.searches[s], positions);
  });
  inside.clear();
  for (const State::Search& search : state.searches)
    inside.insert(inside.end(), search.inside.begin(), search.inside.end());
  std::sort(inside.begin(), inside.end(), [](const VertexInside& a, const VertexInside& b) {
    return a.vertex < b.vertex || (a.vertex == b.vertex && a.tetrahedron < b.tetrahedron);
  });
}

std::array<Index, 4> TetrahedronSearch::corners(Index tetrahedron) const {
  return state_->corners_at(state_->places[tetrahedron]);
}

std::size_t TetrahedronSearch::bytes() const {
  std::size_t sum =
      state_->tetrahedra.bytes() + (state_->vertices.capacity() + state_->places.capacity()) * sizeof(Index) +
      state_->wanted.size() * sizeof(state_->wanted[0]) + state_->searches.capacity() * sizeof(State::Search);
  for (const State::Search& search : state_->searches) {
    sum += search.branches.capacity() * sizeof(Index) + search.tasks.capacity() * sizeof(LeafTask) +
           search.hits.capacity() * sizeof(LeafHit) + search.inside.capacity() * sizeof(VertexInside);
  }
  return sum;
}

}  // namespace meshorder
