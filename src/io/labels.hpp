// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <cstdint>
#include <vector>

namespace meshorder {

/// The labels (kLabel) of all vertices or all cells, for formats that have a column for them.
struct Labels {
  std::vector<std::int64_t> values;  ///< 0 where none is given; empty when the mesh has no such array
  std::vector<bool> given;

  [[nodiscard]] bool any() const noexcept { return !values.empty(); }
};

/// Labels of a mesh. An array of that name that does not hold one whole number for each is no label.
Labels labels_of(const Mesh& mesh, Association association);

/// The array that `labels_of` takes, or nullptr.
const DataArray* label_array(const Mesh& mesh, Association association);

/// The values of a label array: in 32 bits when all fit.
Values label_values(std::vector<std::int64_t> labels);

}  // namespace meshorder
