// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

/// Writes rows of text, made on all threads, in their order; one of the threads writes while the others make
/// the next ones. The same bytes on any number of threads.
///
/// @param row  `row(text, i)` appends row i
/// @note Memory: 1 MB or so for each thread.
template <class Row>
void write_rows(OutputFile& out, Index count, const Row& row) {
  constexpr Index kRows = 4096;             // about 100 kB, which a cache holds
  const Index chunks = 4 * thread_count();  // made before they are written
  if (count <= kRows) {
    Text text;
    for (Index i = 0; i < count; ++i) row(text, i);
    out.write(text.view());
    return;
  }
  std::vector<Text> made;
  std::vector<Text> written;
  for (Index first = 0; first < count || !made.empty();) {
    std::swap(made, written);
    const Index rows = std::min(count - first, kRows * chunks);
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

/// Writes `count` numbers, `in_line` on each line, made as the rows are.
///
/// @param number  `number(text, before, i)` appends `before` and number i
template <class Number>
void write_lines(OutputFile& out, std::size_t count, std::size_t in_line, const Number& number) {
  write_rows(out, static_cast<Index>((count + in_line - 1) / in_line), [&](Text& text, Index line) {
    const std::size_t first = static_cast<std::size_t>(line) * in_line;
    for (std::size_t i = first; i < std::min(first + in_line, count); ++i) {
      number(text, i == first ? "" : " ", i);
    }
    text.write("\n");
  });
}

}  // namespace meshorder
