// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/labels.hpp"
#include "io/nastran/nastran.hpp"
#include "io/nastran/references.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <mutex>
#include <utility>

namespace meshorder::nastran {
namespace {

/// Data of the mesh that could not be written unchanged.
struct Losses {
  std::atomic<std::int64_t> rounded = 0;  ///< number of rounded coordinates
  std::atomic<bool> has_labels = false;   ///< whether some labels are not valid properties
};

/// The input from which all cards are written.
struct Source {
  const Mesh& mesh;
  const Deck& deck;
  DeckNumbers numbers;
  Labels labels;
  std::string target;         ///< path of the file that is written
  bool same_numbers = false;  ///< whether all nodes and elements keep the numbers of the deck
  mutable Losses losses = {};
};

/// Makes the text of cards with the present coordinates and numbers.
class CardWriter {
 public:
  explicit CardWriter(const Source& source)
      : source_(source),
        mesh_(source.mesh),
        deck_(source.deck),
        nodes_(source.numbers.nodes),
        elements_(source.numbers.elements) {}

  /// Returns the text made since the last call.
  [[nodiscard]] std::string take_text() { return std::exchange(out_, {}); }

  /// Adds a text between nodes or elements.
  void write_text(Piece part) {
    const std::string_view text = deck_.text;
    if (source_.same_numbers || part.begin == part.end) {
      out_.append(part.of(text));
      return;
    }
    std::size_t done = part.begin;
    const Piece bulk{std::max(part.begin, deck_.bulk.begin), std::min(part.end, deck_.bulk.end)};
    if (bulk.begin < bulk.end) {
      Cards cards(text, bulk);
      while (cards.next()) {
        out_.append(text.substr(done, cards.place().begin - done));
        write_card(cards.lines());
        done = cards.place().end;
      }
    }
    out_.append(text.substr(done, part.end - done));
  }

  /// Adds the node `item` of the deck, which is vertex v now.
  void write_node(Index item, Index v) {
    const std::string_view card = deck_.node_cards[item].of(deck_.text);
    const bool moved = mesh_.points[v] != deck_.points[item];
    if (!moved && nodes_.at(v) == deck_.nodes.id(item)) {
      out_.append(card);
      return;
    }
    split_card(card, fields_);
    if (moved) return write_moved_node(v);
    edits_.assign(1, {1, nodes_.at(v)});
    append_edited_card(card);
  }

  /// Adds an element of the deck, which is cell c now.
  void write_element(const ElementCard& element, Index c) {
    const std::string_view card = element.place.of(deck_.text);
    split_card(card, fields_);
    edits_.clear();
    const ElementType& type = *element.type;
    edit(1, elements_.at(c));
    if (type.has_property) edit_property(type, c);
    const auto cell = mesh_.cells[c];
    std::array<std::int64_t, kMostNodes> nodes{};
    for (std::size_t k = 0; k < cell.size(); ++k) {
      nodes[node_place(type.shape, element.nodes, k)] = nodes_.at(cell[k]);
    }
    const std::size_t first = type.first_node();
    for (std::size_t k = 0; k < cell.size(); ++k) edit(first + k, nodes[k]);
    for (std::size_t k = cell.size(); k < static_cast<std::size_t>(type.most); ++k) edit_node(first + k);
    edit_extra(type.extra);
    append_edited_card(card);
  }

 private:
  void append_edited_card(std::string_view card) {
    if (append_edited(out_, card, fields_, edits_)) return;
    throw InputError(source_.target, fmt::format("a number of {} is wider than its field", name_of(fields_)),
                     "keep the numbers: --ids keep");
  }

  /// Writes a node, whose coordinates have changed, in the basic system.
  void write_moved_node(Index v) {
    std::vector<std::string> texts{std::to_string(nodes_.at(v)), deck_.has_default_system ? "0" : ""};
    for (const double x : mesh_.points[v]) {
      RealText real = real_text(x);
      if (real.is_rounded) ++source_.losses.rounded;
      texts.push_back(std::move(real.text));
    }
    for (std::size_t field = 6; field < fields_.fields.size(); ++field) {
      texts.emplace_back(fields_.text(field));
    }
    while (texts.back().empty()) texts.pop_back();
    append_checked("GRID", texts);
  }

