// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/study/results.hpp>

#include <istream>
#include <string>

namespace meshorder {

/// This machine, and what this program was made with. Measures the bandwidths, in about a second; that of all
/// threads with as many as `thread_count` says.
MachineRecord describe_machine();

/// What the first processor calls itself in Linux's /proc/cpuinfo. ARM's have no name there but numbers of
/// who made them and what: "aarch64 processor, implementer 0x41, part 0xd0c". Of what says neither,
/// "`architecture` processor".
std::string processor_name(std::istream& cpuinfo, const std::string& architecture);

}  // namespace meshorder
