// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Checks of the C interface, with arrays of all types, sizes and values.
#include "fuzz/families/families.hpp"
#include "fuzz/families/scratch.hpp"

#include <meshorder.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace meshorder::fuzz {
namespace {

constexpr std::array kSizes{4, 4, 8, 8, 4, 8};  // bytes of a number, by mo_type
constexpr std::size_t kMostVertices = 48;
constexpr std::size_t kMostNumbers = 160;

/// Takes values from the front of an input, and zeros after the input's end.
class Choices {
 public:
  explicit Choices(Family::Bytes bytes) : bytes_(bytes) {}

  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  std::size_t below(std::size_t end) { return byte() % end; }
  bool one_in(std::size_t n) { return below(n) == n - 1; }
  template <class T>
  T bits() {
    std::array<std::uint8_t, sizeof(T)> raw{};
    std::generate(raw.begin(), raw.end(), [&] { return byte(); });
    return std::bit_cast<T>(raw);
  }
  [[nodiscard]] bool is_empty() const { return bytes_.empty(); }

 private:
  Family::Bytes bytes_;
};

/// An array of numbers of any type.
class Numbers {
 public:
  /// Converts the values to a type; values that the type cannot hold lose their upper bits.
  Numbers(mo_type type, const std::vector<std::int64_t>& values) : type_(type) {
    for (const std::int64_t value : values) add(value);
  }
  /// Makes `count` zeros.
  Numbers(mo_type type, std::size_t count)
      : type_(type), bytes_(count * kSizes[static_cast<std::size_t>(type)]) {}

  void add(std::int64_t value) {
    switch (type_) {
      case MO_INT32:
        return append(static_cast<std::int32_t>(value));
      case MO_UINT32:
        return append(static_cast<std::uint32_t>(value));
      case MO_INT64:
        return append(value);
      case MO_UINT64:
        return append(static_cast<std::uint64_t>(value));
      case MO_FLOAT:
        return append(static_cast<float>(value));
      default:
        return append(static_cast<double>(value));
    }
  }
  void add_real(double value) {
    if (type_ == MO_FLOAT) return append(static_cast<float>(value));
    append(value);
  }
  [[nodiscard]] std::int64_t count() const {
    return static_cast<std::int64_t>(bytes_.size()) / kSizes[static_cast<std::size_t>(type_)];
  }
  [[nodiscard]] mo_in in() const { return {bytes_.data(), count(), type_}; }
  [[nodiscard]] mo_out out() { return {bytes_.data(), count(), type_}; }
  /// Returns the whole number at a position.
  [[nodiscard]] std::int64_t at(std::size_t place) const {
    if (kSizes[static_cast<std::size_t>(type_)] == 4) {
      return type_ == MO_INT32 ? std::int64_t{load<std::int32_t>(place)}
                               : std::int64_t{load<std::uint32_t>(place)};
    }
    return load<std::int64_t>(place);
  }

 private:
  template <class T>
  void append(T value) {
    const std::size_t end = bytes_.size();
    bytes_.resize(end + sizeof(T));
    std::memcpy(bytes_.data() + end, &value, sizeof(T));
  }
  template <class T>
  [[nodiscard]] T load(std::size_t place) const {
    T value{};
    std::memcpy(&value, bytes_.data() + place * sizeof(T), sizeof(T));
    return value;
  }