  void append_checked(std::string_view name, const std::vector<std::string>& texts) {
    const bool fits =
        std::all_of(texts.begin(), texts.end(), [](const std::string& text) { return text.size() <= 16; });
    if (!fits) {
      throw InputError(source_.target, fmt::format("a field of {} has more than 16 characters", name),
                       "shorten it");
    }
    append_card(out_, name, texts, deck_.line_end);
  }

  /// Adds a number for a field to `edits_`, unless the field has this number already.
  void edit(std::size_t field, std::int64_t number) {
    if (number_of(fields_.text(field)) != number) edits_.push_back({field, number});
  }

  /// Updates the number in a field that may name a node.
  void edit_node(std::size_t field) {
    const std::int64_t number = number_of(fields_.text(field));
    if (number > 0) edit(field, nodes_.now(number));
  }

  void edit_property(const ElementType& type, Index c) {
    const std::int64_t before = number_of(fields_.text(2));
    const bool given = source_.labels.any() && source_.labels.given[c];
    const std::int64_t label = given ? source_.labels.values[c] : before;
    if (label == 0 && integer_of(fields_.text(2)) == 0) return;  // an element that has no property yet
    if (label < 1 || label > kLargestNumber) {
      if (given) source_.losses.has_labels = true;
      return;
    }
    // a blank field stays if it still means the label: the property of BAROR, or the element's own number
    const auto found = deck_.default_properties.find(type.name);
    const bool is_meant = found != deck_.default_properties.end()
                              ? label == found->second
                              : label == number_of(fields_.text(1)) && edits_.empty();
    if (before != 0 || !is_meant) edit(2, label);
  }

  /// Updates the numbers of a beam's orientation node and warping points.
  void edit_extra(Extra extra) {
    if (extra == Extra::none) return;
    const bool is_node = fields_.text(kOrientation + 1).empty() && fields_.text(kOrientation + 2).empty();
    if (is_node) edit_node(kOrientation);
    if (extra == Extra::warping) {
      edit_node(kWarpingA);
      edit_node(kWarpingB);
    }
  }

  /// Writes a card with the present numbers of the nodes and elements that it names.
  void write_card(std::string_view card) {
    split_card(card, fields_);
    const std::string name = name_of(fields_);
    const auto found = references(name, fields_);
    if (!found || found->defines_points) {
      out_.append(card);
      return;
    }
    edits_.clear();
    for (const Reference& reference : found->fields) {
      const std::int64_t number = number_of(fields_.text(reference.field));
      edit(reference.field, source_.numbers.of(reference.association).now(number));
    }
    if (found->is_range) return write_ranges(card, name, *found);
    if (found->list > 0) {
      for (std::size_t field = found->list; field < fields_.fields.size(); ++field) {
        const std::int64_t number = number_of(fields_.text(field));
        if (number > 0) edit(field, source_.numbers.of(found->of_list).now(number));
      }
    }
    append_edited_card(card);
  }

