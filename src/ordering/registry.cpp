// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/all_methods.hpp"
#include "ordering/space_filling.hpp"
#include <meshorder/error.hpp>
#include <meshorder/options.hpp>
#include <meshorder/registry.hpp>

#include <algorithm>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {

namespace {

template <class Method>
struct Registered {
  std::uint64_t id;
  MethodInfo info;
  Method method;
};

/// The registered methods of a program, in the order of their registration.
struct Registry {
  std::shared_mutex mutex;
  std::uint64_t next_id = 1;
  std::vector<Registered<VertexMethod>> vertex_methods;
  std::vector<Registered<ElementMethod>> element_methods;
};

/// Returns the registry. It is never destroyed, since static objects may hold registrations until the program
/// ends.
Registry& registry() {
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): all threads share it
  static auto* const registry = new Registry;
  return *registry;
}

bool is_permitted(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

template <class Method>
std::uint64_t add(MethodInfo info, Method method, const std::vector<MethodInfo>& built_in,
                  std::vector<Registered<Method>> Registry::*list) {
  if (!method) throw InvalidArgument("method '" + info.name + "': the function is empty");
  if (!is_permitted(info.name)) {
    throw InvalidArgument("method '" + info.name +
                          "': a name consists of lower case letters, digits, '-' and '_'");
  }
  Registry& all = registry();
  const std::unique_lock lock(all.mutex);
  const auto has_name = [&](const MethodInfo& other) { return other.name == info.name; };
  if (std::any_of(built_in.begin(), built_in.end(), has_name) ||
      std::any_of((all.*list).begin(), (all.*list).end(),
                  [&](const Registered<Method>& entry) { return has_name(entry.info); })) {
    throw InvalidArgument("method '" + info.name + "': the name is taken");
  }
  if (info.source == MethodInfo{}.source) info.source = "registered";
  const std::uint64_t id = all.next_id++;
  (all.*list).push_back({id, std::move(info), std::move(method)});
  return id;
}

template <class Method>
std::vector<MethodInfo> all_infos(std::vector<MethodInfo> infos,
                                  std::vector<Registered<Method>> Registry::*list) {
  Registry& all = registry();
  const std::shared_lock lock(all.mutex);
  for (const Registered<Method>& entry : all.*list) infos.push_back(entry.info);
  return infos;
}

template <class Method>
Method method_of_name(std::string_view name, std::vector<Registered<Method>> Registry::*list) {
  Registry& all = registry();
  const std::shared_lock lock(all.mutex);
  for (const Registered<Method>& entry : all.*list) {
    if (entry.info.name == name) return entry.method;
  }
  return {};
}

/// If the list has a method with that number, moves the method out of the list into `method`.
template <class Method>
void take_out(std::vector<Registered<Method>>& list, std::uint64_t id, Method& method) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.id == id; });
  if (found == list.end()) return;
  method = std::move(found->method);
  list.erase(found);
}

void remove(std::uint64_t id) {
  if (id == 0) return;
  Registry& all = registry();
  // destroyed after the lock is released: the user's objects may call these functions again
  VertexMethod vertex_method;
  ElementMethod element_method;
  const std::unique_lock lock(all.mutex);
  take_out(all.vertex_methods, id, vertex_method);
  take_out(all.element_methods, id, element_method);
}

/// Returns the method. If the method needs points, the result throws InvalidArgument unless all vertices have
/// coordinates. `vertices(problem)` returns the number of vertices.
template <class Problem, class Method, class Vertices>
Method with_points(const MethodInfo& info, Method method, Vertices vertices) {
  if (!info.needs_points || !method) return method;
  return [name = info.name, method = std::move(method), vertices](const Problem& problem,
                                                                  const OrderOptions& options) {
    check_points(problem.points, vertices(problem), name);
    return method(problem, options);
  };
}

}  // namespace

VertexMethod registered_vertex_method(std::string_view name) {
  return method_of_name(name, &Registry::vertex_methods);
}

ElementMethod registered_element_method(std::string_view name) {
  return method_of_name(name, &Registry::element_methods);
}

inline namespace v0_3 {

Registration& Registration::operator=(Registration&& other) noexcept {
  if (this != &other) {
    remove(id_);
    id_ = std::exchange(other.id_, 0);
  }
  return *this;
}

Registration::~Registration() { remove(id_); }

Registration register_vertex_method(MethodInfo info, VertexMethod method) {
  method = with_points<VertexProblem>(
      info, std::move(method), [](const VertexProblem& problem) { return problem.offsets.size() - 1; });
  return Registration(
      add(std::move(info), std::move(method), built_in_vertex_methods(), &Registry::vertex_methods));
}

Registration register_element_method(MethodInfo info, ElementMethod method) {
  method = with_points<ElementProblem>(
      info, std::move(method), [](const ElementProblem& problem) { return problem.vertex_ranks.size(); });
  return Registration(
      add(std::move(info), std::move(method), built_in_element_methods(), &Registry::element_methods));
}

std::vector<MethodInfo> vertex_methods() {
  return all_infos(built_in_vertex_methods(), &Registry::vertex_methods);
}

std::vector<MethodInfo> element_methods() {
  return all_infos(built_in_element_methods(), &Registry::element_methods);
}

}  // namespace v0_3
}  // namespace meshorder