  mo_type type_;
  std::vector<std::uint8_t> bytes_;
};

mo_type whole_type(Choices& from) { return static_cast<mo_type>(from.below(4)); }

/// Returns `size` numbers from base to base + count − 1, sometimes other numbers.
std::vector<std::int64_t> members(Choices& from, std::size_t size, std::size_t count, std::int64_t base) {
  std::vector<std::int64_t> result(size);
  for (std::int64_t& value : result) {
    const std::uint8_t choice = from.byte();
    value = base + (count > 0 ? choice % static_cast<std::int64_t>(count) : 0);
    if (choice == 255) value = from.bits<std::int64_t>();
    if (choice == 254) value = -1;
    if (choice == 253) value = base + static_cast<std::int64_t>(count);
  }
  return result;
}

/// Returns the offsets of `rows` rows with `size` entries in total; sometimes one offset is any number.
std::vector<std::int64_t> offsets(Choices& from, std::size_t rows, std::size_t size, std::int64_t base) {
  std::vector<std::int64_t> result{base};
  for (std::size_t r = 1; r < rows; ++r) {
    const auto left = static_cast<std::int64_t>(size) + base - result.back();
    result.push_back(result.back() + (left > 0 ? static_cast<std::int64_t>(from.below(8)) % (left + 1) : 0));
  }
  if (rows > 0) result.push_back(static_cast<std::int64_t>(size) + base);
  if (from.one_in(16)) result[from.below(result.size())] = from.bits<std::int64_t>();
  return result;
}

/// Returns `count` real numbers, sometimes too many, too few or none.
Numbers reals(Choices& from, std::size_t count) {
  if (from.one_in(8)) count = from.below(2 * count + 2);
  Numbers result(from.one_in(2) ? MO_FLOAT : MO_DOUBLE, std::vector<std::int64_t>{});
  const bool any_bits = from.one_in(4);
  for (std::size_t i = 0; i < count; ++i) {
    result.add_real(any_bits ? from.bits<double>() : from.byte() / 16.0);
  }
  return result;
}

std::string method_name(Choices& from) {
  const int choice = from.byte() % (mo_method_count() + 2);
  if (choice == mo_method_count()) return "auto";
  if (choice > mo_method_count()) return {static_cast<char>(from.byte())};
  return mo_method_name(choice);
}

/// The options of a call, with the data that they refer to.
class Options {
 public:
  Options(Choices& from, std::size_t vertices)
      : method_(method_name(from)),
        element_method_(method_name(from)),
        start_(reals(from, vertices)),
        groups_(whole_type(from), members(from, vertices, 4, 0)) {
    mo_options_init(&options, sizeof options);
    options.method = method_.c_str();
    if (from.one_in(2)) options.element_method = element_method_.c_str();
    options.seed = from.byte();
    options.threads = 1;
    options.base = from.one_in(4) ? 1 : 0;
    if (from.one_in(16)) options.base = from.bits<std::int32_t>();
    options.check = from.one_in(4) ? MO_CHECK_FAST : MO_CHECK_FULL;
    options.symmetrize = from.one_in(2) ? 1 : 0;
    options.max_iterations = from.one_in(8) ? from.bits<std::int32_t>() : 20;
    options.tolerance = from.one_in(8) ? from.bits<double>() : 0.1;
    options.time_limit = from.one_in(8) ? from.bits<double>() : 1;
    if (from.one_in(4)) options.start = start_.in();
    if (from.one_in(4)) options.groups = groups_.in();
  }

  mo_options options{};

 private:
  std::string method_;
  std::string element_method_;
  Numbers start_;
  Numbers groups_;
};

void check_bijection(const Numbers& new_to_old, const Numbers& old_to_new, std::int64_t base) {
  if (new_to_old.count() != old_to_new.count()) fail("an order of another size was accepted");
  for (std::size_t k = 0; k < static_cast<std::size_t>(new_to_old.count()); ++k) {
    const std::int64_t old = new_to_old.at(k) - base;
    if (old < 0 || old >= old_to_new.count() ||
        old_to_new.at(static_cast<std::size_t>(old)) - base != static_cast<std::int64_t>(k)) {
      fail("an order is no bijection");
    }
  }
}

void check_status(mo_status status) {
  if (status == MO_INTERNAL || status < MO_OK || status > MO_OUT_OF_MEMORY) {
    fail("status " + std::to_string(status) + ": " + mo_last_error());
  }
  if (status != MO_OK && *mo_last_error() == '\0') fail("a failure without a message");
}

}  // namespace

