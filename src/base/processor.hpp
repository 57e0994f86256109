// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <istream>
#include <string>

namespace meshorder {

/// Returns the name of the first processor in Linux's /proc/cpuinfo. ARM processors have only numbers there:
/// "aarch64 processor, implementer 0x41, part 0xd0c". Without either, "`architecture` processor".
std::string processor_name(std::istream& cpuinfo, const std::string& architecture);

/// Returns the name of this machine's processor, as processor_name.
std::string processor_of_this_machine();

/// The family of a processor, by the numbers that x86's CPUID gives.
struct ProcessorFamily {
  std::string maker;  ///< "AuthenticAMD" or "GenuineIntel"; empty on other processors
  int family = -1;
  int model = -1;
};

/// Returns the family of the first processor in Linux's /proc/cpuinfo.
ProcessorFamily processor_family(std::istream& cpuinfo);

/// Returns the family of this machine's processor.
ProcessorFamily family_of_this_machine();

// Families and models are those of Linux: init_amd in arch/x86/kernel/cpu/amd.c, and
// arch/x86/include/asm/intel-family.h.

bool is_zen3(const ProcessorFamily& family);
bool is_zen4(const ProcessorFamily& family);
bool is_zen5(const ProcessorFamily& family);
/// Sapphire Rapids and its successor of the same kind, Emerald Rapids.
bool is_sapphire_rapids(const ProcessorFamily& family);

}  // namespace meshorder
