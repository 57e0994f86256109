// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace meshorder {

/// The labels (kLabel) of all vertices or all cells.
struct Labels {
  std::vector<std::int64_t> values;  ///< each item's label, 0 if it has none; empty if the mesh has no labels
  std::vector<bool> given;           ///< whether the mesh gives each item a label

  [[nodiscard]] bool any() const noexcept { return !values.empty(); }
};

/// Returns the labels of vertices or cells from the array `name`. Ignores an array whose rows are not single
/// integers.
Labels labels_of(const Mesh& mesh, Association association, std::string_view name = kLabel);

/// Returns the array that `labels_of` uses, or nullptr.
const DataArray* label_array(const Mesh& mesh, Association association, std::string_view name = kLabel);

/// Notes that no array except the labels of cells is written; for formats that hold no other array.
void note_arrays_beside_cell_labels(const Mesh& mesh, std::string_view format, Notes& notes);

/// Notes, for a mesh from SU2, that its labels (markers named by numbers) are written as `what`.
void note_number_markers(const Mesh& mesh, std::string_view what, Notes& notes);

/// Converts labels to the values of an array: 32-bit integers if all fit.
Values label_values(std::vector<std::int64_t> labels);

}  // namespace meshorder
