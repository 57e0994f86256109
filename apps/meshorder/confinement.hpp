// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/join_limit.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::command {

/// The files of a command, as the user typed them.
struct Files {
  std::vector<std::string> meshes{};   ///< read by the command
  std::vector<std::string> others{};   ///< other files that it reads
  std::string maps_read{};             ///< prefix of maps that are read; empty: none
  std::vector<FilePath> outputs{};     ///< written by the command; empty names are skipped
  std::string maps_written{};          ///< prefix of maps that are written; empty: none
  std::vector<std::string> folders{};  ///< folders below which it writes
};

/// Continues in a child process if a library, not meshorder, parses one of the meshes. The child can reach
/// only these files and the stored calibrations (see `give_up_rights`): a damaged or malicious file can harm
/// nothing else. Returns in the child only. The parent waits, passes signals on, and ends with the child's
/// status. If a library crashes or does not end, the parent removes unfinished outputs, prints a one-line
/// error and ends with status 2.
///
/// Does nothing for trusted files (`--trust`), or if the system cannot make a child. Call it while there is
/// one thread. Throws InputError for an output that cannot be written.
void confine(const Files& files);

/// Trusts all files that this process reads: `confine` then does nothing.
void trust_files();

/// Bytes for each entry of a graph, like kBytesToOrder: kBytesToPredict to predict times; kBytesToMeasure to
/// run kernels, for each order that is in memory.
inline constexpr std::uint64_t kBytesToPredict = 64;
inline constexpr std::uint64_t kBytesToMeasure = 100;

/// Reads a mesh as `meshorder::read_mesh` does. In a confined process, the reading may take ten seconds of
/// processor time and one more for each MB, and output of libraries is dropped. Afterwards, graphs may use
/// the part of the memory limit that the reading did not use.
///
/// @param bytes_of_entry  as in `limit_joins`
Mesh read_input(const FilePath& path, Notes& notes, std::uint64_t bytes_of_entry = kBytesToOrder);

}  // namespace meshorder::command
