// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/number_reader.hpp"
#include "io/vtk/vtk.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::vtk {

/// Decodes %XX in names and strings.
std::string percent_decoded(std::string_view text);

/// Reads words, counts and arrays of a legacy file, text or binary.
class LegacyInput : public NumberReader {
 public:
  explicit LegacyInput(const FilePath& path) : NumberReader(path) { order = std::endian::big; }

  /// Returns the error for a fault in a section that began at that line.
  [[nodiscard]] InputError section_error(std::int64_t line, const std::string& what,
                                         const std::string& remedy) const;

  /// Reads a count, 0 … kMaxIndex.
  std::int64_t count(std::string_view what);
  /// Fails unless the rest of the file has room for `entries` numbers of `bytes` bytes, or of two characters
  /// in a text file.
  void check_room(std::int64_t entries, std::int64_t bytes, const std::string& what) const;

  /// Reads an array of tuples and the METADATA that may follow it.
  DataArray array(const std::string& name, std::optional<Association> association, std::int64_t tuples,
                  std::int64_t components, const std::string& type);
  /// Reads COMPONENT_NAMES and INFORMATION, up to an empty line.
  void metadata(DataArray& array, std::optional<Association> association);

  bool finite_only = false;  ///< whether real numbers in text must be finite
  FactsOfArrays facts;
  Notes notes;

 private:
  template <class Number>
  Number number(const std::string& what);
  template <class Number, class Stored = Number>
  void numbers(std::vector<Number>& values, std::int64_t count, const std::string& what);
  void bits(std::vector<std::uint8_t>& values, std::int64_t count, const std::string& what);
  void texts(std::vector<std::string>& values, std::int64_t count, const std::string& what);
  template <class Number>
  std::size_t regular_numbers(std::span<Number> values);
  std::int64_t text_length(const std::string& what);
  void information(std::int64_t keys, const DataArray& array, std::optional<Association> association);
  ArrayFacts& facts_of(std::optional<Association> association, const std::string& name);
};

}  // namespace meshorder::vtk
