// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include "io/named_parts.hpp"
#include "io/stream/id_map.hpp"
#include "io/stream/number_reader.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Declarations shared by the reader and the writer of Gmsh's .msh files.
///
/// The specification is the section "MSH file format" of Gmsh's reference manual,
/// https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format, and "Node ordering" there.
namespace meshorder::gmsh {

// ---- element types

/// One of Gmsh's element types: its number in files, its shape and how many nodes it has.
struct ElementType {
  int number;
  Shape shape;
  int nodes;
};

/// Returns a type by number; nullptr if it is unknown or lacks a Shape or a fixed number of nodes.
const ElementType* find_type(int number);

/// Returns the type of cells of that shape with `nodes` vertices, or nullptr. If Gmsh has two such types (the
/// complete and the serendipity quad of 16 nodes), returns the complete one.
const ElementType* find_type(Shape shape, int nodes);

/// Returns, for each node in VTK's order, the position in Gmsh's list; empty if both orders agree or VTK has
/// no such cell.
std::span<const int> vtk_order(Shape shape, int nodes);

// ---- names of the arrays that keep data of Gmsh's files

inline constexpr std::string_view kCellEntity = "gmsh:geometrical";    ///< tag of each cell's entity
inline constexpr std::string_view kCellDimension = "gmsh:entity_dim";  ///< dimension of each cell's entity
inline constexpr std::string_view kCellType = "gmsh:type";  ///< Gmsh's type if shape and nodes leave a choice
inline constexpr std::string_view kCellPartitions = "gmsh:partitions";  ///< 2.x: tags from the third on
inline constexpr std::string_view kCellTagCount = "gmsh:tag_count";  ///< 2.x: number of tags if cells differ
inline constexpr std::string_view kCellGhosts = "gmsh:ghosts";    ///< owner, number of ghosts, ghosts, zeros
inline constexpr std::string_view kNodeEntity = "gmsh:dim_tags";  ///< dimension and tag of a node's entity
inline constexpr std::string_view kNodeParameters = "gmsh:parametric";  ///< 1 if given, else 0; u, v, w

// ---- metadata

/// How many nodes have values in a view's entry for a cell: one, each node, each corner, or a fixed number.
enum class PerElement : std::uint8_t { one, each_node, each_corner, fixed };

/// A section $NodeData, $ElementData or $ElementNodeData. Its values are an array of the mesh.
struct View {
  std::string section;
  Association association = Association::vertices;
  std::optional<std::string> array;    ///< name of the array in the mesh; nullopt: the view has no values
  Index width = 1;                     ///< components of that array
  std::vector<std::string> strings;    ///< verbatim, quotes included
  std::vector<double> reals;           ///< the first is the time
  std::vector<std::int32_t> integers;  ///< step, components, entries (set anew when written), partition …
  PerElement per = PerElement::one;
  int nodes = 1;  ///< nodes per cell, for PerElement::fixed
};

/// Names of two sets in the same order: nodes, and their masters.
struct NodePairs {
  std::string nodes;
  std::string masters;
};

/// A periodic entity of $Periodic.
struct PeriodicLink {
  std::int32_t dimension = 0;
  std::int32_t tag = 0;
  std::int32_t master = 0;
  std::vector<double> affine;
  /// A set has each node once: a node that k pairs name is in the sets of the first k of these.
  std::vector<NodePairs> pairs;
};

struct PhysicalName {
  std::int32_t dimension;
  std::int32_t tag;
  std::string name;
};

/// The head of a block: the entity's dimension and tag; `parametric` (nodes) or type (elements).
using EmptyBlock = std::array<std::int32_t, 3>;

enum class SectionKind : std::uint8_t { format, verbatim, nodes, elements, periodic, ghosts, view };

struct MshSection {
  SectionKind kind;
  std::string name;
  std::string text;  ///< for SectionKind::verbatim: between the lines $Name and $EndName
  std::size_t view = 0;
};

using Entity = std::pair<std::int32_t, std::int32_t>;  ///< dimension and tag

/// The parts of a Gmsh file that do not depend on the order of its nodes and elements.
struct GmshMetadata : FormatMetadata {
  double version = 4.1;
  bool binary = false;
  std::endian order =
      std::endian::native;  ///< byte order of the file's numbers, also of those in verbatim sections
  std::string header = "4.1 0 8";
  std::vector<MshSection> sections;
  std::vector<View> views;
  std::vector<PeriodicLink> periodic;
  std::vector<PhysicalName> names;
  std::map<Entity, std::vector<std::int32_t>> physicals;  ///< physical groups of the entities in $Entities
  std::vector<EmptyBlock> empty_node_blocks;
  std::vector<EmptyBlock> empty_element_blocks;

