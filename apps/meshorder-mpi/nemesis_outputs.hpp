// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_set.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace meshorder::command {

/// The files of the pieces of a mesh in Nemesis, at the rank that puts them in place: NAME.e.PARTS.PART, for
/// instance mesh.e.16.00 to mesh.e.16.15.
class NemesisOutputs {
 public:
  /// Looks, before the work, at what is there.
  ///
  /// @param name  of the files, less the two numbers: mesh.e
  /// @throws InputError if its folder is not there or cannot be written, or has a file of a piece's name that
  ///         meshorder did not write as one; Unavailable in a build without netCDF
  explicit NemesisOutputs(std::string name);

  /// Makes the files of so many pieces, and returns the paths by which they are written.
  [[nodiscard]] std::vector<std::string> open(Index parts);
  /// Returns the names of the files that `open` made.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

  /// Has the set put the files, which are written by now, in place, and remove pieces of an earlier run that
  /// are none of these.
  void add_to(OutputSet& set);

  /// Returns the file of the first piece; without the numbers before `open`.
  [[nodiscard]] const std::string& first() const noexcept { return names_.empty() ? name_ : names_.front(); }

 private:
  [[nodiscard]] std::vector<std::filesystem::path> old_pieces() const;

  std::string name_;
  std::vector<std::string> names_;
  std::vector<OutputFile> files_;
};

/// Returns whether --pieces asks for pieces in Nemesis: the name is that of a file of Exodus II.
[[nodiscard]] bool names_nemesis_pieces(const std::string& pieces);

}  // namespace meshorder::command
