// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace meshorder::openfoam {

/// The parts of a mesh that are needed to order its cells.
struct PolyMesh {
  CsrGraph graph;              ///< joins cells that share an internal face
  Index internal_faces = 0;    ///< at least the number of edges: two cells may share several faces
  std::vector<Point> centres;  ///< for each cell, the mean of its faces' centres; empty if not wanted
};

/// Throws InputError for a missing file of a mesh.
[[noreturn]] void refuse_missing(const std::filesystem::path& file);

/// Reads the files `owner`, `neighbour` and `boundary` in the folder `polyMesh` of a case and, for the
/// centres, `points` and `faces`. Each file may be text or binary, and may be compressed as `.gz`. All must
/// lie below the case's folder. Two cells may share several faces, and faces need not be sorted by their
/// cells. Notes counts in the headers that differ from the files. Accepts a mesh without any cell.
///
/// @throws InputError if one of the five files is missing; if a file is faulty, with its line, byte or face;
///         if a cell has no face, the owner of an internal face does not have the lower number, or patches do
///         not cover the faces of the boundary
/// @note O(faces · log faces of a cell); about 30 bytes a face besides the files' own size.
PolyMesh read_poly_mesh(const std::filesystem::path& of_case, const std::filesystem::path& folder,
                        bool with_centres, Notes& notes);

/// Checks that the patches of a file `boundary` cover the faces after the internal ones in order, without
/// gaps. Patches without faces may begin anywhere. Does not check a file that refers to other numbers by `$`
/// or `#`. O(bytes of the file).
///
/// @throws InputError for a file that is no list of patches, for a patch without `nFaces` or `startFace`, and
///         for patches that leave a gap, overlap or end too early or too late
void check_boundary(const FilePath& path, std::int64_t faces, std::int64_t internal_faces);

}  // namespace meshorder::openfoam
