// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/output_file.hpp"
#include "io/stream/text.hpp"
#include <meshorder/number_view.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string_view>

namespace meshorder {

/// Makes rows of text on all threads and writes them in order; one thread writes while the others make the
/// next rows. The bytes do not depend on the number of threads.
///
/// @param rows  `rows(text, begin, end)` appends rows begin … end−1
/// @note Memory: 1 MB or so for each thread.
void write_row_ranges(OutputFile& out, Index count, const std::function<void(Text&, Index, Index)>& rows);

/// As `write_row_ranges`; `row(text, i)` appends row i.
template <class Row>
void write_rows(OutputFile& out, Index count, const Row& row) {
  write_row_ranges(out, count, [&row](Text& text, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) row(text, i);
  });
}

/// Writes `count` numbers in rows of `in_line`; there must be fewer than 2³¹ rows.
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