  [[nodiscard]] std::vector<std::string> contents() const override;
  [[nodiscard]] bool has(SectionKind kind) const {
    return std::any_of(sections.begin(), sections.end(),
                       [kind](const MshSection& section) { return section.kind == kind; });
  }
  [[nodiscard]] bool is_version_1() const { return version < 2; }
  /// Returns whether the version is 1 or 2: each element then has tags of its own.
  [[nodiscard]] bool is_version_2() const { return version < 3; }
  [[nodiscard]] bool is_version_40() const { return version >= 4 && version < 4.05; }
  /// Returns whether numbers of nodes and elements have 64 bits; in binary files of 4.0 they have 32.
  [[nodiscard]] bool has_wide_numbers() const { return !binary || !is_version_40(); }
};

// ---- reading

/// Returns a map from the numbers of nodes or elements to positions; clears `ids` if they are 1, 2, 3 … Fails
/// for negative numbers and for numbers that are given twice; `what` is "node" or "element".
IdMap number_ids(const NumberReader& source, std::vector<std::int64_t>& ids, std::string_view what);

/// The state of the reader.
struct ReadContext {
  ReadContext(const FilePath& path, Notes& warnings) : source(path), notes(warnings) {}

  NumberReader source;
  Mesh mesh;
  GmshMetadata metadata;
  IdMap nodes;
  IdMap elements;
  std::vector<std::size_t> view_arrays;  ///< index of each view's array in `mesh.data`, if it has one
  Notes& notes;
};

Mesh read(const FilePath& path, Notes& notes);

/// Reads the line $EndSECTION ($ENDSECTION in version 1). Another word that begins with $End, in upper or
/// lower case, also ends the section, with a note.
void expect_end(ReadContext& reading, std::string_view section);

/// Reads the number of a node or element, or a count of the same width (see `has_wide_numbers`).
inline std::int64_t read_number(ReadContext& reading, std::string_view what) {
  return reading.metadata.has_wide_numbers() ? reading.source.int64(what) : reading.source.int32(what);
}
/// Reads a count like `read_number`. `text_bytes` and `binary_bytes`: least bytes of an item
/// (Scanner::count).
inline Index read_count(ReadContext& reading, std::string_view what, std::int64_t text_bytes,
                        std::int64_t binary_bytes) {
  const std::int64_t count = read_number(reading, what);
  return reading.source.checked_count(count, what, reading.source.binary ? binary_bytes : text_bytes);
}

/// Returns the element type of that number; fails if it is not supported.
const ElementType& known_type(const NumberReader& source, std::int64_t number);

/// Adds a cell with these vertices, in Gmsh's order.
void add_cell(Mesh& mesh, const ElementType& type, std::span<const Index> nodes);

[[noreturn]] void fail_unknown_node(const ReadContext& reading, std::int64_t id, std::string_view owner,
                                    std::int64_t owner_id);

/// Returns the vertex with the number `id`; fails, naming the owner, if there is none.
inline Index place_of_node(const ReadContext& reading, std::int64_t id, std::string_view owner,
                           std::int64_t owner_id) {
  const Index place = reading.nodes.find(id);
  if (place < 0) fail_unknown_node(reading, id, owner, owner_id);
  return place;
}

/// Adds a dense array to the mesh.
void keep_array(Mesh& mesh, std::string_view name, Association association, Index components, Values values);

/// Adds the array kCellType if shape and number of nodes do not determine the type of every cell.
void keep_unusual_types(Mesh& mesh, const std::vector<std::int32_t>& numbers);

/// Adds the array kNodeParameters with these values; nodes after the last value have no parameters.
void keep_parameters(Mesh& mesh, std::vector<double> values);

/// Fails if `rows` contains a row twice; `section` is for the message. O(rows · log rows).
void check_distinct(const NumberReader& source, std::vector<Index> rows, std::string_view section);

/// Read a section; `section` is its name without the $: Nodes, ParametricNodes or Elements; in version 1 NOD,
/// NOE or ELM.
void read_nodes_2(ReadContext& reading, std::string_view section);
void read_elements_2(ReadContext& reading, std::string_view section);
void read_entities_4(ReadContext& reading, bool partitioned);
void read_nodes_4(ReadContext& reading);
void read_elements_4(ReadContext& reading);
void read_view(ReadContext& reading, std::string_view section);
void read_periodic(ReadContext& reading, std::string_view section);
void read_ghosts(ReadContext& reading, std::string_view section);
/// Gives the arrays of views distinct names: "NAME step K" if several views of a kind have the same name.
void name_views(ReadContext& reading);

/// Returns the named physical groups that have cells, as sets of cells.
std::vector<EntitySet> physical_sets(const Mesh& mesh, const GmshMetadata& metadata);

/// Returns the first physical group of each cell's entity, 0 for cells without a group; empty if no cell has
/// a group.
std::vector<std::int32_t> labels_of_entities(const Mesh& mesh, const GmshMetadata& metadata);

// ---- writing

/// Writes numbers as text, separated by blanks, or as binary.
/// @tparam Out  OutputFile or Text
template <class Out>
class NumbersTo {
 public:
  NumbersTo(Out& to, std::string_view path, bool is_binary = false, std::endian bytes = std::endian::native)
      : out(to), file(path), binary(is_binary), order(bytes) {}

