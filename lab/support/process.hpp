// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::models {

/// The program of that name beside the running one, or else on PATH; empty when there is none.
std::filesystem::path find_program(std::string_view name);

/// How a child process ended.
struct Ended {
  int code = 0;           ///< exit status, or 128 + the signal that killed it
  std::string last_line;  ///< the last line that it printed, on either stream; empty when there was none
};

/// Runs a program in `folder` to its end, without a shell and without input. What it prints goes to the file
/// `log`. Throws std::system_error when it cannot be started.
Ended run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                  const std::filesystem::path& folder, const std::filesystem::path& log);

}  // namespace meshorder::models
