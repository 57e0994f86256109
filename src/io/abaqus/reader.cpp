// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Abaqus's and CalculiX's decks (.inp): Abaqus Analysis User's Guide, "Input syntax rules"; G. Dhondt,
// CalculiX CrunchiX User's Manual, "Input deck format".
#include "base/text.hpp"
#include "io/abaqus/abaqus.hpp"
#include "io/abaqus/cards.hpp"
#include "io/abaqus/sets.hpp"
#include "io/deck/lines.hpp"
#include "io/deck/numbers.hpp"
#include "io/stream/digits.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <type_traits>
#include <unordered_set>
#include <utility>

namespace meshorder::abaqus {
namespace {

constexpr std::size_t kMostNodes = 20;
constexpr std::size_t kNumbersOnLine = 16;
constexpr std::size_t kShownTypes = 3;

bool is_comment(std::string_view line) { return line.starts_with("**"); }
bool is_keyword(std::string_view line) { return line.starts_with('*') && !is_comment(line); }

void skip_blanks(std::string_view& line) {
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
}

/// Returns whether no field of a line has a text.
bool is_empty(std::string_view line) {
  return std::ranges::all_of(line, [](char c) { return c == ',' || is_blank(c); });
}

/// Takes the next field of a data line if it is a plain number of type T; otherwise returns false and leaves
/// the line as it is. Faster than `next_field` and a parser, which read each byte several times.
template <class T>
[[gnu::always_inline]] inline bool take_plain(std::string_view& line, T& value) {
  std::string_view rest = line;
  skip_blanks(rest);
  if constexpr (std::is_integral_v<T>) {
    if (rest.size() >= sizeof(std::uint64_t)) {
      const Digits digits = leading_digits(rest.data());
      if (digits.count > 0 && digits.count < 8 && rest[static_cast<std::size_t>(digits.count)] == ',') {
        value = static_cast<T>(digits.number);
        line = rest.substr(static_cast<std::size_t>(digits.count) + 1);
        return true;
      }
    }
  }
  const auto [after, code] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (code != std::errc{}) return false;
  rest.remove_prefix(static_cast<std::size_t>(after - rest.data()));
  skip_blanks(rest);
  if (!rest.empty() && rest.front() != ',') return false;
  line = rest.substr(rest.empty() ? 0 : 1);
  return true;
}

/// Takes the next field if it is a plain number; returns true only for a number from 1 to kMaxIndex.
[[gnu::always_inline]] inline bool take_plain_number(std::string_view& line, Index& number) {
  std::int64_t value = 0;
  if (!take_plain(line, value) || value < 1 || value > kMaxIndex) return false;
  number = static_cast<Index>(value);
  return true;
}

/// A place in the deck: the index of a file in `files_`, and a line of this file.
struct Place {
  Index file;
  std::int64_t line;
};

/// A data line of *NODE.
struct NodeLine {
  std::int64_t line = 0;
  Index number = 0;
  int coordinates = 0;
  Point point{0, 0, 0};
};

/// A data line of *ELEMENT.
struct ElementLine {
  std::int64_t line = 0;
  Index number = 0;
};

class DeckReader {
 public:
  DeckReader(const FilePath& path, Notes& notes) : lines_(path), notes_(notes) {
    if (lines_.at().all().find('\0') != std::string_view::npos) {
      throw InputError(path.string(), "is not a text file, unlike decks of Abaqus and CalculiX",
                       "give its deck");
    }
    deck_->line_end = lines_.line_end();
  }

  Mesh read() {
    std::string_view line;
    while (lines_.peek(line)) {
      if (is_keyword(line)) {
        read_card();
      } else if (line.empty() || is_comment(line) || has_card_) {
        add_line();
      } else {
        lines_.at().fail(fmt::format("expected a keyword such as *NODE, found '{}'", shown(line)),
                         "the file may not be a deck of Abaqus or CalculiX");
      }
    }
    finish();
    return std::move(mesh_);
  }

