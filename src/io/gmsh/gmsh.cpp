// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/gmsh/gmsh.hpp"

#include "io/all_formats.hpp"
#include "io/unsupported.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>
#include <span>

// Specification: https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format; 4.0 is described in the manual of
// Gmsh 4.0, and what its binary files hold in GModelIO_MSH4.cpp there. This file walks the sections; v2.cpp
// and v4.cpp read and write nodes and elements, data.cpp and links.cpp their data and links, groups.cpp makes
// groups and entities.

namespace meshorder {
namespace gmsh {
namespace {

// ---- reading

const std::set<std::string_view> kDataSections{"NodeData", "ElementData", "ElementNodeData"};

/// Sections without numbers of nodes or elements, kept verbatim. $Parametrizations has triangles over nodes
/// of its own.
const std::set<std::string_view> kVerbatimSections{"Comment", "Comments", "InterpolationScheme",
                                                   "Parametrizations"};

/// Moves to the line $EndName, $ENDName in version 1, and returns the text before it.
std::string_view body(ReadContext& reading, std::string_view section) {
  NumberReader& source = reading.source;
  const std::string_view all = source.scanner.all();
  const std::string end = "$End" + std::string(section);
  const std::string end_1 = "$END" + std::string(section);
  const auto begin = static_cast<std::size_t>(source.scanner.byte());
  for (std::size_t at = all.find("$E", begin); at != std::string_view::npos; at = all.find("$E", at + 1)) {
    const std::string_view line = all.substr(at);
    const char before = at == 0 ? '\n' : all[at - 1];
    const bool named = line.starts_with(end) || (reading.metadata.is_version_1() && line.starts_with(end_1));
    if ((before != '\n' && before != '\r') || !named) continue;
    const std::string_view rest = line.substr(end.size());
    if (!rest.empty() && std::string_view(" \t\r\n").find(rest.front()) == std::string_view::npos) continue;
    source.scanner.seek(static_cast<std::int64_t>(at));
    return all.substr(begin, at - begin);
  }
  source.fail("$" + std::string(section) + " has no " + end, "the file may be cut short");
}

/// Fails unless the version is supported.
void check_version(const NumberReader& source, double version) {
  if ((version >= 2 && version < 2.3) || (version >= 4 && version < 4.15)) return;
  source.fail(fmt::format("version {:.1f} of Gmsh's format is not supported", version),
              "1, 2.2, 4.0 and 4.1 are; convert the file with gmsh OLD.msh -save -format msh41 -o NEW.msh");
}

void read_format(ReadContext& reading) {
  NumberReader& source = reading.source;
  const std::int64_t begin = source.scanner.byte();
  reading.metadata.version = source.scanner.real("the version");
  check_version(source, reading.metadata.version);
  const auto file_type = source.scanner.integer<std::int32_t>("the file type");
  const auto data_size = source.scanner.integer<std::int32_t>("the data size");
  if (file_type != 0 && file_type != 1) {
    source.fail("the file type is " + std::to_string(file_type), "0 (text) and 1 (binary) are possible");
  }
  if (file_type == 1 && data_size != 8) {
    source.fail(
        "the data size is " + std::to_string(data_size),
        "only binary files with 8 are read; meshio convert --output-format gmsh OLD.msh NEW.msh makes one");
  }
  reading.metadata.header = source.scanner.all().substr(begin, source.scanner.byte() - begin);
  (void)source.scanner.raw_line();
  source.binary = reading.metadata.binary = file_type == 1;
  if (source.binary) {
    const auto one = source.int32("the number 1 that shows the byte order");
    if (one != 1 && one != 0x01000000) {
      source.fail("the number that shows the byte order is " + std::to_string(one), "it must be 1");
    }
    const auto other = std::endian::native == std::endian::little ? std::endian::big : std::endian::little;
    source.order = reading.metadata.order = one == 1 ? std::endian::native : other;
  }
  expect_end(reading, "MeshFormat");
  reading.metadata.sections.push_back({SectionKind::format, "MeshFormat", "", 0});
}

/// Reads the names of physical groups and keeps the section verbatim. Version 2.0 gives no dimensions, so its
/// names are not interpreted.
void read_names(ReadContext& reading) {
  NumberReader& source = reading.source;
  const std::int64_t begin = source.scanner.byte();
  if (reading.metadata.version > 2.05) {
    const Index count =
        source.checked_count(source.text_integer("the number of names"), "the number of names", 4);
    for (Index i = 0; i < count; ++i) {
      PhysicalName name{};
      name.dimension = static_cast<std::int32_t>(source.text_integer("the dimension of a physical group"));
      name.tag = static_cast<std::int32_t>(source.text_integer("the tag of a physical group"));
      const std::string_view text = source.scanner.rest_of_line();
      // as for Gmsh, the second quote ends the name; the text after it, by which libMesh marks blocks, is
      // kept
      const std::size_t end = text.find('"', 1);
      if (!text.starts_with('"') || end == std::string_view::npos) {
        source.fail("the name of the physical group " + std::to_string(name.tag) + " has no quotes",
                    "write it as \"name\"");
      }
      name.name = text.substr(1, end - 1);
      reading.metadata.names.push_back(std::move(name));
    }
    (void)source.scanner.at_end();
  } else {
    (void)body(reading, "PhysicalNames");
  }
  const std::string_view text = source.scanner.all().substr(begin, source.scanner.byte() - begin);
  expect_end(reading, "PhysicalNames");
  reading.metadata.sections.push_back({SectionKind::verbatim, "PhysicalNames", std::string(text), 0});
}

/// Reads the physical groups of entities and keeps the section verbatim.
void read_entities(ReadContext& reading, const std::string& section) {
  NumberReader& source = reading.source;
  const std::int64_t begin = source.scanner.byte();
  read_entities_4(reading, section == "PartitionedEntities");
  (void)source.scanner.at_end();
  const std::string_view text = source.scanner.all().substr(begin, source.scanner.byte() - begin);
  expect_end(reading, section);
  reading.metadata.sections.push_back({SectionKind::verbatim, section, std::string(text), 0});
}

/// Returns whether a word of the text is a number.
bool has_numbers(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n,;:";
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::string_view word = text.substr(at, text.find_first_of(kBlanks, at) - at);
    double value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code != std::errc::invalid_argument && end == word.data() + word.size()) return true;
    at = text.find_first_not_of(kBlanks, at + word.size());
  }
  return false;
}

bool is_text(std::string_view text) {
  return std::none_of(text.begin(), text.end(),
                      [](char c) { return (c >= '\0' && c < '\t') || (c > '\r' && c < ' ') || c == '\x7f'; });
}

/// Keeps an unknown section verbatim, provided it cannot contain node or element numbers.
void read_verbatim(ReadContext& reading, const std::string& section) {
  NumberReader& source = reading.source;
  const std::int64_t line = source.scanner.line();
  const std::string_view text = body(reading, section);
  if (!kVerbatimSections.contains(section) && (has_numbers(text) || !is_text(text))) {
    source.fail(
        fmt::format("the section ${} from line {} on holds numbers of unknown meaning, which reordering "
                    "could invalidate",
                    section, line - 1),
        "take it out of the file, or keep it as $Comments");
  }
  expect_end(reading, section);
  reading.metadata.sections.push_back({SectionKind::verbatim, section, std::string(text), 0});
}

void read_nodes(ReadContext& reading) {
  reading.metadata.is_version_2() ? read_nodes_2(reading, "Nodes") : read_nodes_4(reading);
}

void read_parametric_nodes(ReadContext& reading) {
  if (!reading.metadata.is_version_2()) {
    reading.source.fail("a section $ParametricNodes", "in version 4 it is called $Nodes");
  }
  read_nodes_2(reading, "ParametricNodes");
}

void read_elements(ReadContext& reading) {
  reading.metadata.is_version_2() ? read_elements_2(reading, "Elements") : read_elements_4(reading);
}

void read_periodic_or_ghosts(ReadContext& reading, SectionKind kind) {
  kind == SectionKind::periodic ? read_periodic(reading) : read_ghosts(reading);
}

bool has_section(const Metadata& metadata, SectionKind kind) {
  return std::any_of(metadata.sections.begin(), metadata.sections.end(),
                     [kind](const Section& section) { return section.kind == kind; });
}

/// The kinds of section that a file has at most once.
struct Single {
  std::string_view name;
  SectionKind kind;
  SectionKind after;
  void (*read)(ReadContext&);
};

constexpr std::array kSingles{
    Single{"Nodes", SectionKind::nodes, SectionKind::format, read_nodes},
    Single{"NOD", SectionKind::nodes, SectionKind::format,
           [](ReadContext& reading) { read_nodes_2(reading, "NOD"); }},
    Single{"NOE", SectionKind::nodes, SectionKind::format,
           [](ReadContext& reading) { read_nodes_2(reading, "NOE"); }},
    Single{"ELM", SectionKind::elements, SectionKind::nodes,
           [](ReadContext& reading) { read_elements_2(reading, "ELM"); }},
    Single{"ParametricNodes", SectionKind::nodes, SectionKind::format, read_parametric_nodes},
    Single{"Elements", SectionKind::elements, SectionKind::nodes, read_elements},
    Single{"Periodic", SectionKind::periodic, SectionKind::nodes,
           [](ReadContext& reading) { read_periodic_or_ghosts(reading, SectionKind::periodic); }},
    Single{"GhostElements", SectionKind::ghosts, SectionKind::elements,
           [](ReadContext& reading) { read_periodic_or_ghosts(reading, SectionKind::ghosts); }},
};

void read_single(ReadContext& reading, const Single& single) {
  const std::string name(single.name);
  if (has_section(reading.metadata, single.kind)) {
    reading.source.fail("a second section $" + name, "a file has one of them");
  }
  if (!has_section(reading.metadata, single.after)) {
    reading.source.fail("$" + name + " comes before what it names", "put $Nodes and $Elements first");
  }
  single.read(reading);
  reading.metadata.sections.push_back({single.kind, name, "", 0});
}

/// Reads the section `name` after its first line.
void read_section(ReadContext& reading, const std::string& name) {
  NumberReader& source = reading.source;
  if ((name == "NOD" || name == "NOE") && reading.metadata.sections.empty()) {
    reading.metadata.version = 1;  // which has no $MeshFormat
    reading.metadata.sections.push_back({SectionKind::format, "", "", 0});
  }
  const bool has_format = has_section(reading.metadata, SectionKind::format);
  if (name == "MeshFormat") {
    if (has_format) source.fail("a second section $MeshFormat", "a file has one");
    return read_format(reading);
  }
  if (!has_format && name != "Comment" && name != "Comments") {
    source.fail("$" + name + " comes before $MeshFormat", "a Gmsh file begins with $MeshFormat");
  }
  if (name == "PhysicalNames") return read_names(reading);
  const bool entities = name == "Entities" || name == "PartitionedEntities";
  if (entities && !reading.metadata.is_version_2()) return read_entities(reading, name);
  if (kDataSections.contains(name)) {
    if (!has_section(reading.metadata, SectionKind::elements)) {
      source.fail("$" + name + " comes before $Elements", "put $Nodes and $Elements first");
    }
    return read_view(reading, name);
  }
  for (const Single& single : kSingles) {
    if (single.name == name) return read_single(reading, single);
  }
  read_verbatim(reading, name);
}

/// Completes the mesh once all sections are read.
void finish(ReadContext& reading) {
  Mesh& mesh = reading.mesh;
  for (const auto& [kind, name] : {std::pair{SectionKind::format, "$MeshFormat"},
                                   {SectionKind::nodes, "$Nodes"},
                                   {SectionKind::elements, "$Elements"}}) {
    if (!has_section(reading.metadata, kind)) {
      reading.source.fail("the file has no section " + std::string(name), "it may be cut short");
    }
  }
  if (!reading.metadata.is_version_2()) {
    std::vector<std::int32_t> labels = labels_of_entities(mesh, reading.metadata);
    if (!labels.empty())
      mesh.data.push_back({std::string(kLabel), Association::cells, 1, std::move(labels), {}, {}});
  }
  name_views(reading);
  std::vector<EntitySet> sets = physical_sets(mesh, reading.metadata);
  std::move(sets.begin(), sets.end(), std::back_inserter(mesh.sets));
  mesh.format_metadata = std::make_shared<Metadata>(std::move(reading.metadata));
}

Mesh read(const FilePath& path, Notes& notes) {
  ReadContext reading(path, notes);
  Scanner& in = reading.source.scanner;
  while (!in.at_end()) {
    const std::string word(in.peek_word());
    if (word.front() != '$' || word.size() < 2 || word.substr(0, 4) == "$End") {
      if (reading.metadata.sections.empty() && word.front() != '$') {
        reading.source.fail("is not a Gmsh file (it begins with '" + shown(in.peek_line()) + "')",
                            "a Gmsh file begins with $MeshFormat");
      }
      reading.source.fail("unexpected text outside a section", "a section begins with a line such as $Nodes");
    }
    (void)in.raw_line();
    read_section(reading, word.substr(1));
  }
  finish(reading);
  return std::move(reading.mesh);
}

// ---- writing

bool holds(const Mesh& /*mesh*/, Shape shape, int nodes) { return find_type(shape, nodes) != nullptr; }

/// Returns the type of every cell.
std::vector<const ElementType*> types_of_cells(const Mesh& mesh) {
  const std::vector<std::int32_t> numbers = integers_of(mesh, kCellType, Association::cells);
  std::vector<const ElementType*> types;
  types.reserve(mesh.cells.shapes.size());
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const Shape shape = mesh.cells.shapes[c];
    const int nodes = mesh.cells.vertex_count(c);
    const ElementType* last = types.empty() ? nullptr : types.back();
    if (!last || last->shape != shape || last->nodes != nodes || !numbers.empty()) {
      last = find_type(shape, nodes);
      const ElementType* kept = numbers.empty() ? nullptr : find_type(numbers[c]);
      if (kept && kept->shape == shape && kept->nodes == nodes) last = kept;
    }
    types.push_back(last);
  }
  return types;
}

