// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/row_chunks.hpp"

#include <bit>
#include <cstdint>

namespace meshorder {
namespace {

constexpr Index kChunks = 16;  // enough for most desktops; at most 32: a word holds a set of chunks as bits
constexpr Index kFewColours = 3;

}  // namespace

RowChunks::RowChunks(const Laplacian& laplacian, Index least_rows) : rows_(laplacian.size()) {
  const auto rows = static_cast<std::uint32_t>(std::max(least_rows, chunk_count(rows_, kChunks)));
  shift_ = static_cast<int>(std::bit_width(rows - 1));

  // the chunks that each chunk has edges to, as bits
  std::vector<std::uint32_t> touched(count(), 0);
  for_each([&](Index chunk, Index begin, Index end) {
    for (Offset k = laplacian.offsets[begin]; k < laplacian.offsets[end]; ++k) {
      touched[chunk] |= std::uint32_t{1} << chunk_of(laplacian.neighbours[k]);
    }
  });

  std::vector<std::uint32_t> members;  // the chunks of each colour, as bits
  for (Index chunk = 0; chunk < count(); ++chunk) {
    std::size_t colour = 0;
    while (colour < members.size() && (members[colour] & touched[chunk]) != 0) ++colour;
    if (colour == members.size()) {
      members.push_back(0);
      colours_.emplace_back();
    }
    members[colour] |= std::uint32_t{1} << chunk;
    colours_[colour].push_back(chunk);
  }
  if (index_size(colours_) > std::max(kFewColours, count() / 4)) *this = whole(rows_);
}

RowChunks RowChunks::whole(Index rows) {
  RowChunks one;
  one.rows_ = rows;
  one.shift_ = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(std::max(rows, 1) - 1)));
  one.colours_ = {{0}};
  return one;
}

}  // namespace meshorder
