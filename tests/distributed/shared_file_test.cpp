// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/shared_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace meshorder::distributed {
namespace {

/// Returns the path of a new empty file, the same on all ranks.
std::string new_file(const Communicator& communicator) {
  const std::vector<int> process = communicator.broadcast(std::vector<int>{static_cast<int>(::getpid())});
  const auto path =
      std::filesystem::temp_directory_path() / ("meshorder-shared-" + std::to_string(process.front()));
  communicator.at_root([&] { std::ofstream(path).close(); });
  return path.string();
}

TEST(SharedFile, HoldsWhatEachRankWrote) {
  Communicator communicator;
  const std::string path = new_file(communicator);
  // 100 bytes from rank 0, 200 from rank 1, …
  const auto length = [](int rank) { return Offset{100} * (rank + 1); };
  Offset begin = 0;
  for (int rank = 0; rank < communicator.rank(); ++rank) begin += length(rank);
  for (const Offset chunk : {Offset{1} << 30, Offset{64}}) {
    communicator.set_chunk_limit(chunk);
    const std::vector<std::byte> own(static_cast<std::size_t>(length(communicator.rank())),
                                     static_cast<std::byte>(65 + communicator.rank()));
    SharedFile out(communicator, path, "out", SharedFile::Use::write);
    out.write(begin, own);
    out.close();

    const SharedFile in(communicator, path, "in", SharedFile::Use::read);
    std::vector<std::byte> found(own.size());
    in.read(begin, found);
    EXPECT_EQ(found, own);
    communicator.at_root([&] {
      std::ifstream file(path, std::ios::binary);
      const std::string all{std::istreambuf_iterator<char>(file), {}};
      Offset at = 0;
      for (int rank = 0; rank < communicator.size(); ++rank) {
        for (const Offset end = at + length(rank); at < end; ++at)
          ASSERT_EQ(all.at(static_cast<std::size_t>(at)), static_cast<char>(65 + rank));
      }
      EXPECT_EQ(static_cast<Offset>(all.size()), at);
    });
  }
  communicator.at_root([&] { std::filesystem::remove(path); });
}

TEST(SharedFile, EndsAllRanksWhereOneReadsBeyondTheEnd) {
  const Communicator communicator;
  const std::string path = new_file(communicator);
  communicator.at_root([&] { std::ofstream(path) << "short"; });
  const SharedFile in(communicator, path, "mesh.vtu", SharedFile::Use::read);
  std::vector<std::byte> bytes(communicator.rank() == communicator.size() - 1 ? 6 : 5);
  try {
    in.read(0, bytes);
    FAIL() << "nothing was thrown";
  } catch (const SharedError& error) {
    EXPECT_NE(std::string(error.what()).find("mesh.vtu: ends before byte 6"), std::string::npos)
        << error.what();
  }
  communicator.at_root([&] { std::filesystem::remove(path); });
}

TEST(SharedFile, EndsAllRanksWhereAFileIsMissing) {
  const Communicator communicator;
  EXPECT_THROW(SharedFile(communicator, "/nowhere/mesh.vtu", "mesh.vtu", SharedFile::Use::read), SharedError);
}

}  // namespace
}  // namespace meshorder::distributed
