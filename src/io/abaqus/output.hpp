// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/deck/numbers.hpp"
#include "io/stream/output_file.hpp"
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::abaqus {

/// Writes the lines of a deck.
class DeckOutput {
 public:
  DeckOutput(OutputFile& out, std::string_view line_end) : out_(out), line_end_(line_end) {}

  /// Writes a part of the deck as it is. If its last line has no line end, later output still begins on a
  /// new line.
  void text(std::string_view text) {
    out_.write(text);
    if (!text.empty()) within_line_ = text.back() != '\n' && text.back() != '\r';
  }

  /// The content of a line: the number of the node or element, an element's nodes, and the text at its end.
  struct Row {
    std::int64_t number = 0;
    std::vector<std::int64_t> nodes;
    std::string_view more;
  };
  /// Fills in row i. Called on all threads; `row` may still hold the content of another row.
  using Rows = std::function<void(Row& row, Index i)>;

  /// Writes the lines of nodes, each with `dimension` coordinates.
  void nodes(std::span<const Point> points, int dimension, const Rows& rows);
  /// Writes `count` elements, 16 numbers on a line.
  void elements(Index count, const Rows& rows);
  /// Writes numbers, 16 on a line.
  void list(const std::vector<std::int64_t>& numbers);
  /// Writes a set as *NSET or *ELSET.
  void set(Association association, std::string_view name, const std::vector<std::int64_t>& members);

  /// Notes that coordinates were rounded, if any were.
  void note_rounded(Notes& notes) const;

 private:
  /// Ends the present line if `text` left it without an end.
  void begin_line();

  OutputFile& out_;
  std::string line_end_;
  bool within_line_ = false;
  std::int64_t rounded_ = 0;
};

/// Returns the text of a number in at most 20 characters: Abaqus and CalculiX read no more. The text reads
/// back to the same bits unless the number had to be rounded.
std::string short_real(double value);

/// Writes the sets under names that are valid in decks. Notes the names that change, and the sets without
/// members, which are left out.
void write_sets(DeckOutput& out, const std::vector<EntitySet>& sets, const DeckNumbers& numbers,
                Notes& notes);

}  // namespace meshorder::abaqus
