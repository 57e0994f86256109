// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "command.hpp"
#include "graph/join_limit.hpp"
#include "io/format.hpp"
#include "maps.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::command {

/// The files of a mesh: input, output and maps.
struct MeshFiles {
  std::string input;
  std::string output;
  std::string maps;  ///< prefix of the maps' names; empty: no maps
  Keeping keeping;
  std::string points;  ///< file of coordinates of a matrix's rows; empty: none
};

/// A mesh as it was read, to be ordered and written.
struct MeshToOrder {
  Mesh mesh;
  const Format* format = nullptr;       ///< of the output
  std::optional<Permutation> arranged;  ///< result of `arrange_cells` for this format
  Maps maps;                            ///< ids and kept cells, without the permutations
  MeshChecksums before;                 ///< only if maps are wanted
};

/// Adds --ids (parse<Ids> reads its value), --only, --strict and --maps.
///
/// @param more_maps  other files written with the maps, as the end of a sentence of the help
void add_moving_options(CLI::App& subcommand, MeshFiles& files, std::string& ids,
                        const std::string& more_maps = "");

/// Keeps the cells of one dimension, or all cells for −1. Returns the positions that the kept cells had
/// before. Throws InputError for the file `input` if it has no such cells.
std::vector<Index> keep_wanted(Mesh& mesh, const std::string& input, int dimension, Notes& notes);

/// Reads a mesh, and keeps the wanted cells that the output can hold. Throws Error for a faulty file, and if
/// the output cannot hold the cells that it must hold (see `cells_to_write`).
///
/// @param bytes_of_entry  as in `limit_joins`
MeshToOrder read_to_order(const MeshFiles& files, Notes& notes, std::uint64_t bytes_of_entry = kBytesToOrder);

/// The paths of the files of a mesh and of its maps.
struct WrittenFiles {
  std::vector<std::string> mesh;  ///< the output first, then files beside it, as the .ele of a .node
  std::vector<std::string> maps;
};

/// Returns the files of a set to which only a mesh was written, the one named `output` first.
std::vector<std::string> files_of_mesh(const OutputSet& outputs, const std::string& output);

/// Writes a mesh in its new order, and its maps, as files of a set, whose `commit` puts them in place. The
/// permutations of the maps must be set. Writes no mesh if the output's name is empty, and no maps if their
/// prefix is.
WrittenFiles write_ordered(const MeshToOrder& ordered, const MeshFiles& files, OutputSet& outputs,
                           Notes& notes);

}  // namespace meshorder::command
