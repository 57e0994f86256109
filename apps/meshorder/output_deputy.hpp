// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/descriptor.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/scratch.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::command {

/// Puts outputs in place for a confined child process. The child writes them in private scratch folders and
/// can write in no other folder. The child asks over a socket, and the parent checks that the user requested
/// each file. A malicious file that controls the child can damage these outputs, but no other file.
class OutputDeputy {
 public:
  /// Makes a scratch folder in each folder of outputs or maps. Throws InputError for an output that cannot be
  /// written.
  ///
  /// @param outputs  empty paths are skipped
  /// @param maps     prefix of maps; empty: none
  OutputDeputy(const std::vector<FilePath>& outputs, std::string maps);

  /// Returns the scratch folders.
  [[nodiscard]] std::vector<std::filesystem::path> folders() const;
  /// Returns the outputs that are written to directly, not replaced: devices and pipes.
  [[nodiscard]] const std::vector<std::filesystem::path>& through() const noexcept { return through_; }

  /// Call it in the child, which then writes in these scratch folders and asks the parent to move its files.
  void serve_this_process();
  /// Call it in the parent: does what the child asks, until the child ends.
  void serve_child();

 private:
  struct Output {
    FilePath path;
    bool is_alone = true;  ///< the format has no further files
  };
  struct Home {
    std::filesystem::path folder;  ///< folder of outputs
    Scratch scratch;
  };

  void add_home(const std::filesystem::path& target);
  /// Returns the output of this path. Throws Error if the child may not put it in place.
  [[nodiscard]] FilePath allowed(const std::string& path) const;
  /// Moves a file from its scratch folder to a scratch folder of the parent, which the child cannot reach.
  [[nodiscard]] Scratch taken(const std::string& scratch, const FilePath& target) const;
  [[nodiscard]] std::vector<std::string> do_as_asked(std::string_view request) const;

  std::vector<Output> outputs_;
  std::string maps_;
  std::vector<Home> homes_;
  std::vector<std::filesystem::path> through_;
  Descriptor asking_;     ///< the child's end of the socket
  Descriptor answering_;  ///< the parent's end
};

}  // namespace meshorder::command