  void int32(std::int64_t value) {
    if (!binary) return size(value);
    if (!std::in_range<std::int32_t>(value)) {
      throw InputError(std::string(file),
                       fmt::format("the number {} does not fit in this binary file", value),
                       "give nodes and elements numbers below 2147483648");
    }
    out.binary(static_cast<std::int32_t>(value), order);
  }
  void size(std::int64_t value) { binary ? out.binary(value, order) : out.integer(blank(), value); }
  void number(std::int64_t value, bool wide) { wide ? size(value) : int32(value); }
  /// Writes `of(0)` … `of(count − 1)` as numbers of type Number. In binary files this is faster than writing
  /// them one by one.
  template <class Number, class Of>
  void all(std::size_t count, const Of& of) {
    if (!binary) {
      for (std::size_t k = 0; k < count; ++k) out.number(blank(), Number{of(k)});
      return;
    }
    char* at = out.room(count * sizeof(Number));
    for (std::size_t k = 0; k < count; ++k) at = put_number(at, Number{of(k)}, order);
    out.written(at);
  }
  void real(double value) { binary ? out.binary(value, order) : out.real(blank(), value); }
  void all(const Point& point) {
    all<double>(point.size(), [&](std::size_t k) { return point[k]; });
  }
  void word(std::string_view text) {
    out.write(blank());
    out.write(text);
  }
  /// Ends the line in text; does nothing in binary.
  void end_line() {
    if (!binary) out.write("\n");
    at_line_start_ = true;
  }
  /// Writes a line with a number as text, also in binary files.
  void text_line(std::int64_t value) { out.print("{}\n", value); }

