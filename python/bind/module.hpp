// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <string_view>
#include <vector>

namespace meshorder::python {

/// Returns a text of the library as a Python str. Names in files may have any bytes: those that are not UTF-8
/// become escapes, `\xff`.
nanobind::str text(std::string_view bytes);
nanobind::list texts(const std::vector<std::string>& list);

/// Each function adds its part of the module `meshorder._core`.
void add_errors(nanobind::module_& module);
void add_permutation(nanobind::module_& module);
void add_graphs(nanobind::module_& module);
void add_meshes(nanobind::module_& module);
void add_changing(nanobind::module_& module);
void add_layouts(nanobind::module_& module);
void add_methods(nanobind::module_& module);

}  // namespace meshorder::python
