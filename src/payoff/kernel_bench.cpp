// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/kernel_bench.hpp"

#include "kernels/owned_batches.hpp"
#include "payoff/plain_bench.hpp"
#include "payoff/product_bench.hpp"
#include "payoff/tuned_bench.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace meshorder {
namespace {

/// Counts elements or edges, and how often threads compute them.
class WorkCount {
 public:
  WorkCount(const CsrGraph& graph, int threads) {
    // a row of the matrix has an entry for each neighbour and one for the diagonal
    std::vector<Offset> rows(graph.offsets.begin(), graph.offsets.end());
    for (std::size_t v = 0; v < rows.size(); ++v) rows[v] += static_cast<Offset>(v);
    bounds_ = balanced_ranges(rows, threads);
  }

  void add(std::span<const Index> vertices) {
    owners_of(vertices, bounds_, owners_);
    computed_ += static_cast<Offset>(owners_.size());
    ++count_;
  }

  [[nodiscard]] double mean() const {
    return count_ == 0 ? 1 : static_cast<double>(computed_) / static_cast<double>(count_);
  }

 private:
  std::vector<Index> bounds_;
  std::vector<Index> owners_;
  Offset count_ = 0;
  Offset computed_ = 0;
};

}  // namespace

std::span<const Kernel> kernels_of(const Mesh& mesh) {
  if (stored_matrix(mesh) != nullptr) return kProductsAlone;
  return kKernels;
}

void KernelBench::run(Kernel kernel) {
  if (kernel == Kernel::spmv && !assembled_ && std::ranges::count(kernels(), Kernel::assembly) > 0) {
    run(Kernel::assembly);
  }
  compute(kernel);
  assembled_ = assembled_ || kernel == Kernel::assembly;
}

double KernelBench::run_stretches(Kernel kernel) {
  const double share = compute_stretches(kernel);
  assembled_ = assembled_ || (kernel == Kernel::assembly && share > 0);
  return share;
}

std::unique_ptr<KernelBench> prepare_kernels(KernelSet kernels, const KernelInput& input, int threads) {
  std::unique_ptr<KernelBench> bench;
  if (input.is_matrix()) {
    if (kernels == KernelSet::tuned) {
      throw InvalidArgument("kernels: a matrix has only the plain product; tuned kernels are for meshes");
    }
    bench = std::make_unique<ProductBench>(input.pattern());
  } else if (kernels == KernelSet::plain) {
    bench = std::make_unique<PlainBench>(input);
  } else {
    bench = std::make_unique<TunedBench>(input);
  }
  bench->share(threads);
  return bench;
}

double times_computed(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int threads) {
  if (threads <= 1 || kernel == Kernel::spmv) return 1;
  WorkCount count(graph, threads);
  if (kernel == Kernel::springs) {
    for (Index a = 0; a < graph.size(); ++a) {
      for (const Index b : graph[a]) {
        if (b > a) count.add(std::array{a, b});
      }
    }
  } else {
    const std::size_t corners = static_cast<std::size_t>(simplices.dimension) + 1;
    for (std::size_t first = 0; first + corners <= simplices.vertices.size(); first += corners)
      count.add(simplices.vertices.subspan(first, corners));
  }
  return count.mean();
}

std::vector<Point> displaced(std::span<const Point> points) {
  std::vector<Point> result(points.begin(), points.end());
  if (points.empty()) return result;
  Point low = points.front();
  Point high = points.front();
  for (const Point& point : points) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], point[c]);
      high[c] = std::max(high[c], point[c]);
    }
  }
  const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  const double wave = size > 0.0 ? 3.0 * std::numbers::pi / size : 0.0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      const double along = points[v][(c + 1) % 3] - low[(c + 1) % 3];
      result[v][c] += 0.02 * size * std::sin(wave * along + 1.0 + c) + 0.03 * (points[v][c] - low[c]);
    }
  }
  return result;
}

}  // namespace meshorder