void check_graphs(std::string_view /*family*/, Family::Bytes input) {
  Choices from(input);
  const std::size_t n = from.below(kMostVertices);
  const std::size_t entries = from.below(kMostNumbers);
  Options options(from, n);
  const std::int64_t base = options.options.base == 1 ? 1 : 0;
  const Numbers row_ends(whole_type(from), offsets(from, n, entries, base));
  const Numbers neighbours(whole_type(from), members(from, entries, n, base));
  const Numbers weights = reals(from, entries);
  const auto dimension = static_cast<std::int32_t>(from.below(5));
  const Numbers points = reals(from, n * static_cast<std::size_t>(dimension));
  Numbers new_to_old(whole_type(from), from.one_in(16) ? n + 1 : n);
  Numbers old_to_new(whole_type(from), n);
  const mo_in offsets_in = row_ends.in();
  const mo_in neighbours_in = neighbours.in();
  const mo_in weights_in = weights.in();
  const mo_in points_in = points.in();
  const mo_out to_old = new_to_old.out();
  const mo_out to_new = old_to_new.out();
  const bool weighted = from.one_in(2);
  const bool placed = from.one_in(2);
  const mo_status status =
      mo_order_graph(&offsets_in, &neighbours_in, weighted ? &weights_in : nullptr,
                     placed ? &points_in : nullptr, dimension, &options.options, &to_old, &to_new, nullptr);
  check_status(status);
  if (status == MO_OK) check_bijection(new_to_old, old_to_new, base);
  Numbers values(MO_DOUBLE, n);
  const mo_out values_out = values.out();
  check_status(mo_fiedler(&offsets_in, &neighbours_in, weighted ? &weights_in : nullptr, &options.options,
                          &values_out, nullptr));
}

void check_cells(std::string_view /*family*/, Family::Bytes input) {
  Choices from(input);
  const std::size_t n = from.below(kMostVertices);
  const std::size_t cells = from.below(kMostVertices);
  const std::size_t entries = from.below(kMostNumbers);
  Options options(from, n);
  const std::int64_t base = options.options.base == 1 ? 1 : 0;
  const Numbers cell_ends(whole_type(from), offsets(from, cells, entries, base));
  const Numbers vertices(whole_type(from), members(from, entries, n, base));
  const Numbers types(whole_type(from), members(from, cells, 80, 0));
  const auto dimension = static_cast<std::int32_t>(from.below(5));
  const Numbers points = reals(from, n * static_cast<std::size_t>(dimension));
  std::array<Numbers, 4> orders{Numbers(whole_type(from), n), Numbers(whole_type(from), n),
                                Numbers(whole_type(from), cells), Numbers(whole_type(from), cells)};
  std::array<mo_out, 4> outs{};
  std::transform(orders.begin(), orders.end(), outs.begin(), [](Numbers& order) { return order.out(); });
  const auto& [vertex_new_to_old, vertex_old_to_new, cell_new_to_old, cell_old_to_new] = outs;
  const mo_in offsets_in = cell_ends.in();
  const mo_in vertices_in = vertices.in();
  const mo_in types_in = types.in();
  const mo_in points_in = points.in();
  const bool typed = from.one_in(2);
  const bool placed = from.one_in(2);
  const auto count = from.one_in(8) ? from.bits<std::int64_t>() : static_cast<std::int64_t>(n);
  const mo_status status =
      mo_order_mesh(&offsets_in, &vertices_in, typed ? &types_in : nullptr, count,
                    placed ? &points_in : nullptr, dimension, &options.options, &vertex_new_to_old,
                    &vertex_old_to_new, &cell_new_to_old, &cell_old_to_new, nullptr, nullptr);
  check_status(status);
  if (status != MO_OK) return;
  check_bijection(orders[0], orders[1], base);
  check_bijection(orders[2], orders[3], base);
}

}  // namespace meshorder::fuzz
