// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/abaqus/abaqus.hpp"
#include "io/abaqus/cards.hpp"
#include "io/all_formats.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/stream/text_rows.hpp"
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace meshorder::abaqus {
namespace {

constexpr std::size_t kPerLine = 16;  // numbers on a line

/// Returns the deck that a mesh was read from; null if there is none or the mesh no longer fits the deck.
const AbaqusMetadata* deck_of(const Mesh& mesh) {
  std::size_t at = 0;  // index of the card of element k
  return own_deck<Deck>(mesh, [&](const Deck& deck, Index k, Shape shape, int vertices) {
    const auto has_element = [k](const DeckCard& card) {
      return card.part == CardKind::elements && k < card.first + card.count;
    };
    while (!has_element(deck.sections[at])) ++at;
    return deck.sections[at].kind == ElementKind{shape, vertices};
  });
}

/// Returns a deck of nodes and elements for a mesh that has no deck of its own.
std::shared_ptr<Deck> plain_deck(const Mesh& mesh) {
  auto deck = std::make_shared<Deck>();
  deck->sections.push_back({CardKind::nodes, "*NODE\n", 0, mesh.vertex_count()});
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const ElementKind kind{mesh.cells.shapes[c], mesh.cells.vertex_count(c)};
    if (c == 0 || kind != deck->sections.back().kind) {
      const std::string_view type = type_of(kind, mesh.dimension == 2);
      deck->sections.push_back({CardKind::elements, fmt::format("*ELEMENT, TYPE={}\n", type), c, 0, kind});
    }
    ++deck->sections.back().count;
  }
  return deck;
}

/// Takes the next word of a card and returns it in capitals; a name in quotes may have several words.
std::string next_word_in_capitals(std::string_view& text) { return upper_case(next_word(text, ",=\"\r\n")); }

/// Returns a valid name that is not in `taken`, ignoring case, and adds it to `taken`.
std::string name_for(const std::string& given, std::set<std::string>& taken, NameNumbers& numbers) {
  constexpr std::size_t kLongest = 80;
  std::string name = plain_name(given, " ,\"=*.");
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0) name = "set_" + name;
  const auto numbered = [&](int k) {
    const std::string end = fmt::format("_{}", k);
    return std::string(utf8_prefix(name, kLongest - end.size())) + end;
  };
  return numbers.free_name(std::string(utf8_prefix(name, kLongest)), numbered,
                           [&](const std::string& free) { return taken.insert(upper_case(free)).second; });
}

class DeckWriter {
 public:
  DeckWriter(const Mesh& mesh, const FilePath& path, Notes& notes)
      : mesh_(mesh),
        own_(deck_of(mesh)),
        plain_(own_ == nullptr ? plain_deck(mesh) : nullptr),
        deck_(own_ == nullptr ? *plain_.deck : *own_->deck),
        numbers_(own_ == nullptr ? plain_.new_numbers(mesh, kLargest) : own_->numbers(mesh)),
        notes_(notes),
        file_(path),
        more_of_nodes_(by_place(deck_.more_of_nodes, numbers_.nodes)),
        more_of_elements_(by_place(deck_.more_of_elements, numbers_.elements)),
        same_numbers_(keep_numbers(numbers_, kLargest, deck_.unknown, path)) {}

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
    note_losses();
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

  void note_losses() {
    note_rounded(rounded_, "20 characters that Abaqus and CalculiX read of a number", notes_);
    if (own_ == nullptr) {
      note_arrays_beside_cell_labels(mesh_, "Abaqus", notes_);
      note_unfit_ids(mesh_, "Abaqus", kLargest, notes_);
      note_metadata_unsupported(mesh_, "Abaqus", notes_);
    }
    if (!more_of_nodes_.empty()) {
      notes_.push_back(fmt::format(
          "fields after the coordinates of {} are not supported and stay as they are",
          more_of_nodes_.size() == 1 ? "a node" : fmt::format("{} nodes", more_of_nodes_.size())));
    }
    if (!more_of_elements_.empty()) {
      notes_.push_back(
          fmt::format("numbers after the last node of {} stay as they are; CalculiX does not read them",
                      more_of_elements_.size() == 1 ? "an element"
                                                    : fmt::format("{} elements", more_of_elements_.size())));
    }
    if (own_ == nullptr) return;
    for (const DataArray& array : mesh_.data) note_array_unsupported(array, "Abaqus", notes_);
  }

