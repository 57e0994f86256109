// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The C interface to the public functions. It turns C structures into views and options, and exceptions into
// statuses; it writes results into the caller's arrays.
#include "base/status.hpp"
#include "base/stopwatch.hpp"
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
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): the error of each thread
thread_local std::string last_error;

/// A larger `struct_size` is treated as a field that the caller forgot to set.
constexpr std::size_t kLargestStruct = 4096;

bool is_integer(mo_type type) { return type >= MO_INT32 && type <= MO_UINT64; }
bool is_real(mo_type type) { return type == MO_FLOAT || type == MO_DOUBLE; }

[[noreturn]] void fail(const std::string& name, const std::string& fault) {
  throw InvalidArgument(name + ": " + fault);
}

[[noreturn]] void fail_type(const std::string& name, mo_type type, const char* wanted) {
  fail(name, "the type is " + std::to_string(type) + ", must be one of " + wanted);
}

constexpr const char* kIntegers = "MO_INT32, MO_UINT32, MO_INT64 and MO_UINT64";
constexpr const char* kReals = "MO_FLOAT and MO_DOUBLE";

/// Throws InvalidArgument if the address is not aligned for that type.
void check_alignment(const void* data, mo_type type, const char* name) {
  const std::size_t alignment = type == MO_INT32 || type == MO_UINT32 || type == MO_FLOAT
                                    ? alignof(std::int32_t)
                                : type == MO_DOUBLE ? alignof(double)
                                                    : alignof(std::int64_t);
  if (reinterpret_cast<std::uintptr_t>(data) % alignment == 0) return;
  fail(name, "the address is not a multiple of " + std::to_string(alignment) +
                 ": copy the array to an aligned one");
}

// Input arrays.

/// Returns whether there is a non-empty array. Throws if its size is negative, or its data null or unaligned.
bool is_given(const mo_in* array, const char* name) {
  if (array == nullptr || array->size == 0) return false;
  if (array->size < 0) fail(name, "the size is " + std::to_string(array->size) + ", must not be negative");
  if (array->data == nullptr) fail(name, "the data of " + std::to_string(array->size) + " numbers is null");
  check_alignment(array->data, array->type, name);
  return true;
}

IndexView integers(const mo_in* array, const char* name) {
  if (!is_given(array, name)) return {};
  switch (array->type) {
    case MO_INT32:
      return {static_cast<const std::int32_t*>(array->data), array->size};
    case MO_UINT32:
      return {static_cast<const std::uint32_t*>(array->data), array->size};
    case MO_INT64:
      return {static_cast<const std::int64_t*>(array->data), array->size};
    case MO_UINT64:
      return {static_cast<const std::uint64_t*>(array->data), array->size};
    default:
      fail_type(name, array->type, kIntegers);
  }
}

RealView reals(const mo_in* array, const char* name) {
  if (!is_given(array, name)) return {};
  if (!is_real(array->type)) fail_type(name, array->type, kReals);
  if (array->type == MO_FLOAT) return {static_cast<const float*>(array->data), array->size};
  return {static_cast<const double*>(array->data), array->size};
}

PointsView points_of(const mo_in* array, int dimension) {
  if (!is_given(array, "points")) return {};
  if (!is_real(array->type)) fail_type("points", array->type, kReals);
  if (dimension < 1 || dimension > 3 || array->size % dimension != 0) {
    throw InvalidArgument("points: " + std::to_string(array->size) + " numbers do not make points of " +
                          std::to_string(dimension) + " coordinates, which must be 1, 2 or 3");
  }
  const std::int64_t count = array->size / dimension;
  if (array->type == MO_FLOAT) return {static_cast<const float*>(array->data), count, dimension};
  return {static_cast<const double*>(array->data), count, dimension};
}

/// Returns offsets; throws if there are none.
IndexView offsets_of(const mo_in* array, const char* name) {
  const IndexView offsets = integers(array, name);
  if (offsets.empty()) fail(name, "there are none; at least the first is needed");
  return offsets;
}

/// Returns the VTK cell types, each in a byte; throws for a number that does not fit.
std::vector<std::uint8_t> types_of(const mo_in* array) {
  const IndexView given = integers(array, "vtk_types");
  std::vector<std::uint8_t> types(given.size());
  for (std::size_t c = 0; c < given.size(); ++c) {
    if (!std::in_range<std::uint8_t>(given[c])) {
      fail("vtk_types", "cell " + std::to_string(c) + " has the type " + std::to_string(given[c]) +
                            ", which is not supported");
    }
    types[c] = static_cast<std::uint8_t>(given[c]);
  }
  return types;
}

// Output arrays.

/// Throws unless the array is null (not wanted) or has room for exactly `count` numbers.
void check_room(const mo_out* array, std::size_t count, const char* name) {
  if (array == nullptr) return;
  if (!std::cmp_equal(array->size, count)) {
    fail(name, "room for " + std::to_string(array->size) + " numbers, must be for " + std::to_string(count));
  }
  if (array->data == nullptr && count > 0) fail(name, "the data is null");
  check_alignment(array->data, array->type, name);
}

