// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/tetrahedron_search.hpp"

#include "base/parallel.hpp"
#include "kernels/positions.hpp"
#include "lab/contact/geometry/box_tree.hpp"
#include "lab/contact/geometry/simplex_point.hpp"
#include "lab/contact/search/branch_motions.hpp"
#include "lab/contact/search/clearances.hpp"
#include "lab/contact/search/leaf_planes.hpp"
#include "lab/contact/search/tetrahedron_leaves.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <optional>

namespace meshorder {
namespace {

constexpr Index kBranchesAtOnce = 16;  // branches, or clusters, in a task
constexpr Index kLeavesAtOnce = 256;

/// The tetrahedra that are not flat at `points`, in the order of leaves. Corners are in the sequence that
/// gives a positive volume at `points`.
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
  sort_into_runs(order, kLeaf * kBranch, centers);
  for (std::size_t first = 0; first < order.size(); first += kLeaf * kBranch) {
    const std::size_t count = std::min(order.size() - first, std::size_t{kLeaf * kBranch});
    sort_into_runs(std::span(order).subspan(first, count), kLeaf, centers);
  }
  SortedTetrahedra result;
  for (const Index i : order) {
    result.corners.push_back(corners[i]);
    result.numbers.push_back(numbers[i]);
  }
  return result;
}

std::vector<PointCluster> clusters_of(std::span<const Index> vertices, std::span<const Point> points) {
  std::vector<Index> sorted(vertices.begin(), vertices.end());
  sort_into_runs(sorted, PointCluster::kMaxPoints, points);
  std::vector<PointCluster> clusters;
  for (std::size_t first = 0; first < sorted.size(); first += PointCluster::kMaxPoints) {
    const std::size_t count = std::min(sorted.size() - first, std::size_t{PointCluster::kMaxPoints});
    clusters.emplace_back(std::span(sorted).subspan(first, count));
  }
  return clusters;
}

/// Calls `work(i)` for i = 0 … n − 1, on all threads.
template <class Work>
void for_each_number(Index n, Index at_once, Work work) {
  for_each_chunk(n, at_once, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) work(i);
  });
}

}  // namespace

struct TetrahedronSearch::State {
  State(const SortedTetrahedra& sorted, const Simplices& simplices, std::span<const Point> points,
        std::span<const Index> vertices)
      : tetrahedra(sorted.corners, sorted.numbers),
        clusters(clusters_of(vertices, points)),
        motions(tetrahedra, points),
        clearances(tetrahedra, motions, clusters, points),
        searches(clusters.size()),
        places(simplices.size(), -1),
        wanted_branches(tetrahedra.branches),
        wanted_leaves(tetrahedra.leaves) {
    for (std::size_t i = 0; i < sorted.numbers.size(); ++i) places[sorted.numbers[i]] = static_cast<Index>(i);
  }

  /// A branch, and the points of a cluster that may be in its tetrahedra.
  struct BranchTask {
    Index branch = 0;
    std::uint64_t points = 0;
  };
  /// The tasks and the results of a cluster.
  struct Search {
    std::vector<Index> branches;
    std::vector<BranchTask> branch_tasks;
    std::vector<LeafTask> leaf_tasks;
    std::vector<LeafHit> hits;
    std::vector<VertexInside> inside;
  };

  TetrahedronLeaves tetrahedra;
  std::vector<PointCluster> clusters;
  BranchMotions motions;
  Clearances clearances;
  std::vector<Search> searches;  ///< one for each cluster
  std::vector<Index> places;  ///< for each tetrahedron's number: its place in the leaves; −1 if it is flat
  std::vector<std::atomic<bool>> wanted_branches;
  std::vector<std::atomic<bool>> wanted_leaves;

  void find_branches(Index c, std::span<const double> positions) {
    Search& search = searches[c];
    PointCluster& cluster = clusters[c];
    update_points(cluster, positions);
    branches_at(tetrahedra, cluster, search.branches);
    search.branch_tasks.clear();
    for (const Index branch : search.branches) {
      const std::uint64_t points = clearances.in_doubt(c, branch, cluster, motions);
      if (points == 0) continue;
      search.branch_tasks.push_back({branch, points});
      wanted_branches[branch].store(true, std::memory_order_relaxed);
    }
  }