  /// Writes a card with ranges of numbers. If the ranges no longer hold the same items, writes a list
  /// instead; for PLOAD4, one card for each item.
  void write_ranges(std::string_view card, const std::string& name, const References& found) {
    std::vector<NumberRange> ranges;
    if (name == "PLOAD4") {
      const std::int64_t from = number_of(fields_.text(2));
      ranges.push_back({from, std::max(from, number_of(fields_.text(8))), 1});
    } else {
      ranges = ranges_of(fields_, found.list).value_or(ranges);
    }
    const bool of_nodes = found.of_list == Association::vertices;
    const FileNumbers& numbers = source_.numbers.of(found.of_list);
    std::vector<Index> items;
    const std::vector<std::int64_t> others = numbers_in_list(
        ranges, numbers.of_file(), of_nodes ? deck_.other_points : deck_.other_elements, items);
    std::vector<std::int64_t> before;
    std::vector<std::int64_t> after;
    for (const Index item : items) {
      before.push_back(numbers.of_file().id(item));
      after.push_back(numbers.at(numbers.place(item)));
    }
    std::sort(before.begin(), before.end());
    std::sort(after.begin(), after.end());
    if (before == after && edits_.empty()) {
      out_.append(card);
    } else if (before == after) {
      append_edited_card(card);
    } else if (name == "PLOAD4") {
      for (const std::int64_t number : after) {
        edits_ = {{2, number}, {7, 0}, {8, 0}};
        append_edited_card(card);
      }
    } else {
      after.insert(after.end(), others.begin(), others.end());
      write_list(name, found.list, after);
    }
  }

  /// Writes a card with these numbers instead of the list that begins at field `list`.
  void write_list(const std::string& name, std::size_t list, const std::vector<std::int64_t>& numbers) {
    constexpr std::size_t kInPload2 = 6;  // PLOAD2 has one line only
    std::vector<std::string> head;
    for (std::size_t field = 1; field < list; ++field) head.emplace_back(fields_.text(field));
    for (const Edit& changed : edits_) head[changed.field - 1] = std::to_string(changed.number);
    const std::size_t most = name == "PLOAD2" ? kInPload2 : numbers.size();
    for (std::size_t begin = 0; begin < numbers.size(); begin += most) {
      std::vector<std::string> texts = head;
      for (std::size_t k = begin; k < std::min(begin + most, numbers.size()); ++k) {
        texts.push_back(std::to_string(numbers[k]));
      }
      append_checked(name, texts);
    }
  }

  const Source& source_;
  const Mesh& mesh_;
  const Deck& deck_;
  const FileNumbers& nodes_;
  const FileNumbers& elements_;
  std::string out_;
  CardFields fields_;
  std::vector<Edit> edits_;
};

class BulkWriter {
 public:
  BulkWriter(const Mesh& mesh, const BulkMetadata& own, const FilePath& path, Notes& notes)
      : source_{mesh, *own.deck, own.numbers(mesh), labels_of(mesh, Association::cells), {}},
        notes_(notes),
        file_(path),
        writer_(source_) {
    source_.target = file_.target().string();
    source_.same_numbers = keep_numbers(source_.numbers, kLargestNumber, source_.deck.unknown, path);
    find_items();
  }

  void write() {
    const Deck& deck = source_.deck;
    std::size_t done = 0;  // bytes of the text
    for (Index k = 0; k < index_size(items_);) {
      write_text({done, place(k).begin});
      Index end = k + 1;
      while (end < index_size(items_) && place(end).begin - place(end - 1).end <= kBetween) ++end;
      write_items(k, end);
      done = place(end - 1).end;
      k = end;
    }
    write_text({done, deck.bulk.end});
    write_new_sets();
    file_.write(std::string_view(deck.text).substr(deck.bulk.end));
    file_.commit();
    note_losses();
  }

 private:
  /// Most bytes between two nodes or elements that are written together.
  static constexpr std::size_t kBetween = 4096;
  static constexpr Index kAhead = 8;      // lookahead in items for text
  static constexpr Index kFarAhead = 16;  // lookahead in items for the table of cards

  /// The slot of a node or an element in the text, and the vertex or cell that is written there.
  struct Item {
    bool is_node;
    Index next;  ///< vertex or cell
  };

  void find_items() {
    const Deck& deck = source_.deck;
    const Index nodes = deck.nodes.size();
    const Index elements = deck.elements.size();
    items_.reserve(deck.node_cards.size() + deck.element_cards.size());
    for (Index v = 0, c = 0; v < nodes || c < elements;) {
      const bool is_node =
          v < nodes && (c == elements || deck.node_cards[v].begin < deck.element_cards[c].place.begin);
      items_.push_back({is_node, is_node ? v++ : c++});
    }
  }

