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
    "give the numbers of nodes and cells, and of values of nodes, cells and the model";
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
    if (!in_.at_line_end()) fail_at_more(in_, "counts", kFirstLine);
    (void)in_.raw_line();
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

  [[noreturn]] static void fail_at_more(const Scanner& in, std::string_view of, std::string_view wanted) {
    in.fail(fmt::format("the line of {} is too long", of), std::string(wanted));
  }

  static Index number(Scanner& in, std::string_view what) {
    const auto number = in.integer<std::int64_t>(what);
    if (number < 0 || number > kMaxIndex) {
      in.fail(fmt::format("{} is {}", what, number), "0 to 2147483647 are possible");
    }
    return static_cast<Index>(number);
  }

  void read_nodes(Index count) {
    mesh_.points.resize(static_cast<std::size_t>(count));
    const auto read_point = [&](Scanner& in, Index v) {
      for (double& coordinate : mesh_.points[v]) coordinate = in.finite("a coordinate");
      if (!in.at_line_end()) fail_at_more(in, "a node", "a number and three coordinates are needed");
      return true;
    };
    const Index regular = read_numbered_records(in_, count, node_numbers_, read_point, 0, kMaxIndex);
    for (Index v = regular; v < count; ++v) {
      const Index id = number(in_, "the number of a node");
      if (!node_numbers_.add(id)) in_.fail(fmt::format("node {} is given twice", id), "numbers must differ");
      read_point(in_, v);
    }
    end_records(count);
  }

  /// Takes the line end after the last of `count` records.
  void end_records(Index count) {
    if (count > 0) (void)in_.raw_line();
  }

  /// The contents of a cell's line after the cell's number.
  struct CellLine {
    std::int64_t material;
    const CellKind* kind;
    std::array<Index, 8> cell{};  ///< vertices, in the mesh's order
  };

  /// Reads the rest of the line of the cell `id`, after the number. Compares the cell's type with `likely`
  /// first.
  CellLine read_cell(Scanner& in, Index id, const CellKind* likely) const {
    CellLine line{.material = in.integer<std::int64_t>("the material of a cell"), .kind = likely};
    const std::string_view name = in.word("the type of a cell");
    if (likely == nullptr || name != likely->name) line.kind = &kind_named(in, name);
    const auto nodes = static_cast<std::size_t>(line.kind->nodes);
    std::array<Index, 8> as_given{};
    for (std::size_t k = 0; k < nodes; ++k) {
      const Index node = number(in, "a node of the cell");
      as_given[k] = node_numbers_.find(node);
      if (as_given[k] < 0) {
        in.fail(fmt::format("a node of cell {} is {}, which the file does not have", id, node),
                "correct the cell, or add the node");
      }
    }
    for (std::size_t k = 0; k < nodes; ++k)
      line.cell[k] = as_given[static_cast<std::size_t>(line.kind->places[k])];
    if (!in.at_line_end()) {
      fail_at_more(
          in, fmt::format("cell {}", id),
          fmt::format("a cell of type {} has {} nodes, without any on its edges", line.kind->name, nodes));
    }
    return line;
  }

  /// Returns the type of the next cell, null if there is none.
  [[nodiscard]] const CellKind* next_kind() const {
    Scanner ahead = in_;
    std::int64_t number = 0;
    if (!ahead.take_number(number) || !ahead.take_number(number)) return nullptr;
    return find_kind(ahead.peek_word());
  }

  /// Reads cells on all threads, up to the first cell that does not have the next number, has more nodes than
  /// the first cell or is irregular.
  void read_regular_cells(Index count, std::vector<std::int64_t>& materials) {
    const CellKind* const first = next_kind();
    if (first == nullptr) return;
    Cells& cells = mesh_.cells;
    append_cells(cells, first->shape, first->nodes, count);
    materials.resize(static_cast<std::size_t>(count));
    const auto read = [&](Scanner& in, Index c) {
      const CellLine line = read_cell(in, c, first);  // an error is thrown later, with the cell's number
      if (line.kind->nodes > first->nodes) return false;
      materials[c] = line.material;
      cells.shapes[c] = line.kind->shape;
      std::copy_n(line.cell.begin(), line.kind->nodes, cells[c].begin());
      return true;
    };
    const Index regular = read_numbered_records(in_, count, cell_numbers_, read, 0, kMaxIndex);
    trim_to_corners(cells, 0, regular);
    materials.resize(static_cast<std::size_t>(regular));
  }

  void read_cells(Index count) {
    std::vector<std::int64_t> materials;
    materials.reserve(static_cast<std::size_t>(count));
    read_regular_cells(count, materials);
    for (Index c = mesh_.cell_count(); c < count; ++c) {
      const Index id = number(in_, "the number of a cell");
      if (cells_are_numbered_ && !cell_numbers_.add(id)) {
        cells_are_numbered_ = false;
        notes_.push_back(fmt::format("{}:{}: cell {} is given twice; all cells are now numbered by position",
                                     in_.file(), in_.line(), id));
      }
      const CellLine line = read_cell(in_, id, nullptr);
      materials.push_back(line.material);
      mesh_.cells.push_back(line.kind->shape, {line.cell.data(), static_cast<std::size_t>(line.kind->nodes)});
    }
    end_records(count);
    mesh_.data.push_back(
        {std::string(kLabel), Association::cells, 1, label_values(std::move(materials)), {}, {}});
  }

  static const CellKind* find_kind(std::string_view name) {
    const auto* const found = std::find_if(kCellKinds.begin(), kCellKinds.end(), [&](const CellKind& kind) {
      return same_but_for_case(kind.name, name);
    });
    return found == kCellKinds.end() ? nullptr : found;
  }

  static const CellKind& kind_named(const Scanner& in, std::string_view name) {
    if (const CellKind* const kind = find_kind(name)) return *kind;
    in.fail(fmt::format("a cell has the type '{}'", shown(name)),
            "known: " + join(kCellKinds, [](const CellKind& kind) { return kind.name; }));
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
    const auto read_values = [&](Scanner& in, Index place) {
      for (std::vector<double>& array : arrays) {
        const std::size_t components = array.size() / static_cast<std::size_t>(rows);
        for (std::size_t k = 0; k < components; ++k)
          array[static_cast<std::size_t>(place) * components + k] = in.real(what);
      }
      if (!in.at_line_end())
        fail_at_more(in, fmt::format("data of a {}", item), fmt::format("{} values are needed", values));
      return true;
    };
    const Index regular = read_regular_records(in_, rows, [&](Scanner& in, Index row) {
      Index id = 0;
      const bool is_next = in.take_number(id) && id >= 0 && (places == nullptr || places->id(row) == id);
      return is_next && read_values(in, row);
    });
    std::vector<bool> seen(static_cast<std::size_t>(rows), false);
    std::fill(seen.begin(), seen.begin() + regular, true);
    for (Index row = regular; row < rows; ++row) {
      const Index place = place_of_row(places, row, item);
      if (seen[place]) in_.fail(fmt::format("the {} has data twice", item), "remove one of the lines");
      seen[place] = true;
      read_values(in_, place);
    }
    end_records(rows);
    for (std::size_t i = 0; i < arrays.size(); ++i) mesh_.data[first + i].values = std::move(arrays[i]);
  }

  /// Takes the number of a line of data and returns the position of the node or cell with that number; `row`
  /// if `numbers` is null.
  Index place_of_row(const IdMap* numbers, Index row, std::string_view item) {
    const Index id = number(in_, "the number of a line of data");
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
    if (!in_.at_line_end()) fail_at_more(in_, "the sizes of arrays", "a size for each array is needed");
    (void)in_.raw_line();
    for (const Index size : components) {
      if (in_.bytes_left() == 0) in_.fail("the label of an array is missing", "the file may be cut short");
      const std::string line(in_.raw_line());
      const std::string label(trimmed(std::string_view(line).substr(0, line.find(','))));
      const std::string name = names_.take(association, label);
      metadata_->labels.emplace(std::pair(association, name), line);
      mesh_.data.push_back({name, association, size, std::vector<double>(), {}, {}});
    }
  }

  /// Keeps the data of the model. If the model has no data, fails at further text, which could depend on the
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
