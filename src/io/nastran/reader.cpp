// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Nastran's bulk data: MSC Nastran Quick Reference Guide, "Bulk Data Entries".
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "io/deck/numbers.hpp"
#include "io/labels.hpp"
#include "io/nastran/deck_text.hpp"
#include "io/nastran/nastran.hpp"
#include "io/nastran/references.hpp"
#include "io/nastran/systems.hpp"
#include "io/stream/read_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace meshorder::nastran {
namespace {

/// Distinct texts, in the order of their first appearance.
struct Texts {
  std::vector<std::string> list;
  std::set<std::string> known;

  void add(const std::string& text) {
    if (known.insert(text).second) list.push_back(text);
  }
};

class DeckReader {
 public:
  DeckReader(const FilePath& path, Notes& notes) : file_(path), notes_(notes) {
    deck_->line_end = file_.line_end();
    deck_->bulk = file_.bulk();
  }

  Mesh read() {
    try {
      read_cards();
    } catch (const Fault& fault) {
      file_.fail(fault.byte, fault.what, fault.remedy);
    }
    finish();
    return std::move(mesh_);
  }

 private:
  /// The cards of a part of the bulk data, up to the first one with a fault.
  struct PartCards {
    std::vector<Card> cards;
    std::optional<Fault> fault;
  };

  /// Parses cards on all threads, some parts of the text at a time; adds them to the mesh one by one.
  void read_cards() {
    constexpr std::size_t kPartBytes = std::size_t{1} << 18;
    const std::vector<Piece> parts = parts_of_cards(file_.text(), file_.bulk(), kPartBytes);
    const Index at_once = 4 * thread_count();
    for (Index first = 0; first < index_size(parts); first += at_once) {
      std::vector<PartCards> read(static_cast<std::size_t>(std::min(at_once, index_size(parts) - first)));
      parallel_loop(index_size(read), [&](Index k) { read[k] = cards_of(parts[first + k]); });
      for (const PartCards& part : read) {
        for (const Card& card : part.cards) add(card);
        if (part.fault) throw Fault(*part.fault);
      }
    }
  }

  [[nodiscard]] PartCards cards_of(Piece part) const {
    constexpr std::size_t kCardBytes = 64;
    PartCards result;
    result.cards.reserve((part.end - part.begin) / kCardBytes);
    Cards cards(file_.text(), part);
    CardFields fields;
    try {
      while (cards.next()) result.cards.push_back(parse_card(cards, fields));
    } catch (const Fault& fault) {
      result.fault = fault;
    }
    return result;
  }

  void add(const Card& card) {
    card_ = card.place;
    switch (card.kind) {
      case Card::Kind::node:
        return add_node(card);
      case Card::Kind::element:
        return add_element(card);
      case Card::Kind::other:
        break;
    }
    split_card(card.place.of(file_.text()), fields_);
    read_other(name_of(fields_));
  }

  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    file_.fail(card_.begin, what, remedy);
  }

  [[nodiscard]] std::int64_t number(std::size_t field, std::string_view what) const {
    return number_in(fields_, field, what, card_);
  }

  void add_node(const Card& card) {
    if (!deck_->nodes.add(card.number)) {
      fail(fmt::format("node {} is given twice", card.number), "numbers must differ");
    }
    system_of_.push_back(card.group);
    has_systems_ = has_systems_ || card.group > 0;
    has_more_in_nodes_ = has_more_in_nodes_ || card.has_more;
    mesh_.points.push_back(card.point);
    deck_->node_cards.push_back(card.place);
  }

