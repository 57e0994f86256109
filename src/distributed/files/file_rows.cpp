// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/file_rows.hpp"

#include "io/vtk/vtu_compressor.hpp"
#include "io/vtk/vtu_document.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace meshorder::distributed {
namespace {

std::span<const char> characters(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
std::span<char> characters(std::span<std::byte> bytes) {
  return {reinterpret_cast<char*>(bytes.data()), bytes.size()};
}

/// Blocks first … end − 1.
struct BlockRange {
  Offset first = 0;
  Offset end = 0;
};

/// Returns the blocks that have bytes begin … end − 1 of an array.
BlockRange blocks_with(const FilePart& array, Offset begin, Offset end) {
  if (begin == end) return {};
  // the last block may be longer than the others
  const auto block_of = [&](Offset byte) { return std::min(byte / array.block, array.blocks - 1); };
  return {block_of(begin), block_of(end - 1) + 1};
}

/// Returns where each block that this rank wants begins in the file, then the end of the last block.
std::vector<Offset> own_starts(const Communicator& communicator, const std::vector<Offset>& at_root,
                               BlockRange wanted) {
  Parcels<Offset> sent;
  sent.starts.assign(static_cast<std::size_t>(communicator.size()) + 1, 0);
  const std::vector<BlockRange> ranges = communicator.gathered(wanted);
  communicator.at_root([&] {
    for (std::size_t rank = 0; rank < ranges.size(); ++rank) {
      const auto& [first, end] = ranges[rank];
      if (first < end)
        sent.values.insert(sent.values.end(), at_root.begin() + first, at_root.begin() + end + 1);
      sent.starts[rank + 1] = static_cast<Offset>(sent.values.size());
    }
  });
  return communicator.exchange(sent).values;
}

/// Moves bytes between ranks, so that the rank with the first byte of a block gets the whole block.
std::vector<std::byte> in_whole_blocks(const Communicator& communicator, const Layout& bytes,
                                       std::vector<std::byte> own, Offset block) {
  const GlobalIndex begin = bytes.begin(communicator.rank());
  const GlobalIndex end = bytes.end(communicator.rank());
  std::vector<Offset> starts;
  for (int rank = 0; rank < bytes.ranks(); ++rank) {
    const GlobalIndex first_of_rank = (bytes.begin(rank) + block - 1) / block * block;
    starts.push_back(std::clamp(first_of_rank, begin, end) - begin);
  }
  starts.push_back(end - begin);
  return communicator.exchange(std::span<const std::byte>(own), starts).values;
}

/// Compressed blocks, one after another.
struct CompressedBlocks {
  std::vector<std::uint64_t> sizes;
  std::vector<std::byte> bytes;
};

CompressedBlocks compressed(VtuEncoding::Compressor kind, std::span<const std::byte> values, Offset block) {
  const vtk::VtuCompressor compressor(kind);
  CompressedBlocks result;
  const auto each = static_cast<std::size_t>(block);
  for (std::size_t at = 0; at < values.size(); at += each) {
    const std::string bytes =
        compressor.compress(characters(values.subspan(at, std::min(each, values.size() - at))));
    result.sizes.push_back(bytes.size());
    const auto* const first = reinterpret_cast<const std::byte*>(bytes.data());
    result.bytes.insert(result.bytes.end(), first, first + bytes.size());
  }
  return result;
}

}  // namespace

std::vector<std::byte> read_values(const Communicator& communicator, const SharedFile& file,
                                   const PartName& name, VtuEncoding::Compressor compressor,
                                   const FilePart& array, const std::vector<Offset>& blocks, Offset begin,
                                   Offset end) {
  std::vector<std::byte> values =
      communicator.together([&] { return std::vector<std::byte>(static_cast<std::size_t>(end - begin)); });
  if (compressor == VtuEncoding::Compressor::none) {
    file.read(array.at + array.stored - array.size() + begin, values);
    return values;
  }
  const BlockRange range = blocks_with(array, begin, end);
  const std::vector<Offset> starts = own_starts(communicator, blocks, range);
  const std::vector<std::byte> stored = [&] {
    std::vector<std::byte> bytes = communicator.together([&] {
      return std::vector<std::byte>(
          starts.empty() ? 0 : static_cast<std::size_t>(starts.back() - starts.front()));
    });
    file.read(starts.empty() ? 0 : starts.front(), bytes);
    return bytes;
  }();
  communicator.together([&] {
    const vtk::VtuCompressor codec(compressor);
    std::vector<std::byte> whole;  // a block of which only a part is wanted
    for (Offset b = range.first; b < range.end; ++b) {
      const Offset block_begin = b * array.block;
      const Offset block_end = b + 1 == array.blocks ? array.size() : block_begin + array.block;
      const Offset from = std::max(begin, block_begin);
      const Offset to = std::min(end, block_end);
      const auto k = static_cast<std::size_t>(b - range.first);
      const auto source = std::span(stored).subspan(static_cast<std::size_t>(starts[k] - starts.front()),
                                                    static_cast<std::size_t>(starts[k + 1] - starts[k]));
      const auto wanted = std::span(values).subspan(static_cast<std::size_t>(from - begin),
                                                    static_cast<std::size_t>(to - from));
      const bool is_all = to - from == block_end - block_begin;
      if (!is_all) whole.resize(static_cast<std::size_t>(block_end - block_begin));
      if (!codec.uncompress(characters(source), characters(is_all ? wanted : std::span(whole)))) {
        throw InputError(name.file,
                         fmt::format("block {} of the array '{}' cannot be uncompressed", b, name.part),
                         "the array is damaged");
      }
      if (!is_all) std::copy_n(whole.begin() + (from - block_begin), to - from, wanted.begin());
    }
  });
  return values;
}

Offset write_values(const Communicator& communicator, const SharedFile& file, const VtuEncoding& encoding,
                    Offset at, std::vector<std::byte> values, Offset block) {
  const Layout layout = Layout::of_sizes(communicator.gathered(std::ssize(values)));
  std::vector<std::uint64_t> words{static_cast<std::uint64_t>(layout.size())};  // used at the root only
  Offset word_count = 1;
  if (encoding.compressor != VtuEncoding::Compressor::none) {
    const Offset blocks = (layout.size() + block - 1) / block;
    word_count = 3 + blocks;
    values = in_whole_blocks(communicator, layout, std::move(values), block);
    CompressedBlocks own =
        communicator.together([&] { return compressed(encoding.compressor, values, block); });
    values = std::move(own.bytes);
    const std::vector<std::uint64_t> sizes = communicator.gathered_at_root(own.sizes);
    words = {static_cast<std::uint64_t>(blocks), static_cast<std::uint64_t>(block),
             static_cast<std::uint64_t>(layout.size() % block)};
    words.insert(words.end(), sizes.begin(), sizes.end());
  }
  const std::string header = communicator.is_root() ? vtk::vtu_words(words, encoding) : std::string();
  file.write(at, std::as_bytes(std::span(header)));
  const Offset before = word_count * (encoding.wide_headers ? 8 : 4);
  return before + write_raw(communicator, file, at + before, values);
}

Offset write_raw(const Communicator& communicator, const SharedFile& file, Offset at,
                 std::span<const std::byte> values) {
  const Layout layout = Layout::of_sizes(communicator.gathered(std::ssize(values)));
  file.write(at + layout.begin(communicator.rank()), values);
  return layout.size();
}

}  // namespace meshorder::distributed