void check_integers(const mo_out* array, std::size_t count, const char* name) {
  check_room(array, count, name);
  if (array != nullptr && !is_integer(array->type)) fail_type(name, array->type, kIntegers);
}

void check_reals(const mo_out* array, std::size_t count, const char* name) {
  check_room(array, count, name);
  if (array != nullptr && !is_real(array->type)) fail_type(name, array->type, kReals);
}

template <class T>
void write_as(std::span<const Index> map, int base, void* data, const char* name) {
  if (!map.empty() && !std::in_range<T>(static_cast<Offset>(map.size()) - 1 + base)) {
    throw TooLarge(std::string(name) + ": the type cannot hold the number " +
                   std::to_string(static_cast<Offset>(map.size()) - 1 + base));
  }
  std::transform(map.begin(), map.end(), static_cast<T*>(data),
                 [base](Index number) { return static_cast<T>(Offset{number} + base); });
}

/// Writes a map into an array that `check_integers` accepted; does nothing if the array is null.
void write(std::span<const Index> map, int base, const mo_out* array, const char* name) {
  if (array == nullptr) return;
  switch (array->type) {
    case MO_INT32:
      return write_as<std::int32_t>(map, base, array->data, name);
    case MO_UINT32:
      return write_as<std::uint32_t>(map, base, array->data, name);
    case MO_INT64:
      return write_as<std::int64_t>(map, base, array->data, name);
    default:
      return write_as<std::uint64_t>(map, base, array->data, name);
  }
}

/// Writes numbers into an array that `check_reals` accepted; does nothing if the array is null.
void write(std::span<const double> values, const mo_out* array) {
  if (array == nullptr) return;
  if (array->type == MO_DOUBLE) {
    std::copy(values.begin(), values.end(), static_cast<double*>(array->data));
  } else {
    std::transform(values.begin(), values.end(), static_cast<float*>(array->data),
                   [](double value) { return static_cast<float>(value); });
  }
}

// Structures that grow from version to version.

void check_struct_size(std::size_t size, const char* name) {
  if (size >= sizeof(std::size_t) && size <= kLargestStruct) return;
  fail(name, "struct_size is " + std::to_string(size) + ", must be the size of the structure");
}

/// Copies those of the fields that are entirely within the first `size` bytes of the structure.
template <class Struct, class... Fields>
void copy_fields(const Struct& from, Struct& to, std::size_t size, Fields Struct::*... fields) {
  const auto copy = [&](auto field) {
    const auto* const begin = reinterpret_cast<const char*>(&from);
    const auto* const end = reinterpret_cast<const char*>(&(from.*field)) + sizeof(from.*field);
    if (static_cast<std::size_t>(end - begin) > size) return;
    std::memcpy(&(to.*field), &(from.*field), sizeof(from.*field));
  };
  (copy(fields), ...);
}

/// Copies all fields of options but `struct_size`.
void copy_options(const mo_options& from, mo_options& to, std::size_t size) {
  copy_fields(from, to, size, &mo_options::method, &mo_options::element_method, &mo_options::workload,
              &mo_options::seed, &mo_options::tolerance, &mo_options::time_limit, &mo_options::threads,
              &mo_options::base, &mo_options::check, &mo_options::symmetrize, &mo_options::start,
              &mo_options::groups, &mo_options::progress, &mo_options::user, &mo_options::max_iterations,
              &mo_options::reserved, &mo_options::cell_groups);
}

mo_options default_options() {
  mo_options options{};
  options.struct_size = sizeof options;
  options.tolerance = OrderOptions{}.tolerance;
  options.time_limit = std::numeric_limits<double>::infinity();
  options.max_iterations = OrderOptions{}.max_iterations;
  return options;
}

/// Returns the caller's options, with defaults for the fields that a caller of an older header lacks.
mo_options complete_options(const mo_options* given) {
  mo_options options = default_options();
  if (given == nullptr) return options;
  check_struct_size(given->struct_size, "options");
  copy_options(*given, options, given->struct_size);
  return options;
}

void check_result(const mo_result* result) {
  if (result != nullptr) check_struct_size(result->struct_size, "result");
}

