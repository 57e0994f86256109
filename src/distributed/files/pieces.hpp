// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/grid_rows.hpp"
#include "distributed/files/piece_schema.hpp"

#include <string>
#include <vector>

namespace meshorder::distributed {

/// What is reported of pieces.
struct PiecesReport {
  GlobalIndex ghost_vertices = 0;  ///< of all pieces
  GlobalIndex ghost_cells = 0;
  Notes notes;  ///< at the root: what has another name in the pieces
};

/// Returns what the pieces of a mesh have in common. Every rank has to call it.
///
/// @param ghosts  layers of ghost cells, 0 or 1
/// @throws as `Communicator::exchange`
[[nodiscard]] PieceSchema schema_of_pieces(const Communicator& communicator, const GridRows& grid,
                                           int ghosts);

/// Writes a .vtu file for each part, over files that exist and are empty; each rank writes those of its
/// parts. Every rank has to call it. O(size of the mesh of a rank · log), memory for the cells of a rank's
/// pieces and one of their arrays after another.
///
/// Format: "VTK File Formats", https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.
///
/// @param part_starts  first new number of each part, and the end of the last one's
/// @param with_ghosts  whether a piece has the cells of other parts that use vertices of its part
/// @param paths        of the files, one for each part
/// @param names        of the files in messages
/// @throws SharedError where a rank cannot write, as on a full disk, and for a piece that a file with 32-bit
///         sizes cannot hold
PiecesReport write_pieces(const Communicator& communicator, const GridRows& grid, const PieceSchema& schema,
                          const std::vector<GlobalIndex>& part_starts, bool with_ghosts,
                          const std::vector<std::string>& paths, const std::vector<std::string>& names);

/// Returns what pieces lose in a .vtkhdf file that .vtu files hold.
[[nodiscard]] Notes losses_in_vtkhdf(const PieceSchema& schema);

/// Writes the pieces as the partitions of one .vtkhdf file, over a file that exists; each rank writes the
/// rows of its parts at the places where libhdf5, at the root, has made room for them. Every rank has to call
/// it. O(size of the mesh of a rank · log), memory for the cells of a rank's pieces and one of their arrays
/// after another.
///
/// Format: "VTKHDF File Format", version 1.0.
///
/// @param path  of the file
/// @param name  of the file in messages
/// @throws SharedError where a rank cannot write, as on a full disk, and for hexahedra of higher order that
///         VTK before its version 9 numbered; Unavailable in a build without HDF5
PiecesReport write_pieces_to_vtkhdf(const Communicator& communicator, const GridRows& grid,
                                    const PieceSchema& schema, const std::vector<GlobalIndex>& part_starts,
                                    bool with_ghosts, const std::string& path, const std::string& name);

}  // namespace meshorder::distributed
