// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/stream/id_map.hpp"
#include "io/stream/regular_text.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_ends.hpp"
#include "io/ucd/ucd.hpp"
#include "mesh/cells.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

namespace meshorder::ucd {
namespace {

constexpr char kComment = '#';
constexpr std::string_view kFirstLine =
    "it has the numbers of nodes, cells, and values of nodes, cells and the model";
constexpr char kBinary = '\7';  // the first byte of a binary file

class Reader {
 public:
  Reader(const FilePath& path, Notes& notes) : in_(path), notes_(notes) {}

  Mesh read() {
    if (in_.all().front() == kBinary) {
      throw InputError(in_.file(), "is a binary AVS UCD file", "save it as text");
    }
    metadata_->comments_before = comments_before(in_.all(), kComment);
    in_.seek(std::ssize(metadata_->comments_before));
    const Index nodes = in_.count("the number of nodes", 8);
    const Index cells = in_.count("the number of cells", 8);
    const std::int64_t node_values = count_of_values("nodes");
    const std::int64_t cell_values = count_of_values("cells");
    metadata_->model_values = count_of_values("the model");
    if (!take_end()) fail_at_more("counts", std::string(kFirstLine));
    read_nodes(nodes);
    read_cells(cells);
    names_.take(Association::cells, std::string(kLabel));
    read_data(Association::vertices, node_values, node_numbers_);
    read_data(Association::cells, cell_values, cell_numbers_);
    keep_rest();
    note_missing_line_end(in_, kComment, notes_);
    mesh_.vertex_ids = node_numbers_.ids_unless_from(1);
    if (cells_are_numbered_) mesh_.cell_ids = cell_numbers_.ids_unless_from(1);
    mesh_.format_metadata = metadata_;
    return std::move(mesh_);
  }

 private:
  std::int64_t count_of_values(std::string_view of) {
    if (in_.at_line_end()) in_.fail("the first line has fewer than five counts", std::string(kFirstLine));
    const std::string what = fmt::format("the number of values of {}", of);
    const auto count = in_.integer<std::int64_t>(what);
    if (count < 0 || count > kMaxIndex) in_.fail(fmt::format("{} is {}", what, count), "0 or more is needed");
    return count;
  }

  /// Takes the end of a line; returns false if the line goes on.
  bool take_end() {
    if (!in_.at_line_end()) return false;
    (void)in_.raw_line();
    return true;
  }

  [[noreturn]] void fail_at_more(std::string_view of, const std::string& wanted) const {
    in_.fail(fmt::format("the line of {} has more than it should", of), wanted);
  }

  Index number(std::string_view what) {
    const auto number = in_.integer<std::int64_t>(what);
    if (number < 0 || number > kMaxIndex) {
      in_.fail(fmt::format("{} is {}", what, number), "0 to 2147483647 are possible");
    }
    return static_cast<Index>(number);
  }

  /// Returns whether the next number and the `count` − 1 after it may be numbers of nodes or cells.
  [[nodiscard]] bool can_count_from_next(Index count) const {
    Scanner ahead = in_;
    Index first = 0;
    return ahead.take_number(first) && first >= 0 && first <= kMaxIndex - count;
  }

  /// Reads nodes on all threads, up to the first one that is not numbered on or is irregular. Returns how
  /// many it read.
  Index read_regular_nodes() {
    const Index count = mesh_.vertex_count();
    if (!can_count_from_next(count)) return 0;
    const Index regular = read_numbered_records(in_, count, node_numbers_, [&](Scanner& in, Index v) {
      return std::ranges::all_of(mesh_.points[v], [&](double& x) { return in.take_finite(x); });
    });
    if (regular > 0) (void)take_end();
    return regular;
  }

  void read_nodes(Index count) {
    mesh_.points.resize(static_cast<std::size_t>(count));
    for (Point& point : std::span(mesh_.points).subspan(static_cast<std::size_t>(read_regular_nodes()))) {
      const Index id = number("the number of a node");
      if (!node_numbers_.add(id)) in_.fail(fmt::format("node {} is given twice", id), "numbers must differ");
      for (double& coordinate : point) coordinate = in_.finite("a coordinate");
      if (!take_end()) fail_at_more("a node", "a number and three coordinates are needed");
    }
  }

  /// Returns the type of the next cell, null if there is none.
  [[nodiscard]] const CellKind* next_kind() const {
    Scanner ahead = in_;
    std::int64_t number = 0;
    if (!ahead.take_number(number) || !ahead.take_number(number)) return nullptr;
    return find_kind(ahead.peek_word());
  }

