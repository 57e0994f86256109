// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/nastran/nastran.hpp"
#include "io/stream/scanner.hpp"

#include <fmt/format.h>

#include <utility>

namespace meshorder::nastran {

std::int64_t number_in(const CardFields& fields, std::size_t field, std::string_view what, Piece card) {
  const std::int64_t result = number_of(fields.text(field));
  if (result > 0 && result <= kMaxIndex) return result;
  throw Fault{card.begin, fmt::format("{} is '{}'", what, shown(fields.text(field))),
              "a number from 1 to 2147483647 is needed"};
}

namespace {

class CardParser {
 public:
  CardParser(const Cards& cards, CardFields& fields)
      : cards_(cards), place_(cards.place()), fields_(fields) {}

  Card parse() {
    if (cards_.is_orphan())
      fail("expected a card such as GRID, found a line that continues one", "add the card");
    split_card(cards_.lines(), fields_);
    Card card;
    card.place = place_;
    const std::string name = name_of(fields_);
    if (name == "GRID") {
      read_node(card);
    } else if (card.type = element_type(name); card.type != nullptr) {
      check_lines();
      if (!is_to_ground(*card.type)) read_element(card);
    }
    return card;
  }

 private:
  [[noreturn]] void fail(std::string what, std::string remedy) const {
    throw Fault{place_.begin, std::move(what), std::move(remedy)};
  }

  [[nodiscard]] std::int64_t number(std::size_t field, std::string_view what) const {
    return number_in(fields_, field, what, place_);
  }

  void check_lines() const {
    if (fields_.fault.empty()) return;
    fail(std::string(fields_.fault), "write it in fields of 8 or 16 columns, its lines one after the other");
  }

  [[nodiscard]] bool has_more_from(std::size_t field) const {
    while (field < fields_.fields.size() && fields_.text(field).empty()) ++field;
    return field < fields_.fields.size();
  }

  void read_node(Card& card) const {
    check_lines();
    card.kind = Card::Kind::node;
    card.number = number(1, "the number of a node");
    if (const std::string_view system = fields_.text(2); !system.empty()) {
      card.group = system == "0" ? 0 : number(2, "the system of a node");
    }
    for (std::size_t k = 0; k < card.point.size(); ++k) {
      const std::string_view text = fields_.text(3 + k);
      if (text.empty()) continue;
      const auto value = real_of(text);
      if (!value) {
        fail(fmt::format("a coordinate of node {} is '{}'", card.number, shown(text)),
             "a finite number is needed");
      }
      card.point[k] = *value;
    }
    card.has_more = has_more_from(6);
  }

  /// Returns whether an element is a CBUSH to the ground, which is not a cell.
  [[nodiscard]] bool is_to_ground(const ElementType& type) const {
    const std::size_t first = type.first_node();
    return type.name == "CBUSH" && (fields_.text(first).empty() || number_of(fields_.text(first + 1)) == 0);
  }

  void read_element(Card& card) const {
    card.kind = Card::Kind::element;
    card.number = number(1, "the number of an element");
    count_nodes(card);
    const ElementType& type = *card.type;
    const std::size_t first = type.first_node();
    for (std::size_t k = 0; k < static_cast<std::size_t>(card.nodes); ++k) {
      const std::size_t field = first + node_place(type.shape, card.nodes, k);
      const std::int64_t node = number_of(fields_.text(field));
      const bool fits = node > 0 && node <= kMaxIndex;
      if (!fits) (void)number(field, fmt::format("a node of element {}", card.number));  // throws
      card.cell[k] = static_cast<Index>(node);
    }
    if (const std::string_view property = fields_.text(2); type.has_property && !property.empty()) {
      card.group = integer_of(property) == 0 ? 0 : number(2, "the property of an element");
    }
    card.has_more = has_more_from(first + static_cast<std::size_t>(type.most));
  }

  /// Finds how many vertices the cell gets.
  void count_nodes(Card& card) const {
    const ElementType& type = *card.type;
    int given = 0;
    int last = 0;
    for (int k = 0; k < type.most; ++k) {
      const std::string_view text = fields_.text(type.first_node() + static_cast<std::size_t>(k));
      if (text.empty() || text == "0") continue;
      ++given;
      last = k + 1;
    }
    if (last < type.corners) {
      fail(fmt::format("element {} has {} of the {} nodes of {}", card.number, last, type.corners, type.name),
           "fields or lines are missing");
    }
    card.lacks_nodes = given != last || !has_size(type, given);
    card.nodes = card.lacks_nodes ? type.corners : given;
  }

  const Cards& cards_;
  Piece place_;
  CardFields& fields_;
};

}  // namespace

Card parse_card(const Cards& cards, CardFields& fields) { return CardParser(cards, fields).parse(); }

}  // namespace meshorder::nastran
