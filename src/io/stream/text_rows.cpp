// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/text_rows.hpp"

#include "base/parallel.hpp"

#include <utility>
#include <vector>

namespace meshorder {

void write_row_ranges(OutputFile& out, Index count, const std::function<void(Text&, Index, Index)>& rows) {
  constexpr Index kRows = 4096;             // about 100 kB, which a cache holds
  const Index chunks = 4 * thread_count();  // chunks in a batch, which is written when all are made
  if (count <= kRows) {
    Text text;
    rows(text, 0, count);
    return out.write(text.view());
  }
  std::vector<Text> made;
  std::vector<Text> written;
  for (Index first = 0; first < count || !made.empty();) {
    std::swap(made, written);
    const Index next = std::min(count - first, kRows * chunks);
    made.resize(static_cast<std::size_t>(chunk_count(next, kRows)));
    parallel_loop(index_size(made) + 1, [&](Index turn) {
      if (turn == 0) {
        for (const Text& text : written) out.write(text.view());
        return;
      }
      Text& text = made[static_cast<std::size_t>(turn - 1)];
      text.clear();
      const Index begin = first + (turn - 1) * kRows;
      rows(text, begin, begin + std::min(kRows, first + next - begin));
    });
    first += next;
  }
}

}  // namespace meshorder
