// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/status.hpp"
#include "ordering/foreign_method.hpp"
#include <meshorder/error.hpp>
#include <meshorder/registry.hpp>

#include <meshorder.h>

#include <filesystem>
#include <string>
#include <system_error>

#if defined(__unix__) || defined(__APPLE__)
#include <dlfcn.h>
#endif

namespace meshorder {

#if defined(__unix__) || defined(__APPLE__)
namespace {

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): a plug-in's function has no other context
thread_local std::string source_of_methods;
thread_local std::string fault_of_method;  // why a method was last refused
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

/// Registers a method of a plug-in for the rest of the program.
mo_status register_method(const char* name, const char* description, int32_t needs_points, mo_method method,
                          void* user) {
  return status_of(
      [&] { register_foreign_method(name, description, needs_points, method, user, source_of_methods); },
      fault_of_method);
}

}  // namespace
#endif

inline namespace v0_3 {

void load_methods(const std::filesystem::path& shared_library) {
#if defined(__unix__) || defined(__APPLE__)
  // dlopen would look for a name without a folder only among the system's libraries
  std::error_code failed_to_look;
  const std::filesystem::path file = std::filesystem::exists(shared_library, failed_to_look)
                                         ? std::filesystem::absolute(shared_library)
                                         : shared_library;
  if (std::filesystem::exists(file, failed_to_look) &&
      !std::filesystem::is_regular_file(file, failed_to_look))
    throw Unavailable("plug-in: " + file.string() +
                      " is not a file; give a shared library");  // dlopen would block on a pipe
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw Unavailable("plug-in: " + std::string(dlerror()));
  using Plugin = mo_status (*)(mo_register_fn);
  const auto plugin = reinterpret_cast<Plugin>(dlsym(library, "meshorder_plugin_v1"));
  if (plugin == nullptr) {
    throw Unavailable("plug-in: " + shared_library.string() + " has no function meshorder_plugin_v1");
  }
  source_of_methods = shared_library.filename().string();
  fault_of_method.clear();
  if (const mo_status failed = plugin(register_method); failed != MO_OK) {
    throw InvalidArgument("plug-in: " + shared_library.string() + " returned " + std::to_string(failed) +
                          " on being loaded" + (fault_of_method.empty() ? "" : ": " + fault_of_method));
  }
#else
  throw Unavailable("plug-in: " + shared_library.string() + ": this build cannot load shared libraries");
#endif
}

}  // namespace v0_3
}  // namespace meshorder
