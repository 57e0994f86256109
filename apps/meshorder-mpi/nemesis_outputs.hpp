// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_set.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace meshorder::command {

/// The files of a mesh's pieces in Nemesis, on the rank that puts them in place: NAME.e.PARTS.PART, for
/// instance mesh.e.16.00 to mesh.e.16.15.
class NemesisOutputs {
 public:
  /// Checks, before the work, that the files can be written.
  ///
  /// @param name  of the files, without the two numbers: mesh.e
  /// @throws InputError if the folder of the files does not exist or cannot be written, or holds a file with
  ///                    a piece's name that meshorder did not write as a piece; Unavailable in a build
  ///                    without netCDF
  explicit NemesisOutputs(std::string name);

  /// Makes the files of `parts` pieces; returns the paths under which to write them.
  [[nodiscard]] std::vector<std::string> open(Index parts);
  /// Returns the names of the files that `open` made.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

  /// Adds the files to the set; call it after they are written. The set also removes other pieces of an
  /// earlier run.
  void add_to(OutputSet& set);

  /// Returns the file of the first piece; before `open`, the name without numbers.
  [[nodiscard]] const std::string& first() const noexcept { return names_.empty() ? name_ : names_.front(); }

 private:
  [[nodiscard]] std::vector<std::filesystem::path> old_pieces() const;

  std::string name_;
  std::vector<std::string> names_;
  std::vector<OutputFile> files_;
};

/// Returns whether --pieces requests pieces in Nemesis: its name has an extension of Exodus II.
[[nodiscard]] bool names_nemesis_pieces(const std::string& pieces);

}  // namespace meshorder::command
