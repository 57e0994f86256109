// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "cells/cell_arrays.hpp"
#include <meshorder/order.hpp>

#include <span>
#include <string_view>
#include <vector>

namespace meshorder {

/// Returns whether all cells may change places with each other, as in most meshes: one block of one
/// dimension. O(cells).
bool has_one_slot_class(const CellArrays& cells);

/// Cells that may change places with each other have the same slot class: block × dimension. Returns the
/// class of each cell, 4 · block + dimension. O(cells).
std::vector<Index> slot_classes(const CellArrays& cells);

/// Gives the places of each class to the cells of the class, in the order in which `cells_in_order` lists the
/// cells.
///
/// @throws InvalidArgument unless `cells_in_order` and `classes` have the same size
Permutation permutation_within_classes(std::span<const Index> classes, std::vector<Index>&& cells_in_order);

/// Orders all cells: cells of the highest dimension by the method, the others by `lexmax` (under `original`
/// they do not move). A cell moves only to places of its slot class. Within a class, the cells of a group
/// stay together, and the groups ascend.
///
/// @param groups  a number for each cell, or none
/// @throws as `order_incidence`, and InvalidArgument unless `groups` is empty or has a number for each cell
Order order_cells(std::string_view method, const CellArrays& cells, const Permutation& vertices,
                  const PointsView& points, const IndexView& groups, const OrderOptions& options);

}  // namespace meshorder
