// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/moved_part.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// Writes the parts of a mesh as Nemesis files; one rank has the whole mesh. Nemesis files are Exodus II
/// files that also hold the numbers that nodes and elements have in the whole mesh, and the vertices and
/// facets shared with other parts. A mesh that did not come from an Exodus II file, or is not in the order of
/// such a file, is first written to memory as an Exodus II file and read from there. O(size of the mesh ·
/// log) time.
///
/// Format: Hennigan, Shadid, "NEMESIS I: A Set of Functions for Describing Unstructured Finite-Element Data
/// on Parallel Computers" (Sandia, 1998), and the names of dimensions and variables in exodusII_int.h of
/// SEACAS, https://sandialabs.github.io/seacas-docs/.
///
/// @param mesh         the mesh in its new order; Exodus II must be able to hold its cells
/// @param part_starts  as in `part_of`
/// @param paths        paths of existing files, one for each part
/// @param names        names of the files in messages
/// @param notes        receives notes on data that Exodus II stores in another form
/// @return number of vertices of all pieces minus that of the mesh: vertices on borders are in several pieces
/// @throws SharedError if a file cannot be written; TooLarge for more than 10,000 blocks; Unavailable in a
///         build without netCDF
GlobalIndex write_nemesis_pieces(const Mesh& mesh, const std::vector<GlobalIndex>& part_starts,
                                 const std::vector<std::string>& paths, const std::vector<std::string>& names,
                                 Notes& notes);

/// As above, for a mesh from an Exodus II file. Each rank has a part of the mesh, and writes the pieces of
/// its own parts. Every rank has to call it. O(size of the part + size of the share · log).
///
/// @param moved       the mesh in its new order by blocks
/// @param block_ends  ends of the file's blocks, as in `places_by_block`
/// @throws SharedError if a file cannot be written; and as `Communicator::exchange`
GlobalIndex write_nemesis_pieces(const Communicator& communicator, MovedPart moved,
                                 const std::vector<GlobalIndex>& block_ends,
                                 const std::vector<GlobalIndex>& part_starts,
                                 const std::vector<std::string>& paths,
                                 const std::vector<std::string>& names);

/// Returns the name of the file of a part: "mesh.e.16.03".
[[nodiscard]] std::string nemesis_name(const std::string& name, Index parts, Index part);

/// Returns whether a file is a piece that `write_nemesis_pieces` wrote; false in a build without netCDF.
[[nodiscard]] bool is_own_nemesis_piece(const std::filesystem::path& path);

}  // namespace meshorder::distributed
