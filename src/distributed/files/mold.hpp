// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/vtk/vtk.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// Returns an array with one row of zeros or empty texts; `type` is the index of an alternative of Values.
[[nodiscard]] DataArray blank_row(std::string name, Association association, std::size_t type,
                                  Index components, std::vector<std::string> component_names = {});

/// Returns a .vtu file of one point and one cell that declares the arrays and fields of a mesh.
///
/// @param arrays    one row of each array; arrays on points come before arrays on cells
/// @param metadata  metadata of the mesh; its encoding of .vtu files is ignored
/// @param in_order_of_vtk_9  whether higher-order hexahedra have VTK 9's node order; sets the file's version
/// @param notes     receives notes on data that .vtu files store in another form
[[nodiscard]] std::string mold_of(std::vector<DataArray> arrays, vtk::VtkMetadata metadata,
                                  bool in_order_of_vtk_9, Notes& notes);

}  // namespace meshorder::distributed