/// Returns the ids of another format if Gmsh allows them: positive and distinct; else none, with a note.
std::vector<std::int64_t> usable_ids(const std::vector<std::int64_t>& ids, std::string_view what,
                                     Notes& notes) {
  std::vector<std::int64_t> sorted = ids;
  std::sort(sorted.begin(), sorted.end());
  const bool usable = sorted.empty() || (sorted.front() > 0 &&
                                         std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
  if (usable) return ids;
  notes.push_back(fmt::format("the {} are renumbered: Gmsh's numbers are positive and distinct", what));
  return {};
}

bool is_parametric_2(const Metadata& layout) {
  return layout.is_version_2() &&
         std::any_of(layout.sections.begin(), layout.sections.end(),
                     [](const Section& section) { return section.name == "ParametricNodes"; });
}

/// Returns whether the mesh still has the arrays that a file of this layout needs.
bool still_fits(const Mesh& mesh, const Metadata& layout) {
  const DataArray* entities = find_array(mesh, kNodeEntity, Association::vertices);
  const bool has_node_entities =
      entities && entities->components == 2 && !integers_of(mesh, kNodeEntity, Association::vertices).empty();
  if (layout.is_version_2()) return !is_parametric_2(layout) || (has_node_entities && parameters_of(mesh));
  return has_node_entities &&
         integers_of(mesh, kCellEntity, Association::cells).size() == mesh.cells.shapes.size();
}

/// Takes ids, entities and tags from a mesh that came from a Gmsh file.
void take_layout(const Metadata& layout, WriteContext& output) {
  const Mesh& mesh = output.mesh;
  const auto place = [&](std::string_view name, Association association) {
    output.placed.push_back(find_array(mesh, name, association));
  };
  output.node_ids = mesh.vertex_ids;
  output.cell_ids = mesh.cell_ids;
  place(kCellEntity, Association::cells);
  if (layout.is_version_2()) {
    if (!integers_of(mesh, kLabel, Association::cells).empty()) place(kLabel, Association::cells);
    if (layout.is_version_1()) return;
    place(kCellPartitions, Association::cells);
    place(kCellTagCount, Association::cells);
    if (!is_parametric_2(layout)) return;
    output.node_entities = integers_of(mesh, kNodeEntity, Association::vertices);
    place(kNodeEntity, Association::vertices);
    place(kNodeParameters, Association::vertices);
    return;
  }
  output.cell_tags = integers_of(mesh, kCellEntity, Association::cells);
  output.cell_dimensions = integers_of(mesh, kCellDimension, Association::cells);
  if (output.cell_dimensions.empty()) {
    std::array<std::int32_t, kShapes> dimensions{};
    for (int s = 0; s < kShapes; ++s) dimensions[s] = dimension(static_cast<Shape>(s));
    output.cell_dimensions.resize(mesh.cells.shapes.size());
    std::transform(mesh.cells.shapes.begin(), mesh.cells.shapes.end(), output.cell_dimensions.begin(),
                   [&](Shape shape) { return dimensions[static_cast<std::size_t>(shape)]; });
  }
  output.node_entities = integers_of(mesh, kNodeEntity, Association::vertices);
  place(kCellDimension, Association::cells);
  place(kNodeEntity, Association::vertices);
  place(kNodeParameters, Association::vertices);
  if (has_section(layout, SectionKind::ghosts)) place(kCellGhosts, Association::cells);
  // labels that were changed after reading are no longer those of the entities: they become data
  const std::vector<std::int32_t> labels = integers_of(mesh, kLabel, Association::cells);
  if (!labels.empty() && labels == labels_of_entities(mesh, layout)) place(kLabel, Association::cells);
}

/// Notes the sets that differ from the physical groups and periodic nodes of the layout.
void note_sets(const Mesh& mesh, const Metadata& layout, Notes& notes) {
  const std::vector<EntitySet> of_layout = physical_sets(mesh, layout);
  using Name = std::pair<Association, std::string_view>;
  std::multimap<Name, const EntitySet*> physical;
  for (const EntitySet& set : of_layout) physical.emplace(Name(set.association, set.name), &set);
  std::set<std::string> periodic;
  for (const PeriodicLink& link : layout.periodic) periodic.insert({link.nodes, link.master_nodes});
  for (const EntitySet& set : mesh.sets) {
    if (set.association == Association::vertices && periodic.contains(set.name)) continue;
    std::vector<Index> members = set.members;
    std::sort(members.begin(), members.end());
    const auto [first, last] = physical.equal_range({set.association, set.name});
    const bool held =
        std::any_of(first, last, [&](const auto& other) { return members == other.second->members; });
    if (!held) note_set_unsupported(set, "Gmsh", notes);
  }
}

/// Adds a data section for every array that has no place in the file yet.
void add_views(Metadata& layout, const WriteContext& output, Notes& notes) {
  std::set<std::pair<Association, std::string>> viewed;
  for (const View& view : layout.views) {
    if (view.array) viewed.emplace(view.association, *view.array);
  }
  for (const DataArray& array : output.mesh.data) {
    const auto& placed = output.placed;
    const bool has_view = viewed.contains({array.association, array.name});
    if (has_view || std::find(placed.begin(), placed.end(), &array) != placed.end()) continue;
    add_view(layout, array, notes);
  }
}

void write_format(NumberWriter& sink, const Metadata& layout) {
  sink.out.print("{}\n", layout.header);
  if (!layout.binary) return;
  sink.int32(1);
  sink.out.write("\n");
}

void write_section(NumberWriter& sink, const WriteContext& output, const Section& section) {
  if (section.name.empty()) return;  // the format of version 1
  const bool version_2 = output.layout.is_version_2();
  sink.out.print("${}\n", section.name);
  switch (section.kind) {
    case SectionKind::format:
      write_format(sink, output.layout);
      break;
    case SectionKind::verbatim:
      break;
    case SectionKind::nodes:
      version_2 ? write_nodes_2(sink, output) : write_nodes_4(sink, output);
      break;
    case SectionKind::elements:
      version_2 ? write_elements_2(sink, output) : write_elements_4(sink, output);
      break;
    case SectionKind::periodic:
      write_periodic(sink, output);
      break;
    case SectionKind::ghosts:
      write_ghosts(sink, output);
      break;
    case SectionKind::view:
      write_view(sink, output, output.layout.views[section.view]);
      break;
  }
  const bool has_binary = section.kind != SectionKind::format && section.kind != SectionKind::verbatim &&
                          !(version_2 && section.kind == SectionKind::periodic);
  if (sink.binary && has_binary) sink.out.write("\n");
  sink.out.write(section.text);
  sink.out.print("{}{}\n", output.layout.is_version_1() ? "$END" : "$End", section.name);
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const auto* own = dynamic_cast<const Metadata*>(mesh.format_metadata.get());
  const bool keeps_layout = own && still_fits(mesh, *own);
  Metadata layout = keeps_layout ? *own : Metadata{};
  WriteContext output{mesh, layout, types_of_cells(mesh), {}, {}, {}, {}, {}, {}, NamedParts(mesh)};
  output.placed.push_back(find_array(mesh, kCellType, Association::cells));
  if (keeps_layout) {
    take_layout(layout, output);
    note_sets(mesh, layout, notes);
  } else {
    note_metadata_unsupported(mesh, "Gmsh", notes);
    output.node_ids = usable_ids(mesh.vertex_ids, "vertices", notes);
    output.cell_ids = usable_ids(mesh.cell_ids, "cells", notes);
    classify(layout, output, notes);
  }
  add_views(layout, output, notes);

  OutputFile out(path);
  const std::string file = path.string();
  NumberWriter sink(out, file, layout.binary, layout.order);
  for (const Section& section : layout.sections) write_section(sink, output, section);
  out.commit();
}

}  // namespace

