// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Reading of results, and of numbers in text.

#include "io/stream/scanner.hpp"
#include "io/unv/unv.hpp"

#include <optional>

namespace meshorder::unv {

/// The first records of a dataset of results.
struct ResultsHeader {
  Results results;   ///< without the array's name
  std::string name;  ///< name of the dataset
};

/// A dataset of results before all nodes and elements are known.
struct FoundResults : ResultsHeader {
  std::int64_t line = 0;
  std::vector<std::int64_t> numbers = {};  ///< numbers of nodes or elements
  std::vector<double> values = {};         ///< components · numbers
  std::string text = {};                   ///< the lines before the values
  std::string all = {};                    ///< all lines
};

/// Takes the records before the values; returns nullopt if the values are neither at nodes nor at elements,
/// or are of an unknown type.
std::optional<ResultsHeader> read_results_header(Scanner& in, int dataset);

/// Returns the values as an array; nullopt if there are no values, or if an item is unknown or comes twice.
std::optional<DataArray> array_of(const FoundResults& found, const IdMap& items);

/// Returns the numbers of the systems of coordinates in a dataset 2420, except global systems.
std::vector<std::int64_t> local_systems(std::string_view text);

/// Parses a real number as Fortran writes it: 1.5D-3, 1.5E-3, 1.5-103. Throws an Error at the scanner's line.
double real_of(const Scanner& at, std::string_view word, std::string_view what);

/// Returns whether a whole number leaves a blank in its ten columns. Readers can then split the line at
/// blanks.
inline bool fits_columns(std::int64_t number) {
  constexpr std::int64_t kLargest = 999'999'999;
  return number <= kLargest && number > -kLargest / 10;
}

}  // namespace meshorder::unv