 private:
  DeckCard& begin_section(CardKind part, std::string text, std::int64_t line) {
    places_of_sections_.push_back({present_file(), line});
    DeckCard& section = deck_->sections.emplace_back();
    section.part = part;
    section.text = std::move(text);
    return section;
  }

  /// Takes a line and appends it to the text of the last card.
  void add_line() {
    if (deck_->sections.empty() || deck_->sections.back().part != CardKind::text) {
      begin_section(CardKind::text, {}, lines_.at().line());
    }
    deck_->sections.back().text += lines_.take();
  }

  /// Takes a keyword line and the lines that continue it.
  std::string take_keyword() {
    const std::size_t length = keyword_lines(lines_.rest()).size();
    std::string text;
    while (text.size() < length) text += lines_.take();
    return text;
  }

  void read_card() {
    has_card_ = true;
    line_ = lines_.at().line();
    const std::string file = lines_.at().file();
    std::string text = take_keyword();
    const Card card = parse_card(text);
    if (card.keyword == "INCLUDE") return include(card.value("INPUT"));
    constexpr std::array<std::string_view, 6> kGenerators{"NGEN", "NFILL", "NCOPY",
                                                          "NMAP", "ELGEN", "ELCOPY"};
    if (std::find(kGenerators.begin(), kGenerators.end(), card.keyword) != kGenerators.end()) {
      lines_.fail(line_, card.title + " makes nodes or elements without lines that could move",
                  "let a preprocessor write all nodes and elements");
    }
    if (card.keyword == "NODE") return read_nodes(card, std::move(text));
    if (card.keyword == "ELEMENT") return read_elements(card, std::move(text));
    follow_parts(card);
    begin_section(CardKind::text, std::move(text), line_);
    if (card.keyword == "NSET" || card.keyword == "ELSET") {
      return read_set(card, {file, line_});
    }
    std::string_view line;
    if (card.keyword == "SYSTEM" && lines_.peek(line) && !line.starts_with('*')) {
      lines_.at().fail("*SYSTEM gives coordinates in a local system", "write the deck in global coordinates");
    }
  }

  /// Follows the cards of parts and assemblies; fails for a second part or instance.
  void follow_parts(const Card& card) {
    if (card.keyword == "PART" && ++parts_ > 1) refuse_second("*PART");
    if (card.keyword == "INSTANCE" && ++instances_ > 1) refuse_second("*INSTANCE");
    if (card.keyword == "ASSEMBLY" || card.keyword == "ENDINSTANCE") in_assembly_ = true;
    if (card.keyword == "ENDASSEMBLY" || card.keyword == "INSTANCE") in_assembly_ = false;
    sets_.enter_assembly(in_assembly_);
  }

  void refuse_second(std::string_view title) const {
    refuse_parts(fmt::format("a second {}, which uses the numbers of the first", title));
  }

  void refuse_in_assembly(std::string_view title) const {
    if (in_assembly_) refuse_parts(fmt::format("{} of the assembly, in addition to the part's", title));
  }

  [[noreturn]] void refuse_parts(const std::string& what) const {
    lines_.fail(line_, what,
                "write the deck without parts and assemblies: in Abaqus/CAE a choice of Model > Edit "
                "Attributes");
  }

  void include(std::string_view name) {
    if (name.empty()) lines_.fail(line_, "the name of a file is missing", "write *INCLUDE, INPUT=FILE");
    lines_.include(std::string(name), line_);
  }

  /// Gives the next line of the present card but does not take it; follows *INCLUDE. Returns false at the end
  /// of the card.
  bool peek_in_card(std::string_view& line) {
    while (lines_.peek(line)) {
      if (!is_keyword(line)) return true;
      if (parse_card(line).keyword != "INCLUDE") return false;
      line_ = lines_.at().line();
      include(parse_card(take_keyword()).value("INPUT"));
    }
    return false;
  }

