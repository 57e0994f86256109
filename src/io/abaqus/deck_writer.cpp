// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/abaqus/abaqus.hpp"
#include "io/abaqus/cards.hpp"
#include "io/abaqus/output.hpp"
#include "io/deck/numbers.hpp"
#include "io/stream/output_file.hpp"
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace meshorder::abaqus {
namespace {

/// Returns whether the cells of a card's elements still have the type of the card.
bool has_kind(const Mesh& mesh, const AbaqusMetadata& metadata, const DeckCard& section) {
  for (Index k = section.first; k < section.first + section.count; ++k) {
    const Index c = metadata.cell(k);
    if (ElementKind{mesh.cells.shapes[c], mesh.cells.vertex_count(c)} != section.kind) return false;
  }
  return true;
}

/// Takes the next word of a card and returns it in capitals; a name in quotes may have several words.
std::string next_word_in_capitals(std::string_view& text) { return capitals(next_word(text, " \t,=\"\r\n")); }

class DeckWriter {
 public:
  DeckWriter(const Mesh& mesh, const AbaqusMetadata& own, const FilePath& path, Notes& notes)
      : mesh_(mesh),
        deck_(*own.deck),
        nodes_(deck_.nodes, own.vertex_of, mesh.vertex_ids),
        elements_(deck_.elements, own.cell_of, mesh.cell_ids),
        notes_(notes),
        file_(path),
        out_(file_, deck_.line_end),
        more_of_nodes_(by_place(deck_.more_of_nodes, nodes_)),
        more_of_elements_(by_place(deck_.more_of_elements, elements_)),
        same_numbers_(keep_numbers(nodes_, elements_, kLargest, deck_.unknown, path)) {}

  void write() {
    const auto after_last = [&](auto is_wanted) {
      return std::find_if(deck_.sections.rbegin(), deck_.sections.rend(), is_wanted).base();
    };
    const auto after_mesh =
        after_last([](const DeckCard& section) { return section.part != CardKind::text; });
    const auto after_nodes = after_last(
        [](const DeckCard& section) { return section.part == CardKind::nodes && section.count > 0; });
    for (auto section = deck_.sections.begin();; ++section) {
      if (section == after_nodes) write_sets_of_cards();
      if (section == after_mesh) write_new_sets();
      if (section == deck_.sections.end()) break;
      if (section->part == CardKind::text && may_use_set_of_cards(section->text)) write_sets_of_cards();
      write(*section);
    }
    file_.commit();
    out_.note_rounded(notes_);
    note_more();
  }

 private:
  using TextByPlace = std::unordered_map<Index, std::string_view>;

  /// Changes the keys of `texts` from positions in the file to positions in the mesh.
  static TextByPlace by_place(const std::map<Index, std::string>& texts, const FileNumbers& numbers) {
    TextByPlace result;
    for (const auto& [k, text] : texts) result.emplace(numbers.place(k), text);
    return result;
  }

  static std::string_view text_at(const TextByPlace& texts, Index place) {
    if (texts.empty()) return {};
    const auto found = texts.find(place);
    return found == texts.end() ? std::string_view() : found->second;
  }

  void note_more() {
    if (!more_of_nodes_.empty()) {
      notes_.push_back(fmt::format(
          "fields after the coordinates of {} stay as they are, and are not understood",
          more_of_nodes_.size() == 1 ? "a node" : fmt::format("{} nodes", more_of_nodes_.size())));
    }
    if (!more_of_elements_.empty()) {
      notes_.push_back(
          fmt::format("numbers after the last node of {} stay as they are; CalculiX does not read them",
                      more_of_elements_.size() == 1 ? "an element"
                                                    : fmt::format("{} elements", more_of_elements_.size())));
    }
  }

  void write(const DeckCard& section) {
    switch (section.part) {
      case CardKind::nodes:
        return write_nodes(section);
      case CardKind::elements:
        return write_elements(section);
      case CardKind::text:
        return same_numbers_ ? out_.text(section.text) : write_renumbered(section.text);
    }
  }

  /// Returns the positions in the mesh of a card's items, ascending.
  static std::vector<Index> places_of(const DeckCard& section, const FileNumbers& numbers) {
    std::vector<Index> places(static_cast<std::size_t>(section.count));
    std::iota(places.begin(), places.end(), section.first);
    for (Index& place : places) place = numbers.place(place);
    if (places.empty()) return places;
    const auto [least, greatest] = std::minmax_element(places.begin(), places.end());
    if (const Index first = *least; *greatest - first == section.count - 1) {  // no gaps
      std::iota(places.begin(), places.end(), first);
    } else {
      std::sort(places.begin(), places.end());
    }
    return places;
  }

  /// Writes as many nodes as the card had, in the order of the mesh. If these are no longer the card's own
  /// nodes, its NSET is left out, and `write_sets_of_cards` writes the set.
  void write_nodes(const DeckCard& section) {
    if (has_its_nodes(section)) {
      out_.text(section.text);
    } else {
      out_.text(without_parameter(section.text, "NSET"));
      const std::string set(parse_card(section.text).value("NSET"));
      if (!set.empty()) {
        std::string_view words = set;
        words_of_sets_.insert(next_word_in_capitals(words));
        sets_of_cards_.emplace_back(set, &section);
      }
    }
    const std::span points(mesh_.points);
    out_.nodes(
        points.subspan(static_cast<std::size_t>(section.first), static_cast<std::size_t>(section.count)),
        mesh_.dimension, [&](DeckOutput::Row& row, Index i) {
          row.number = nodes_.at(section.first + i);
          row.more = text_at(more_of_nodes_, section.first + i);
        });
  }

  [[nodiscard]] bool has_its_nodes(const DeckCard& section) const {
    const std::vector<Index> places = places_of(section, nodes_);
    return places.empty() ||
           (places.front() == section.first && index_size(places) == places.back() + 1 - section.first);
  }

  /// Returns whether a card contains the first word of the name of a set that is still to be written. O(bytes
  /// of the card), for any number of sets.
  [[nodiscard]] bool may_use_set_of_cards(std::string_view text) const {
    while (!sets_of_cards_.empty() && !text.empty()) {
      if (words_of_sets_.contains(next_word_in_capitals(text))) return true;
    }
    return false;
  }

  /// Writes the sets that `write_nodes` left out so far: after the last *NODE or before a card that uses one
  /// of these sets.
  void write_sets_of_cards() {
    for (const auto& [set, section] : sets_of_cards_) {
      std::vector<std::int64_t> members;
      for (const Index v : places_of(*section, nodes_)) members.push_back(nodes_.at(v));
      const bool quoted = set.find_first_of(" ,=") != std::string::npos;
      out_.set(Association::vertices, quoted ? '"' + set + '"' : set, members);
    }
    sets_of_cards_.clear();
    words_of_sets_.clear();
  }

  void write_elements(const DeckCard& section) {
    out_.text(section.text);
    const std::vector<Index> places = places_of(section, elements_);
    out_.elements(section.count, [&](DeckOutput::Row& row, Index i) {
      const Index c = places[static_cast<std::size_t>(i)];
      const auto cell = mesh_.cells[c];
      row.number = elements_.at(c);
      row.nodes.resize(cell.size());
      for (std::size_t k = 0; k < cell.size(); ++k)
        row.nodes[node_place(section.kind, k)] = nodes_.at(cell[k]);
      row.more = text_at(more_of_elements_, c);
    });
  }

  [[nodiscard]] const FileNumbers& numbers_of(Association association) const {
    return association == Association::vertices ? nodes_ : elements_;
  }

  /// Writes a card with the present numbers of the nodes and elements that it names.
  void write_renumbered(const std::string& text) {
    const Card card = parse_card(text);
    if ((card.keyword == "NSET" || card.keyword == "ELSET") && card.has("GENERATE")) {
      const Association association = card.keyword == "NSET" ? Association::vertices : Association::cells;
      return write_generated(text, numbers_of(association), card.has("UNSORTED"));
    }
    std::size_t done = 0;
    for (const Reference& reference : references(card, text).value_or(std::vector<Reference>())) {
      out_.text(std::string_view(text).substr(done, reference.begin - done));
      file_.integer("", numbers_of(reference.association).now(reference.number));
      done = reference.begin + reference.length;
    }
    out_.text(std::string_view(text).substr(done));
  }

  /// Writes a set of ranges: unchanged if the ranges still hold the same items, else as a list, with the
  /// comments after it. `is_path`: the order of the items matters.
  void write_generated(const std::string& text, const FileNumbers& numbers, bool is_path) {
    std::vector<std::int64_t> now;
    std::string comments;
    bool same = true;
    const std::string_view keyword = keyword_lines(text);
    std::string_view lines = std::string_view(text).substr(keyword.size());
    while (!lines.empty()) {
      std::string_view line = next_word(lines, "\r\n");
      if (trimmed(line).starts_with("**")) comments.append(line).append(deck_.line_end);
      if (line.empty() || trimmed(line).starts_with("**")) continue;
      std::array<std::int64_t, 3> range{0, 0, 1};
      for (std::int64_t& value : range) {
        const std::int64_t number = line.empty() ? 0 : number_of(next_field(line));
        if (number > 0) value = number;
      }
      const auto& [from, to, step] = range;
      if (from == 0) continue;
      std::vector<std::int64_t> of_range;
      std::vector<std::int64_t> before;
      for (const Index k : items_in_range(numbers.of_file(), from, std::max(from, to), step)) {
        before.push_back(numbers.of_file().id(k));
        of_range.push_back(numbers.at(numbers.place(k)));
      }
      if (!is_path) std::sort(of_range.begin(), of_range.end());
      same = same && of_range == before;
      now.insert(now.end(), of_range.begin(), of_range.end());
    }
    if (same) return out_.text(text);
    out_.text(without_parameter(keyword, "GENERATE"));
    out_.list(now);
    out_.text(comments);
  }

  void write_new_sets() {
    write_sets(
        out_, sets_beside(deck_.sets, mesh_.sets, nodes_, elements_, notes_),
        [&](Index v) { return nodes_.at(v); }, [&](Index c) { return elements_.at(c); }, notes_);
  }

  const Mesh& mesh_;
  const Deck& deck_;
  FileNumbers nodes_;
  FileNumbers elements_;
  Notes& notes_;
  OutputFile file_;
  DeckOutput out_;
  TextByPlace more_of_nodes_;
  TextByPlace more_of_elements_;
  bool same_numbers_;
  std::vector<std::pair<std::string, const DeckCard*>> sets_of_cards_;  ///< sets still to be written
  std::unordered_set<std::string> words_of_sets_;  ///< first word of each of their names, in capitals
};

}  // namespace

const AbaqusMetadata* own_deck(const Mesh& mesh) {
  const auto* const own = dynamic_cast<const AbaqusMetadata*>(mesh.format_metadata.get());
  if (own == nullptr || !own->whole) return nullptr;
  const Deck& deck = *own->deck;
  if (deck.nodes.size() != mesh.vertex_count() || deck.elements.size() != mesh.cell_count()) return nullptr;
  const bool fits = std::all_of(deck.sections.begin(), deck.sections.end(), [&](const DeckCard& section) {
    return section.part != CardKind::elements || has_kind(mesh, *own, section);
  });
  return fits ? own : nullptr;
}

void write_into_deck(const Mesh& mesh, const AbaqusMetadata& own, const FilePath& path, Notes& notes) {
  DeckWriter(mesh, own, path, notes).write();
  for (const DataArray& array : mesh.data) note_array_unsupported(array, "Abaqus", notes);
}

}  // namespace meshorder::abaqus
