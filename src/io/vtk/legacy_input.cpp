// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/vtk/legacy_input.hpp"

#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/stream/byte_order.hpp"
#include "io/stream/regular_text.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace meshorder::vtk {
namespace {

/// A number type and its name in files.
struct TypeName {
  std::string_view name;
  std::size_t alternative;  // index of an alternative of Values
  bool is_kept = true;      // whether the writer uses this type name again
};

// type names in files besides kLegacyTypeNames
constexpr std::array kOtherTypeNames{TypeName{"signed_char", 2},   TypeName{"long", 8},
                                     TypeName{"unsigned_long", 9}, TypeName{"vtkidtype", 8},
                                     TypeName{"long_long", 8},     TypeName{"unsigned_long_long", 9},
                                     TypeName{"bit", 3, false},    TypeName{"utf8_string", 10},
                                     TypeName{"int64", 8, false},  TypeName{"float64", 0, false}};

/// Returns the number type of a name in lower case; nullopt if unknown.
std::optional<TypeName> number_type(std::string_view name) {
  const auto* const usual = std::find(kLegacyTypeNames.begin(), kLegacyTypeNames.end(), name);
  if (usual != kLegacyTypeNames.end()) {
    return TypeName{*usual, static_cast<std::size_t>(usual - kLegacyTypeNames.begin()), false};
  }
  const auto* const other = std::find_if(kOtherTypeNames.begin(), kOtherTypeNames.end(),
                                         [&](const TypeName& type) { return type.name == name; });
  if (other != kOtherTypeNames.end()) return *other;
  return {};
}

/// Returns a name without the digits at its end.
std::string_view without_digits(std::string_view name) {
  return name.substr(0, name.find_last_not_of("0123456789") + 1);
}

}  // namespace

std::string percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned int code = 0;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(text.data() + i + 1, text.data() + i + 3, code, 16).ptr == text.data() + i + 3) {
      result += static_cast<char>(code);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

InputError LegacyInput::section_error(std::int64_t line, const std::string& what,
                                      const std::string& remedy) const {
  return {Location{scanner.file(), binary ? 0 : line, -1}, what, remedy};
}

std::int64_t LegacyInput::count(std::string_view what) {
  const std::int64_t value = text_integer(what);
  if (value < 0) fail(fmt::format("{} is {}", what, value), "it cannot be negative");
  if (value > kMaxIndex) fail(fmt::format("{} is {}", what, value), "at most 2147483647 are possible");
  return value;
}

void LegacyInput::check_room(std::int64_t entries, std::int64_t bytes, const std::string& what) const {
  const std::int64_t least = binary ? bytes : 2;
  if (entries > (scanner.bytes_left() + 1) / least) {
    fail(fmt::format("{} of {} numbers cannot be in the {} bytes that follow", what, entries,
                     scanner.bytes_left()),
         "the count is wrong or the file is cut short");
  }
}

// ---- numbers

template <class Number>
Number LegacyInput::number(const std::string& what) {
  if constexpr (std::is_same_v<Number, double>) {
    return finite_only ? scanner.finite(what) : scanner.real(what);
  } else if constexpr (std::is_same_v<Number, float>) {
    // parsed as float: a conversion from double would round twice
    const std::string_view digits = scanner.peek_word();
    float value = 0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool whole = code == std::errc{} && end == digits.data() + digits.size();
    if (!whole || (finite_only && !std::isfinite(value))) {
      const double real = finite_only ? scanner.finite(what) : scanner.real(what);
      if (std::isfinite(real) && std::abs(real) > std::numeric_limits<float>::max())
        fail(what + " is too large for a float", "double is needed");
      return static_cast<float>(real);
    }
    scanner.word(what);
    return value;
  } else {
    using Wide = std::conditional_t<std::is_same_v<Number, std::uint64_t>, std::uint64_t, std::int64_t>;
    const Wide value = scanner.integer<Wide>(what);
    if (!std::in_range<Number>(value)) fail(what + " is " + std::to_string(value), "its type cannot hold it");
    return static_cast<Number>(value);
  }
}

/// Reads numbers of a text up to the first irregular number. Returns how many it read; 0 if a number is not
/// finite but must be.
template <class Number>
std::size_t LegacyInput::regular_numbers(std::span<Number> values) {
  if constexpr (std::is_floating_point_v<Number>) {
    if (finite_only) {
      Scanner at = scanner;
      const std::size_t read = read_regular_numbers(at, values);
      const auto read_values = values.first(read);
      if (std::all_of(read_values.begin(), read_values.end(),
                      [](Number value) { return std::isfinite(value); })) {
        scanner.move_to(at);
        return read;
      }
      return 0;
    }
  }
  return read_regular_numbers(scanner, values);
}

template <class Number, class Stored>
void LegacyInput::numbers(std::vector<Number>& values, std::int64_t count, const std::string& what) {
  check_room(count, sizeof(Stored), what);
  resize_large(values, static_cast<std::size_t>(count));
  if (!binary) {
    std::size_t regular = 0;
    if constexpr (std::is_same_v<Number, Stored>) regular = regular_numbers<Number>(values);
    for (std::size_t i = regular; i < values.size(); ++i)
      values[i] = static_cast<Number>(number<Stored>(what));
    return;
  }
  if (count == 0) return;
  const std::string_view bytes =
      scanner.binary_block(count * static_cast<std::int64_t>(sizeof(Stored)), what);
  const char* at = bytes.data();
  for (Number& value : values) {
    value = static_cast<Number>(number_at<Stored>(at, std::endian::big));
    at += sizeof(Stored);
  }
}

void LegacyInput::bits(std::vector<std::uint8_t>& values, std::int64_t count, const std::string& what) {
  if (!binary) return numbers(values, count, what);
  if (count == 0) return;
  const std::string_view bytes = scanner.binary_block((count + 7) / 8, what);
  values.resize(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = (static_cast<unsigned char>(bytes[i / 8]) >> (7 - i % 8)) & 1U;
  }
}

void LegacyInput::texts(std::vector<std::string>& values, std::int64_t count, const std::string& what) {
  if (count > scanner.bytes_left() + 1)
    fail(what + " of " + std::to_string(count) + " texts cannot be in the rest of the file",
         "the count is wrong or the file is cut short");
  values.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    if (binary) {
      values.emplace_back(scanner.binary_block(text_length(what), what));
    } else {
      if (scanner.bytes_left() == 0) fail("unexpected end of file in " + what, "it may be cut short");
      values.push_back(percent_decoded(scanner.raw_line()));
    }
  }
}

