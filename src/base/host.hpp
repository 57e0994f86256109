// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <istream>
#include <string>

namespace meshorder {

/// Returns the name of the first processor in `cpuinfo`, the text of Linux's /proc/cpuinfo. For ARM
/// processors, which have only two numbers there: "aarch64 processor, implementer 0x41, part 0xd0c". Without
/// a name or both numbers: "`architecture` processor".
std::string processor_name(std::istream& cpuinfo, const std::string& architecture);

/// Returns `processor_name` of this machine.
std::string processor_of_this_machine();

/// The family and model of an x86 processor, as CPUID numbers them; −1 on other processors.
struct ProcessorFamily {
  std::string maker;  ///< "AuthenticAMD"; empty on other processors
  int family = -1;
  int model = -1;
};

/// Returns the family of the first processor in `cpuinfo`, the text of Linux's /proc/cpuinfo.
ProcessorFamily processor_family(std::istream& cpuinfo);

/// Returns the family of this machine's processor.
ProcessorFamily family_of_this_machine();

/// Returns whether the family is AMD's Zen 4, by the test in Linux (init_amd in arch/x86/kernel/cpu/amd.c).
bool is_zen4(const ProcessorFamily& family);

/// Returns the folder for files that can be remade: the first of `$MESHORDER_CACHE`,
/// `$XDG_CACHE_HOME/meshorder` and `$HOME/.cache/meshorder` whose variable is set (the last two: to an
/// absolute path). Empty if there is none. The folder need not exist.
std::filesystem::path user_cache_folder();

}  // namespace meshorder
