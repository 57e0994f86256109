// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"
#include "ordering/permutation.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::command {

/// Which vertex and cell of the output was which in the input, as NumPy arrays beside each other:
/// PREFIX.vertices.old_to_new.npy, PREFIX.vertices.new_to_old.npy, and the same for elements (all cells, in
/// the order of the file). Where the input numbers its vertices or cells in a way of its own,
/// PREFIX.vertices.ids.npy holds those numbers, in the input's order.
struct Maps {
  Permutation vertices;
  Permutation elements;
  std::vector<std::int64_t> vertex_ids;
  std::vector<std::int64_t> element_ids;
};

/// Writes the maps and returns the paths.
std::vector<std::string> write_maps(const Maps& maps, const std::string& prefix);

/// Reads maps for a mesh and checks that they fit it. Throws Error.
Maps read_maps(const std::string& prefix, const Mesh& mesh);

}  // namespace meshorder::command