  void add_element(const Card& card) {
    if (!deck_->elements.add(card.number)) {
      fail(fmt::format("element {} is given twice", card.number), "numbers must differ");
    }
    std::array<Index, kMostNodes> cell{};
    const Offset entry = mesh_.cells.offsets.back();
    for (std::size_t k = 0; k < static_cast<std::size_t>(card.nodes); ++k) {
      cell[k] = deck_->nodes.find(card.cell[k]);
      if (cell[k] >= 0) continue;
      cell[k] = 0;
      later_nodes_.push_back({entry + static_cast<Offset>(k), card.cell[k], card.place.begin});
    }
    begin_block();
    const ElementType& type = *card.type;
    mesh_.cells.push_back(type.shape, {cell.data(), static_cast<std::size_t>(card.nodes)});
    deck_->element_cards.push_back({card.place, &type, card.nodes});
    if (type.has_property) {
      labels_.push_back(card.group);  // `complete_properties` replaces kBlank
      labelled_.push_back(mesh_.cell_count() - 1);
    }
    if (card.lacks_nodes) ++without_some_;
    if (card.has_more) with_more_.add(std::string(type.name));
  }

  /// Begins a block of cells at the first element and after each card of another kind: elements stay in their
  /// blocks.
  void begin_block() {
    const bool first = deck_->element_cards.empty();
    if (first || other_since_) mesh_.cell_blocks.push_back(mesh_.cell_count());
    other_since_ = false;
  }

  void read_other(const std::string& name) {
    if (name.starts_with('=')) fail("cards are repeated by '='", "write out the repeated cards");
    other_since_ = true;
    const auto found = references(name, fields_);
    if (name == "GRDSET" && !fields_.text(2).empty() && fields_.text(2) != "0") {
      default_system_ = number(2, "the system of nodes");
      has_systems_ = deck_->has_default_system = true;
    }
    if ((name == "BAROR" || name == "BEAMOR") && !fields_.text(2).empty()) {
      deck_->default_properties[name == "BAROR" ? "CBAR" : "CBEAM"] = number(2, "the property of elements");
    }
    systems_.add(name, fields_, card_.begin);
    if (!found) strangers_.push_back({name, card_});
    if (found && found->defines_element) deck_->other_elements.push_back(number_of(fields_.text(1)));
    if (found && found->defines_points) {
      for (const NumberRange& range : ranges_of(fields_, found->list).value_or(std::vector<NumberRange>())) {
        add_points(range);
      }
    }
    if (name.starts_with("SET")) deck_->last_set = std::max(deck_->last_set, number_of(fields_.text(1)));
    if (name == "SET3" && found && found->list > 0) {
      sets_.push_back(card_);
    } else {
      others_.add(shown(name));
    }
  }

  void add_points(const NumberRange& range) {
    constexpr std::int64_t kMost = 10'000'000;  // most numbers in one range
    if (range.to - range.from > kMost) fail("a range has more than ten million points", "correct it");
    const std::int64_t count = std::max<std::int64_t>((range.to - range.from) / range.step + 1, 0);
    claim_memory(static_cast<std::uint64_t>(count) * sizeof(std::int64_t), "a range of points");
    for (std::int64_t n = range.from; n <= range.to; n += range.step) deck_->other_points.push_back(n);
  }

  void finish() {
    std::vector<std::string> elements = others_.list;
    std::erase_if(elements,
                  [](const std::string& name) { return !name.starts_with('C') || name.starts_with("CORD"); });
    require_mesh(*deck_, file_.path(), "has no GRID", "has no elements that are cells", join(elements));
    resolve(later_nodes_, deck_->nodes, mesh_.cells, [&](const LaterNode<std::size_t>& later) {
      file_.fail(later.place, fmt::format("a node of the element is {}, which no GRID has", later.number),
                 "add it, or correct the element");
    });
    place_nodes();
    mesh_.dimension = 3;
    sort_once(deck_->other_points);
    sort_once(deck_->other_elements);
    complete_properties();
    add_labels();
    read_sets();
    list_contents();
    find_unknown();
    note_all();
    deck_->points = mesh_.points;
    deck_->text = std::move(file_.text());
    keep_deck(mesh_, deck_);
  }

  static void sort_once(std::vector<std::int64_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  }