  /// Includes the file of the parameter INPUT, if there is one; returns the keyword lines without INPUT.
  std::string with_input(const Card& card, std::string text) {
    if (!card.has("INPUT")) return text;
    include(card.value("INPUT"));
    return without_parameter(text, "INPUT");
  }

  /// Gives the next data line of nodes or elements but does not take it; returns false at the end of the
  /// card. Appends comments to `comments`; drops blank lines.
  bool peek_data(std::string_view& line, std::string& comments) {
    while (peek_in_card(line)) {
      if (line.empty()) {
        (void)lines_.take();
      } else if (is_comment(line)) {
        comments += lines_.take();
      } else {
        return true;
      }
    }
    return false;
  }

  /// Makes a section of the comments after the last data line, if there are any.
  void end_data(std::string comments) {
    if (!comments.empty()) begin_section(CardKind::text, std::move(comments), lines_.at().line());
  }

  /// Takes the number of a node or element from the front of a line.
  Index take_number(std::string_view& line, std::string_view what) {
    std::int64_t number = 0;
    if (!take_plain(line, number)) number = parse_integer<std::int64_t>(lines_.at(), next_field(line), what);
    if (number < 1 || number > kMaxIndex) {
      lines_.at().fail(fmt::format("{} is {}", what, number), "1 to 2147483647 are possible");
    }
    return static_cast<Index>(number);
  }

  double take_coordinate(std::string_view& line) {
    double value = 0;
    if (!take_plain(line, value)) {
      const std::string_view field = next_field(line);
      if (!field.empty()) value = parse_real(lines_.at(), field, "a coordinate");
    }
    if (!std::isfinite(value)) lines_.at().fail("a coordinate is not finite", "a finite number is needed");
    return value;
  }

  void read_nodes(const Card& card, std::string text) {
    refuse_in_assembly("*NODE");
    const std::string_view system = card.value("SYSTEM");
    if (!system.empty() && !same_but_for_case(system, "R")) {
      lines_.fail(line_, "*NODE gives coordinates in a local system", "write the deck in global coordinates");
    }
    const std::string set(card.value("NSET"));
    text = with_input(card, std::move(text));
    DeckCard& section = begin_section(CardKind::nodes, std::move(text), line_);
    section.first = mesh_.vertex_count();
    std::string comments;
    std::string_view line;
    while (peek_data(line, comments)) {
      section.text += std::exchange(comments, {});
      if (read_regular_nodes()) continue;
      read_node(line);
      (void)lines_.take();
    }
    section.count = mesh_.vertex_count() - section.first;
    if (!set.empty()) sets_.add_block(Association::vertices, set, section.first, section.count);
    end_data(std::move(comments));
  }

  /// Adds the number of a node or element; fails at `line` of the present file if the number is taken.
  void add_number(IdMap& numbers, Index number, std::int64_t line, std::string_view what) {
    if (!numbers.add(number)) {
      lines_.fail(line, fmt::format("{} {} is given twice", what, number), "numbers must differ");
    }
  }

  /// Reads nodes on all threads, up to the first irregular line. Returns whether it read any.
  bool read_regular_nodes() {
    const Index most = lines_.lines_to_take();
    if (most == 0) return false;
    node_lines_.resize(static_cast<std::size_t>(most));
    const Index count = lines_.take_regular(most, [&](std::string_view line, std::int64_t at, Index k) {
      NodeLine& node = node_lines_[static_cast<std::size_t>(k)];
      node = {.line = at};
      if (!take_plain_number(line, node.number)) return false;
      for (; node.coordinates < 3 && !line.empty(); ++node.coordinates) {
        double& x = node.point[static_cast<std::size_t>(node.coordinates)];
        if (!take_plain(line, x) || !std::isfinite(x)) return false;
      }
      return is_empty(line);
    });
    for (const NodeLine& node : std::span(node_lines_).first(static_cast<std::size_t>(count))) {
      add_number(deck_->nodes, node.number, node.line, "node");
      if (node.coordinates == 3) has_third_coordinate_ = true;
      mesh_.points.push_back(node.point);
    }
    return count > 0;
  }

