// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/grid_rows.hpp"
#include "distributed/files/piece_schema.hpp"

#include <string>
#include <vector>

namespace meshorder::distributed {

/// Properties of the written pieces.
struct PiecesReport {
  GlobalIndex ghost_vertices = 0;  ///< summed over all pieces, like `ghost_cells`
  GlobalIndex ghost_cells = 0;
  Notes notes;  ///< at the root: notes on arrays whose names differ in the pieces
};

/// Returns the common properties of the pieces of a mesh. Every rank has to call it.
///
/// @param ghosts  layers of ghost cells, 0 or 1
/// @throws as `Communicator::exchange`
[[nodiscard]] PieceSchema schema_of_pieces(const Communicator& communicator, const GridRows& grid,
                                           int ghosts);

/// Writes a .vtu file for each part, to files that exist and are empty; each rank writes the files of its
/// parts. Every rank has to call it. O(size of the mesh of a rank · log); takes memory for the cells of a
/// rank's pieces and for one of their arrays at a time.
///
/// Format: "VTK File Formats", https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.
///
/// @param part_starts  first new number of each part, then the end of the last part
/// @param with_ghosts  whether a piece has the cells of other parts that use vertices of its part
/// @param paths        paths of the files, one for each part
/// @param names        names of the files in messages
/// @throws SharedError if a rank cannot write, as on a full disk, and for a piece too large for a file with
///         32-bit sizes
PiecesReport write_pieces(const Communicator& communicator, const GridRows& grid, const PieceSchema& schema,
                          const std::vector<GlobalIndex>& part_starts, bool with_ghosts,
                          const std::vector<std::string>& paths, const std::vector<std::string>& names);

/// Returns notes on what pieces lose in a .vtkhdf file, compared with .vtu files.
[[nodiscard]] Notes losses_in_vtkhdf(const PieceSchema& schema);

/// Writes the pieces as the partitions of one .vtkhdf file, to a file that exists. At the root, libhdf5 makes
/// room for all rows; then each rank writes the rows of its parts. Every rank has to call it. O(size of the
/// mesh of a rank · log); takes memory for the cells of a rank's pieces and for one of their arrays at a
/// time.
///
/// Format: "VTKHDF File Format", version 1.0.
///
/// @param path  path of the file
/// @param name  name of the file in messages
/// @throws SharedError if a rank cannot write, as on a full disk, and for higher-order hexahedra with the
///         node order of VTK before version 9; Unavailable in a build without HDF5
PiecesReport write_pieces_to_vtkhdf(const Communicator& communicator, const GridRows& grid,
                                    const PieceSchema& schema, const std::vector<GlobalIndex>& part_starts,
                                    bool with_ghosts, const std::string& path, const std::string& name);

}  // namespace meshorder::distributed
