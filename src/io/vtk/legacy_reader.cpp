// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Reader of VTK's legacy files, versions 1.0 to 5.1, UNSTRUCTURED_GRID and POLYDATA, text and binary:
// https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html
//
// VTK's own reader is not used: it reads past the end of damaged cell lists, trusts the sizes in a header
// when it allocates, cannot read `nan`, and changes the locale of the whole program.
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/names.hpp"
#include "io/stream/regular_text.hpp"
#include "io/stream/text_ends.hpp"
#include "io/vtk/legacy_input.hpp"
#include "io/vtk/vtk.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace meshorder::vtk {
namespace {

constexpr int kFirstVersionWithOffsets = 50;  // ten times the version
constexpr int kLastVersion = 51;

class LegacyReader {
 public:
  explicit LegacyReader(const FilePath& path) : in_(path) {}

  Mesh read(Notes& notes) {
    read_header();
    while (!at_end()) read_section(in_.word("a keyword"));
    finish();
    notes.insert(notes.end(), in_.notes.begin(), in_.notes.end());
    return std::move(mesh_);
  }

 private:
  void read_header() {
    constexpr std::string_view kMagic = "# vtk DataFile Version";
    const std::string_view first = in_.scanner.raw_line();
    if (!first.starts_with(kMagic)) {
      throw InputError(Location{in_.scanner.file(), 1, -1}, "is not a legacy VTK file",
                       "the first line of one is like '# vtk DataFile Version 4.2'");
    }
    const std::string_view version = trimmed(first.substr(kMagic.size()));
    int major = 0;
    int minor = 0;
    const char* const end = version.data() + version.size();
    const auto dot = std::from_chars(version.data(), end, major).ptr;
    if (version.empty() || dot == end || *dot != '.' ||
        std::from_chars(dot + 1, end, minor).ec != std::errc{}) {
      major = 3;
      minor = 0;
      in_.notes.push_back("the first line gives no version; the file is read as version 3.0");
    }
    version_ = major > 9 || minor > 9 || minor < 0 ? kLastVersion + 1 : 10 * major + minor;
    if (version_ > kLastVersion || version_ < 10) {
      throw InputError(Location{in_.scanner.file(), 1, -1},
                       "the version " + std::to_string(major) + "." + std::to_string(minor) + " is unknown",
                       "versions 1.0 to 5.1 are supported");
    }
    layout_.version = std::to_string(major) + "." + std::to_string(minor);
    layout_.title = in_.scanner.raw_line();

    const std::string mode = lower_case(in_.word("ASCII or BINARY"));
    if (mode != "ascii" && mode != "binary")
      in_.fail("the third line is '" + shown(mode) + "'", "ASCII or BINARY is needed");
    const std::string dataset = lower_case(in_.word("DATASET"));
    const std::string kind = dataset == "dataset" ? lower_case(in_.word("the kind of the dataset")) : "";
    if (kind == "structured_points" || kind == "structured_grid" || kind == "rectilinear_grid" ||
        kind == "image_data") {
      in_.fail("the dataset " + upper_case(kind) + " is structured and cannot be reordered",
               "UNSTRUCTURED_GRID and POLYDATA can be");
    }
    if (kind != "unstructured_grid" && kind != "polydata") {
      in_.fail("expected a mesh, found '" + shown(kind.empty() ? dataset : kind) + "'",
               "DATASET UNSTRUCTURED_GRID or DATASET POLYDATA is needed");
    }
    layout_.polydata = kind == "polydata";
    in_.binary = mode == "binary";
    if (in_.binary) in_.scanner.keep_padding();
  }

  /// Skips blanks and line ends; returns whether nothing but padding is left.
  bool at_end() {
    return in_.scanner.at_end() ||
           is_padding(in_.scanner.all().substr(static_cast<std::size_t>(in_.scanner.byte())));
  }

