// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The C interface to orders, Fiedler vectors and methods.
#include "base/stopwatch.hpp"
#include "c/arguments.hpp"
#include "cells/cell_arrays.hpp"
#include "ordering/foreign_method.hpp"
#include <meshorder/changing.hpp>
#include <meshorder/error.hpp>
#include <meshorder/fiedler.hpp>
#include <meshorder/options.hpp>
#include <meshorder/order.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/registry.hpp>
#include <meshorder/version.hpp>
#include <meshorder/view.hpp>

#include <meshorder.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::c {
namespace {

/// Throws if there are points, but not one for each of the `n` vertices of a graph.
void check_points(const PointsView& points, std::size_t n) {
  if (points.empty() || points.size() == n) return;
  fail("points", "there are " + std::to_string(points.size()) + ", but the offsets are those of " +
                     std::to_string(n) + " vertices");
}

/// Throws if all outputs of a call are null.
void check_any_output(std::initializer_list<const mo_out*> maps,
                      std::initializer_list<const mo_result*> results) {
  const auto exists = [](const auto* output) { return output != nullptr; };
  if (std::ranges::any_of(maps, exists) || std::ranges::any_of(results, exists)) return;
  throw InvalidArgument("all outputs are null; give at least one");
}

/// Throws if two arrays of `bytes` bytes each overlap.
void check_apart(const void* from, const void* to, std::uint64_t bytes) {
  const auto a = reinterpret_cast<std::uintptr_t>(from);
  const auto b = reinterpret_cast<std::uintptr_t>(to);
  if (a != 0 && b != 0 && (a < b ? b - a : a - b) < bytes)
    fail("to", "the rows overlap those of from; give another array");
}

void check_result(const mo_result* result) {
  if (result != nullptr) check_struct_size(result->struct_size, "result");
}

/// Writes those fields of a report for which the caller's structure has room.
void write_report(const mo_result& report, mo_result* result) {
  if (result == nullptr) return;
  copy_fields(report, *result, result->struct_size, &mo_result::complete, &mo_result::components,
              &mo_result::seconds, &mo_result::lambda2, &mo_result::method);
}

mo_result report_of(bool complete, double seconds, const std::vector<FiedlerComponent>& components,
                    std::string_view method) {
  mo_result report{};
  report.complete = complete ? 1 : 0;
  report.components = static_cast<std::int32_t>(components.size());
  report.seconds = seconds;
  const auto largest =
      std::max_element(components.begin(), components.end(),
                       [](const FiedlerComponent& a, const FiedlerComponent& b) { return a.size < b.size; });
  if (largest != components.end()) report.lambda2 = largest->lambda2;
  method.copy(report.method, sizeof report.method - 1);  // the rest is zero
  return report;
}

mo_result report_of(const Order& order) {
  return report_of(order.complete, order.seconds, order.fiedler, order.method.name);
}

void order_graph(const GraphView& graph, const PointsView& points, const mo_options& options,
                 const mo_out* new_to_old, const mo_out* old_to_new, mo_result* result) {
  const std::size_t n = graph.offsets.size() - 1;
  check_points(points, n);
  check_any_output({new_to_old, old_to_new}, {result});
  check_integers(new_to_old, n, "new_to_old");
  check_integers(old_to_new, n, "old_to_new");
  check_result(result);
  const Order order = order_vertices(graph, name_or_auto(options.method), order_options(options), points);
  write(order.permutation.new_to_old(), graph.base, new_to_old, "new_to_old");
  write(order.permutation.old_to_new(), graph.base, old_to_new, "old_to_new");
  write_report(report_of(order), result);
}

/// Returns the map as a permutation; throws if it is not a bijection or has too many entries.
Permutation permutation_of(const IndexView& new_to_old, int base) {
  const auto n = static_cast<std::int64_t>(new_to_old.size());
  if (n > std::numeric_limits<Index>::max()) {
    throw TooLarge("new_to_old: " + std::to_string(n) + " entries; at most 2,147,483,647 are possible");
  }
  std::vector<Index> map(new_to_old.size());
  for (std::size_t k = 0; k < map.size(); ++k) {
    const std::int64_t old = new_to_old[k];
    if (old < base || old >= n + base) {
      fail("new_to_old", "entry " + std::to_string(k) + " is " + std::to_string(old) + ", outside " +
                             std::to_string(base) + " … " + std::to_string(n - 1 + base));
    }
    map[k] = static_cast<Index>(old - base);
  }
  return Permutation::from_new_to_old(std::move(map));
}

/// Converts a number counted from `base` to one counted from 0. Returns the smallest int64 unchanged, to
/// avoid overflow: it is out of every range.
std::int64_t from_zero_on(std::int64_t number, int base) {
  return number == std::numeric_limits<std::int64_t>::min() ? number : number - base;
}

/// Returns the previous places, counted from 0; -1 for new vertices.
std::vector<std::int64_t> places_before(const IndexView& previous, int base) {
  std::vector<std::int64_t> places(previous.size());
  for (std::size_t v = 0; v < places.size(); ++v) places[v] = from_zero_on(previous[v], base);
  return places;
}

/// Returns a copy of a name; the copy lives as long as the process.
const char* kept(std::string name) {
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): never destroyed
  static auto* const mutex = new std::mutex;
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): never destroyed
  static auto* const names = new std::set<std::string>;
  const std::lock_guard lock(*mutex);
  return names->insert(std::move(name)).first->c_str();
}

}  // namespace
}  // namespace meshorder::c

