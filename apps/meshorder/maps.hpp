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

/// The reordering of a mesh file, on disk as NumPy arrays: PREFIX.vertices.old_to_new.npy and
/// PREFIX.vertices.new_to_old.npy, and PREFIX.cells.*.npy for all cells. If the input numbers its vertices
/// or cells other than from 0 or 1 on, PREFIX.vertices.ids.npy or PREFIX.cells.ids.npy holds these numbers
/// in the input's order. If cells of the input were left out, the maps of cells number those that were kept,
/// and PREFIX.cells.kept.npy holds their positions among all cells of the input. Where the mesh is in parts,
/// PREFIX.vertices.parts.npy and PREFIX.cells.parts.npy hold the part of each in the new order.
/// PREFIX.maps.json says which mesh the maps are for, without the cells that were left out.
struct Maps {
  Permutation vertices;
  Permutation cells;
  std::vector<std::int64_t> vertex_ids;
  std::vector<std::int64_t> cell_ids;
  std::vector<Index> kept;          ///< empty: all cells
  std::vector<Index> vertex_parts;  ///< of each vertex in the new order; empty: no parts
  std::vector<Index> cell_parts;    ///< of each cell in the new order
};

/// Checksums that distinguish a mesh, and the order that it is in, from others.
struct MeshChecksums {
  std::uint64_t points = 0;  ///< of the coordinates
  std::uint64_t cells = 0;   ///< of the vertices of all cells

  bool operator==(const MeshChecksums&) const = default;
};

/// Checksums of the maps themselves, by which those of two runs are told apart: of the new places of all
/// vertices and of all cells, and of what not every mesh has, which are empty lists then.
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

/// Fails, before the work, if maps cannot be written.
void check_can_write_maps(const std::string& prefix);

/// Writes the maps, and the checksums of the mesh before and after, as files of a set, and has that remove
/// maps that an earlier run left with this prefix; returns the paths.
std::vector<std::string> write_maps(const Maps& maps, const MeshChecksums& before, const MeshChecksums& after,
                                    const std::string& prefix, OutputSet& files);

/// Writes PREFIX.maps.json as a file of a set; returns its path.
std::string write_identity(const MeshChecksums& before, const MeshChecksums& after, const MapChecksums& maps,
                           const std::string& prefix, OutputSet& files);

/// Has a set remove maps that an earlier run left with this prefix and that not every mesh has: old numbers
/// and kept cells.
void remove_other_maps(const std::string& prefix, OutputSet& files);

/// Leaves those cells out of a mesh that were left out before it was ordered, with the notes of `keep_cells`.
/// A mesh that has just the cells that were kept stays as it is. Throws Error for positions that do not fit
/// it.
void leave_out_unmapped_cells(const std::string& prefix, Mesh& mesh, Notes& notes);

/// Reads the maps of a mesh, which is in its old order or, if `inverse`, in the new one. Throws Error if a
/// file is missing, is not a permutation or has another length; and if PREFIX.maps.json is there and says
/// that the mesh is in the other order or is another one. A mesh whose points were moved is still the same by
/// its cells.
Maps read_maps(const std::string& prefix, const Mesh& mesh, const std::string& mesh_path, bool inverse);

}  // namespace meshorder::command