  Out& out;
  const std::string_view file;
  const bool binary;
  const std::endian order;

 private:
  std::string_view blank() { return std::exchange(at_line_start_, false) ? "" : " "; }

  bool at_line_start_ = true;
};
using NumberWriter = NumbersTo<OutputFile>;
using RowWriter = NumbersTo<Text>;

/// Writes the output of `row(to, i)` for each i, in order; calls `row` on all threads.
template <class Row>
void write_rows(NumberWriter& sink, Index count, const Row& row) {
  meshorder::write_rows(sink.out, count, [&](Text& text, Index i) {
    RowWriter to(text, sink.file, sink.binary, sink.order);
    row(to, i);
    to.end_line();
  });
}

/// The input of the writer: a mesh and its layout, which was read with the mesh or made for it.
struct WriteContext {
  const Mesh& mesh;
  const GmshMetadata& layout;
  std::vector<const ElementType*> types;      ///< type of each cell
  std::vector<std::int64_t> node_ids;         ///< empty: 1, 2, 3 …
  std::vector<std::int64_t> cell_ids;         ///< empty: 1, 2, 3 …
  std::vector<std::int32_t> cell_dimensions;  ///< 4.x: dimension of each cell's entity
  std::vector<std::int32_t> cell_tags;        ///< 4.x: tag of each cell's entity
  std::vector<std::int32_t> node_entities;    ///< 4.x, $ParametricNodes: dimension, tag of each node's entity
  std::vector<const DataArray*> placed;       ///< arrays that other sections hold: they need no view
  NamedParts parts;                           ///< arrays and sets of the mesh, by name

  [[nodiscard]] std::int64_t node_id(Index v) const { return node_ids.empty() ? v + 1 : node_ids[v]; }
  [[nodiscard]] std::int64_t cell_id(Index c) const { return cell_ids.empty() ? c + 1 : cell_ids[c]; }
};

inline constexpr Index kAnyComponents = 0;
/// Returns an array as 32-bit integers, 0 for items without a value; empty if missing or not convertible, or
/// if it has other components.
std::vector<std::int32_t> integers_of(const Mesh& mesh, std::string_view name, Association association,
                                      Index components = 1);

/// Returns the values of the array kNodeParameters, or nullptr if it is missing or malformed.
const std::vector<double>* parameters_of(const Mesh& mesh);

/// Makes entities, physical groups and their names for a mesh without a Gmsh layout, from its labels, its
/// sets of cells and any entities kept from an earlier conversion.
void classify(GmshMetadata& layout, WriteContext& output, Notes& notes);

/// Adds a view for an array that has no view yet, or a note if Gmsh cannot hold the array.
void add_view(GmshMetadata& layout, const DataArray& array, Notes& notes);

/// Adapts each view whose array now has another number of components. A view that cannot hold its new array
/// gets no array. Notes changes.
void refit_views(GmshMetadata& layout, const NamedParts& parts, Notes& notes);

/// Returns a name that fits between double quotes in one line.
std::string name_in_quotes(std::string_view name);

/// Writes the numbers of a cell's nodes in Gmsh's order, as size_t if `wide`, else as int.
void write_cell_nodes(RowWriter& to, const WriteContext& output, Index c, bool wide);

void write_nodes_2(NumberWriter& sink, const WriteContext& output);
void write_elements_2(NumberWriter& sink, const WriteContext& output);
void write_nodes_4(NumberWriter& sink, const WriteContext& output);
void write_elements_4(NumberWriter& sink, const WriteContext& output);
void write_view(NumberWriter& sink, const WriteContext& output, const View& view);
void write_periodic(NumberWriter& sink, const WriteContext& output);
void write_ghosts(NumberWriter& sink, const WriteContext& output);
/// Returns the array kCellGhosts, or nullptr if it is missing or malformed.
const DataArray* ghosts_of(const Mesh& mesh);

}  // namespace meshorder::gmsh