using namespace meshorder;
using namespace meshorder::c;

struct mo_reorderer {
  Reorderer inside;
  int base;
};

uint32_t mo_version() { return version(); }

mo_status mo_order_graph(const mo_in* offsets, const mo_in* neighbours, const mo_in* weights,
                         const mo_in* points, int32_t dimension, const mo_options* options,
                         const mo_out* new_to_old, const mo_out* old_to_new, mo_result* result) {
  return guarded([&] {
    const mo_options given = complete_options(options);
    order_graph(graph_of(offsets, neighbours, weights, base_of(given.base)), points_of(points, dimension),
                given, new_to_old, old_to_new, result);
  });
}

mo_status mo_order_mesh(const mo_in* cell_offsets, const mo_in* cell_vertices, const mo_in* vtk_types,
                        int64_t vertex_count, const mo_in* points, int32_t dimension,
                        const mo_options* options, const mo_out* vertex_new_to_old,
                        const mo_out* vertex_old_to_new, const mo_out* cell_new_to_old,
                        const mo_out* cell_old_to_new, mo_result* vertex_result, mo_result* cell_result) {
  return guarded([&] {
    const mo_options given = complete_options(options);
    const int base = base_of(given.base);
    if (vertex_count < 0) fail("vertex_count", "must not be negative");
    const IndexView offsets = offsets_of(cell_offsets, "cell_offsets");
    const std::vector<std::uint8_t> types = types_of(vtk_types);
    const MeshView mesh{
        .points = points_of(points, dimension),
        .cells = CellsView::mixed(offsets, integers(cell_vertices, "cell_vertices"), std::span(types), base),
        .vertex_count = static_cast<std::size_t>(vertex_count)};

    const std::size_t n = vertex_count_of(mesh);
    check_any_output({vertex_new_to_old, vertex_old_to_new, cell_new_to_old, cell_old_to_new},
                     {vertex_result, cell_result});
    check_integers(vertex_new_to_old, n, "vertex_new_to_old");
    check_integers(vertex_old_to_new, n, "vertex_old_to_new");
    check_integers(cell_new_to_old, mesh.cells.size(), "cell_new_to_old");
    check_integers(cell_old_to_new, mesh.cells.size(), "cell_old_to_new");
    check_result(vertex_result);
    check_result(cell_result);

    const MeshMethods methods{.vertices = std::string(name_or_auto(given.method)),
                              .elements = std::string(name_or_auto(given.element_method))};
    const auto [vertices, cells] = order_mesh(mesh, methods, order_options(given));
    write(vertices.permutation.new_to_old(), base, vertex_new_to_old, "vertex_new_to_old");
    write(vertices.permutation.old_to_new(), base, vertex_old_to_new, "vertex_old_to_new");
    write(cells.permutation.new_to_old(), base, cell_new_to_old, "cell_new_to_old");
    write(cells.permutation.old_to_new(), base, cell_old_to_new, "cell_old_to_new");
    write_report(report_of(vertices), vertex_result);
    write_report(report_of(cells), cell_result);
  });
}

mo_status mo_order_edges(const mo_in* ends, const mo_in* vertex_new_to_old, int32_t base,
                         const mo_out* new_to_old) {
  return guarded([&] {
    if (vertex_new_to_old == nullptr) fail("vertex_new_to_old", "the map is null");
    if (new_to_old == nullptr) fail("new_to_old", "the output is null");
    const IndexView given = integers(ends, "ends");
    check_integers(new_to_old, given.size() / 2, "new_to_old");
    const Permutation vertices =
        permutation_of(integers(vertex_new_to_old, "vertex_new_to_old"), base_of(base));
    std::vector<std::int64_t> from_zero(given.size());
    for (std::size_t k = 0; k < given.size(); ++k) from_zero[k] = from_zero_on(given[k], base);
    write(order_edges(from_zero, vertices).new_to_old(), base, new_to_old, "new_to_old");
  });
}

