// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace meshorder {

/// Writes rows of text, made on all threads, in their order; one of the threads writes while the others make
/// the next ones. The same bytes on any number of threads.
///
/// @param row  `row(text, i)` appends row i
/// @note Memory: 16 MB or so.
template <class Row>
void write_rows(OutputFile& out, Index count, const Row& row) {
  constexpr Index kRows = 4096;  // about 100 kB, which a cache holds
  constexpr Index kChunks = 64;  // made before they are written
  std::vector<Text> made;
  std::vector<Text> written;
  for (Index first = 0; first < count || !made.empty();) {
    std::swap(made, written);
    const Index rows = std::min(count - first, kRows * kChunks);
    made.resize(static_cast<std::size_t>(chunk_count(rows, kRows)));
    parallel_loop(index_size(made) + 1, [&](Index turn) {
      if (turn == 0) {
        for (const Text& text : written) out.write(text.view());
        return;
      }
      Text& text = made[static_cast<std::size_t>(turn - 1)];
      text.clear();
      const Index begin = first + (turn - 1) * kRows;
      const Index end = begin + std::min(kRows, first + rows - begin);
      for (Index i = begin; i < end; ++i) row(text, i);
    });
    first += rows;
  }
}

}  // namespace meshorder
