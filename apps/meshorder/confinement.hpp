// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <string>
#include <vector>

namespace meshorder::command {

/// The files of a command, as the user typed them.
struct Files {
  std::vector<std::string> meshes{};   ///< that it reads
  std::vector<std::string> others{};   ///< that it reads, too
  std::string maps_read{};             ///< prefix of maps that it reads; empty: none
  std::vector<FilePath> outputs{};     ///< that it writes; empty names are skipped
  std::string maps_written{};          ///< prefix of maps that it writes; empty: none
  std::vector<std::string> folders{};  ///< below which it writes
};

/// Goes on in a child process if a library, not meshorder, parses one of the meshes. The child reaches these
/// files, the kept calibrations and nothing else (see `give_up_rights`): a damaged file, or one made to do
/// harm, can harm nothing else. Returns in the child only. This process waits, passes signals on, and ends as
/// the child does. If a library crashes or does not end, it removes unfinished outputs, prints one line of
/// error and ends with status 2.
///
/// Does nothing for files that are trusted (`--trust`), and where the system makes no child. To be called
/// while there is one thread. Throws InputError for an output that cannot be written.
void confine(const Files& files);

/// Trusts all files that this process reads: `confine` does nothing.
void trust_files();

/// Reads a mesh as `meshorder::read_mesh` does. In a confined process the reading may take ten seconds of
/// processor time and a second more for each MB, and what libraries print is dropped.
Mesh read_input(const FilePath& path, Notes& notes);

}  // namespace meshorder::command
