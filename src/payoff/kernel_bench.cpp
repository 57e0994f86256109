// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/kernel_bench.hpp"

#include "payoff/plain_bench.hpp"
#include "payoff/product_bench.hpp"
#include "payoff/tuned_bench.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meshorder {

std::span<const Kernel> kernels_of(const Mesh& mesh) {
  if (stored_matrix(mesh) != nullptr) return kProductsAlone;
  return kKernels;
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