  /// Reads cells on all threads, up to the first one that is not numbered on, has more nodes than the first
  /// cell or is irregular.
  void read_regular_cells(Index count, std::vector<std::int64_t>& materials) {
    const CellKind* const first = next_kind();
    if (first == nullptr || !can_count_from_next(count)) return;
    Cells& cells = mesh_.cells;
    append_cells(cells, first->shape, first->nodes, count);
    materials.resize(static_cast<std::size_t>(count));
    const Index regular = read_numbered_records(in_, count, cell_numbers_, [&](Scanner& in, Index c) {
      if (!in.take_number(materials[c])) return false;
      const std::string_view name = in.word("the type of a cell");
      const CellKind* const kind = name == first->name ? first : find_kind(name);
      if (kind == nullptr || kind->nodes > first->nodes) return false;
      std::array<Index, 8> as_given{};
      const auto nodes = static_cast<std::size_t>(kind->nodes);
      for (std::size_t k = 0; k < nodes; ++k) {
        Index node = 0;
        if (!in.take_number(node)) return false;
        as_given[k] = node_numbers_.find(node);
        if (as_given[k] < 0) return false;
      }
      cells.shapes[c] = kind->shape;
      const std::span<Index> cell = cells[c];
      for (std::size_t k = 0; k < nodes; ++k) cell[k] = as_given[static_cast<std::size_t>(kind->places[k])];
      return true;
    });
    trim_to_corners(cells, 0, regular);
    materials.resize(static_cast<std::size_t>(regular));
    if (regular > 0) (void)take_end();
  }

  void read_cells(Index count) {
    std::vector<std::int64_t> materials;
    materials.reserve(static_cast<std::size_t>(count));
    std::array<Index, 8> cell{};
    read_regular_cells(count, materials);
    for (Index c = mesh_.cell_count(); c < count; ++c) {
      const Index id = number("the number of a cell");
      if (cells_are_numbered_ && !cell_numbers_.add(id)) {
        cells_are_numbered_ = false;
        notes_.push_back(fmt::format("{}:{}: cell {} is given twice; all cells are now numbered by position",
                                     in_.file(), in_.line(), id));
      }
      materials.push_back(in_.integer<std::int64_t>("the material of a cell"));
      const CellKind& kind = kind_named(in_.word("the type of a cell"));
      const auto nodes = static_cast<std::size_t>(kind.nodes);
      for (std::size_t k = 0; k < nodes; ++k) {
        const Index node = number("a node of the cell");
        const Index v = node_numbers_.find(node);
        if (v < 0) {
          in_.fail(fmt::format("a node of cell {} is {}, which the file does not have", id, node),
                   "correct the cell, or add the node");
        }
        cell[k] = v;
      }
      std::array<Index, 8> in_order{};
      for (std::size_t k = 0; k < nodes; ++k) in_order[k] = cell[static_cast<std::size_t>(kind.places[k])];
      if (!take_end()) {
        fail_at_more(
            fmt::format("cell {}", id),
            fmt::format("a cell of type {} has {} nodes, without any on its edges", kind.name, nodes));
      }
      mesh_.cells.push_back(kind.shape, {in_order.data(), nodes});
    }
    mesh_.data.push_back(
        {std::string(kLabel), Association::cells, 1, label_values(std::move(materials)), {}, {}});
  }

  static const CellKind* find_kind(std::string_view name) {
    const auto* const found = std::find_if(kCellKinds.begin(), kCellKinds.end(), [&](const CellKind& kind) {
      return same_but_for_case(kind.name, name);
    });
    return found == kCellKinds.end() ? nullptr : found;
  }

  const CellKind& kind_named(std::string_view name) const {
    if (const CellKind* const kind = find_kind(name)) return *kind;
    in_.fail(fmt::format("a cell has the type '{}'", shown(name)),
             "known are " + join(kCellKinds, [](const CellKind& kind) { return kind.name; }));
  }

  // ---- data

