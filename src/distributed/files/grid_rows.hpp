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

class MovedPart;

/// A mesh in its new order, in the form of a .vtu file. Every rank has the rows of a range of new numbers.
struct GridRows {
  Layout vertices;
  Layout cells;
  Rows cell_vertices;  ///< vertices of this rank's cells: new numbers, in VTK's order
  /// Returns this rank's rows of the k-th array of the piece in `xml`; for texts, 32-bit indices in `texts`.
  /// Must not be called for the connectivity and the offsets of cells. Every rank has to call it.
  std::function<std::vector<std::byte>(std::size_t k)> rows;

  // only at the root
  std::string xml;     ///< a .vtu file of one piece; the values of its arrays are not used
  std::string fields;  ///< <FieldData> of `xml` with all values inline; empty if `xml` has the values inline
  std::vector<std::string> texts;
};

/// Distributes a mesh from the root. The mesh is in its new order, and VTK can hold its cells. Every rank has
/// to call it. O(size of the mesh) at the root.
///
/// @param mesh   at the root, where it must outlive the result; ignored on other ranks
/// @param notes  receives, at the root, notes on data that .vtu files store in another form
/// @throws as `Communicator::exchange`
[[nodiscard]] GridRows scattered_grid(const Communicator& communicator, const Mesh& mesh, Notes& notes);

/// Returns a moved mesh: equal to what `scattered_grid` makes from the whole mesh in its new order. The types
/// of labels and ids fit the values of all ranks; the marks of a set follow the order of the set's members on
/// all ranks. Every rank has to call it. O(size of the part).
///
/// @param communicator  must outlive the result
/// @param moved         must outlive the result, and have only cells that VTK can hold; loses its cells
/// @param notes         as for `scattered_grid`
[[nodiscard]] GridRows moved_grid(const Communicator& communicator, MovedPart& moved, Notes& notes);

}  // namespace meshorder::distributed
