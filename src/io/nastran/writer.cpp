// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/all_formats.hpp"
#include "io/deck/numbers.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/nastran/nastran.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/unsupported.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::nastran {
namespace {

/// Writes bulk data of nodes, elements and sets for a mesh that has no deck of its own.
class PlainBulkWriter {
 public:
  PlainBulkWriter(const Mesh& mesh, const FilePath& path, Notes& notes)
      : mesh_(mesh),
        notes_(notes),
        file_(path),
        labels_(labels_of(mesh, Association::cells)),
        numbers_(no_deck_.new_numbers(mesh, kLargestNumber)) {
    if (mesh.vertex_count() > kLargestNumber || mesh.cell_count() > kLargestNumber) {
      throw InputError(path.string(), "has more than 99999999 vertices or cells",
                       "Nastran cannot number more");
    }
  }

  void write() {
    file_.write("CEND\nBEGIN BULK\n");
    write_rows(file_, mesh_.vertex_count(), [this](Text& text, Index v) { write_node(text, v); });
    write_rows(file_, mesh_.cell_count(), [this](Text& text, Index c) { write_element(text, c); });
    write_sets();
    file_.write("ENDDATA\n");
    file_.commit();
    note_losses();
  }

 private:
  void write_node(Text& out, Index v) {
    std::array<RealText, 3> reals;
    for (std::size_t k = 0; k < reals.size(); ++k) {
      reals[k] = real_text(mesh_.points[v][k]);
      if (reals[k].is_rounded) ++rounded_;
    }
    out.print("GRID*   {:>16}                {:>16}{:>16}\n*       {:>16}\n", numbers_.nodes.at(v),
              reals[0].text, reals[1].text, reals[2].text);
  }

  void write_element(Text& out, Index c) {
    const auto cell = mesh_.cells[c];
    const Shape shape = mesh_.cells.shapes[c];
    const int nodes = static_cast<int>(cell.size());
    std::array<std::int64_t, 2 + kMostNodes> numbers{numbers_.elements.at(c), property(c)};
    for (std::size_t k = 0; k < cell.size(); ++k) {
      numbers[2 + node_place(shape, nodes, k)] = numbers_.nodes.at(cell[k]);
    }
    constexpr std::size_t kOnLine = 8;
    constexpr std::string_view kBlanks = "        ";
    const std::string_view card = card_of(shape, nodes);
    out.write(card);
    out.write(kBlanks.substr(card.size()));
    for (std::size_t k = 0; k < 2 + cell.size(); ++k) {
      if (k > 0 && k % kOnLine == 0) out.write("+\n+       ");
      const fmt::format_int digits(numbers[k]);
      out.write(kBlanks.substr(digits.size()));
      out.write({digits.data(), digits.size()});
    }
    out.write("\n");
  }

  /// Returns the property of a cell: its label if that is a valid number, else 1.
  std::int64_t property(Index c) {
    const bool given = labels_.any() && labels_.given[c];
    const std::int64_t label = given ? labels_.values[c] : 1;
    if (label >= 1 && label <= kLargestNumber) return label;
    ++lost_labels_;
    return 1;
  }

  void write_sets() {
    std::int64_t number = 0;
    for (const EntitySet& set : mesh_.sets) {
      std::string card;
      append_set(card, ++number, set, numbers_, "\n", notes_);
      file_.write(card);
    }
  }

  void note_losses() {
    note_rounded(rounded_, kWidestField, notes_);
    if (lost_labels_ > 0) {
      notes_.push_back(fmt::format("{} cells whose labels are not from 1 to 99999999 have the property 1",
                                   lost_labels_.load()));
    }
    note_arrays_beside_cell_labels(mesh_, "Nastran", notes_);
    note_unfit_ids(mesh_, "Nastran", kLargestNumber, notes_);
    note_metadata_unsupported(mesh_, "Nastran", notes_);
  }

  const Mesh& mesh_;
  Notes& notes_;
  OutputFile file_;
  Labels labels_;
  std::atomic<std::int64_t> rounded_ = 0;
  std::atomic<std::int64_t> lost_labels_ = 0;
  BulkMetadata no_deck_{std::make_shared<Deck>()};
  DeckNumbers numbers_;
};

bool holds(const Mesh& mesh, Shape shape, int vertices) {
  return !card_of(shape, vertices).empty() || deck_of(mesh) != nullptr;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  if (const BulkMetadata* const own = deck_of(mesh)) return write_into_deck(mesh, *own, path, notes);
  PlainBulkWriter(mesh, path, notes).write();
}

}  // namespace

void append_set(std::string& out, std::int64_t number, const EntitySet& set, const DeckNumbers& numbers,
                std::string_view line_end, Notes& notes) {
  if (set.members.empty()) {
    note_set_empty(set, notes);
    return;
  }
  const std::string name = plain_name(set.name);
  note_renamed_set(set, name, notes);
  std::vector<std::string> texts{std::to_string(number),
                                 set.association == Association::vertices ? "GRID" : "ELEM"};
  for (const Index member : set.members) {
    texts.push_back(std::to_string(numbers.of(set.association).at(member)));
  }
  out.append(kSetComment).append(name).append(line_end);
  append_card(out, "SET3", texts, line_end);
}

}  // namespace meshorder::nastran

namespace meshorder {

Format nastran_format() {
  return {.name = "Nastran",
          .extensions = {".bdf", ".nas", ".fem"},
          .groups_cells_by_type = false,
          .read = nastran::read,
          .write = nastran::write,
          .holds = nastran::holds,
          .first_number = 1,
          .has_numbers = true};
}

}  // namespace meshorder
