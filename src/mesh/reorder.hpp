// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "graph/csr_graph.hpp"
#include <meshorder/mesh.hpp>

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

template <>
struct EnumNames<Ids> {
  static constexpr std::string_view kind = "treatment of ids";
  static constexpr std::array names{std::pair{Ids::renumber, "renumber"}, std::pair{Ids::keep, "keep"},
                                    std::pair{Ids::attach, "attach"}};
};

/// Computes the order by which the public `reorder` moves a mesh, but does not change the mesh. `graph` is
/// the mesh's vertex graph; `options.ids` and `options.format` are not used. Throws as `reorder`, but does
/// not check the mesh.
MeshOrder compute_reordering(const Mesh& mesh, const CsrGraph& graph, const ReorderOptions& options);

/// Like `move_mesh`, with the order that `compute_reordering` returned.
void apply_reordering(Mesh& mesh, const MeshOrder& order, Ids ids = Ids::renumber);

/// Like the public `apply_reordering`, but does not check the mesh. For `Ids::keep`, ids must exist already.
void move_mesh(Mesh& mesh, const Permutation& vertices, const Permutation& cells, Ids ids);

/// Returns the permutation that sorts cells by dimension, highest first, then by type, stably; nothing if the
/// cells are sorted already. For formats that keep the cells of a type together. O(cells · log cells).
std::optional<Permutation> places_by_type(const Cells& cells);

/// Moves the cells by `places_by_type`, makes each type a block, and returns that permutation, or nothing if
/// no cell moves. O(size of the mesh + cells · log cells).
std::optional<Permutation> group_cells_by_type(Mesh& mesh);

/// Undoes a permutation of cells and gives the mesh its old blocks. O(size of the mesh).
void restore_cells(Mesh& mesh, const Permutation& arranged, std::vector<Index> blocks);

}  // namespace meshorder
