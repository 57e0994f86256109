// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/file_rows.hpp"

#include "io/vtk/vtu_compressor.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace meshorder::distributed {
namespace {

constexpr Offset kBefore = 5;      // bytes of the file before the array
constexpr std::uint8_t kByte = 3;  // number type

std::string new_file_of_rows(const Communicator& communicator) {
  const std::vector<int> process = communicator.broadcast(std::vector<int>{static_cast<int>(::getpid())});
  const auto path =
      std::filesystem::temp_directory_path() / ("meshorder-rows-" + std::to_string(process.front()));
  communicator.at_root([&] { std::ofstream(path).close(); });
  return path.string();
}

std::byte value_at(Offset k) { return static_cast<std::byte>((k * k / 7) & 0xFF); }

std::vector<std::byte> values_between(Offset begin, Offset end) {
  std::vector<std::byte> result;
  for (Offset k = begin; k < end; ++k) result.push_back(value_at(k));
  return result;
}

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns a word of a file of 32-bit headers.
Offset word_at(const std::string& bytes, Offset at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

struct Kept {
  Offset values;
  Offset block;
  VtuEncoding::Compressor compressor;
};

/// Writes values in uneven shares, and reads parts that other ranks wrote.
void expect_kept(const Communicator& communicator, const Kept& kept) {
  using Compressor = VtuEncoding::Compressor;
  VtuEncoding encoding;
  encoding.compressor = kept.compressor;
  encoding.wide_headers = false;
  const std::string path = new_file_of_rows(communicator);
  // rank 0 has nothing, the last rank about twice as much as the others
  std::vector<GlobalIndex> sizes(static_cast<std::size_t>(communicator.size()), 0);
  for (std::size_t r = 1; r < sizes.size(); ++r) sizes[r] = kept.values / std::ssize(sizes);
  sizes.back() = 0;
  sizes.back() = kept.values - Layout::of_sizes(sizes).size();
  const Layout layout = Layout::of_sizes(sizes);
  const int rank = communicator.rank();
  Offset stored = 0;
  {
    SharedFile out(communicator, path, "out", SharedFile::Use::write);
    stored = write_values(communicator, out, encoding, kBefore,
                          values_between(layout.begin(rank), layout.end(rank)), kept.block);
    out.close();
  }
  const std::string bytes = communicator.at_root([&] { return content(path); });
  FilePart array{.type = kByte, .rows = kept.values, .at = kBefore, .stored = stored, .block = kept.block};
  std::vector<Offset> blocks;
  if (kept.compressor == Compressor::none) {
    communicator.at_root([&] { ASSERT_EQ(word_at(bytes, kBefore), kept.values); });
  } else {
    array.blocks = (kept.values + kept.block - 1) / kept.block;
    communicator.at_root([&] {
      ASSERT_EQ(word_at(bytes, kBefore), array.blocks);
      ASSERT_EQ(word_at(bytes, kBefore + 4), kept.block);
      ASSERT_EQ(word_at(bytes, kBefore + 8), kept.values % kept.block);
      blocks.push_back(kBefore + 4 * (3 + array.blocks));
      const vtk::VtuCompressor codec(kept.compressor);
      std::string all;
      for (Offset b = 0; b < array.blocks; ++b) {
        const Offset size = word_at(bytes, kBefore + 12 + 4 * b);
        std::string block(static_cast<std::size_t>(std::min(kept.block, kept.values - b * kept.block)), ' ');
        ASSERT_TRUE(codec.uncompress({bytes.data() + blocks.back(), static_cast<std::size_t>(size)}, block));
        all += block;
        blocks.push_back(blocks.back() + size);
      }
      ASSERT_EQ(blocks.back(), std::ssize(bytes));
      for (Offset k = 0; k < kept.values; ++k)
        ASSERT_EQ(static_cast<std::byte>(all[static_cast<std::size_t>(k)]), value_at(k)) << k;
    });
  }
  communicator.at_root([&] { ASSERT_EQ(std::ssize(bytes), kBefore + stored); });

  const SharedFile in(communicator, path, "in", SharedFile::Use::read);
  const Layout even = Layout::even(kept.values, communicator.size());
  for (const auto& [begin, end] : {std::pair{even.begin(rank), even.end(rank)},
                                   std::pair{even.begin(rank) / 2, kept.values - even.begin(rank) / 3},
                                   std::pair{rank % 2 * kept.values, kept.values}}) {
    ASSERT_EQ(read_values(communicator, in, {"in", "u"}, kept.compressor, array, blocks, begin, end),
              values_between(begin, end));
  }
  communicator.at_root([&] { std::filesystem::remove(path); });
}

TEST(VtuRows, AreReadAsTheyWereWritten) {
  Communicator communicator;
  for (const auto compressor : {VtuEncoding::Compressor::none, VtuEncoding::Compressor::zlib,
                                VtuEncoding::Compressor::lz4, VtuEncoding::Compressor::lzma}) {
    if (!vtk::VtuCompressor::available(compressor)) continue;
    // blocks smaller than a rank's values, and blocks with the values of several ranks
    for (const Offset block : {7, 64, 1000, 100000}) {
      for (const Offset values : {0, 1, 6, 7, 10000}) expect_kept(communicator, {values, block, compressor});
    }
  }
}

TEST(VtuRows, EndAllRanksWhereABlockOfOneIsDamaged) {
  if (!vtk::VtuCompressor::available(VtuEncoding::Compressor::zlib)) GTEST_SKIP() << "needs zlib";
  const Communicator communicator;
  const std::string path = new_file_of_rows(communicator);
  const auto block = communicator.at_root([&] {
    const std::string bytes(100, 'a');
    std::string packed = vtk::VtuCompressor(VtuEncoding::Compressor::zlib).compress(bytes);
    std::ofstream(path, std::ios::binary) << packed << packed.substr(0, packed.size() / 2);
    return std::ssize(packed);
  });
  const FilePart array{.type = kByte, .rows = 200, .blocks = 2, .block = 100};
  const SharedFile in(communicator, path, "mesh.vtu", SharedFile::Use::read);
  const bool is_last = communicator.rank() == communicator.size() - 1;
  try {
    (void)read_values(communicator, in, {"mesh.vtu", "u"}, VtuEncoding::Compressor::zlib, array,
                      {0, block, block + block / 2}, 0, is_last ? 101 : 100);
    FAIL() << "nothing was thrown";
  } catch (const SharedError& error) {
    EXPECT_NE(std::string(error.what()).find("mesh.vtu: block 1 of the array 'u' cannot be uncompressed"),
              std::string::npos)
        << error.what();
  }
  communicator.at_root([&] { std::filesystem::remove(path); });
}

}  // namespace
}  // namespace meshorder::distributed