  /// Reads the arrays on nodes or cells: their sizes, their labels with units, and a line for each item.
  void read_data(Association association, std::int64_t values, const IdMap& numbers) {
    if (values == 0) return;
    const bool of_nodes = association == Association::vertices;
    const std::string_view item = of_nodes ? "node" : "cell";
    const Index rows = of_nodes ? mesh_.vertex_count() : mesh_.cell_count();
    (void)in_.checked_count(rows, fmt::format("the number of {}s with data", item), 2 * (values + 1));
    const std::size_t first = mesh_.data.size();
    begin_arrays(association, values);
    std::vector<std::vector<double>> arrays;
    for (std::size_t i = first; i < mesh_.data.size(); ++i) {
      arrays.emplace_back(static_cast<std::size_t>(rows) *
                          static_cast<std::size_t>(mesh_.data[i].components));
    }
    const std::string what = fmt::format("a value of a {}", item);
    const IdMap* const places = of_nodes || cells_are_numbered_ ? &numbers : nullptr;
    const Index regular = read_regular_records(in_, rows, [&](Scanner& in, Index row) {
      Index id = 0;
      if (!in.take_number(id) || id < 0 || (places != nullptr && places->id(row) != id)) return false;
      for (std::vector<double>& array : arrays) {
        const std::size_t components = array.size() / static_cast<std::size_t>(rows);
        const std::span own =
            std::span(array).subspan(static_cast<std::size_t>(row) * components, components);
        if (!std::ranges::all_of(own, [&](double& value) { return in.take_number(value); })) return false;
      }
      return true;
    });
    if (regular > 0) (void)take_end();
    std::vector<bool> seen(static_cast<std::size_t>(rows), false);
    std::fill(seen.begin(), seen.begin() + regular, true);
    for (Index row = regular; row < rows; ++row) {
      const Index place = place_of_row(places, row, item);
      if (seen[place]) in_.fail(fmt::format("the {} has data twice", item), "remove one of the lines");
      seen[place] = true;
      for (std::size_t i = 0; i < arrays.size(); ++i) {
        const Index components = mesh_.data[first + i].components;
        for (Index k = 0; k < components; ++k) {
          arrays[i][Offset{place} * components + k] = in_.real(what);
        }
      }
      if (!take_end()) {
        fail_at_more(fmt::format("data of a {}", item), fmt::format("{} values are needed", values));
      }
    }
    for (std::size_t i = 0; i < arrays.size(); ++i) mesh_.data[first + i].values = std::move(arrays[i]);
  }

  /// Takes the number of a line of data; returns the position of its item, `row` if cells have no numbers.
  Index place_of_row(const IdMap* numbers, Index row, std::string_view item) {
    const Index id = number("the number of a line of data");
    const Index place = numbers == nullptr ? row : numbers->find(id);
    if (place < 0) in_.fail(fmt::format("{} {} does not exist", item, id), "correct its number");
    return place;
  }

  void begin_arrays(Association association, std::int64_t values) {
    const Index count = in_.count("the number of arrays", 4);
    std::int64_t left = values;
    std::vector<Index> components;
    for (Index i = 0; i < count; ++i) {
      const auto size = in_.integer<std::int64_t>("the components of an array");
      if (size < 1 || size > left) break;
      components.push_back(static_cast<Index>(size));
      left -= size;
    }
    if (left != 0 || index_size(components) != count) {
      in_.fail(fmt::format("the components of the arrays do not add up to {}", values),
               "correct them, or the first line of the file");
    }
    if (!take_end()) fail_at_more("the sizes of arrays", "a size for each array is needed");
    for (const Index size : components) {
      if (in_.bytes_left() == 0) in_.fail("the label of an array is missing", "the file may be cut short");
      const std::string line(in_.raw_line());
      const std::string label(trimmed(std::string_view(line).substr(0, line.find(','))));
      const std::string name = names_.take(association, label);
      metadata_->labels.emplace(std::pair(association, name), line);
      mesh_.data.push_back({name, association, size, std::vector<double>(), {}, {}});
    }
  }

  /// Keeps the data of the model. If the model has no data, fails for further text: it could depend on the
  /// old order.
  void keep_rest() {
    if (in_.at_end()) return;
    if (metadata_->model_values == 0) {
      in_.fail("the file continues after its last line",
               "the counts of its first line are wrong, or there are too many lines");
    }
    metadata_->model_data = in_.all().substr(static_cast<std::size_t>(in_.byte()));
  }

  Scanner in_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<UcdMetadata> metadata_ = std::make_shared<UcdMetadata>();
  IdMap node_numbers_;
  IdMap cell_numbers_;
  bool cells_are_numbered_ = true;  // whether all numbers of cells differ
  UniqueNames names_;
};

}  // namespace

bool begins_ucd(std::string_view bytes) {
  if (bytes.starts_with(kBinary)) return true;
  bytes.remove_prefix(comments_before(bytes, kComment).size());
  const auto numbers_of_line = [&](std::string_view allowed) {
    std::string_view line;
    while (trimmed(line).empty() && !bytes.empty()) {
      line = bytes.substr(0, bytes.find_first_of("\r\n"));
      bytes.remove_prefix(std::min(line.size() + 1, bytes.size()));
    }
    int count = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
      if (word.find_first_not_of(allowed) != std::string_view::npos) return 0;
    }
    return count;
  };
  // five counts, then a node and its coordinates
  return numbers_of_line("0123456789") == 5 && numbers_of_line("0123456789+-.eEdD") == 4;
}

Mesh read(const FilePath& path, Notes& notes) { return Reader(path, notes).read(); }

}  // namespace meshorder::ucd