  void read_node(std::string_view line) {
    const Index number = take_number(line, "the number of a node");
    add_number(deck_->nodes, number, lines_.at().line(), "node");
    Point point{0, 0, 0};
    for (std::size_t k = 0; k < 3 && !line.empty(); ++k) {
      if (k == 2) has_third_coordinate_ = true;
      point[k] = take_coordinate(line);
    }
    if (!is_empty(line)) {
      deck_->more_of_nodes.emplace(mesh_.vertex_count(), fmt::format(", {}", trimmed(line)));
    }
    mesh_.points.push_back(point);
  }

  void read_elements(const Card& card, std::string text) {
    refuse_in_assembly("*ELEMENT");
    const std::string type = upper_case(card.value("TYPE"));
    if (type.empty()) lines_.fail(line_, "*ELEMENT has no TYPE", "write *ELEMENT, TYPE=C3D4 or the like");
    const std::string set(card.value("ELSET"));
    const auto kind = kind_of(type);
    if (!kind) return keep_elements(type, card, std::move(text));
    text = with_input(card, std::move(text));
    DeckCard& section = begin_section(CardKind::elements, std::move(text), line_);
    section.first = mesh_.cell_count();
    section.kind = *kind;
    std::string comments;
    std::string_view line;
    while (peek_data(line, comments)) {
      section.text += std::exchange(comments, {});
      if (read_regular_elements(*kind)) continue;
      read_element(*kind, type, line, section.text);
    }
    section.count = mesh_.cell_count() - section.first;
    if (section.count > 0) mesh_.cell_blocks.push_back(section.first);
    if (!set.empty()) sets_.add_block(Association::cells, set, section.first, section.count);
    note_type(type, *kind);
    end_data(std::move(comments));
  }

  /// Reads elements on all threads, up to the first element that does not fit on one line or names an unknown
  /// node. Returns whether it read any element.
  bool read_regular_elements(ElementKind kind) {
    const auto nodes = static_cast<std::size_t>(kind.nodes);
    const Index most = nodes < kNumbersOnLine ? lines_.lines_to_take() : 0;
    if (most == 0) return false;
    element_lines_.resize(static_cast<std::size_t>(most));
    element_nodes_.resize(nodes * static_cast<std::size_t>(most));
    const auto cell_of = [&](Index k) {
      return std::span(element_nodes_).subspan(nodes * static_cast<std::size_t>(k), nodes);
    };
    const std::size_t bytes_before = lines_.rest().size();
    const Index count = lines_.take_regular(most, [&](std::string_view line, std::int64_t at, Index k) {
      ElementLine& element = element_lines_[static_cast<std::size_t>(k)];
      element.line = at;
      if (!take_plain_number(line, element.number)) return false;
      for (std::size_t given = 0; given < nodes; ++given) {
        Index node = 0;
        if (!take_plain_number(line, node)) return false;
        const Index vertex = deck_->nodes.find(node);
        if (vertex < 0) return false;
        cell_of(k)[node_place(kind, given)] = vertex;
      }
      return is_empty(line);
    });
    reserve_cells(count, nodes, bytes_before);
    const std::span read(element_lines_.data(), static_cast<std::size_t>(count));
    for (const ElementLine& element : read)
      add_number(deck_->elements, element.number, element.line, "element");
    Cells& cells = mesh_.cells;
    cells.vertices.insert(cells.vertices.end(), element_nodes_.data(),
                          element_nodes_.data() + nodes * read.size());
    cells.shapes.insert(cells.shapes.end(), read.size(), kind.shape);
    for (Index k = 0; k < count; ++k)
      cells.offsets.push_back(cells.offsets.back() + static_cast<Offset>(nodes));
    return count > 0;
  }

