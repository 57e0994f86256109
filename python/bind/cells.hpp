// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "arrays.hpp"
#include <meshorder/view.hpp>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder::python {

/// Cells as Python's half of the module passes them: blocks, each of one shape; or offsets, vertices and, if
/// given, types.
using Blocks = std::vector<std::pair<std::string, Array>>;
using Mixed = std::tuple<Array, Array, std::optional<Array>>;
using GivenCells = std::variant<Blocks, Mixed>;
using GivenPoints = std::optional<nb::ndarray<nb::ro, nb::device::cpu>>;

/// Returns a view; the arrays must outlive it. Throws InvalidArgument for unknown shapes.
MeshView mesh_view(const GivenPoints& points, const GivenCells& cells, std::size_t vertex_count);

}  // namespace meshorder::python
