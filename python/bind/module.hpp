// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <nanobind/nanobind.h>

namespace meshorder::python {

/// Each adds its subject to the module `meshorder._core`.
void add_errors(nanobind::module_& module);
void add_permutation(nanobind::module_& module);
void add_graphs(nanobind::module_& module);
void add_meshes(nanobind::module_& module);
void add_methods(nanobind::module_& module);

}  // namespace meshorder::python
