// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_set.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace meshorder::command {

/// A file of a set: all ranks write it under a temporary path, and the root completes it. Every rank has to
/// call all functions; they throw SharedError if the root fails.
class SharedOutput {
 public:
  /// @param outputs  used at the root
  /// @param start    first bytes, written by the root
  SharedOutput(const distributed::Communicator& communicator, OutputSet& outputs, const FilePath& target,
               std::string_view start = {});

  /// Returns the path under which the ranks write.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  /// Adds the file to the set; call it after all ranks have closed the file.
  void commit();

 private:
  const distributed::Communicator& communicator_;
  std::optional<OutputFile> file_;  ///< at the root
  std::string path_;
};

}  // namespace meshorder::command