/// Reads the length of a text; the first two bits say how many bytes encode the length.
std::int64_t LegacyInput::text_length(const std::string& what) {
  std::uint64_t length = scanner.binary<std::uint8_t>(what);
  constexpr std::array kFollowing{7, 3, 1, 0};
  const int following = kFollowing[length >> 6U];
  length &= following == 7 ? 0xFFU : 0x3FU;
  for (int i = 0; i < following; ++i) length = (length << 8U) | scanner.binary<std::uint8_t>(what);
  return std::in_range<std::int64_t>(length) ? static_cast<std::int64_t>(length) : -1;
}

// ---- arrays

DataArray LegacyInput::array(const std::string& name, std::optional<Association> association,
                             std::int64_t tuples, std::int64_t components, const std::string& given_type) {
  DataArray result;
  result.name = name;
  result.association = association.value_or(Association::vertices);
  const std::string what = "the array '" + shown(name) + "'";
  if (components < 1 || components > kMaxIndex)
    fail(what + " has " + std::to_string(components) + " components", "at least 1 is needed");
  result.components = static_cast<Index>(components);

  const std::string lower = lower_case(given_type);
  std::optional<TypeName> type = number_type(lower);
  if (!type) {
    // some writers append the number of components to the type; VTK reads only the type's beginning
    type = number_type(without_digits(lower));
    if (type) {
      notes.push_back(
          fmt::format("{} is of type '{}', which is read as {}", what, shown(given_type), type->name));
      type->is_kept = false;
    }
  }
  if (!type) {
    fail(fmt::format("{} is of type '{}'", what, shown(given_type)),
         "a number type such as float, double or int is needed");
  }
  result.values = values_of_type(type->alternative);

  // tuples begin on the next line; in a binary file at that line's first byte
  const bool text = are_texts(result.values);
  const std::int64_t count = tuples * components;
  if (count > 0 && (binary || text)) scanner.raw_line();
  if (type->name == "bit") {
    bits(std::get<std::vector<std::uint8_t>>(result.values), count, what);
    notes.push_back(what + " holds bits, which are stored as bytes");
  } else if (type->name == "vtkidtype") {
    numbers<std::int64_t, std::int32_t>(std::get<std::vector<std::int64_t>>(result.values), count, what);
  } else {
    std::visit(
        [&](auto& values) {
          if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<std::string>>) {
            texts(values, count, what);
          } else {
            numbers(values, count, what);
          }
        },
        result.values);
  }
  if (type->is_kept) facts_of(association, name).type = given_type;
  if (upper_case(scanner.peek_word()) == "METADATA") {
    word("METADATA");
    metadata(result, association);
  }
  return result;
}

ArrayFacts& LegacyInput::facts_of(std::optional<Association> association, const std::string& name) {
  return facts.try_emplace({association, name}, ArrayFacts{association, name, {}, {}, {}}).first->second;
}

void LegacyInput::metadata(DataArray& array, std::optional<Association> association) {
  scanner.raw_line();
  while (scanner.bytes_left() > 0) {
    std::string_view line = scanner.raw_line();
    const std::string key = upper_case(next_word(line));
    if (key.empty()) return;
    if (key == "COMPONENT_NAMES") {
      array.component_names.clear();
      for (Index i = 0; i < array.components; ++i) {
        if (scanner.bytes_left() == 0)
          fail("unexpected end of file in COMPONENT_NAMES", "it may be cut short");
        array.component_names.push_back(percent_decoded(scanner.raw_line()));
      }
    } else if (key == "INFORMATION") {
      information(parsed(next_word(line), "the number of keys"), array, association);
      return;
    } else {
      notes.push_back(fmt::format("METADATA has '{}', which is left out", shown(key)));
    }
  }
}

/// Reads INFORMATION; keeps its keys verbatim except for norms, which VTK computes.
void LegacyInput::information(std::int64_t keys, const DataArray& array,
                              std::optional<Association> association) {
  std::string kept;
  bool keep = false;
  while (true) {
    if (scanner.bytes_left() == 0) {
      if (keys > 0) fail("unexpected end of file in INFORMATION", "it may be cut short");
      break;
    }
    const std::string_view line = scanner.raw_line();
    if (trimmed(line).empty()) {
      if (keys <= 0) break;
      continue;
    }
    if (line.starts_with("NAME ")) {
      --keys;
      keep = !line.starts_with("NAME L2_NORM");
    }
    if (keep) kept += std::string(line) + "\n";
  }
  if (!kept.empty() && !array.name.empty()) facts_of(association, array.name).information = kept;
}

}  // namespace meshorder::vtk
