// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

namespace meshorder {
inline namespace v0_3 {

/// Kind of a failure. The numbers are those of `mo_status` in meshorder.h and do not change.
enum class Code : int {
  ok = 0,
  invalid_argument = 1,
  bad_input = 2,
  too_large = 3,
  unavailable = 4,
  stopped = 5,
  io = 6,
  internal = 7,
};

/// Base class of all exceptions that meshorder throws, besides `std::bad_alloc`.
///
/// Exceptions of a user's callback (progress, companion, own method) pass through unchanged. After an
/// exception the inputs have the values that they had before the call; outputs are unspecified.
class MESHORDER_API Error : public std::runtime_error {
 public:
  /// @param code     kind of the failure; this class itself is thrown for `Code::io`
  /// @param message  one sentence: the fault, its place and a remedy
  Error(Code code, const std::string& message) : std::runtime_error(message), code_(code) {}

  /// Returns the kind of the failure. Each derived class has its own kind.
  [[nodiscard]] Code code() const noexcept { return code_; }

 private:
  Code code_;
};

/// Thrown for invalid arguments: an unknown method, a map that is not a bijection, sizes that do not match,
/// an asymmetric graph, a coordinate or weight that is not finite. Nothing was changed.
struct MESHORDER_API InvalidArgument : Error {
  explicit InvalidArgument(const std::string& message) : Error(Code::invalid_argument, message) {}
};

/// Position of a fault in a file. Text is located by line, binary data by byte.
struct Location {
  std::string file;
  std::int64_t line = 0;   ///< from 1; 0 if unknown
  std::int64_t byte = -1;  ///< from 0; −1 if unknown
};

/// Thrown for a faulty file or faulty bytes in memory.
///
/// `what()` reads "FILE:LINE: fault; remedy" for text and "FILE: byte N: fault; remedy" for binary data.
class MESHORDER_API InputError : public Error {
 public:
  /// @param location  where the fault is
  /// @param what      the fault; may quote names from the file: `what()` escapes control characters
  /// @param remedy    what would be right; may be empty
  InputError(Location location, const std::string& what, const std::string& remedy);

  /// The same for a fault that has no line or byte.
  InputError(const std::string& file, const std::string& what, const std::string& remedy)
      : InputError(Location{file, 0, -1}, what, remedy) {}

  /// Returns where the fault is. Valid as long as this exception or a copy of it exists.
  [[nodiscard]] const Location& location() const noexcept { return *location_; }

 private:
  std::shared_ptr<const Location> location_;  // shared: copying an exception must not throw
};

/// Thrown for 2³¹ or more vertices, cells, degrees of freedom or (if METIS has 32-bit integers) entries; for
/// a result that the caller's integer type cannot hold; for a graph beyond the memory limit.
struct MESHORDER_API TooLarge : Error {
  explicit TooLarge(const std::string& message) : Error(Code::too_large, message) {}
};

/// Thrown for a method, a format or a compression that this build lacks (the message names the build option),
/// and for a library or plug-in that cannot be loaded.
struct MESHORDER_API Unavailable : Error {
  explicit Unavailable(const std::string& message) : Error(Code::unavailable, message) {}
};

/// Thrown when `Run::progress` returned false.
struct MESHORDER_API Stopped : Error {
  explicit Stopped(const std::string& message = "stopped by the progress callback")
      : Error(Code::stopped, message) {}
};

/// Thrown for a failure inside meshorder or a library that it uses, such as an error status of METIS.
struct MESHORDER_API InternalError : Error {
  explicit InternalError(const std::string& message) : Error(Code::internal, message) {}
};

}  // namespace v0_3
}  // namespace meshorder
