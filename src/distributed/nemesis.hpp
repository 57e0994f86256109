// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "distributed/layout.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// Writes the parts of a mesh as files of Nemesis: Exodus II, with the numbers in the whole mesh, and what
/// each part shares with which others. A mesh that did not come from an Exodus II file, or is not in the
/// order of one, is written to memory as such a file first, and read from there. O(size of the mesh · log).
///
/// Format: Hennigan, Shadid, "NEMESIS I: A Set of Functions for Describing Unstructured Finite-Element Data
/// on Parallel Computers" (Sandia, 1998), and the names of dimensions and variables in exodusII_int.h of
/// SEACAS, https://sandialabs.github.io/seacas-docs/.
///
/// @param mesh         in its new order; Exodus II holds its cells
/// @param part_starts  as of `part_of`
/// @param files        one for each part
/// @param notes        receives what Exodus II holds in another way
/// @return how many vertices the pieces have more than the mesh, as several have the same
/// @throws InputError where a file cannot be written; Unavailable in a build without netCDF
GlobalIndex write_nemesis_pieces(const Mesh& mesh, const std::vector<GlobalIndex>& part_starts,
                                 const std::vector<FilePath>& files, Notes& notes);

/// Returns the name of the file of a part: "mesh.e.16.03".
[[nodiscard]] std::string nemesis_name(const std::string& name, Index parts, Index part);

/// Returns whether a file is a piece that `write_nemesis_pieces` wrote; false in a build without netCDF.
[[nodiscard]] bool is_own_nemesis_piece(const std::filesystem::path& path);

}  // namespace meshorder::distributed