std::vector<std::string> Metadata::contents() const {
  std::vector<std::string> result;
  std::set<std::string> known;
  const auto add = [&](std::string what) {
    if (known.insert(what).second) result.push_back(std::move(what));
  };
  for (const Section& section : sections) {
    if (section.kind != SectionKind::verbatim) continue;
    // the groups themselves are labels and sets
    const bool has_names = section.name == "PhysicalNames";
    add(has_names ? "the numbers of named physical groups" : "Gmsh's $" + section.name);
  }
  if (!periodic.empty()) add(fmt::format("the pairs of {} periodic entities", periodic.size()));
  const bool timed = std::any_of(views.begin(), views.end(), [](const View& view) {
    return (!view.reals.empty() && view.reals[0] != 0) || view.integers[0] != 0;
  });
  if (timed) add("the times and steps of data");
  return result;
}

const ElementType& known_type(const NumberReader& source, std::int64_t number) {
  const ElementType* type = number < 0 || number > 1000 ? nullptr : find_type(static_cast<int>(number));
  if (!type) {
    source.fail("the element type " + std::to_string(number) + " is not supported",
                "types with a fixed number of nodes are, such as 4 for tetrahedra");
  }
  return *type;
}

void add_cell(Mesh& mesh, const ElementType& type, std::span<const Index> nodes) {
  const std::span<const int> order = vtk_order(type.shape, type.nodes);
  if (order.empty()) return mesh.cells.push_back(type.shape, nodes);
  std::array<Index, 27> sorted{};  // only cells of second order are sorted
  for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = nodes[order[k]];
  mesh.cells.push_back(type.shape, std::span(sorted).first(order.size()));
}