mo_status mo_reorderer_create(const mo_options* options, double slack, double budget_seconds,
                              mo_reorderer** reorderer) {
  if (reorderer != nullptr) *reorderer = nullptr;
  return guarded([&] {
    if (reorderer == nullptr) fail("reorderer", "the pointer to the result is null");
    const mo_options given = complete_options(options);
    const int base = base_of(given.base);
    Reorderer inside({.method = std::string(name_or_auto(given.method)),
                      .slack = slack,
                      .budget_seconds = budget_seconds,
                      .order = order_options(given)});
    *reorderer = std::make_unique<mo_reorderer>(mo_reorderer{std::move(inside), base}).release();
  });
}

void mo_reorderer_destroy(mo_reorderer* reorderer) {
  const std::unique_ptr<mo_reorderer> ends_here(reorderer);
}

mo_status mo_reorderer_update(mo_reorderer* reorderer, const mo_in* offsets, const mo_in* neighbours,
                              const mo_in* points, int32_t dimension, const mo_in* previous,
                              const mo_out* new_to_old, const mo_out* old_to_new, int32_t* repair) {
  return guarded([&] {
    if (reorderer == nullptr) fail("reorderer", "the pointer is null");
    const int base = reorderer->base;
    const PointsView coordinates = points_of(points, dimension);
    const GraphView graph = offsets == nullptr ? GraphView() : graph_of(offsets, neighbours, nullptr, base);
    const std::size_t n = offsets == nullptr ? coordinates.size() : graph.offsets.size() - 1;
    check_points(coordinates, n);
    check_integers(new_to_old, n, "new_to_old");
    check_integers(old_to_new, n, "old_to_new");
    const std::vector<std::int64_t> places = places_before(integers(previous, "previous"), base);
    const Update update = offsets == nullptr ? reorderer->inside.update(coordinates, places)
                                             : reorderer->inside.update(graph, coordinates, places);
    write(update.permutation.new_to_old(), base, new_to_old, "new_to_old");
    write(update.permutation.old_to_new(), base, old_to_new, "old_to_new");
    if (repair != nullptr) *repair = static_cast<std::int32_t>(update.repair);
  });
}

mo_status mo_reorderer_observe(mo_reorderer* reorderer, double step_seconds) {
  return guarded([&] {
    if (reorderer == nullptr) fail("reorderer", "the pointer is null");
    reorderer->inside.observe(step_seconds);
  });
}

mo_status mo_fiedler(const mo_in* offsets, const mo_in* neighbours, const mo_in* weights,
                     const mo_options* options, const mo_out* values, mo_result* result) {
  return guarded([&] {
    const Stopwatch stopwatch;
    const mo_options given = complete_options(options);
    const GraphView graph = graph_of(offsets, neighbours, weights, base_of(given.base));
    check_reals(values, graph.offsets.size() - 1, "values");
    check_result(result);
    const Fiedler fiedler = fiedler_vector(graph, order_options(given));
    write(fiedler.values, values);
    write_report(report_of(fiedler.complete, stopwatch.seconds(), fiedler.components, "fiedler"), result);
  });
}

mo_status mo_move(const mo_in* new_to_old, int32_t base, const void* from, void* to, int64_t row_bytes) {
  return guarded([&] {
    if (new_to_old == nullptr) fail("new_to_old", "the map is null");
    if (row_bytes < 0) fail("row_bytes", "must not be negative");
    const Permutation order = permutation_of(integers(new_to_old, "new_to_old"), base_of(base));
    check_apart(from, to, static_cast<std::uint64_t>(order.size()) * static_cast<std::uint64_t>(row_bytes));
    order.move_rows(from, row_bytes, to, row_bytes, static_cast<std::size_t>(row_bytes));
  });
}

int32_t mo_method_count() {
  std::int32_t count = 0;
  std::string ignored;
  status_of([&] { count = static_cast<std::int32_t>(vertex_methods().size()); }, ignored);
  return count;
}

const char* mo_method_name(int32_t k) {
  const char* name = nullptr;
  std::string ignored;
  status_of(
      [&] {
        std::vector<MethodInfo> methods = vertex_methods();
        if (k >= 0 && std::cmp_less(k, methods.size())) {
          name = kept(std::move(methods[static_cast<std::size_t>(k)].name));
        }
      },
      ignored);
  return name;
}

mo_status mo_register(const char* name, const char* description, int32_t needs_points, mo_method method,
                      void* user) {
  return guarded(
      [&] { register_foreign_method(name, description, needs_points, method, user, "registered"); });
}
