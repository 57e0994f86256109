// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_set.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace meshorder::command {

/// A file of a set that the root completes and that all ranks write, by its path while it is unfinished.
/// Every rank has to call all functions; they throw SharedError where the root cannot.
class SharedOutput {
 public:
  /// @param outputs  the root's
  /// @param start    first bytes, which the root writes
  SharedOutput(const distributed::Communicator& communicator, OutputSet& outputs, const FilePath& target,
               std::string_view start = {});

  /// Returns the path by which the ranks write.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  /// Adds the file, which is closed by now, to the set.
  void commit();

 private:
  const distributed::Communicator& communicator_;
  std::optional<OutputFile> file_;  ///< at the root
  std::string path_;
};

}  // namespace meshorder::command
