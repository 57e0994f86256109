// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/product_bench.hpp"

#include "base/parallel.hpp"
#include "kernels/owned_batches.hpp"
#include "kernels/plain.hpp"
#include <meshorder/error.hpp>

#include <numeric>
#include <string>
#include <utility>

namespace meshorder {

ProductBench::ProductBench(EntryPattern pattern)
    : pattern_(std::move(pattern)),
      values_(pattern_.columns.size(), 1.0),
      x_(static_cast<std::size_t>(pattern_.rows())),
      y_(x_.size()) {
  std::iota(x_.begin(), x_.end(), 1.0);
}

std::span<const Kernel> ProductBench::kernels() const { return kProductsAlone; }

void ProductBench::share(int threads) {
  bounds_ = threads < 2 ? std::vector<Index>() : balanced_ranges(pattern_.starts, threads);
}

void ProductBench::run_rows(Index begin, Index end) {
  const std::span<const Offset> starts = pattern_.starts;
  plain::multiply(plain::Matrix<double, Index, Offset>{starts.subspan(begin), pattern_.columns, values_},
                  std::span<const double>(x_),
                  std::span(y_).subspan(begin, static_cast<std::size_t>(end) - begin));
}

void ProductBench::compute(Kernel kernel) {
  if (kernel != Kernel::spmv) {
    throw InvalidArgument("kernels: a matrix has no kernel '" + std::string(to_string(kernel)) + "'");
  }
  if (bounds_.empty()) return run_rows(0, pattern_.rows());
  for_each_part(index_size(bounds_) - 1, [&](Index part) { run_rows(bounds_[part], bounds_[part + 1]); });
}

std::span<const double> ProductBench::result(Kernel /*kernel*/) const { return y_; }

double ProductBench::streamed_bytes(Kernel /*kernel*/) const { return static_cast<double>(bytes()); }

std::size_t ProductBench::bytes() const {
  return bytes_of(values_) + bytes_of(pattern_.columns) + bytes_of(pattern_.starts) + bytes_of(x_) +
         bytes_of(y_);
}

}  // namespace meshorder
