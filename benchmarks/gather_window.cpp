// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// gather_window [ROWS, default 46316]: times the product with a matrix of 12 blocks a row, whose columns are
// chosen at random among the rows at most w away, for several w: best and median milliseconds of 25 runs. The
// matrices differ only in these columns, so times differ only by where the product gathers from.
#include "base/median.hpp"
#include "base/random.hpp"
#include "base/stopwatch.hpp"
#include "kernels/block_csr.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace mo = meshorder;

namespace {

constexpr int kRowBlocks = 12;
constexpr int kRuns = 25;

/// Chooses the columns of each row anew, ascending, at most `window` rows away.
void choose_columns(mo::BlockCsr& matrix, mo::Index window) {
  mo::Random random(1);
  for (mo::Index row = 0; row < matrix.size(); ++row) {
    const mo::Index first = std::max<mo::Index>(0, row - window);
    const mo::Index last = std::min(matrix.size() - 1, row + window);
    const auto begin = matrix.columns.begin() + matrix.offsets[row];
    const auto end = matrix.columns.begin() + matrix.offsets[row + 1];
    std::generate(begin, end, [&] {
      return first + static_cast<mo::Index>(random.below(static_cast<std::uint64_t>(last - first) + 1));
    });
    std::sort(begin, end);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const mo::Index rows = argc > 1 ? std::atoi(argv[1]) : 46316;
  mo::BlockCsr matrix;
  const auto blocks = static_cast<std::size_t>(rows) * kRowBlocks;
  for (mo::Index row = 1; row <= rows; ++row) matrix.offsets.push_back(mo::Offset{kRowBlocks} * row);
  matrix.columns.resize(blocks);
  matrix.values.assign(9 * blocks, 0.125);
  const mo::AlignedVector<double> x(3 * static_cast<std::size_t>(rows), 1.0);
  mo::AlignedVector<double> y(x.size());
  fmt::print("{} rows, {:.0f} MB of matrix\n{:>10}{:>12}{:>12}\n", rows, 76e-6 * static_cast<double>(blocks),
             "w", "best ms", "median");
  for (const mo::Index window : {8, 64, 256, 1024, 4096, 16384, rows}) {
    choose_columns(matrix, window);
    std::vector<double> times;
    for (int run = 0; run < kRuns; ++run) {
      const mo::Stopwatch watch;
      multiply(matrix, x, y);
      times.push_back(1e3 * watch.seconds());
    }
    fmt::print("{:>10}{:>12.3f}{:>12.3f}\n", window, *std::min_element(times.begin(), times.end()),
               mo::median(times));
  }
}
