// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// meshorder._core: the library's functions on arrays. Users call Python's half of the package, which converts
// their objects to arrays and back.
#include "module.hpp"

#include <meshorder/version.hpp>

#include <nanobind/stl/string.h>

NB_MODULE(_core, module) {
  using namespace meshorder::python;
  nanobind::set_leak_warnings(false);  // a user's global variables keep objects until the process ends
  add_errors(module);
  add_permutation(module);
  add_graphs(module);
  add_meshes(module);
  add_changing(module);
  add_layouts(module);
  add_methods(module);
  module.def("build_info", &meshorder::build_info);
  module.attr("version") = MESHORDER_VERSION_STRING;
}
