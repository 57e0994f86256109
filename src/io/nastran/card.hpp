// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Cards of Nastran's bulk data: their lines and fields.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::nastran {

/// The bytes of a card or of another part of a text.
struct Piece {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
};

/// Iterates over the cards of a text of whole lines. A card is a line with a name, the lines that continue
/// it, and the comments between these lines. Comments and empty lines around cards belong to no card.
class Cards {
 public:
  /// `text` must outlive this object.
  Cards(std::string_view text, Piece part) : text_(text), at_(part.begin), end_(part.end) {}

  /// Moves to the next card; returns false if there is none.
  bool next();
  [[nodiscard]] Piece place() const { return card_; }
  [[nodiscard]] std::string_view lines() const { return card_.of(text_); }
  /// Returns whether the card is a continuation line that has no card before it.
  [[nodiscard]] bool is_orphan() const { return is_orphan_; }

 private:
  std::string_view text_;
  std::size_t at_;
  std::size_t end_;
  Piece card_;
  bool is_orphan_ = false;
};

/// Divides `whole`, lines of `text`, into parts of whole cards. All parts but the last have at least `bytes`
/// bytes; all but the first begin with a letter, thus with a card. O(parts) if most lines begin with a
/// letter.
std::vector<Piece> parts_of_cards(std::string_view text, Piece whole, std::size_t bytes);

/// A field of a card.
struct Field {
  std::size_t begin = 0;   ///< first byte in the card
  std::size_t length = 0;  ///< bytes of the field that are on the line
  std::size_t width = 0;   ///< 8 or 16 columns; 0 between commas
  std::string_view text;   ///< without blanks around it
};

/// The fields of a card. Field 0 is the name; the others are numbered on from line to line, with 8 on each
/// line, or 4 if they are large.
struct CardFields {
  std::vector<Field> fields;
  bool is_large = false;     ///< whether the first line has large fields
  std::string_view fault{};  ///< why the fields cannot be found; empty if they can

  /// Returns the text of a field without blanks; empty if the card has no such field.
  [[nodiscard]] std::string_view text(std::size_t field) const {
    return field < fields.size() ? fields[field].text : std::string_view();
  }
};

/// Splits the lines of a card into fields; reuses the memory of `result`. The texts of the fields are valid
/// as long as `card`.
void split_card(std::string_view card, CardFields& result);

/// Returns the name of a card in capitals, without the asterisk of large fields.
std::string name_of(const CardFields& card);

/// Returns a field as an integer; nullopt if the field is not an integer.
std::optional<std::int64_t> integer_of(std::string_view field);

/// Returns the number, above 0, of a node, element or property in a field; 0 if the field holds no such
/// number.
std::int64_t number_of(std::string_view field);

/// Returns a field as a real number, which may lack the letter of its exponent (1.5-3 is 0.0015); nullopt if
/// the field is not a finite number.
std::optional<double> real_of(std::string_view field);

/// A number to be written into a field; 0 leaves the field blank.
struct Edit {
  std::size_t field = 0;
  std::int64_t number = 0;
};

/// Appends a card with the numbers of `edits` (ascending by field), in the columns of the old numbers.
/// Returns false if a number does not fit its field.
bool append_edited(std::string& out, std::string_view card, const CardFields& fields,
                   const std::vector<Edit>& edits);

/// Appends a card of small fields, or of large ones if a text has more than 8 characters, on as many lines as
/// needed. `line_end` ends each line. Texts must not have more than 16 characters.
void append_card(std::string& out, std::string_view name, const std::vector<std::string>& texts,
                 std::string_view line_end);

/// A real number as a field.
struct RealText {
  std::string text;         ///< at most 16 characters
  bool is_rounded = false;  ///< whether the text reads back to another number
};

/// Returns the shortest text that reads back to the same bits. If it has more than 16 characters, returns the
/// text of the value rounded to as many digits as fit. The text has a point, and no letter before the
/// exponent.
RealText real_text(double value);

}  // namespace meshorder::nastran