  void read_section(std::string_view name) {
    const std::string key = upper_case(name);
    const auto section = std::find(kPolydataSections.begin(), kPolydataSections.end(), key);
    if (key == "POINTS") {
      read_points();
    } else if (layout_.polydata && section != kPolydataSections.end()) {
      read_cells(static_cast<std::size_t>(section - kPolydataSections.begin()), key);
    } else if (!layout_.polydata && key == "CELLS") {
      read_cells(0, key);
    } else if (!layout_.polydata && key == "CELL_TYPES") {
      read_cell_types();
    } else if (key == "POINT_DATA" || key == "CELL_DATA") {
      begin_data(key);
    } else if (key == "FIELD") {
      read_field();
    } else if (key == "LOOKUP_TABLE" && on_) {
      read_lookup_table();
    } else if (key == "METADATA") {
      DataArray unnamed;
      in_.metadata(unnamed, {});
    } else if (on_ && read_attribute(key)) {
      return;
    } else {
      in_.fail("the section '" + shown(name) + "' is unknown",
               "the keywords of VTK's legacy files are needed");
    }
  }

  void read_points() {
    if (on_) in_.fail("POINTS after the data", "move it before POINT_DATA and CELL_DATA");
    if (has_points_) in_.fail("a second section POINTS", "a file has one");
    has_points_ = true;
    const std::int64_t count = in_.count("the number of points");
    const std::string type(in_.word("the type of the points"));
    if (lower_case(type) == "string" || lower_case(type) == "utf8_string")
      in_.fail("the points are of type " + type, "numbers are needed");
    const std::int64_t start = in_.scanner.line();
    in_.finite_only = true;
    const DataArray array = in_.array(std::string(kPoints), {}, count, 3, type);
    in_.finite_only = false;
    metadata_->float_points = std::holds_alternative<std::vector<float>>(array.values);
    if (!metadata_->float_points && !std::holds_alternative<std::vector<double>>(array.values)) {
      in_.notes.push_back("the points are of type " + type + " and are stored as double");
    }
    add_points(mesh_.points, array.values, [&](std::size_t p) { return not_finite(start, p); });
  }

  [[nodiscard]] InputError not_finite(std::int64_t line, std::size_t point) const {
    return in_.section_error(
        line, "point " + std::to_string(point) + " (counted from 0) has a coordinate that is not finite",
        "finite numbers are needed");
  }

  // ---- cells

  void read_cells(std::size_t section, const std::string& key) {
    FileCells& cells = sections_[section];
    if (on_) in_.fail(key + " comes after the data", "points and cells come first");
    if (!cells.vertices.empty()) in_.fail(key + " is given twice", "one is needed");
    cells_line_ = in_.scanner.line();
    const std::int64_t count = in_.count("the number of " + key);
    const std::int64_t size = in_.count("the size of " + key);
    if (version_ >= kFirstVersionWithOffsets) {
      read_offsets_and_vertices(cells, count, size, key);
    } else {
      read_counted_cells(cells, count, size, key);
    }
  }

  /// Reads cells as stored before version 5: for each cell, its number of vertices, then its vertices.
  void read_counted_cells(FileCells& cells, std::int64_t count, std::int64_t size, const std::string& key) {
    in_.check_room(size, 4, key);
    if (count > size)
      in_.fail(key + " has " + std::to_string(count) + " cells in " + std::to_string(size) + " numbers",
               "each cell takes 2 at least");
    if (size > 0) in_.begin_binary();
    if (read_sound_cells(cells, count, size)) return;
    reserve_large(cells.offsets, static_cast<std::size_t>(count) + 1);
    reserve_large(cells.vertices, static_cast<std::size_t>(size - count));
    std::int64_t left = size;
    for (std::int64_t c = 0; c < count; ++c) {
      const std::int32_t vertices = left > 0 ? in_.int32(key) : 0;
      if (left == 0 || vertices < 0 || vertices > --left) {
        in_.fail("cell " + std::to_string(c) + " (counted from 0) of " + key + " has " +
                     std::to_string(vertices) + " vertices where " + std::to_string(left) +
                     " numbers are left",
                 "the size of " + key + " counts all numbers that follow");
      }
      left -= vertices;
      for (std::int32_t i = 0; i < vertices; ++i) cells.vertices.push_back(checked_vertex(in_.int32(key), c));
      cells.offsets.push_back(static_cast<Offset>(cells.vertices.size()));
    }
    if (left != 0)
      in_.fail(key + " has " + std::to_string(left) + " numbers more than its cells take",
               "its size counts all numbers that follow");
  }

