// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/machine.hpp"

#include "lab/study/results_json.hpp"
#include "payoff/machine.hpp"
#include "support/files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace meshorder {
namespace {

TEST(Machine, ProgramsAreCalledByVersionAndRevision) {
  MachineRecord machine;
  machine.program = "0.2.0";
  EXPECT_EQ(program_in_words(machine), "meshorder 0.2.0");
  machine.revision = "0123456789abcdef0123456789abcdef01234567";
  EXPECT_EQ(program_in_words(machine), "meshorder 0.2.0, revision 0123456789ab");
  machine.revision += "+5eed5eed";
  EXPECT_EQ(program_in_words(machine), "meshorder 0.2.0, revision 0123456789ab with changes 5eed5eed");
}

TEST(Machine, IsDescribedInFull) {
  const MachineRecord machine = describe_machine();
  EXPECT_EQ(machine.cores, static_cast<int>(std::thread::hardware_concurrency()));
  EXPECT_EQ(machine.caches, caches_of_this_machine());
  EXPECT_GT(machine.memory_bytes, std::uint64_t{64} << 20);
  EXPECT_GT(machine.read_bandwidth, 0.05);
  EXPECT_GT(machine.read_bandwidth_all, 0.05);
  EXPECT_NE(machine.compiler.find('.'), std::string::npos) << machine.compiler;
  EXPECT_NE(machine.flags.find("-std=c++20"), std::string::npos) << machine.flags;
  EXPECT_EQ(std::count(machine.system.begin(), machine.system.end(), ' '), 2) << machine.system;
  // through the results of a study, which refuse empty members
  const test::TemporaryFolder folder;
  StudyResults results;
  results.began = "2026-11-20T17:30:00Z";
  results.reference = "original";
  results.orderings = {{"original", "Original", "original", "original"}};
  results.machine = machine;
  write_results(results, folder.path() / "results.json");
  EXPECT_EQ(read_results(folder.path() / "results.json").machine, machine);
}

}  // namespace
}  // namespace meshorder
