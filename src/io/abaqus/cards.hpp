// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Keyword lines of Abaqus's and CalculiX's decks, and the numbers of nodes and elements in the lines below
// them.

#include <meshorder/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::abaqus {

/// A keyword with its parameters.
struct Card {
  struct Parameter {
    std::string name;   ///< in capitals and without blanks: "REFNODE"
    std::string value;  ///< as written, without quotes; empty if there is none
  };
  std::string title;    ///< in capitals: "*NODE PRINT"
  std::string keyword;  ///< in capitals, without blanks and asterisk: "NODEPRINT"
  std::vector<Parameter> parameters;

  /// Returns the parameter of that name, null if the card has none. Valid as long as the card.
  [[nodiscard]] const Parameter* find(std::string_view name) const;
  [[nodiscard]] bool has(std::string_view name) const { return find(name) != nullptr; }
  /// Returns the value of that parameter, an empty text if the card has none. Valid as long as the card.
  [[nodiscard]] std::string_view value(std::string_view name) const;
};

/// Returns the keyword line at the front and the lines that continue it. A line of parameters continues the
/// line before if that line ends with a comma; comments and blank lines may lie between. A line of numbers or
/// set names is data. O(bytes returned and skipped).
std::string_view keyword_lines(std::string_view lines);

/// Returns the card of a keyword line and the lines that continue it.
Card parse_card(std::string_view lines);

/// Returns `lines`, which begin with a keyword line, without the parameter `name` and the comma before it.
std::string without_parameter(std::string_view lines, std::string_view name);

/// Removes the next field from the front of a data line and returns it without blanks around it.
std::string_view next_field(std::string_view& line);

/// Returns `value` without the quotes around it, if it has some.
std::string_view without_quotes(std::string_view value);

/// Parses a field as the number of a node or element: digits, or the name of an instance, a dot and digits.
/// Returns 0 for anything else.
std::int64_t number_of(std::string_view field);

/// A number of a node or element in the lines of a card.
struct Reference {
  Association association;
  std::size_t begin;  ///< byte of its first digit
  std::size_t length;
  std::int64_t number;
};

/// Returns whether the lines or numbers of a card are in another file.
bool has_other_file(const Card& card);

/// Returns the places where a card names nodes and elements by number; nullopt if they are not known.
/// `lines`: the lines of the card, from the keyword on.
std::optional<std::vector<Reference>> references(const Card& card, std::string_view lines);

/// The name of a set in the first field of a line. Valid as long as the lines.
struct NamedSet {
  Association association;
  std::string_view name;
};

/// Returns the sets of nodes or elements that the lines of a load, a boundary condition or a surface name.
/// Returns no sets for other cards, which may name other things.
std::vector<NamedSet> named_sets(const Card& card, std::string_view lines);

/// Returns "; did you mean *CLOAD?" for a keyword that is spelt almost like a known one; else "".
std::string suggested_keyword(const Card& card);

/// Returns whether a card with these lines pairs the nodes of several sets in the order of their numbers:
/// first with first, and so on. New numbers would pair other nodes.
bool pairs_sets(const Card& card, std::string_view lines);

/// Returns whether the effect of a card depends on the order of node and element numbers, even if the card
/// names no node or element. Such cards read data of an earlier analysis or define cyclic symmetry: for sides
/// with different meshes, CalculiX 2.20 interpolates in triangles that depend on the numbers.
bool depends_on_numbers(const Card& card);

/// Returns the positive integers that are parameter values of a card or entire fields below its keyword.
std::vector<std::int64_t> numbers_in(std::string_view lines);

}  // namespace meshorder::abaqus
