// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/mesh.hpp>

#include <filesystem>
#include <vector>

namespace meshorder::openfoam {

/// The parts of a mesh that are needed to order its cells.
struct PolyMesh {
  CsrGraph graph;              ///< joins cells that share an internal face
  Index internal_faces = 0;    ///< at least the number of edges: two cells may share several
  std::vector<Point> centres;  ///< of each cell the mean of its faces' centres; empty unless asked for
};

/// Reads the files `owner` and `neighbour` in the folder `polyMesh` of a case and, for the centres, `points`
/// and `faces`: text or binary, each also as `.gz`. They must lie below the case's folder.
///
/// @throws InputError for a file that is missing or faulty, with its line or byte, and for a cell without
///         faces; a mesh without any cell is returned as it is
/// @note O(faces · log faces of a cell); about 30 bytes a face besides the files' own size.
PolyMesh read_poly_mesh(const std::filesystem::path& of_case, const std::filesystem::path& folder,
                        bool with_centres);

}  // namespace meshorder::openfoam