void write_cell_nodes(RowWriter& to, const WriteContext& output, Index c, bool wide) {
  const auto nodes = output.mesh.cells[c];
  const std::span<const int> order = vtk_order(output.types[c]->shape, output.types[c]->nodes);
  const auto put = [&](std::span<const Index> vertices) {
    if (wide)
      return to.all<std::int64_t>(vertices.size(),
                                  [&](std::size_t k) { return output.node_id(vertices[k]); });
    for (const Index v : vertices) to.int32(output.node_id(v));
  };
  if (order.empty()) return put(nodes);
  std::array<Index, 27> sorted{};
  for (std::size_t k = 0; k < order.size(); ++k) sorted[order[k]] = nodes[k];
  put(std::span(sorted).first(order.size()));
}

void fail_unknown_node(const ReadContext& reading, std::int64_t id, std::string_view owner,
                       std::int64_t owner_id) {
  reading.source.fail(fmt::format("{} {} names node {}, which $Nodes does not have", owner, owner_id, id),
                      "name nodes that exist");
}

void keep_unusual_types(Mesh& mesh, const std::vector<std::int32_t>& numbers) {
  const ElementType* last = nullptr;
  for (const std::int32_t number : numbers) {
    if (last && last->number == number) continue;
    last = find_type(number);
    if (find_type(last->shape, last->nodes) == last) continue;
    mesh.data.push_back({std::string(kCellType), Association::cells, 1, numbers, {}, {}});
    return;
  }
}

