// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/error.hpp"
#include "io/format.hpp"
#include "mesh/mesh.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace meshorder {

/// The cell array that keeps VTK's own numbers of cell types where shape and number of vertices do not tell
/// them: a Lagrange tetrahedron of 10 nodes is not a quadratic one.
inline constexpr std::string_view kVtkTypes = "vtk:type";

/// Cells as VTK's files hold them: type numbers of vtkCellType.h, and for each cell the end of its vertices.
struct VtkCells {
  std::vector<std::uint8_t> types;
  std::vector<Offset> offsets{0};
  std::vector<Index> vertices;
};

/// The Error at the cell types of a file: (what, remedy).
using VtkError = std::function<Error(const std::string&, const std::string&)>;

/// Gives `mesh` these cells, their vertices in the order of a Mesh. Pixels and voxels become quads and
/// hexahedra (noted); numbers that shape and vertices do not tell are kept as the array kVtkTypes. Throws
/// `error` for types that have no Shape and for cells with a number of vertices that their type does not
/// have. O(vertex entries).
void take_vtk_cells(Mesh& mesh, VtkCells cells, const VtkError& error, Notes& notes);

/// VTK's type number of every cell. Throws Error naming the first cell that VTK's files cannot hold: node
/// orders above second order are known only of meshes that came from VTK (`higher_orders`).
std::vector<std::uint8_t> vtk_types(const Mesh& mesh, const std::string& file, bool higher_orders);

/// True for types of which VTK's files list the vertices in another order than a Mesh does: linear wedges.
bool has_order_of_its_own(std::uint8_t type);

/// Brings the vertices of all cells of such types into the order of VTK's files. O(cells).
void swap_to_vtk(const std::vector<std::uint8_t>& types, Cells& cells);

/// True for hexahedra of higher order, whose nodes VTK numbered differently before its version 9 (files of
/// XML version 2.1 and of legacy version 5.1).
bool is_higher_order_hexahedron(std::uint8_t type);

/// Swaps the two edges that VTK 9 numbers differently, in all higher-order hexahedra of `cells`; applied
/// twice it changes nothing. Degrees come from the array HigherOrderDegrees of the mesh, where it has one.
void swap_hexahedron_edges(const Mesh& mesh, const std::vector<std::uint8_t>& types, Cells& cells);

}  // namespace meshorder
