// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/foreign_method.hpp"
#include <meshorder/error.hpp>
#include <meshorder/registry.hpp>

#include <meshorder.h>

#include <string>
#include <utility>
#include <vector>

#if defined(__unix__) || defined(__APPLE__)
#include <dlfcn.h>
#endif

namespace meshorder {
namespace {

thread_local std::string source_of_methods;

/// Registers a method of a plug-in for the rest of the program.
mo_status register_foreign(const char* name, const char* description, int32_t needs_points, mo_method method,
                           void* user) {
  try {
    if (name == nullptr || method == nullptr) return MO_INVALID_ARGUMENT;
    register_vertex_method({.name = name,
                            .description = description != nullptr ? description : "",
                            .needs_points = needs_points != 0,
                            .source = source_of_methods},
                           foreign_vertex_method(name, needs_points != 0, method, user))
        .keep();
    return MO_OK;
  } catch (const Error& error) {
    return static_cast<mo_status>(error.code());
  } catch (...) {
    return MO_INTERNAL;
  }
}

}  // namespace

VertexMethod foreign_vertex_method(std::string name, bool needs_points, mo_method method, void* user) {
  return [name = std::move(name), needs_points, method, user](const VertexProblem& problem,
                                                              const OrderOptions&) {
    const auto n = static_cast<std::int64_t>(problem.offsets.size()) - 1;
    std::vector<double> xyz;
    if (problem.points.size() > 0) {
      xyz.reserve(3 * problem.points.size());
      for (std::size_t p = 0; p < problem.points.size(); ++p) {
        for (int axis = 0; axis < 3; ++axis) xyz.push_back(problem.points(p, axis));
      }
    } else if (needs_points) {
      throw InvalidArgument("order '" + name + "' needs the coordinates of all vertices");
    }
    std::vector<Index> new_to_old(static_cast<std::size_t>(n), -1);
    const int failed = method(user, n, problem.offsets.data(), problem.neighbours.data(),
                              xyz.empty() ? nullptr : xyz.data(), new_to_old.data());
    if (failed != 0) {
      throw InternalError("the order '" + name + "' failed with " + std::to_string(failed));
    }
    return Permutation::from_new_to_old(std::move(new_to_old));
  };
}

inline namespace v0_2 {

void load_methods(const std::filesystem::path& shared_library) {
#if defined(__unix__) || defined(__APPLE__)
  void* const library = dlopen(shared_library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw Unavailable("plug-in: " + std::string(dlerror()));
  using Plugin = int (*)(mo_register_fn);
  const auto plugin = reinterpret_cast<Plugin>(dlsym(library, "meshorder_plugin_v1"));
  if (plugin == nullptr) {
    throw Unavailable("plug-in: " + shared_library.string() + " has no function meshorder_plugin_v1");
  }
  source_of_methods = shared_library.filename().string();
  if (const int failed = plugin(register_foreign); failed != 0) {
    throw InvalidArgument("plug-in: " + shared_library.string() + " returned " + std::to_string(failed) +
                          " on being loaded");
  }
#else
  throw Unavailable("plug-in: " + shared_library.string() + ": this build cannot load shared libraries");
#endif
}

}  // namespace v0_2
}  // namespace meshorder