  /// Reserves memory for `count` elements that were just read, and for as many more as the rest of the file
  /// can hold.
  ///
  /// @param bytes_before  bytes of the file that were left before these elements
  void reserve_cells(Index count, std::size_t nodes, std::size_t bytes_before) {
    const std::size_t cells = mesh_.cells.shapes.size() + static_cast<std::size_t>(count);
    if (cells <= mesh_.cells.shapes.capacity()) return;
    const std::size_t left = lines_.rest().size();
    const std::size_t bytes_of_one = (bytes_before - left) / static_cast<std::size_t>(count);
    const std::size_t all = cells + left / bytes_of_one;
    mesh_.cells.reserve(static_cast<Offset>(all), static_cast<Offset>(all * nodes));
  }

  /// Reads an element from as many lines as its nodes need, and takes these lines.
  void read_element(ElementKind kind, const std::string& type, std::string_view line, std::string& comments) {
    const Index number = take_number(line, "the number of an element");
    add_number(deck_->elements, number, lines_.at().line(), "element");
    const auto nodes = static_cast<std::size_t>(kind.nodes);
    std::array<Index, kMostNodes> cell{};
    const Offset first = mesh_.cells.offsets.back();
    const std::int64_t first_line = lines_.at().line();
    std::size_t on_first_line = 0;  // nodes on the first line
    // false: the line before lacks a comma at its end, so this line may be another element
    bool may_have_more = true;
    for (std::size_t given = 0;;) {
      const bool goes_on = line.ends_with(',');
      while (!line.empty()) {
        skip_blanks(line);
        if (line.empty() || line.front() == ',') {  // a comma at the end
          line.remove_prefix(line.empty() ? 0 : 1);
          continue;
        }
        if (given == nodes && !may_have_more) {
          lines_.fail(first_line,
                      fmt::format("element {} has {} nodes on its line, but {} has {}", number, on_first_line,
                                  type, nodes),
                      fmt::format("TYPE={} of its *ELEMENT, or the line, is wrong", type));
        }
        if (given == nodes) {  // CalculiX does not read the rest of the line
          deck_->more_of_elements.emplace(mesh_.cell_count(), fmt::format(", {}", line));
          break;
        }
        const Index node = take_number(line, "a node of the element");
        // `node_place` is its own inverse: it also gives the vertex of the cell for a node of the element
        const std::size_t k = node_place(kind, given++);
        cell[k] = deck_->nodes.find(node);
        if (cell[k] < 0) {
          cell[k] = 0;
          later_nodes_.push_back(
              {first + static_cast<Offset>(k), node, {present_file(), lines_.at().line()}});
        }
      }
      (void)lines_.take();
      if (given == nodes) break;
      if (may_have_more) on_first_line = given;
      may_have_more = goes_on;
      if (!peek_data(line, comments)) {
        lines_.at().fail(fmt::format("element {} has {} of the {} nodes of {}", number, given, nodes, type),
                         "lines are missing");
      }
    }
    mesh_.cells.push_back(kind.shape, {cell.data(), nodes});
  }

  /// Returns the position of the present file in `files_`.
  Index present_file() {
    const std::string& file = lines_.at().file();
    if (files_.empty() || files_.back() != file) files_.push_back(file);
    return index_size(files_) - 1;
  }

  /// Keeps the lines of elements of an unknown type as text.
  void keep_elements(const std::string& type, const Card& card, std::string text) {
    text = with_input(card, std::move(text));
    begin_section(CardKind::text, std::move(text), line_);
    deck_->unknown.push_back(fmt::format("elements of type {} (line {})", shown(type), line_));
    deck_->contents.push_back(fmt::format("elements of type {}", shown(type)));
    if (other_types_.size() < kShownTypes)
      other_types_.push_back(fmt::format("{}, line {}", shown(type), line_));
    if (const std::string_view set = card.value("ELSET"); !set.empty()) {
      sets_.add_block(Association::cells, set, 0, 0);
    }
    std::string_view line;
    bool goes_on = false;
    while (peek_in_card(line)) {
      if (!line.empty() && !is_comment(line)) {
        const bool ends_with_comma = line.ends_with(',');
        if (!goes_on) other_elements_.insert(take_number(line, "the number of an element"));
        goes_on = ends_with_comma;
      }
      deck_->sections.back().text += lines_.take();
    }
  }

