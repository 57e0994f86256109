// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/vtk/vtk.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <string>
#include <vector>

namespace meshorder::distributed {

/// Returns a .vtu file of one point and one cell, which says what arrays and fields a mesh has.
///
/// @param arrays    one row of each, those of points before those of cells
/// @param metadata  of the mesh; how a .vtu file is coded is not looked at
/// @param in_order_of_vtk_9  whether the nodes of higher-order hexahedra are, which the file's version says
/// @param notes     receives what .vtu files hold in another way
[[nodiscard]] std::string mold_of(std::vector<DataArray> arrays, vtk::Metadata metadata,
                                  bool in_order_of_vtk_9, Notes& notes);

/// Returns the fields of such a file as they are there, with their values; an empty text without fields.
[[nodiscard]] std::string fields_of(const std::string& mold);

}  // namespace meshorder::distributed