void keep_parameters(Mesh& mesh, std::vector<double> values) {
  values.resize(4 * mesh.points.size(), 0.0);
  mesh.data.push_back({std::string(kNodeParameters),
                       Association::vertices,
                       4,
                       std::move(values),
                       {},
                       {"given", "u", "v", "w"}});
}

const std::vector<double>* parameters_of(const Mesh& mesh) {
  const DataArray* array = find_array(mesh, kNodeParameters, Association::vertices);
  if (!array || array->components != 4 || !array->is_dense()) return nullptr;
  return std::get_if<std::vector<double>>(&array->values);
}

std::vector<std::int32_t> integers_of(const Mesh& mesh, std::string_view name, Association association) {
  const DataArray* array = find_array(mesh, name, association);
  if (!array || (!array->is_dense() && array->components != 1)) return {};
  std::vector<std::int32_t> given = std::visit(
      [](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        std::vector<std::int32_t> result;
        if constexpr (std::is_same_v<T, std::int32_t>) {
          result = values;
        } else if constexpr (std::is_integral_v<T>) {
          result.reserve(values.size());
          for (const T value : values) {
            if (!std::in_range<std::int32_t>(value)) return std::vector<std::int32_t>{};
            result.push_back(static_cast<std::int32_t>(value));
          }
        }
        return result;
      },
      array->values);
  if (array->is_dense() || given.empty()) return given;
  const Index count = association == Association::vertices ? mesh.vertex_count() : mesh.cell_count();
  std::vector<std::int32_t> all(static_cast<std::size_t>(count), 0);
  for (std::size_t k = 0; k < given.size(); ++k) all[array->indices[k]] = given[k];
  return all;
}

}  // namespace gmsh

Format gmsh_format() {
  return {.name = "Gmsh",
          .extensions = {".msh"},
          .groups_cells_by_type = false,
          .read = gmsh::read,
          .write = gmsh::write,
          .holds = gmsh::holds,
          .first_number = 1};
}

}  // namespace meshorder
