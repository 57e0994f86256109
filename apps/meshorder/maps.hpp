// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/output_set.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::command {

/// The reordering of a mesh file. On disk it is a set of NumPy arrays:
/// - PREFIX.vertices.old_to_new.npy, PREFIX.vertices.new_to_old.npy, and the same for cells;
/// - PREFIX.vertices.ids.npy, PREFIX.cells.ids.npy: the input's numbers of vertices and cells, in the input's
///   order, if they are other than 0, 1, … or 1, 2, …;
/// - PREFIX.cells.kept.npy: the positions of the kept cells among all cells of the input, if some cells were
///   left out; the maps of cells then number only the kept cells;
/// - PREFIX.vertices.parts.npy, PREFIX.cells.parts.npy: the part of each vertex and cell, in the new order;
///   only for a mesh in parts.
///
/// PREFIX.maps.json identifies the mesh of the maps, without the cells that were left out.
struct Maps {
  Permutation vertices;
  Permutation cells;
  std::vector<std::int64_t> vertex_ids;
  std::vector<std::int64_t> cell_ids;
  std::vector<Index> kept;          ///< empty: all cells
  std::vector<Index> vertex_parts;  ///< of each vertex in the new order; empty: no parts
  std::vector<Index> cell_parts;    ///< of each cell in the new order
};

/// Checksums that identify a mesh in its present order.
struct MeshChecksums {
  std::uint64_t points = 0;  ///< of the coordinates
  std::uint64_t cells = 0;   ///< of the vertices of all cells

  bool operator==(const MeshChecksums&) const = default;
};

/// Checksums that distinguish the maps of two runs: of the new numbers of all vertices and cells, and of the
/// optional lists. A missing list counts as empty.
struct MapChecksums {
  std::uint64_t vertices = 0;
  std::uint64_t cells = 0;
  std::uint64_t vertex_ids = 0;
  std::uint64_t cell_ids = 0;
  std::uint64_t kept = 0;

  bool operator==(const MapChecksums&) const = default;
};

/// The files of the maps of vertices or of cells.
struct MapPaths {
  std::string old_to_new;
  std::string new_to_old;
  std::string ids;
  std::string parts;
};

/// Returns the paths of maps with a prefix; `what` is "vertices" or "cells".
MapPaths map_paths(const std::string& prefix, const std::string& what);

/// Returns the checksums of a mesh in its order, the same on any number of threads. O(points + cells).
MeshChecksums checksums_of(const Mesh& mesh);

/// Throws if maps cannot be written. Call it before the work.
void check_can_write_maps(const std::string& prefix);

/// Writes the maps, and the checksums of the mesh before and after, as files of a set. The set also removes
/// optional maps that an earlier run left with this prefix. Returns the paths.
std::vector<std::string> write_maps(const Maps& maps, const MeshChecksums& before, const MeshChecksums& after,
                                    const std::string& prefix, OutputSet& files);

/// Writes PREFIX.maps.json as a file of a set; returns its path.
std::string write_identity(const MeshChecksums& before, const MeshChecksums& after, const MapChecksums& maps,
                           const std::string& prefix, OutputSet& files);

/// Makes `files` also remove optional maps that an earlier run left with this prefix: old numbers and kept
/// cells.
void remove_other_maps(const std::string& prefix, OutputSet& files);

/// Removes from a mesh the cells that were left out before it was ordered, and adds notes on the losses. A
/// mesh that has exactly the kept cells stays as it is. Throws Error for positions that do not fit the mesh.
void leave_out_unmapped_cells(const std::string& prefix, Mesh& mesh, Notes& notes);

/// Reads the maps of a mesh that is in its old order or, if `inverse`, in the new one. Throws Error if:
/// - `prefix` names a file, or a file is missing, faulty or of another length;
/// - PREFIX.maps.json exists and shows that the maps belong to another mesh or run, or that the mesh is in
///   the other order. A mesh with moved points is still recognised by its cells.
Maps read_maps(const std::string& prefix, const Mesh& mesh, const std::string& mesh_path, bool inverse);

}  // namespace meshorder::command
