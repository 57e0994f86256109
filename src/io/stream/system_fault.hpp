// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshorder {

/// The reason why a system call failed, as a clause, and a remedy.
struct SystemFault {
  std::string reason;
  std::string remedy;
};

/// Returns reason and remedy for an `errno` of calls that write or replace files.
SystemFault system_fault(int error);

/// Throws InputError "FILE: WHAT: REASON; REMEDY" for an `errno`.
[[noreturn]] void throw_system_fault(const std::string& file, const std::string& what, int error);

}  // namespace meshorder