  /// Returns the place in the text that the k-th node or element gets.
  [[nodiscard]] Piece place(Index k) const {
    const Item item = items_[k];
    return item.is_node ? source_.deck.node_cards[item.next] : source_.deck.element_cards[item.next].place;
  }

  void write_text(Piece part) {
    if (source_.same_numbers) return file_.write(part.of(source_.deck.text));
    writer_.write_text(part);
    file_.write(writer_.take_text());
  }

  /// Writes nodes and elements, and the texts between them.
  void write_items(Index first, Index last) {
    write_row_ranges(file_, last - first, [&](Text& text, Index begin, Index end) {
      CardWriter writer(source_);
      try {
        for (Index k = first + begin; k < first + end; ++k) {
          if (k + kFarAhead < last) __builtin_prefetch(old_place(items_[k + kFarAhead]));
          if (k + kAhead < last) prefetch(*old_place(items_[k + kAhead]));
          if (k > first) writer.write_text({place(k - 1).end, place(k).begin});
          write_item(writer, items_[k]);
        }
      } catch (const InputError&) {
        keep_error(first + begin);
      }
      text.write(writer.take_text());
    });
    if (error_) std::rethrow_exception(error_);
  }

  /// Returns the item's entry in the deck's table of cards: the place of its card in the text.
  [[nodiscard]] const Piece* old_place(Item item) const {
    return item.is_node ? &source_.deck.node_cards[node_at_[item.next]]
                        : &source_.deck.element_cards[element_at_[item.next]].place;
  }

  void prefetch(Piece card) const {
    constexpr std::size_t kLine = 64;
    for (std::size_t at = card.begin; at < card.end; at += kLine) {
      __builtin_prefetch(source_.deck.text.data() + at);
    }
  }

  void write_item(CardWriter& writer, Item item) const {
    if (item.is_node) {
      writer.write_node(node_at_[item.next], item.next);
    } else {
      writer.write_element(source_.deck.element_cards[element_at_[item.next]], item.next);
    }
  }

  /// Keeps the error that is being handled, unless an item of a lower index has one.
  void keep_error(Index item) {
    const std::scoped_lock lock(mutex_);
    if (item >= first_with_error_) return;
    first_with_error_ = item;
    error_ = std::current_exception();
  }

  void write_new_sets() {
    std::int64_t number = source_.deck.last_set;
    for (const EntitySet& set : sets_beside(source_.deck.sets, source_.mesh, source_.numbers, notes_)) {
      std::string text;
      append_set(text, ++number, set, source_.numbers, source_.deck.line_end, notes_);
      file_.write(text);
    }
  }

  void note_losses() const {
    note_rounded(source_.losses.rounded, kWidestField, notes_);
    if (source_.losses.has_labels)
      notes_.emplace_back("labels that are not property numbers are not written");
    note_arrays_beside_cell_labels(source_.mesh, "Nastran", notes_);
  }

  Source source_;
  Notes& notes_;
  OutputFile file_;
  CardWriter writer_;                                           // writes texts between nodes and elements
  std::vector<Index> node_at_ = source_.numbers.nodes.items();  // node of the deck at each vertex
  std::vector<Index> element_at_ = source_.numbers.elements.items();  // element of the deck at each cell
  std::vector<Item> items_;
  std::mutex mutex_;  // protects the members below
  std::exception_ptr error_;
  Index first_with_error_ = kMaxIndex;
};

}  // namespace

const BulkMetadata* deck_of(const Mesh& mesh) {
  return own_deck<Deck>(mesh, [](const Deck& deck, Index k, Shape shape, int vertices) {
    const ElementCard& card = deck.element_cards[k];
    return shape == card.type->shape && vertices == card.nodes;
  });
}

void write_into_deck(const Mesh& mesh, const BulkMetadata& own, const FilePath& path, Notes& notes) {
  BulkWriter(mesh, own, path, notes).write();
}

}  // namespace meshorder::nastran
