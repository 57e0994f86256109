// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/machine.hpp"

#include "lab/study/results_json.hpp"
#include "payoff/machine.hpp"
#include "support/files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <thread>

namespace meshorder {
namespace {

std::string name_in(const std::string& cpuinfo) {
  std::istringstream stream(cpuinfo);
  return processor_name(stream, "aarch64");
}

TEST(Machine, ProcessorsAreCalledWhatTheyCallThemselves) {
  EXPECT_EQ(name_in("processor\t: 0\nmodel\t\t: 2\nmodel name\t: AMD EPYC 9R45 \n\nmodel name\t: other\n"),
            "AMD EPYC 9R45");
}

TEST(Machine, ProcessorsWithoutANameAreCalledByTheirNumbers) {
  EXPECT_EQ(name_in("processor\t: 0\nCPU implementer\t: 0x41\nCPU part\t: 0xd0c\n"),
            "aarch64 processor, implementer 0x41, part 0xd0c");
  EXPECT_EQ(name_in("processor\t: 0\nCPU part\t: 0xd0c\n"), "aarch64 processor");
  EXPECT_EQ(name_in(""), "aarch64 processor");
}

TEST(Machine, FamiliesAreThoseOfTheFirstProcessor) {
  std::istringstream amd(
      "processor\t: 0\nvendor_id\t: AuthenticAMD\ncpu family\t: 25\nmodel\t\t: 17\nmodel name\t: AMD EPYC\n\n"
      "processor\t: 1\nmodel\t\t: 18\n");
  const ProcessorFamily family = processor_family(amd);
  EXPECT_EQ(family.maker, "AuthenticAMD");
  EXPECT_EQ(family.family, 25);
  EXPECT_EQ(family.model, 17);
  std::istringstream arm("processor\t: 0\nCPU implementer\t: 0x41\n");
  EXPECT_EQ(processor_family(arm).family, -1);
}

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
  // as a study keeps it, which refuses what is empty
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