  /// Records a type that `type_of` does not return for this kind: other formats lose it.
  void note_type(const std::string& type, ElementKind kind) {
    const bool usual = type == type_of(kind, true) || type == type_of(kind, false);
    if (usual || std::find(types_.begin(), types_.end(), type) != types_.end()) return;
    types_.push_back(type);
  }

  void read_set(const Card& card, Location place) {
    const bool of_nodes = card.keyword == "NSET";
    if (card.value(card.keyword).empty()) {
      lines_.fail(line_, fmt::format("*{} has no name", card.keyword),
                  fmt::format("write *{}, {}=NAME", card.keyword, card.keyword));
    }
    sets_.begin_card(of_nodes ? Association::vertices : Association::cells, card, std::move(place));
    if (has_other_file(card)) return;
    std::string_view line;
    while (peek_in_card(line)) {
      if (!is_comment(line)) {
        if (const std::string fault = sets_.add_line(line); !fault.empty()) {
          lines_.at().fail(fault, "numbers and names of sets are possible");
        }
      }
      deck_->sections.back().text += lines_.take();
    }
  }

  void finish() {
    require_mesh(*deck_, lines_.at().file(), "has no *NODE", "has no *ELEMENT",
                 join(other_types_, std::string_view("; ")),
                 "correct TYPE= if it is misspelt; C3D4, C3D8, C3D10, S3, S4 and the like are cells");
    resolve(later_nodes_, deck_->nodes, mesh_.cells, [&](const LaterNode<Place>& later) {
      throw InputError(Location{files_[later.place.file], later.place.line, -1},
                       fmt::format("a node of the element is {}, which no *NODE has", later.number),
                       "add it, or correct the element");
    });
    const bool has_volume = mesh_.cells.highest_dimension() == 3;
    mesh_.dimension = has_volume || has_third_coordinate_ ? 3 : 2;
    mesh_.sets = sets_.members(notes_);
    deck_->sets = mesh_.sets;
    list_contents();
    find_unknown_cards();
    find_dead_references();
    if (!lines_.included().empty()) {
      notes_.push_back(fmt::format("included files are now part of the deck: {}", join(lines_.included())));
    }
    keep_deck(mesh_, deck_);
  }

  /// Calls `work(card, text, place)` for each card that is kept as text.
  template <class Work>
  void for_cards(const Work& work) const {
    for (std::size_t i = 0; i < deck_->sections.size(); ++i) {
      const DeckCard& section = deck_->sections[i];
      if (section.part != CardKind::text || !is_keyword(trimmed(section.text))) continue;
      work(parse_card(section.text), section.text, places_of_sections_[i]);
    }
  }

  void list_contents() {
    constexpr std::array<std::string_view, 4> kElsewhere{"HEADING", "NSET", "ELSET", "ELEMENT"};
    std::vector<std::string> titles;
    std::set<std::string> known_titles;
    std::vector<std::string> surfaces;
    for_cards([&](const Card& card, std::string_view /*text*/, Place /*place*/) {
      if (card.keyword == "SURFACE") surfaces.push_back(fmt::format("'{}'", shown(card.value("NAME"))));
      const bool elsewhere =
          std::find(kElsewhere.begin(), kElsewhere.end(), card.keyword) != kElsewhere.end();
      if (!elsewhere && known_titles.insert(card.title).second) titles.push_back(card.title);
    });
    std::vector<std::string>& contents = deck_->contents;
    if (!types_.empty()) contents.push_back("the types of elements " + join(types_));
    if (!surfaces.empty()) contents.push_back("surfaces of the deck: " + join(surfaces));
    if (!titles.empty()) contents.push_back("cards of the deck: " + join(titles));
    if (!deck_->more_of_nodes.empty()) contents.emplace_back("fields after the coordinates of nodes");
  }

