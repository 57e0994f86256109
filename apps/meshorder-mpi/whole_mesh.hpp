// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/order/order.hpp"
#include "mesh_files.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

namespace meshorder::command {

/// A mesh that rank 0 reads, moves and writes, its cells as the output keeps them.
struct WholeMesh : MeshToOrder {
  Permutation arranged;  ///< places of the cells as they were read
};

/// Reads a mesh at the root, whose memory it takes. Every rank has to call it.
///
/// @param files  with an output, which gives the format
/// @throws SharedError for a faulty file, cells that the output must hold and cannot, and ids likewise
[[nodiscard]] WholeMesh read_at_root(const distributed::Communicator& communicator, const MeshFiles& files,
                                     Ids ids, Notes& notes);

/// Puts the mesh at the root into its new order, and fills in its maps. Every rank has to call it.
void move_at_root(const distributed::Communicator& communicator, WholeMesh& whole,
                  const distributed::DistributedOrder& order, const MeshFiles& files, Ids ids);

}  // namespace meshorder::command