  /// Converts the coordinates of nodes from their own systems to the basic system.
  void place_nodes() {
    if (!has_systems_) return;
    std::replace(system_of_.begin(), system_of_.end(), Card::kBlank, default_system_);
    const std::vector<Point> given = mesh_.points;
    const CoordinateSystems::NodePosition in_basic = [&](std::int64_t node, std::size_t byte) {
      const Index v = deck_->nodes.find(node);
      if (v < 0) file_.fail(byte, fmt::format("node {} of the coordinate system is missing", node), "add it");
      return systems_.in_basic(system_of_[v], given[v], byte, in_basic);
    };
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      mesh_.points[v] = systems_.in_basic(system_of_[v], given[v], deck_->node_cards[v].begin, in_basic);
    }
  }

  /// Gives elements without a property the property of BAROR or BEAMOR, else their own number.
  void complete_properties() {
    for (std::size_t k = 0; k < labels_.size(); ++k) {
      if (labels_[k] != Card::kBlank) continue;
      const Index c = labelled_[k];
      const auto found = deck_->default_properties.find(deck_->element_cards[c].type->name);
      const bool has_default = found != deck_->default_properties.end();
      labels_[k] = has_default ? found->second : deck_->elements.id(c);
    }
  }

  void add_labels() {
    if (labels_.empty()) return;
    DataArray& array = mesh_.data.emplace_back();
    array.name = kLabel;
    array.association = Association::cells;
    if (index_size(labels_) < mesh_.cell_count()) array.indices = std::move(labelled_);
    array.values = label_values(std::move(labels_));
  }

  void read_sets() {
    for (const Piece card : sets_) {
      const std::string_view text = file_.text();
      split_card(card.of(text), fields_);
      const auto found = references("SET3", fields_);
      const auto ranges = ranges_of(fields_, found->list);
      EntitySet set;
      set.association = found->of_list;
      set.name = name_of_set(text, card);
      const bool of_nodes = set.association == Association::vertices;
      if (!ranges) continue;
      (void)numbers_in_list(*ranges, of_nodes ? deck_->nodes : deck_->elements, {}, set.members);
      mesh_.sets.push_back(std::move(set));
    }
    deck_->sets = mesh_.sets;
  }

  /// Returns the name of a set: from the comment above its card, else "SET3 N" with the number of the set.
  [[nodiscard]] std::string name_of_set(std::string_view text, Piece card) const {
    const std::string_view before = text.substr(0, card.begin);
    const std::size_t end = before.find_last_not_of("\r\n") + 1;
    const std::size_t begin = before.substr(0, end).find_last_of("\r\n") + 1;
    const std::string_view line = before.substr(begin, end - begin);
    if (line.starts_with(kSetComment)) return std::string(line.substr(kSetComment.size()));
    return fmt::format("SET3 {}", fields_.text(1));
  }

  void list_contents() {
    std::vector<std::string>& contents = deck_->contents;
    if (file_.bulk().begin > 0) contents.emplace_back("executive and case control");
    if (has_more_in_nodes_) contents.emplace_back("displacement systems and constraints of GRID");
    if (!with_more_.list.empty()) contents.push_back("fields after the nodes of " + join(with_more_.list));
    if (without_some_ > 0) contents.emplace_back("edge nodes of elements that lack some of them");
    if (!others_.list.empty()) contents.push_back("cards of the bulk data: " + join(others_.list));
  }

  [[nodiscard]] bool is_item(std::int64_t number) const {
    return deck_->nodes.find(number) >= 0 || deck_->elements.find(number) >= 0;
  }

  /// Returns whether the text of a field may name nodes or elements.
  [[nodiscard]] bool may_name(std::string_view text) const {
    return same_but_for_case(text, "THRU") || is_item(number_of(text));
  }

  void find_unknown() {
    const std::string_view text = file_.text();
    const auto add = [&](std::string_view what, std::size_t byte) {
      deck_->unknown.push_back(fmt::format("{} (line {})", what, file_.location(byte).line));
    };
    find_in_control(text.substr(0, file_.bulk().begin), add);
    constexpr std::string_view kMove = "$HMMOVE";  // lists of elements, in comments
    const Piece bulk = file_.bulk();
    if (const std::size_t at = bulk.of(text).find(kMove); at != std::string_view::npos) {
      add(kMove, bulk.begin + at);
    }
    for (const auto& [name, card] : strangers_) {
      split_card(card.of(text), fields_);
      const std::size_t first = name == "SET1" ? 2 : 1;  // after the number of the set
      bool names = !fields_.fault.empty();
      for (std::size_t k = first; k < fields_.fields.size(); ++k) names = names || may_name(fields_.text(k));
      if (names) add(shown(name), card.begin);
    }
  }

  /// Finds nodes or elements that case control names: in sets, curves, and commands with a grid point.
  template <class Add>
  void find_in_control(std::string_view control, const Add& add) const {
    bool in_set = false;
    for (std::size_t begin = 0; begin < control.size();) {
      const std::size_t end = std::min(control.find_first_of("\r\n", begin), control.size());
      std::string_view line = control.substr(begin, end - begin);
      const std::size_t byte = begin;
      begin = end + 1;
      line = line.substr(0, line.find('$'));
      std::string_view rest = line;
      const std::string_view word = next_word(rest, "=");
      const bool is_curve = word.size() > 1 && same_but_for_case(word.substr(0, 2), "XY");
      if (names_grid_point(line)) add(shown(word.substr(0, word.find('('))), byte);
      const bool goes_on = in_set;
      const bool is_set = word.size() == 3 && same_but_for_case(word, "SET");
      if (is_set) (void)next_word(rest, "=");  // the number of the set
      in_set = (is_set || in_set) && trimmed(line).ends_with(',');
      if (!is_set && !goes_on && !is_curve) continue;
      if (is_curve || names_items(goes_on && !is_set ? line : rest)) {
        add(is_curve ? shown(word) : std::string("SET of case control"), byte);
        in_set = false;
      }
    }
  }

  /// Returns whether a line of case control names a node: GROUNDCHECK(GRID=17) or PARAM,GRDPNT,17.
  [[nodiscard]] bool names_grid_point(std::string_view line) const {
    std::string_view last;
    for (std::string_view word; !(word = next_word(line, ",=()")).empty(); last = word) {
      const bool is_point = same_but_for_case(last, "GRID") || same_but_for_case(last, "GRDPNT");
      if (is_point && deck_->nodes.find(number_of(word)) >= 0) return true;
    }
    return false;
  }

  [[nodiscard]] bool names_items(std::string_view list) const {
    for (std::string_view word; !(word = next_word(list, ",=")).empty();) {
      if (may_name(word)) return true;
    }
    return false;
  }

  void note_all() {
    if (without_some_ > 0) {
      notes_.push_back(
          fmt::format("{} without some of the nodes of edges: the cells have only the corners",
                      without_some_ == 1 ? "one element is" : fmt::format("{} elements are", without_some_)));
    }
    if (!file_.included().empty()) {
      notes_.push_back(fmt::format("included files are now part of the file: {}", join(file_.included())));
    }
    if (!file_.has_end()) notes_.emplace_back("the file has no ENDDATA; it may be cut short");
    note_kept_numbers(deck_->unknown, notes_);
  }

  /// A card that is not known.
  struct Stranger {
    std::string name;
    Piece card;
  };

  DeckText file_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<Deck> deck_ = std::make_shared<Deck>();
  Piece card_;  // the card that is being added
  CardFields fields_;
  CoordinateSystems systems_{file_};
  std::int64_t default_system_ = 0;
  std::vector<std::int64_t> system_of_;              // system of each node
  bool has_systems_ = false;                         // whether any node has a system other than the basic one
  std::vector<LaterNode<std::size_t>> later_nodes_;  // place: the byte of the element
  std::vector<std::int64_t> labels_;
  std::vector<Index> labelled_;
  std::vector<Piece> sets_;
  std::vector<Stranger> strangers_;
  Texts others_;     // names of other cards
  Texts with_more_;  // names of cards of elements with further fields
  std::int64_t without_some_ = 0;
  bool has_more_in_nodes_ = false;
  bool other_since_ = false;  // another card since the last element
};

}  // namespace

Mesh read(const FilePath& path, Notes& notes) { return DeckReader(path, notes).read(); }

}  // namespace meshorder::nastran
