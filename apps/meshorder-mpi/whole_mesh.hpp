// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/order/order.hpp"
#include "mesh_files.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

#include <optional>

namespace meshorder::command {

/// Reads a mesh into the memory of the root, with its cells in the order that the output's format needs.
/// Every rank has to call it.
///
/// @param files  with an output, which sets the format
/// @throws SharedError for a faulty file, and if the output cannot hold cells or ids that it has to hold
[[nodiscard]] MeshToOrder read_at_root(const distributed::Communicator& communicator, const MeshFiles& files,
                                       Ids ids, Notes& notes);

/// Reorders the mesh at the root and fills in its maps. Entries of a matrix stay in the file's order. Every
/// rank has to call it.
void move_at_root(const distributed::Communicator& communicator, MeshToOrder& whole,
                  const distributed::DistributedOrder& order, bool has_maps, Ids ids);

}  // namespace meshorder::command
