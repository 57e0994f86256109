// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/host.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace meshorder {
namespace {

std::string name_in(const std::string& cpuinfo) {
  std::istringstream stream(cpuinfo);
  return processor_name(stream, "aarch64");
}

TEST(Processor, IsCalledWhatItCallsItself) {
  EXPECT_EQ(name_in("processor\t: 0\nmodel\t\t: 2\nmodel name\t: AMD EPYC 9R45 \n\nmodel name\t: other\n"),
            "AMD EPYC 9R45");
}

TEST(Processor, IsCalledByItsNumbersWithoutAName) {
  EXPECT_EQ(name_in("processor\t: 0\nCPU implementer\t: 0x41\nCPU part\t: 0xd0c\n"),
            "aarch64 processor, implementer 0x41, part 0xd0c");
  EXPECT_EQ(name_in("processor\t: 0\nCPU part\t: 0xd0c\n"), "aarch64 processor");
  EXPECT_EQ(name_in(""), "aarch64 processor");
}

TEST(Processor, HasTheFamilyOfTheFirstOne) {
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

}  // namespace
}  // namespace meshorder
