// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "c/arguments.hpp"

#include <meshorder/options.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace meshorder::c {
namespace {

bool is_integer(mo_type type) { return type >= MO_INT32 && type <= MO_UINT64; }
bool is_real(mo_type type) { return type == MO_FLOAT || type == MO_DOUBLE; }

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
                                : type == MO_UINT8  ? alignof(std::uint8_t)
                                                    : alignof(std::int64_t);
  if (reinterpret_cast<std::uintptr_t>(data) % alignment == 0) return;
  fail(name, "the address is not a multiple of " + std::to_string(alignment) +
                 ": copy the array to an aligned one");
}

/// Returns whether an array has entries. Throws if the size is negative, or the data null or misaligned.
bool is_given(const mo_in* array, const char* name) {
  if (array == nullptr || array->size == 0) return false;
  if (array->size < 0) fail(name, "the size is " + std::to_string(array->size) + ", must not be negative");
  if (array->data == nullptr) fail(name, "the data of " + std::to_string(array->size) + " numbers is null");
  check_alignment(array->data, array->type, name);
  return true;
}

/// Throws unless the array is null (not wanted) or has room for exactly `count` numbers.
void check_room(const mo_out* array, std::size_t count, const char* name) {
  if (array == nullptr) return;
  if (!std::cmp_equal(array->size, count)) {
    fail(name, "the size is " + std::to_string(array->size) + ", must be " + std::to_string(count));
  }
  if (array->data == nullptr && count > 0) fail(name, "the data is null");
  check_alignment(array->data, array->type, name);
}

template <class T>
void write_as(std::span<const Index> numbers, Offset largest, int base, void* data, const char* name) {
  if (!std::in_range<T>(largest + base)) {
    throw TooLarge(std::string(name) + ": the type cannot hold the number " + std::to_string(largest + base));
  }
  std::transform(numbers.begin(), numbers.end(), static_cast<T*>(data),
                 [base](Index number) { return static_cast<T>(Offset{number} + base); });
}

/// Copies the fields of options, except `struct_size`, that lie within the first `size` bytes.
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

}  // namespace

std::string& last_error() {
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): the error of each thread
  thread_local std::string message;
  return message;
}

[[noreturn]] void fail(const std::string& name, const std::string& fault) {
  throw InvalidArgument(name + ": " + fault);
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

IndexView offsets_of(const mo_in* array, const char* name) {
  const IndexView offsets = integers(array, name);
  if (offsets.empty()) fail(name, "there are none; at least the first is needed");
  return offsets;
}

std::vector<std::uint8_t> types_of(const mo_in* array) {
  if (array != nullptr && array->type == MO_UINT8 && is_given(array, "vtk_types")) {
    const auto* const types = static_cast<const std::uint8_t*>(array->data);
    return {types, types + array->size};
  }
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

void check_integers(const mo_out* array, std::size_t count, const char* name) {
  check_room(array, count, name);
  if (array != nullptr && !is_integer(array->type)) fail_type(name, array->type, kIntegers);
}

void check_reals(const mo_out* array, std::size_t count, const char* name) {
  check_room(array, count, name);
  if (array != nullptr && !is_real(array->type)) fail_type(name, array->type, kReals);
}

void write(std::span<const Index> numbers, std::size_t count, int base, const mo_out* array,
           const char* name) {
  if (array == nullptr || numbers.empty()) return;
  const Offset largest = static_cast<Offset>(count) - 1;
  switch (array->type) {
    case MO_INT32:
      return write_as<std::int32_t>(numbers, largest, base, array->data, name);
    case MO_UINT32:
      return write_as<std::uint32_t>(numbers, largest, base, array->data, name);
    case MO_INT64:
      return write_as<std::int64_t>(numbers, largest, base, array->data, name);
    default:
      return write_as<std::uint64_t>(numbers, largest, base, array->data, name);
  }
}

void write(std::span<const double> values, const mo_out* array) {
  if (array == nullptr) return;
  if (array->type == MO_DOUBLE) {
    std::copy(values.begin(), values.end(), static_cast<double*>(array->data));
  } else {
    std::transform(values.begin(), values.end(), static_cast<float*>(array->data),
                   [](double value) { return static_cast<float>(value); });
  }
}

mo_options complete_options(const mo_options* given) {
  mo_options options = default_options();
  if (given == nullptr) return options;
  check_struct_size(given->struct_size, "options");
  copy_options(*given, options, given->struct_size);
  return options;
}

int base_of(std::int32_t base) {
  if (base != 0 && base != 1) fail("options", "the base is " + std::to_string(base) + ", must be 0 or 1");
  return base;
}

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

}  // namespace meshorder::c

using namespace meshorder;

void mo_options_init(mo_options* options, size_t struct_size) {
  c::fill_struct(options, struct_size,
                 [&](mo_options& to) { c::copy_options(c::default_options(), to, struct_size); });
}

const char* mo_last_error() { return c::last_error().c_str(); }
