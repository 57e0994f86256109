// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// A mesh in its new order, as a .vtu file holds it. Every rank has the rows of a range of new numbers.
struct GridRows {
  Layout vertices;
  Layout cells;
  Rows cell_vertices;  ///< of the own cells: new numbers, in VTK's order
  /// Returns the own rows of the k-th array of the piece in `xml`, which is not the connectivity or the
  /// offsets of cells; of an array of texts, 32-bit places among `texts`. Every rank has to call it.
  std::function<std::vector<std::byte>(std::size_t k)> rows;

  // at the root
  std::string xml;     ///< a .vtu file of one piece, of which only the arrays' elements count
  std::string fields;  ///< its <FieldData> with all values in itself; empty without
  std::vector<std::string> texts;
};

/// Shares out a mesh that the root has, and that is in its new order; VTK holds its cells. Every rank has to
/// call it. O(size of the mesh) at the root.
///
/// @param mesh   at the root, where it outlives the result; not looked at elsewhere
/// @param notes  at the root: what VTK's files hold in another way
/// @throws as `Communicator::exchange`
[[nodiscard]] GridRows scattered_grid(const Communicator& communicator, const Mesh& mesh, Notes& notes);

}  // namespace meshorder::distributed
