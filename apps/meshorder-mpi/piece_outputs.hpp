// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_set.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace meshorder::command {

/// The files of a mesh's pieces, on the rank that puts them in place: FOLDER/NAME.pvtu, which names the
/// others, FOLDER/NAME_0000.vtu and so on.
class PieceOutputs {
 public:
  /// Checks, before the work, that the files can be written.
  ///
  /// @param folder  made by `open` if it does not exist; its parent has to exist
  /// @throws InputError if the folder cannot be written; if it has to be made and its name has the extension
  ///                    of a mesh format; if it holds a file with a piece's name that NAME.pvtu does not
  ///                    list: another program may have written this file
  PieceOutputs(std::filesystem::path folder, std::string name);
  /// Removes the folder if `open` made it and it is empty.
  ~PieceOutputs();
  PieceOutputs(const PieceOutputs&) = delete;
  PieceOutputs(PieceOutputs&&) = delete;
  PieceOutputs& operator=(const PieceOutputs&) = delete;
  PieceOutputs& operator=(PieceOutputs&&) = delete;

  /// Makes the files of `pieces` pieces; returns the paths under which to write them.
  std::vector<std::string> open(Index pieces);

  /// Adds the complete files and NAME.pvtu to a set. The set also removes other pieces of an earlier run.
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