/// Writes as much of a report as the caller's structure has room for.
void write(const mo_result& report, mo_result* result) {
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

// Options.

Check check_of(std::int32_t check) {
  switch (check) {
    case MO_CHECK_FULL:
      return Check::full;
    case MO_CHECK_FAST:
      return Check::fast;
    case MO_CHECK_NONE:
      return Check::none;
    default:
      fail("options",
           "check is " + std::to_string(check) + ", must be MO_CHECK_FULL, MO_CHECK_FAST or MO_CHECK_NONE");
  }
}

int base_of(std::int32_t base) {
  if (base != 0 && base != 1) fail("options", "the base is " + std::to_string(base) + ", must be 0 or 1");
  return base;
}

std::string_view name_or_auto(const char* method) { return method != nullptr ? method : "auto"; }

OrderOptions order_options(const mo_options& given) {
  if (given.reserved != 0) fail("options", "reserved must be 0; mo_options_init makes it so");
  OrderOptions options{.seed = given.seed,
                       .tolerance = given.tolerance,
                       .max_iterations = given.max_iterations,
                       .start = reals(&given.start, "start"),
                       .groups = integers(&given.groups, "groups"),
                       .cell_groups = integers(&given.cell_groups, "cell_groups"),
                       .check = check_of(given.check),
                       .symmetry = given.symmetrize != 0 ? Symmetry::mirror : Symmetry::require,
                       .run = {.threads = given.threads, .time_limit = given.time_limit}};
  if (given.workload != nullptr) options.workload = parse_workload(given.workload);
  if (given.progress != nullptr) {
    options.run.progress = [progress = given.progress, user = given.user](const Progress& state) {
      return progress(user, std::string(state.stage).c_str(), state.fraction) == 0;
    };
  }
  return options;
}

GraphView graph_of(const mo_in* offsets, const mo_in* neighbours, const mo_in* weights, int base) {
  return {.offsets = offsets_of(offsets, "offsets"),
          .neighbours = integers(neighbours, "neighbours"),
          .weights = reals(weights, "weights"),
          .base = base};
}

// Implementations of the functions.

void order_graph(const GraphView& graph, const PointsView& points, const mo_options& options,
                 const mo_out* new_to_old, const mo_out* old_to_new, mo_result* result) {
  const std::size_t n = graph.offsets.size() - 1;
  check_integers(new_to_old, n, "new_to_old");
  check_integers(old_to_new, n, "old_to_new");
  check_result(result);
  const Order order = order_vertices(graph, name_or_auto(options.method), order_options(options), points);
  write(order.permutation.new_to_old(), graph.base, new_to_old, "new_to_old");
  write(order.permutation.old_to_new(), graph.base, old_to_new, "old_to_new");
  write(report_of(order), result);
}

/// Returns the map as a permutation; throws for an entry out of range.
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

/// Returns a number that counts from `base` as one that counts from 0; the smallest one of all stays, and is
/// out of every range.
std::int64_t from_zero_on(std::int64_t number, int base) {
  return number == std::numeric_limits<std::int64_t>::min() ? number : number - base;
}

/// Returns the previous places, numbered from 0; -1 for new vertices.
std::vector<std::int64_t> places_before(const IndexView& previous, int base) {
  std::vector<std::int64_t> places(previous.size());
  for (std::size_t v = 0; v < places.size(); ++v) places[v] = from_zero_on(previous[v], base);
  return places;
}

/// Returns a copy of a name that lives as long as the process.
const char* kept(std::string name) {
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): never destroyed
  static auto* const mutex = new std::mutex;
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): never destroyed
  static auto* const names = new std::set<std::string>;
  const std::lock_guard lock(*mutex);
  return names->insert(std::move(name)).first->c_str();
}

/// Calls `work()` and returns its status; if it fails, `mo_last_error` returns the reason.
template <class Work>
mo_status guarded(const Work& work) noexcept {
  return status_of(work, last_error);
}

}  // namespace
}  // namespace meshorder

using namespace meshorder;

struct mo_reorderer {
  Reorderer inside;
  int base;
};

uint32_t mo_version() { return version(); }

const char* mo_last_error() { return last_error.c_str(); }

void mo_options_init(mo_options* options, size_t struct_size) {
  if (options == nullptr || struct_size < sizeof(std::size_t)) return;
  // fields that a newer header adds are set to 0
  if (struct_size <= kLargestStruct) std::memset(static_cast<void*>(options), 0, struct_size);
  copy_options(default_options(), *options, struct_size);
  options->struct_size = struct_size;
}

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

    const std::size_t n = mesh.vertex_count > 0 ? mesh.vertex_count : mesh.points.size();
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
    write(report_of(vertices), vertex_result);
    write(report_of(cells), cell_result);
  });
}

mo_status mo_order_edges(const mo_in* ends, const mo_in* vertex_new_to_old, int32_t base,
                         const mo_out* new_to_old) {
  return guarded([&] {
    if (vertex_new_to_old == nullptr) fail("vertex_new_to_old", "the map is null");
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
    if (reorderer == nullptr) fail("reorderer", "there is no place to write it to");
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
    if (reorderer == nullptr) fail("reorderer", "there is none");
    const int base = reorderer->base;
    const PointsView coordinates = points_of(points, dimension);
    const GraphView graph = offsets == nullptr ? GraphView() : graph_of(offsets, neighbours, nullptr, base);
    const std::size_t n = offsets == nullptr ? coordinates.size() : graph.offsets.size() - 1;
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
    if (reorderer == nullptr) fail("reorderer", "there is none");
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
    write(report_of(fiedler.complete, stopwatch.seconds(), fiedler.components, "fiedler"), result);
  });
}

mo_status mo_move(const mo_in* new_to_old, int32_t base, const void* from, void* to, int64_t row_bytes) {
  return guarded([&] {
    if (new_to_old == nullptr) fail("new_to_old", "the map is null");
    if (row_bytes < 0) fail("row_bytes", "must not be negative");
    permutation_of(integers(new_to_old, "new_to_old"), base_of(base))
        .move_rows(from, row_bytes, to, row_bytes, static_cast<std::size_t>(row_bytes));
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