  /// Reads cells as `read_counted_cells` does, but fast. If the cells have a fault, returns false and leaves
  /// `in_` where it was.
  bool read_sound_cells(FileCells& cells, std::int64_t count, std::int64_t size) {
    Scanner at = in_.scanner;
    std::vector<std::int32_t> numbers;
    resize_large(numbers, static_cast<std::size_t>(size));
    if (!read_int32s(at, numbers)) return false;
    std::vector<Offset> offsets;
    resize_large(offsets, static_cast<std::size_t>(count) + 1);
    const std::int64_t limit = point_limit();
    Offset next = 0;
    for (std::int64_t c = 0; c < count; ++c) {
      if (next >= size || numbers[next] < 0 || numbers[next] >= size - next) return false;
      const Offset end = next + 1 + numbers[next];
      Offset place = offsets[c];
      for (++next; next < end; ++next, ++place) {
        if (numbers[next] < 0 || numbers[next] >= limit) return false;
        numbers[place] = numbers[next];  // overwrites numbers that were checked before
      }
      offsets[c + 1] = place;
    }
    if (next != size) return false;
    numbers.resize(static_cast<std::size_t>(size - count));
    in_.scanner.move_to(at);
    cells.offsets = std::move(offsets);
    cells.vertices = std::move(numbers);
    return true;
  }

  /// Fills `numbers` from the position of `at` on; returns false if a number is missing or irregular.
  bool read_int32s(Scanner& at, std::vector<std::int32_t>& numbers) const {
    if (!in_.binary) return read_regular_numbers<std::int32_t>(at, numbers) == numbers.size();
    constexpr auto kBytes = static_cast<std::int64_t>(sizeof(std::int32_t));
    const auto count = static_cast<std::int64_t>(numbers.size());
    if (at.bytes_left() / kBytes < count) return false;
    const std::string_view bytes = at.binary_block(count * kBytes, "cells");
    for (std::int64_t i = 0; i < count; ++i)
      numbers[i] = number_at<std::int32_t>(bytes.data() + i * kBytes, std::endian::big);
    return true;
  }

  /// Returns the number of points, if it is known, else kMaxIndex; cells may name only smaller numbers.
  [[nodiscard]] std::int64_t point_limit() const {
    return has_points_ ? mesh_.vertex_count() : std::int64_t{kMaxIndex};
  }

  Index checked_vertex(std::int64_t vertex, std::int64_t cell) {
    if (vertex < 0 || vertex >= point_limit()) keep_fault_at_vertex(vertex, cell);
    return static_cast<Index>(vertex);
  }

  /// Keeps the first fault of a vertex until types are known: not all numbers of a polyhedron are points.
  void keep_fault_at_vertex(std::int64_t vertex, std::int64_t cell) {
    if (vertex_fault_) return;
    vertex_fault_ = InputError(
        Location{in_.scanner.file(), in_.binary ? 0 : in_.scanner.line(),
                 in_.binary ? in_.scanner.byte() : -1},
        "cell " + std::to_string(cell) + " (counted from 0) names the point " + std::to_string(vertex),
        "points run from 0 to " + std::to_string(point_limit() - 1));
  }

