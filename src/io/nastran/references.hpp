// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Finds the fields in which cards that are neither nodes nor cells name nodes and elements.

#include "io/nastran/card.hpp"
#include "io/stream/id_map.hpp"
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace meshorder::nastran {

/// A field with the number of a node or element.
struct Reference {
  Association association;
  std::size_t field;
};

/// The nodes and elements that a card names.
struct References {
  std::vector<Reference> fields = {};  ///< ascending
  /// First field of a list, 0 if the card has no list. The list extends to the end of the card. It has
  /// numbers, and ranges such as "1 THRU 9" or "1 THRU 9 BY 2".
  std::size_t list = 0;
  Association of_list = Association::vertices;
  bool is_range = false;  ///< whether the list has a range
  /// Whether the card defines items that are neither vertices nor cells: points, or an element.
  bool defines_points = false;   ///< the list has their numbers
  bool defines_element = false;  ///< field 1 has its number
};

/// Returns the references of a card of that name (in capitals); nullopt if the card or its form is not known.
std::optional<References> references(std::string_view name, const CardFields& card);

/// The numbers `from`, `from` + `step`, … ≤ `to`; a single number if `from` = `to`.
struct NumberRange {
  std::int64_t from;
  std::int64_t to;
  std::int64_t step;
};

/// Returns the numbers and ranges of the list of a card; nullopt if the list holds anything else.
std::optional<std::vector<NumberRange>> ranges_of(const CardFields& card, std::size_t list);

/// Returns the numbers in `others`, which must ascend, that are in the ranges. Appends to `found` the
/// positions of the items in the ranges, each once.
std::vector<std::int64_t> numbers_in_list(const std::vector<NumberRange>& ranges, const IdMap& items,
                                          const std::vector<std::int64_t>& others, std::vector<Index>& found);

}  // namespace meshorder::nastran
