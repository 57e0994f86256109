// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/machine.hpp"

#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

namespace meshorder {
namespace {

TEST(Machine, CachesOfThePaperAreThoseOfItsProcessor) {
  EXPECT_EQ(to_string(parse_caches("paper")), "32K,256K,10M");
}

TEST(Machine, CachesOfThisMachineAreAscending) {
  const Caches caches = caches_of_this_machine();
  ASSERT_FALSE(caches.level_bytes.empty());
  EXPECT_GE(caches.level_bytes.front(), 4 << 10);
  EXPECT_LE(caches.level_bytes.back(), Offset{4} << 30);
  EXPECT_TRUE(std::is_sorted(caches.level_bytes.begin(), caches.level_bytes.end(), std::less_equal()));
  EXPECT_EQ(parse_caches("this"), caches);
  EXPECT_EQ(parse_caches(""), caches);
  EXPECT_EQ(parse_caches(to_string(caches)), caches);
}

/// Returns what a machine with these caches reports; its third level is shared by the listed processors.
std::string caches_reported(const std::string& third_level, const std::string& processors) {
  const test::TemporaryFolder folder;
  const auto add = [&](int index, const char* level, const char* type, const std::string& size,
                       const std::string& shared) {
    const std::filesystem::path path = folder.path() / ("index" + std::to_string(index));
    std::filesystem::create_directory(path);
    std::ofstream(path / "level") << level << '\n';
    std::ofstream(path / "type") << type << '\n';
    std::ofstream(path / "size") << size << '\n';
    std::ofstream(path / "shared_cpu_list") << shared << '\n';
  };
  add(0, "1", "Data", "48K", "0");
  add(1, "1", "Instruction", "32K", "0");
  add(2, "2", "Unified", "2048K", "0");
  add(3, "3", "Unified", third_level, processors);
  return to_string(caches_in(folder.path().string()));
}

TEST(Machine, ACacheThatOtherVirtualMachinesUseCountsByItsShare) {
  EXPECT_EQ(caches_reported("491520K", "0-1"), "48K,2M,8M") << "480 MiB for two threads";
  EXPECT_EQ(caches_reported("327680K", "0-63"), "48K,2M,320M") << "all of a large processor";
  EXPECT_EQ(caches_reported("98304K", "0-7,16-23"), "48K,2M,96M");
  EXPECT_EQ(caches_reported("32768K", "0-1"), "48K,2M,32M");
  EXPECT_EQ(caches_reported("266240K", "3"), "48K,2M,4M");
  EXPECT_EQ(to_string(caches_in("/nowhere")), "");
}

TEST(Machine, CachesMayBeGivenBySizes) {
  EXPECT_EQ(parse_caches("48K,1M"), parse_cache_sizes("48K,1M"));
  EXPECT_THROW(parse_caches("paper,1G"), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
