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
  std::optional<Permutation> arranged;  ///< what `arrange_cells` did for this format
  Maps maps;                            ///< ids and kept cells, without the permutations
  MeshChecksums before;                 ///< only if maps are wanted
};

/// Adds --ids, whose value parse<Ids> reads, --only, --strict and --maps.
///
/// @param more_maps  other files written with the maps, as the end of a sentence of the help
void add_moving_options(CLI::App& subcommand, MeshFiles& files, std::string& ids,
                        const std::string& more_maps = "");

/// Keeps the cells of one dimension, or all cells for −1. Returns the positions that the kept cells had
/// before. Throws InputError for the file `input` if it has no such cells.
std::vector<Index> keep_wanted(Mesh& mesh, const std::string& input, int dimension, Notes& notes);

/// Reads a mesh with the cells that the output can hold. Throws Error for a faulty file, and for cells that
/// the output would have to hold but cannot.
///
/// @param bytes_of_entry  as in `limit_joins`
MeshToOrder read_to_order(const MeshFiles& files, Notes& notes, std::uint64_t bytes_of_entry = kBytesToOrder);

/// Writes, as files of a set, a mesh that is in its new order and its maps. The permutations of the maps must
/// be set. `commit` of the set puts all files in place. Returns the paths of the maps. If the output's name
/// is empty, no mesh is written.
std::vector<std::string> write_ordered(const MeshToOrder& ordered, const MeshFiles& files, OutputSet& outputs,
                                       Notes& notes);

}  // namespace meshorder::command
