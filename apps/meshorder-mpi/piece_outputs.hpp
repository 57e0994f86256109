// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_set.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace meshorder::command {

/// The files of the pieces of a mesh, at the rank that puts them in place: FOLDER/NAME.pvtu, which names the
/// others, FOLDER/NAME_0000.vtu and so on.
class PieceOutputs {
 public:
  /// Looks, before the work, at what is there.
  ///
  /// @param folder  made by `open` where it is missing; the folder that it is in exists
  /// @throws InputError if the folder cannot be written, or has a file of a piece's name that no NAME.pvtu
  ///         there names: it is nobody's who would want it replaced
  PieceOutputs(std::filesystem::path folder, std::string name);
  /// Removes a folder that `open` has made and nothing was put into.
  ~PieceOutputs();
  PieceOutputs(const PieceOutputs&) = delete;
  PieceOutputs(PieceOutputs&&) = delete;
  PieceOutputs& operator=(const PieceOutputs&) = delete;
  PieceOutputs& operator=(PieceOutputs&&) = delete;

  /// Begins the files of so many pieces; returns the paths of the unfinished ones.
  std::vector<std::string> open(Index pieces);

  /// Adds the files, which are complete, and the one that names them to a set, which also removes pieces of
  /// an earlier run beyond these.
  ///
  /// @param index  content of NAME.pvtu
  void add_to(OutputSet& set, const std::string& index);

  /// Returns FOLDER/NAME.pvtu.
  [[nodiscard]] std::filesystem::path index() const;
  /// Returns the names of the pieces' files within the folder.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

 private:
  [[nodiscard]] std::vector<std::filesystem::path> old_pieces() const;

  std::filesystem::path folder_;
  std::string name_;
  bool is_made_ = false;
  std::vector<std::string> names_;
  std::vector<OutputFile> files_;
};

}  // namespace meshorder::command