  /// Lists the cards that may name nodes or elements in places that `references` does not know.
  void find_unknown_cards() {
    for_cards([&](const Card& card, std::string_view text, Place place) {
      const bool is_set = card.keyword == "NSET" || card.keyword == "ELSET";
      if (card.keyword == "ELEMENT" || (is_set && !has_other_file(card))) return;
      const bool goes_by_numbers = depends_on_numbers(card);
      if (!goes_by_numbers && references(card, text)) return;
      const std::vector<std::int64_t> numbers = numbers_in(text);
      const bool names_any = goes_by_numbers || card.keyword == "PARAMETER" || has_other_file(card) ||
                             pairs_sets(card, text) ||
                             std::any_of(numbers.begin(), numbers.end(), [&](std::int64_t number) {
                               return deck_->nodes.find(number) >= 0 || deck_->elements.find(number) >= 0;
                             });
      if (names_any) {
        deck_->unknown.push_back(
            fmt::format("{} (line {}{})", card.title, place.line, suggested_keyword(card)));
      }
    });
    note_kept_numbers(deck_->unknown, notes_);
  }

  /// Notes the nodes, elements and sets that cards name but the deck does not have.
  void find_dead_references() {
    for_cards([&](const Card& card, std::string_view text, Place place) {
      if (card.keyword == "NSET" || card.keyword == "ELSET" || card.keyword == "ELEMENT") return;
      const std::string which = fmt::format("{}:{}: {} names", files_[place.file], place.line, card.title);
      std::vector<std::int64_t> missing;
      for (const Reference& reference : references(card, text).value_or(std::vector<Reference>{})) {
        const bool of_nodes = reference.association == Association::vertices;
        const bool is_there = (of_nodes ? deck_->nodes : deck_->elements).find(reference.number) >= 0 ||
                              (!of_nodes && other_elements_.contains(reference.number));
        if (!is_there) missing.push_back(reference.number);
      }
      if (!missing.empty()) notes_.push_back(note_of_missing(which, missing));
      std::set<std::string> named;
      for (const auto& [association, name] : named_sets(card, text)) {
        if (sets_.knows(association, name) || !named.insert(upper_case(name)).second) continue;
        notes_.push_back(fmt::format("{} the {} '{}', which the deck does not have", which,
                                     name_of_sets(association), shown(name)));
      }
    });
  }

  DeckLines lines_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<Deck> deck_ = std::make_shared<Deck>();
  std::vector<Place> places_of_sections_;
  std::vector<LaterNode<Place>> later_nodes_;
  std::vector<NodeLine> node_lines_;                 // buffer for regular lines of nodes
  std::vector<ElementLine> element_lines_;           // buffer for regular lines of elements
  std::vector<Index> element_nodes_;                 // vertices of these elements, in the order of cells
  std::vector<std::string> files_;                   // names of the files in the order of reading; may repeat
  std::unordered_set<std::int64_t> other_elements_;  // numbers of elements that are not cells
  SetReader sets_{*deck_, mesh_.cells, other_elements_};
  std::vector<std::string> other_types_;  // types that are not cells, the first few, for a message
  std::vector<std::string> types_;
  std::int64_t line_ = 0;  // line of the last keyword
  int parts_ = 0;
  int instances_ = 0;
  bool in_assembly_ = false;  // in *ASSEMBLY but not in *INSTANCE
  bool has_card_ = false;
  bool has_third_coordinate_ = false;
};

}  // namespace

Mesh read(const FilePath& path, Notes& notes) { return DeckReader(path, notes).read(); }

}  // namespace meshorder::abaqus