  void write(const DeckCard& section) {
    switch (section.part) {
      case CardKind::nodes:
        return write_nodes(section);
      case CardKind::elements:
        return write_elements(section);
      case CardKind::text:
        return same_numbers_ ? write_text(section.text) : write_renumbered(section.text);
    }
  }

  /// Returns the positions in the mesh of a card's items, ascending.
  static std::vector<Index> places_of(const DeckCard& section, const FileNumbers& numbers) {
    std::vector<Index> places = index_range(section.first, section.count);
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
      write_text(section.text);
    } else {
      write_text(without_parameter(section.text, "NSET"));
      const std::string set(parse_card(section.text).value("NSET"));
      if (!set.empty()) {
        std::string_view words = set;
        words_of_sets_.insert(next_word_in_capitals(words));
        sets_of_cards_.emplace_back(set, &section);
      }
    }
    if (section.count > 0) begin_line();
    write_row_ranges(file_, section.count, [&](Text& text, Index begin, Index end) {
      std::int64_t rounded_here = 0;
      for (Index v = section.first + begin; v < section.first + end; ++v) {
        text.integer("", numbers_.nodes.at(v));
        for (int k = 0; k < mesh_.dimension; ++k) {
          const RealText real(mesh_.points[v][k]);
          if (real.is_rounded) ++rounded_here;
          text.write(", ");
          text.write(real.text());
        }
        end_row(text, text_at(more_of_nodes_, v));
      }
      rounded_ += rounded_here;
    });
  }

  void end_row(Text& text, std::string_view more) const {
    text.write(more);
    text.write(deck_.line_end);
  }

  [[nodiscard]] bool has_its_nodes(const DeckCard& section) const {
    const std::vector<Index> places = places_of(section, numbers_.nodes);
    return places.empty() ||
           (places.front() == section.first && index_size(places) == places.back() + 1 - section.first);
  }

  /// Returns whether a card contains the first word of an unwritten set's name. O(bytes of the card), for any
  /// number of sets.
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
      for (const Index v : places_of(*section, numbers_.nodes)) members.push_back(numbers_.nodes.at(v));
      const bool quoted = set.find_first_of(" ,=") != std::string::npos;
      write_set(Association::vertices, quoted ? '"' + set + '"' : set, members);
    }
    sets_of_cards_.clear();
    words_of_sets_.clear();
  }

  void write_elements(const DeckCard& section) {
    write_text(section.text);
    const std::vector<Index> places = places_of(section, numbers_.elements);
    if (section.count > 0) begin_line();
    write_row_ranges(file_, section.count, [&](Text& text, Index begin, Index end) {
      std::vector<std::int64_t> nodes;
      for (Index i = begin; i < end; ++i) {
        const Index c = places[i];
        const auto cell = mesh_.cells[c];
        nodes.resize(cell.size());
        for (std::size_t k = 0; k < cell.size(); ++k) {
          nodes[node_place(section.kind, k)] = numbers_.nodes.at(cell[k]);
        }
        text.integer("", numbers_.elements.at(c));
        for (std::size_t k = 0; k < nodes.size(); ++k) {
          const bool begins_line = (k + 1) % kPerLine == 0;
          if (begins_line) end_row(text, ",");
          text.integer(begins_line ? "" : ", ", nodes[k]);
        }
        end_row(text, text_at(more_of_elements_, c));
      }
    });
  }

  /// Writes a card with the present numbers of the nodes and elements that it names.
  void write_renumbered(const std::string& text) {
    const Card card = parse_card(text);
    if ((card.keyword == "NSET" || card.keyword == "ELSET") && card.has("GENERATE")) {
      const Association association = card.keyword == "NSET" ? Association::vertices : Association::cells;
      return write_generated(text, numbers_.of(association), card.has("UNSORTED"));
    }
    std::size_t done = 0;
    for (const Reference& reference : references(card, text).value_or(std::vector<Reference>())) {
      write_text(std::string_view(text).substr(done, reference.begin - done));
      file_.integer("", numbers_.of(reference.association).now(reference.number));
      done = reference.begin + reference.length;
    }
    write_text(std::string_view(text).substr(done));
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
      std::string_view line = lines.substr(0, lines.find_first_of("\r\n"));
      lines.remove_prefix(std::min(line.size() + 1, lines.size()));
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
    if (same) return write_text(text);
    write_text(without_parameter(keyword, "GENERATE"));
    write_list(now);
    write_text(comments);
  }

  void write_new_sets() {
    std::vector<EntitySet> sets = sets_beside(deck_.sets, mesh_, numbers_, notes_);
    if (own_ == nullptr) add_sets_of_labels(sets);
    write_sets(sets);
  }

  /// Writes the sets under names that are valid in decks. Notes the names that change, and the sets without
  /// members, which are left out.
  void write_sets(const std::vector<EntitySet>& sets) {
    std::map<Association, std::set<std::string>> taken;
    std::map<Association, NameNumbers> numbering;
    for (const EntitySet& set : sets) {
      if (set.members.empty()) {
        note_set_empty(set, notes_);
        continue;
      }
      const std::string name = name_for(set.name, taken[set.association], numbering[set.association]);
      note_renamed_set(set, name, notes_);
      std::vector<std::int64_t> members;
      members.reserve(set.members.size());
      for (const Index member : set.members) members.push_back(numbers_.of(set.association).at(member));
      write_set(set.association, name, members);
    }
  }

  void write_set(Association association, std::string_view name, const std::vector<std::int64_t>& members) {
    const std::string_view keyword = association == Association::vertices ? "NSET" : "ELSET";
    begin_line();
    file_.print("*{}, {}={}{}", keyword, keyword, name, deck_.line_end);
    write_list(members);
  }

  void write_list(const std::vector<std::int64_t>& numbers) {
    if (!numbers.empty()) begin_line();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      file_.integer(i % kPerLine == 0 ? "" : ", ", numbers[i]);
      if (i % kPerLine == kPerLine - 1 || i + 1 == numbers.size()) file_.write(deck_.line_end);
    }
  }

  /// Writes a part of the deck as it is.
  void write_text(std::string_view text) {
    file_.write(text);
    if (!text.empty()) within_line_ = text.back() != '\n' && text.back() != '\r';
  }

  /// Ends the present line if `write_text` left it without an end.
  void begin_line() {
    if (within_line_) file_.write(deck_.line_end);
    within_line_ = false;
  }

  void add_sets_of_labels(std::vector<EntitySet>& sets) {
    const Labels labels = labels_of(mesh_, Association::cells);
    if (!labels.any()) return;
    const bool are_markers = mesh_.format == "su2";  // label 0 is not a marker of SU2
    std::map<std::int64_t, EntitySet> by_label;
    for (Index c = 0; c < mesh_.cell_count(); ++c) {
      if (labels.given[c] && (labels.values[c] != 0 || !are_markers))
        by_label[labels.values[c]].members.push_back(c);
    }
    for (auto& [label, set] : by_label) {
      set.name = fmt::format("label_{}", label);
      sets.push_back(std::move(set));
    }
    notes_.emplace_back("labels of cells are written as sets named label_N");
  }

  const Mesh& mesh_;
  const AbaqusMetadata* own_;  // null if the mesh has no deck
  AbaqusMetadata plain_;       // the deck of a mesh without one
  const Deck& deck_;
  DeckNumbers numbers_;
  Notes& notes_;
  OutputFile file_;
  bool within_line_ = false;
  std::atomic<std::int64_t> rounded_ = 0;  ///< number of rounded coordinates
  TextByPlace more_of_nodes_;
  TextByPlace more_of_elements_;
  bool same_numbers_;
  std::vector<std::pair<std::string, const DeckCard*>> sets_of_cards_;  ///< sets still to be written
  std::unordered_set<std::string> words_of_sets_;  ///< first words of the names of these sets, in capitals
};

bool holds(const Mesh& mesh, Shape shape, int vertices) {
  return !type_of({shape, vertices}, false).empty() || deck_of(mesh) != nullptr;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) { DeckWriter(mesh, path, notes).write(); }

}  // namespace
}  // namespace meshorder::abaqus

namespace meshorder {

Format abaqus_format() {
  return {.name = "Abaqus",
          .extensions = {".inp"},
          .groups_cells_by_type = true,
          .read = abaqus::read,
          .write = abaqus::write,
          .holds = abaqus::holds,
          .first_number = 1,
          .has_numbers = true};
}

}  // namespace meshorder
