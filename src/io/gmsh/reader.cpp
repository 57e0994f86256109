// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/gmsh/gmsh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <span>
#include <utility>

// Specification: https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format; for 4.0 the manual of Gmsh 4.0, and
// for its binary files GModelIO_MSH4.cpp of that version. This file reads section after section; v2.cpp and
// v4.cpp read and write nodes and elements, data.cpp and links.cpp their data and links; groups.cpp makes
// groups and entities.

namespace meshorder::gmsh {
namespace {

const std::set<std::string_view> kDataSections{"NodeData", "ElementData", "ElementNodeData"};

/// Sections without numbers of nodes or elements, kept verbatim. The triangles in $Parametrizations refer to
/// nodes in the same section.
const std::set<std::string_view> kVerbatimSections{"Comment", "Comments", "InterpolationScheme",
                                                   "Parametrizations"};

/// Moves to the line $EndName or, in version 1, $ENDName; returns the text before it.
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

void read_format(ReadContext& reading) {
  NumberReader& source = reading.source;
  const std::int64_t begin = source.scanner.byte();
  const double version = reading.metadata.version = source.scanner.real("the version");
  if (!(version >= 2 && version < 2.3) && !(version >= 4 && version < 4.15)) {
    source.fail(fmt::format("version {:.1f} of Gmsh's format is not supported", version),
                "1, 2.2, 4.0 and 4.1 are supported; convert the file with gmsh OLD.msh -save -format msh41 "
                "-o NEW.msh");
  }
  const auto file_type = source.scanner.integer<std::int32_t>("the file type");
  const auto data_size = source.scanner.integer<std::int32_t>("the data size");
  if (file_type != 0 && file_type != 1) {
    source.fail("the file type is " + std::to_string(file_type), "0 (text) and 1 (binary) are possible");
  }
  if (file_type == 1 && data_size != 8) {
    source.fail("the data size is " + std::to_string(data_size),
                "only binary files with 8 are supported; meshio convert --output-format gmsh OLD.msh NEW.msh "
                "makes one");
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

/// Keeps the text from `begin` to the scanner as a section, and reads the line that ends the section.
void keep_verbatim(ReadContext& reading, std::string_view section, std::int64_t begin) {
  const Scanner& in = reading.source.scanner;
  const std::string_view text = in.all().substr(begin, in.byte() - begin);
  expect_end(reading, section);
  reading.metadata.sections.push_back({SectionKind::verbatim, std::string(section), std::string(text), 0});
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
      const auto number = [&](const char* what) {
        const std::int64_t value = source.text_integer(what);
        if (!std::in_range<std::int32_t>(value))
          source.fail(fmt::format("{} is {}", what, value), "it must fit 32 bits");
        return static_cast<std::int32_t>(value);
      };
      name.dimension = number("the dimension of a physical group");
      name.tag = number("the tag of a physical group");
      const std::string_view text = source.scanner.rest_of_line();
      // as in Gmsh, the second quote ends the name; libMesh marks blocks by the text after that quote, which
      // the section keeps
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
  keep_verbatim(reading, "PhysicalNames", begin);
}

/// Reads the physical groups of entities and keeps the section verbatim.
void read_entities(ReadContext& reading, std::string_view section) {
  const std::int64_t begin = reading.source.scanner.byte();
  read_entities_4(reading, section == "PartitionedEntities");
  (void)reading.source.scanner.at_end();
  keep_verbatim(reading, section, begin);
}

/// Returns whether any word of the text is a number.
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
  const std::int64_t begin = source.scanner.byte();
  const std::string_view text = body(reading, section);
  if (!kVerbatimSections.contains(section) && (has_numbers(text) || !is_text(text))) {
    source.fail(
        fmt::format("the section ${} from line {} on holds numbers of unknown meaning, which reordering "
                    "could invalidate",
                    section, line - 1),
        "remove it from the file, or rename it to $Comments");
  }
  keep_verbatim(reading, section, begin);
}

void read_nodes(ReadContext& reading, std::string_view section) {
  const bool version_2 = reading.metadata.is_version_2();
  if (section == "ParametricNodes" && !version_2) {
    reading.source.fail("a section $ParametricNodes", "in version 4 it is called $Nodes");
  }
  version_2 || section != "Nodes" ? read_nodes_2(reading, section) : read_nodes_4(reading);
}

void read_elements(ReadContext& reading, std::string_view section) {
  const bool of_old = reading.metadata.is_version_2() || section == "ELM";
  of_old ? read_elements_2(reading, section) : read_elements_4(reading);
}

/// A section that a file has at most once; it must follow a section of the kind `after`.
struct Single {
  std::string_view name;
  SectionKind kind;
  SectionKind after;
  void (*read)(ReadContext&, std::string_view section);
};

constexpr std::array kSingles{
    Single{"Nodes", SectionKind::nodes, SectionKind::format, read_nodes},
    Single{"NOD", SectionKind::nodes, SectionKind::format, read_nodes},
    Single{"NOE", SectionKind::nodes, SectionKind::format, read_nodes},
    Single{"ParametricNodes", SectionKind::nodes, SectionKind::format, read_nodes},
    Single{"Elements", SectionKind::elements, SectionKind::nodes, read_elements},
    Single{"ELM", SectionKind::elements, SectionKind::nodes, read_elements},
    Single{"Periodic", SectionKind::periodic, SectionKind::nodes, read_periodic},
    Single{"GhostElements", SectionKind::ghosts, SectionKind::elements, read_ghosts},
};

void read_single(ReadContext& reading, const Single& single) {
  const std::string name(single.name);
  if (reading.metadata.has(single.kind)) {
    reading.source.fail("a second section $" + name, "a file has one of them");
  }
  if (!reading.metadata.has(single.after)) {
    reading.source.fail("$" + name + " comes before the nodes or elements that it names",
                        "put $Nodes and $Elements first");
  }
  single.read(reading, name);
  reading.metadata.sections.push_back({single.kind, name, "", 0});
}

/// Reads the section `name` after its first line.
void read_section(ReadContext& reading, const std::string& name) {
  NumberReader& source = reading.source;
  if ((name == "NOD" || name == "NOE") && reading.metadata.sections.empty()) {
    reading.metadata.version = 1;  // version 1 has no $MeshFormat
    reading.metadata.sections.push_back({SectionKind::format, "", "", 0});
  }
  const bool has_format = reading.metadata.has(SectionKind::format);
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
    if (!reading.metadata.has(SectionKind::elements)) {
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
    if (!reading.metadata.has(kind)) {
      reading.source.fail("the file has no section " + std::string(name), "it may be cut short");
    }
  }
  if (!reading.metadata.is_version_2()) {
    std::vector<std::int32_t> labels = labels_of_entities(mesh, reading.metadata);
    if (!labels.empty()) keep_array(mesh, kLabel, Association::cells, 1, std::move(labels));
  }
  name_views(reading);
  std::vector<EntitySet> sets = physical_sets(mesh, reading.metadata);
  std::move(sets.begin(), sets.end(), std::back_inserter(mesh.sets));
  mesh.format_metadata = std::make_shared<GmshMetadata>(std::move(reading.metadata));
}

}  // namespace

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

IdMap number_ids(const NumberReader& source, std::vector<std::int64_t>& ids, std::string_view what) {
  for (const std::int64_t id : ids) {
    if (id < 0) source.fail(fmt::format("{} {} has a negative number", what, id), "numbers must be positive");
  }
  IdMap result;
  for (const std::int64_t id : ids) {
    if (!result.add(id)) {
      source.fail(fmt::format("{} {} is given twice", what, id), "each needs a number of its own");
    }
  }
  if (result.runs_from(1)) ids = std::vector<std::int64_t>();  // frees the memory
  return result;
}

void expect_end(ReadContext& reading, std::string_view section) {
  NumberReader& source = reading.source;
  const std::string end = fmt::format("{}{}", reading.metadata.is_version_1() ? "$END" : "$End", section);
  const std::string_view word = source.scanner.peek_word();
  const std::string_view all = source.scanner.all();
  const bool is_cut = word.size() < end.size() && word.data() + word.size() == all.data() + all.size();
  if (word.empty() || is_cut) source.fail("unexpected end of file; expected " + end, "it may be cut short");
  if (word != end && word != fmt::format("$End{}", section)) {
    const std::string found = shown(word);
    if (word.front() == '$' && !same_but_for_case(word.substr(0, 4), "$End")) {
      source.fail(fmt::format("expected {}, found {}", end, found), "end the section before the next one");
    }
    if (word.front() != '$') {
      source.fail(fmt::format("${} continues; expected {}", section, end), "is a count too small?");
    }
    reading.notes.push_back(fmt::format("{}:{}: {} is read as {}; Gmsh itself skips the text after it",
                                        source.scanner.file(), source.scanner.line(), found, end));
  }
  (void)source.scanner.word(end);
}

const ElementType& known_type(const NumberReader& source, std::int64_t number) {
  const ElementType* type = number < 0 || number > 1000 ? nullptr : find_type(static_cast<int>(number));
  if (!type) {
    source.fail("the element type " + std::to_string(number) + " is not supported",
                "types with a fixed number of nodes are supported, such as 4 for tetrahedra");
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
    return keep_array(mesh, kCellType, Association::cells, 1, numbers);
  }
}

void keep_array(Mesh& mesh, std::string_view name, Association association, Index components, Values values) {
  mesh.data.push_back({std::string(name), association, components, std::move(values), {}, {}});
}

void keep_parameters(Mesh& mesh, std::vector<double> values) {
  values.resize(4 * mesh.points.size(), 0.0);
  keep_array(mesh, kNodeParameters, Association::vertices, 4, std::move(values));
  mesh.data.back().component_names = {"given", "u", "v", "w"};
}

}  // namespace meshorder::gmsh
