// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Bindings for the list of methods, and methods written in Python.
#include "module.hpp"
#include "options.hpp"
#include <meshorder/registry.hpp>

#include <nanobind/stl/string.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

namespace meshorder::python {
namespace {

/// Returns the registered Python functions. They must be released before the interpreter ends, so `end` runs
/// at exit.
std::map<std::string, Registration>& registrations() {
  static std::map<std::string, Registration> all;
  return all;
}

nb::list described(const std::vector<MethodInfo>& methods) {
  nb::list list;
  for (const MethodInfo& method : methods) {
    list.append(nb::make_tuple(method.name, method.description, method.needs_points, method.deterministic,
                               method.source));
  }
  return list;
}

/// Returns a vertex method that calls `function(offsets, neighbours, points)`, which returns new_to_old. The
/// arrays are copies, because Python may keep them.
VertexMethod method_of(const nb::object& function) {
  // any thread may release the last reference to the function
  const std::shared_ptr<nb::object> kept(new nb::object(function), [](nb::object* object) {
    const nb::gil_scoped_acquire lock;
    delete object;
  });
  return [kept](const VertexProblem& problem, const OrderOptions&) {
    const nb::gil_scoped_acquire lock;
    std::vector<double> coordinates;
    coordinates.reserve(3 * problem.points.size());
    for (std::size_t i = 0; i < problem.points.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) coordinates.push_back(problem.points(i, axis));
    }
    const nb::object new_to_old =
        (*kept)(given(std::vector(problem.offsets.begin(), problem.offsets.end())),
                given(std::vector(problem.neighbours.begin(), problem.neighbours.end())),
                given(std::move(coordinates)));
    const Array map = nb::cast<Array>(new_to_old);
    return Permutation::from_new_to_old(index_view(map));
  };
}

}  // namespace

void add_methods(nb::module_& module) {
  module.def("vertex_methods", [] { return described(vertex_methods()); });
  module.def("element_methods", [] { return described(element_methods()); });
  module.def("register", [](const std::string& name, const std::string& description, bool needs_points,
                            const nb::object& function) {
    registrations().insert_or_assign(
        name,
        register_vertex_method(
            {.name = name, .description = description, .needs_points = needs_points, .source = "Python"},
            method_of(function)));
  });
  module.def("unregister", [](const std::string& name) { return registrations().erase(name) > 0; });
  module.def("end", [] {
    wait_for_calls();
    registrations().clear();
  });
  module.def("forget_calls", &forget_calls);
  module.def("load_methods", [](const std::string& path) { load_methods(path); });
}

}  // namespace meshorder::python