  void find_leaves(Index c) {
    Search& search = searches[c];
    search.leaf_tasks.clear();
    for (const BranchTask& task : search.branch_tasks)
      leaves_at(tetrahedra, task.branch, clusters[c], task.points, search.leaf_tasks);
    for (const LeafTask& task : search.leaf_tasks)
      wanted_leaves[task.leaf].store(true, std::memory_order_relaxed);
  }

  void test_points(Index c, std::span<const double> positions) {
    Search& search = searches[c];
    search.hits.clear();
    search.inside.clear();
    for (const LeafTask& task : search.leaf_tasks)
      hits_of(tetrahedra, clusters[c], task, positions, search.hits);
    for (const LeafHit& hit : search.hits) {
      const Index vertex = clusters[c].vertices[hit.point];
      for (std::uint32_t lanes = hit.lanes; lanes != 0; lanes &= lanes - 1) {
        const Index place = kLeaf * hit.leaf + std::countr_zero(lanes);
        if (tetrahedra.numbers[place] < 0) continue;
        const std::array<Index, 4> corners = corners_at(place);
        std::array<Point, 4> at{};
        for (int k = 0; k < 4; ++k) at[k] = point_of(positions, corners[k]);
        if (const auto weights = weights_inside(point_of(positions, vertex), at))
          search.inside.push_back({vertex, tetrahedra.numbers[place], *weights});
      }
    }
  }

  [[nodiscard]] std::array<Index, 4> corners_at(Index place) const {
    const Index* const first =
        tetrahedra.corners.data() + Offset{4} * kLeaf * (place / kLeaf) + place % kLeaf;
    return {first[0], first[kLeaf], first[2 * kLeaf], first[3 * kLeaf]};
  }
};

TetrahedronSearch::TetrahedronSearch(const Simplices& simplices, std::span<const Point> points,
                                     std::span<const Index> vertices)
    : state_(std::make_unique<State>(sorted_tetrahedra(simplices, points), simplices, points, vertices)) {}
TetrahedronSearch::~TetrahedronSearch() = default;
TetrahedronSearch::TetrahedronSearch(TetrahedronSearch&&) noexcept = default;
TetrahedronSearch& TetrahedronSearch::operator=(TetrahedronSearch&&) noexcept = default;

void TetrahedronSearch::find(std::span<const double> positions, std::vector<VertexInside>& inside) {
  State& state = *state_;
  TetrahedronLeaves& tetrahedra = state.tetrahedra;
  const Index clusters = index_size(state.clusters);
  for_each_number(tetrahedra.branches, kBranchesAtOnce,
                  [&](Index branch) { state.motions.update(branch, positions, tetrahedra); });
  for_each_number(clusters, kBranchesAtOnce, [&](Index c) { state.find_branches(c, positions); });
  for_each_number(tetrahedra.branches, kBranchesAtOnce, [&](Index branch) {
    if (state.wanted_branches[branch].exchange(false, std::memory_order_relaxed))
      update_boxes(tetrahedra, branch, positions);
  });
  for_each_number(clusters, kBranchesAtOnce, [&](Index c) { state.find_leaves(c); });
  for_each_number(tetrahedra.leaves, kLeavesAtOnce, [&](Index leaf) {
    if (state.wanted_leaves[leaf].exchange(false, std::memory_order_relaxed))
      update_planes(tetrahedra, leaf, positions);
  });
  for_each_number(clusters, kBranchesAtOnce, [&](Index c) { state.test_points(c, positions); });

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
  std::size_t sum = state_->tetrahedra.bytes() + state_->motions.bytes() + state_->clearances.bytes() +
                    state_->places.capacity() * sizeof(Index) +
                    state_->clusters.capacity() * sizeof(PointCluster) +
                    state_->searches.capacity() * sizeof(State::Search);
  for (const State::Search& search : state_->searches) {
    sum += search.branches.capacity() * sizeof(Index) +
           search.branch_tasks.capacity() * sizeof(State::BranchTask) +
           search.leaf_tasks.capacity() * sizeof(LeafTask) + search.hits.capacity() * sizeof(LeafHit) +
           search.inside.capacity() * sizeof(VertexInside);
  }
  return sum;
}

}  // namespace meshorder
