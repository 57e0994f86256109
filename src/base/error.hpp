// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace meshorder {

/// Where in a file something is wrong. Text is located by line, binary by byte; unknown parts stay unset.
struct Location {
  std::string file;
  std::int64_t line = 0;   ///< from 1; 0 means unknown
  std::int64_t byte = -1;  ///< from 0; negative means unknown
};

/// Bad input: one sentence that says where, what is wrong and what would be right.
///
/// `what()` reads `FILE:LINE: what; remedy`, or `FILE: byte N: what; remedy` in binary data.
class Error : public std::runtime_error {
 public:
  Error(Location location, const std::string& what, const std::string& remedy);
  Error(const std::string& file, const std::string& what, const std::string& remedy)
      : Error(Location{file, 0, -1}, what, remedy) {}

  [[nodiscard]] const Location& location() const noexcept { return location_; }

 private:
  Location location_;
};

/// A caller's mistake: an unknown method, a permutation that is none, sizes that do not fit each other.
class InvalidArgument : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace meshorder