  /// Reads cells as stored since version 5: offsets, then vertices.
  void read_offsets_and_vertices(FileCells& cells, std::int64_t count, std::int64_t size,
                                 const std::string& key) {
    if (count == 0) return;
    const auto read_part = [&](const char* name, std::int64_t entries) {
      if (upper_case(in_.word(name)) != name)
        in_.fail(std::string(name) + " is missing in " + key, "it comes before its numbers");
      const std::string type(in_.word("the type of the numbers"));
      DataArray part = in_.array(name, {}, entries, 1, type);
      in_.facts.erase({std::nullopt, name});
      return part;
    };
    in_.check_room(count, 1, key);
    DataArray offsets = read_part("OFFSETS", count);
    if (auto* const same = std::get_if<std::vector<Offset>>(&offsets.values)) {
      cells.offsets = std::move(*same);
    } else {
      cells.offsets = integers_of<Offset>(offsets.values);
    }
    if (cells.offsets.empty() || cells.offsets.front() != 0 || cells.offsets.back() != size ||
        !std::is_sorted(cells.offsets.begin(), cells.offsets.end())) {
      throw in_.section_error(cells_line_,
                              "the OFFSETS of " + key + " do not ascend from 0 to " + std::to_string(size),
                              "each is where a cell begins, the last is the size of CONNECTIVITY");
    }
    const DataArray vertices = read_part("CONNECTIVITY", size);
    if (!are_integers(vertices.values)) {
      throw in_.section_error(cells_line_, "the CONNECTIVITY of " + key + " is not a list of integers",
                              "an integer type is needed");
    }
    with_integers(vertices.values, [&]<class Number>(const std::vector<Number>& numbers) {
      // no early exit: the loop can then be vectorised
      resize_large(cells.vertices, numbers.size());
      const std::int64_t limit = point_limit();
      std::size_t missing = 0;
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        missing += static_cast<std::size_t>(std::cmp_less(numbers[i], 0)) +
                   static_cast<std::size_t>(std::cmp_greater_equal(numbers[i], limit));
        cells.vertices[i] = static_cast<Index>(numbers[i]);
      }
      if (missing == 0) return;
      // a number of a polyhedron need not be a point; a number that does not fit an Index is a fault in any
      // cell
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (!std::in_range<Index>(numbers[i])) cells.vertices[i] = -1;
      }
      const auto wrong = std::find_if(numbers.begin(), numbers.end(), [&](Number vertex) {
        return std::cmp_less(vertex, 0) || std::cmp_greater_equal(vertex, limit);
      });
      const auto cell = std::upper_bound(cells.offsets.begin(), cells.offsets.end(),
                                         static_cast<Offset>(wrong - numbers.begin())) -
                        cells.offsets.begin() - 1;
      keep_fault_at_vertex(std::in_range<Index>(*wrong) ? static_cast<std::int64_t>(*wrong) : -1, cell);
    });
  }

  void read_cell_types() {
    types_line_ = in_.scanner.line();
    const std::int64_t count = in_.count("the number of CELL_TYPES");
    in_.check_room(count, 4, "CELL_TYPES");
    if (count > 0) in_.begin_binary();
    std::vector<std::uint8_t>& types = sections_[0].types;
    resize_large(types, static_cast<std::size_t>(count));
    if (!in_.binary) {
      Scanner at = in_.scanner;
      if (read_regular_numbers<std::uint8_t>(at, types) == types.size()) return in_.scanner.move_to(at);
    }
    types.clear();
    for (std::int64_t c = 0; c < count; ++c) {
      const std::int32_t type = in_.int32("CELL_TYPES");
      if (type < 0 || type > 255)
        in_.fail("cell " + std::to_string(c) + " (counted from 0) has the type " + std::to_string(type),
                 "VTK's types run from 0 to 81");
      types.push_back(static_cast<std::uint8_t>(type));
    }
  }

  // ---- data

  void begin_data(const std::string& key) {
    on_ = key == "POINT_DATA" ? Association::vertices : Association::cells;
    const std::int64_t count = in_.count("the number of " + key);
    if (count != owner_count())
      in_.fail(
          key + " is for " + std::to_string(count) + (on_ == Association::vertices ? " points" : " cells"),
          "the file has " + std::to_string(owner_count()));
  }

  [[nodiscard]] std::int64_t owner_count() const {
    if (on_ == Association::vertices) return mesh_.vertex_count();
    std::int64_t cells = 0;
    for (const FileCells& section : sections_) cells += static_cast<std::int64_t>(section.offsets.size()) - 1;
    return cells;
  }

  /// Returns a name that no other array of points or cells has; VTK keeps only one array of each name.
  std::string own_name(const std::string& wanted) {
    std::string name = names_.take(*on_, wanted);
    if (name != wanted) {
      in_.notes.push_back("the array '" + shown(wanted) + "' is given twice; the second is called '" +
                          shown(name) + "'");
    }
    return name;
  }

  /// Reads SCALARS, VECTORS and similar; returns false for another keyword.
  bool read_attribute(const std::string& key) {
    const auto attribute = std::find_if(kLegacyAttributes.begin(), kLegacyAttributes.end(),
                                        [&](const LegacyAttribute& a) { return a.keyword == key; });
    if (attribute == kLegacyAttributes.end()) return false;
    const std::string name = own_name(percent_decoded(in_.word("the name of " + key)));
    std::int64_t components = attribute->components;
    if (attribute->role == Role::texture_coordinates || attribute->role == Role::color_scalars)
      components = in_.text_integer("the components of " + key);

    ArrayRole role{attribute->role, *on_, name, {}};
    std::string type = in_.binary ? "unsigned_char" : "float";
    if (attribute->role != Role::color_scalars) type = in_.word("the type of " + key);
    if (attribute->role == Role::scalars) {
      const bool are_single = upper_case(in_.scanner.peek_word()) == "LOOKUP_TABLE";
      components = are_single ? 1 : in_.text_integer("the components of SCALARS");
      if (upper_case(in_.word("LOOKUP_TABLE")) != "LOOKUP_TABLE")
        in_.fail("SCALARS '" + shown(name) + "' has no LOOKUP_TABLE",
                 "'LOOKUP_TABLE default' follows its name and type");
      role.lookup_table = in_.word("the name of the lookup table");
    }
    metadata_->roles.push_back(std::move(role));
    add_array(mesh_, in_.array(name, on_, owner_count(), components, type));
    return true;
  }

  /// Reads a FIELD: arrays of points or cells or, before POINT_DATA and CELL_DATA, of the whole mesh.
  void read_field() {
    in_.word("the name of the FIELD");
    const std::int64_t arrays = in_.count("the number of arrays of the FIELD");
    for (std::int64_t i = 0; i < arrays; ++i) {
      std::string name = percent_decoded(in_.word("the name of an array"));
      if (name == "NULL_ARRAY") continue;
      if (on_) name = own_name(name);
      const std::int64_t components = in_.count("the components of '" + shown(name) + "'");
      const std::int64_t tuples = in_.count("the tuples of '" + shown(name) + "'");
      const std::string type(in_.word("the type of '" + shown(name) + "'"));
      if (on_ && tuples != owner_count()) {
        in_.fail("the array '" + shown(name) + "' has " + std::to_string(tuples) + " tuples",
                 std::to_string(owner_count()) + " are needed");
      }
      DataArray array = in_.array(name, on_, tuples, components, type);
      if (on_) {
        add_array(mesh_, std::move(array));
      } else {
        metadata_->fields.push_back(std::move(array));
      }
    }
  }

  void read_lookup_table() {
    const std::string name(in_.word("the name of the lookup table"));
    const std::int64_t size = in_.count("the size of the lookup table");
    std::string content;
    if (in_.binary) {
      in_.begin_binary();
      content = in_.scanner.binary_block(4 * size, "the lookup table");
    } else {
      in_.check_room(4 * size, 1, "the lookup table");
      for (std::int64_t i = 0; i < 4 * size; ++i) {
        const std::string_view word = in_.word("the lookup table");
        (void)parse_real(in_.scanner, word, "a colour");
        content += std::string(word) + (i % 4 == 3 ? "\n" : " ");
      }
    }
    layout_.lookup_tables.push_back({*on_, name, static_cast<Index>(size), std::move(content)});
  }

  // ---- the end

  void finish() {
    if (!has_points_) in_.fail("the file has no POINTS", "the file may be cut short");
    FileCells all = layout_.polydata ? polydata_cells() : std::move(sections_[0]);
    if (all.types.size() + 1 != all.offsets.size()) {
      throw in_.section_error(types_line_,
                              "there are " + std::to_string(all.types.size()) + " CELL_TYPES for " +
                                  std::to_string(all.offsets.size() - 1) + " cells",
                              "each cell has one");
    }
    take_faces(all);
    for (const Index vertex : all.vertices) {
      if (vertex < 0 || vertex >= mesh_.vertex_count())
        throw in_.section_error(cells_line_, "a cell names the point " + std::to_string(vertex),
                                "points run from 0 to " + std::to_string(mesh_.vertex_count() - 1));
    }
    const bool old_order = version_ < kLastVersion &&
                           std::any_of(all.types.begin(), all.types.end(), is_higher_order_hexahedron);
    const std::vector<std::uint8_t> types = old_order ? all.types : std::vector<std::uint8_t>{};
    metadata_->inward_wedges = take_cells(
        mesh_, all,
        [&](const std::string& what, const std::string& remedy) {
          return in_.section_error(types_line_, what, remedy);
        },
        in_.notes);
    metadata_->polyhedra = std::move(all.polyhedra);
    if (old_order) swap_hexahedron_edges(mesh_, types, mesh_.cells);

    layout_.binary = in_.binary;
    metadata_->facts = std::move(in_.facts);
    metadata_->legacy = std::move(layout_);
    mesh_.format_metadata = metadata_;
  }

  /// Replaces the numbers of each polyhedron by its points, in order of appearance; keeps its faces in
  /// `all.polyhedra`.
  void take_faces(FileCells& all) {
    if (std::find(all.types.begin(), all.types.end(), kPolyhedron) == all.types.end()) {
      if (vertex_fault_) throw InputError(*vertex_fault_);
      return;
    }
    FileCells taken;
    taken.vertices.reserve(all.vertices.size());
    taken.polyhedra.starts.push_back(0);
    std::vector<Index> cell_of_point(mesh_.points.size(), -1);
    for (std::size_t c = 0; c < all.types.size(); ++c) {
      const std::span<const Index> numbers(all.vertices.data() + all.offsets[c],
                                           all.vertices.data() + all.offsets[c + 1]);
      if (all.types[c] == kPolyhedron) {
        take_polyhedron(static_cast<Index>(c), numbers, cell_of_point, taken);
      } else {
        taken.vertices.insert(taken.vertices.end(), numbers.begin(), numbers.end());
      }
      taken.offsets.push_back(static_cast<Offset>(taken.vertices.size()));
      taken.polyhedra.starts.push_back(static_cast<Offset>(taken.polyhedra.numbers.size()));
    }
    taken.types = std::move(all.types);
    all = std::move(taken);
  }

  void take_polyhedron(Index cell, std::span<const Index> numbers, std::vector<Index>& cell_of_point,
                       FileCells& taken) const {
    const std::string what = "cell " + std::to_string(cell) + " (counted from 0), a polyhedron, ";
    if (!are_faces(numbers)) {
      throw in_.section_error(
          cells_line_, what + "has faces that do not fit its " + std::to_string(numbers.size()) + " numbers",
          "the number of its faces is needed, then of each face the number of its corners and these");
    }
    for_faces(numbers, [&](std::span<const Index> corners) {
      for (const Index corner : corners) {
        if (corner < 0 || corner >= mesh_.vertex_count()) {
          throw in_.section_error(cells_line_, what + "names the point " + std::to_string(corner),
                                  "points run from 0 to " + std::to_string(mesh_.vertex_count() - 1));
        }
        if (cell_of_point[corner] != cell) taken.vertices.push_back(corner);
        cell_of_point[corner] = cell;
      }
    });
    taken.polyhedra.numbers.insert(taken.polyhedra.numbers.end(), numbers.begin(), numbers.end());
  }

  /// Returns the cells of all sections of a POLYDATA file; each section is a block.
  FileCells polydata_cells() {
    FileCells all;
    std::vector<Index> blocks;
    for (std::size_t s = 0; s < sections_.size(); ++s) {
      FileCells& section = sections_[s];
      const std::size_t count = section.offsets.size() - 1;
      if (count > 0) blocks.push_back(index_size(all.types));
      const auto shift = static_cast<Offset>(all.vertices.size());
      for (std::size_t c = 0; c < count; ++c) {
        all.types.push_back(polydata_type(s, section.offsets[c + 1] - section.offsets[c]));
        all.offsets.push_back(shift + section.offsets[c + 1]);
      }
      all.vertices.insert(all.vertices.end(), section.vertices.begin(), section.vertices.end());
      section = {};
    }
    if (blocks.size() > 1) mesh_.cell_blocks = std::move(blocks);
    return all;
  }

  static std::uint8_t polydata_type(std::size_t section, Offset vertices) {
    switch (section) {
      case 0:
        return vertices == 1 ? 1 : 2;  // vertex or several
      case 1:
        return vertices == 2 ? 3 : 4;  // line or polyline
      case 2:
        return vertices == 3 ? 5 : vertices == 4 ? 9 : 7;  // triangle, quad or polygon
      default:
        return 6;
    }
  }

  LegacyInput in_;
  Mesh mesh_;
  UniqueNames names_;  // names of arrays
  std::shared_ptr<VtkMetadata> metadata_ = std::make_shared<VtkMetadata>();
  LegacyLayout layout_;
  int version_ = 0;
  bool has_points_ = false;
  std::array<FileCells, 4> sections_;  // an unstructured grid uses only the first
  std::int64_t cells_line_ = 0;
  std::int64_t types_line_ = 0;
  std::optional<InputError> vertex_fault_;
  std::optional<Association> on_;  // owner of the arrays that follow; nullopt: the whole mesh
};

}  // namespace

Mesh read_legacy(const FilePath& path, Notes& notes) { return LegacyReader(path).read(notes); }

}  // namespace meshorder::vtk
