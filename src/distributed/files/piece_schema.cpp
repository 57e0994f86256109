// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/piece_schema.hpp"

#include "base/text.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/text_store.hpp"
#include "io/vtk/vtu_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

using Section = PieceArray::Section;
using Source = PieceArray::Source;

constexpr std::string_view kPointIds = "GlobalPointIds";
constexpr std::string_view kCellIds = "GlobalCellIds";
constexpr std::string_view kGhostType = "vtkGhostType";
constexpr std::string_view kPart = "part";
constexpr std::string_view kGlobalIds = "GlobalIds";  // VTK's name of the role

/// Tags of the sections, in the order of Section and of a piece.
constexpr std::array<std::string_view, 4> kSections{"PointData", "CellData", "Points", "Cells"};

/// Returns the attributes of an element, except some, in the form of a tag.
template <std::size_t N>
std::string attributes_without(const vtk::VtuElement& element,
                               const std::array<std::string_view, N>& left_out) {
  std::string text;
  for (const auto& [name, value] : element.attributes) {
    if (std::find(left_out.begin(), left_out.end(), name) == left_out.end())
      text += fmt::format(" {}=\"{}\"", name, xml_escaped(value));
  }
  return text;
}

std::string_view name_of(const vtk::VtuElement& element) {
  const std::string* const name = element.attribute("Name");
  return name == nullptr ? std::string_view() : *name;
}

std::uint8_t type_of(const vtk::VtuElement& element) {
  const std::string* const type = element.attribute("type");
  const auto* const known = std::find(vtk::kXmlTypeNames.begin(), vtk::kXmlTypeNames.end(),
                                      type == nullptr ? std::string_view() : *type);
  return static_cast<std::uint8_t>(known - vtk::kXmlTypeNames.begin());
}

Offset components_of(const vtk::VtuElement& element) {
  const std::string* const text = element.attribute("NumberOfComponents");
  Offset components = 1;
  if (text != nullptr) std::from_chars(text->data(), text->data() + text->size(), components);
  return components;
}

/// Returns the section with that tag; nothing for other tags.
std::optional<Section> section_named(std::string_view name) {
  const auto* const found = std::find(kSections.begin(), kSections.end(), name);
  if (found == kSections.end()) return std::nullopt;
  return static_cast<Section>(found - kSections.begin());
}

bool is_of_pieces(std::string_view name, Section section) {
  return name == kGhostType || name == kPart ||
         name == (section == Section::points_data ? kPointIds : kCellIds);
}

/// Returns an array that only the pieces have.
PieceArray added(Section section, Source source, std::string_view type, std::string_view name,
                 std::string_view more = "") {
  const auto* const known = std::find(vtk::kXmlTypeNames.begin(), vtk::kXmlTypeNames.end(), type);
  const auto alternative = static_cast<std::uint8_t>(known - vtk::kXmlTypeNames.begin());
  return {section,
          source,
          std::string(name),
          0,
          alternative,
          size_of_type(alternative),
          fmt::format(" type=\"{}\"{} Name=\"{}\"", type, more, name),
          {}};
}

/// Returns the k-th array of the mesh as an array of the pieces.
PieceArray taken(const vtk::VtuDocument& file, const vtk::VtuElement& element, Section section,
                 std::size_t k) {
  constexpr std::array<std::string_view, 5> kOfValues{"format", "offset", "RangeMin", "RangeMax",
                                                      "NumberOfTuples"};
  PieceArray array{section,
                   Source::rows,
                   std::string(name_of(element)),
                   k,
                   type_of(element),
                   0,
                   attributes_without(element, kOfValues),
                   {}};
  if (section == Section::cells && name_of(element) == "connectivity") array.source = Source::connectivity;
  if (section == Section::cells && name_of(element) == "offsets") array.source = Source::offsets;
  Offset number = size_of_type(array.type);
  if (number == 0) {
    array.source = Source::texts;
    number = sizeof(std::int32_t);
  }
  array.row = number * components_of(element);
  for (const vtk::VtuElement& information : element.children) array.inside += file.source(information);
  return array;
}

}  // namespace

PieceSchema::PieceSchema(const std::string& xml, std::string fields, int ghosts)
    : fields_(std::move(fields)), ghosts_(ghosts) {
  TextStore store(xml);
  const vtk::VtuDocument file(FilePath("mesh.vtu", store));
  const std::string* const version = file.root().attribute("version");
  version_ = version == nullptr ? "0.1" : *version;
  word_ = file.encoding().wide_headers ? 8 : 4;
  has_order_of_vtk_9_ = file.version() >= 21;
  std::size_t number = 0;
  for (const vtk::VtuElement& section : file.root().child("UnstructuredGrid")->child("Piece")->children) {
    const std::optional<Section> known = section_named(section.name);
    if (known == Section::points_data || known == Section::cells_data) {
      (known == Section::points_data ? points_data_ : cells_data_) =
          attributes_without(section, std::array{kGlobalIds});
      add_roles(section, *known);
    }
    for (const vtk::VtuElement& element : section.children) {
      const std::size_t k = number++;
      if (!known) continue;
      if (section.name.ends_with("Data") && is_of_pieces(name_of(element), *known)) {
        replaced_.push_back(
            fmt::format("on {} '{}'", known == Section::points_data ? "points" : "cells", name_of(element)));
        continue;
      }
      arrays_.push_back(taken(file, element, *known, k));
    }
  }
  constexpr std::string_view kIdType = " IdType=\"1\"";
  for (const auto& [section, ids] :
       {std::pair{Section::points_data, kPointIds}, {Section::cells_data, kCellIds}}) {
    arrays_.push_back(added(section, Source::global_ids, "Int64", ids, kIdType));
    arrays_.push_back(added(section, Source::ghost_type, "UInt8", kGhostType));
    arrays_.push_back(added(section, Source::part, "Int32", kPart));
  }
  for (const Association association : {Association::vertices, Association::cells}) {
    const std::string_view ids = association == Association::vertices ? kPointIds : kCellIds;
    roles_.push_back({vtk::Role::global_ids, association, std::string(ids), {}});
  }
  points_data_ += fmt::format(" {}=\"{}\"", kGlobalIds, kPointIds);
  cells_data_ += fmt::format(" {}=\"{}\"", kGlobalIds, kCellIds);
  std::stable_sort(arrays_.begin(), arrays_.end(),
                   [](const PieceArray& a, const PieceArray& b) { return a.section < b.section; });
}

/// Adds the roles of a section's arrays, except that of global ids, which are the pieces' own.
void PieceSchema::add_roles(const vtk::VtuElement& section, Section kind) {
  for (std::size_t role = 0; role < vtk::kXmlRoles.size(); ++role) {
    const std::string* const name = section.attribute(vtk::kXmlRoles[role]);
    if (name == nullptr || name->empty() || vtk::kXmlRoles[role] == kGlobalIds) continue;
    const Association association = kind == Section::points_data ? Association::vertices : Association::cells;
    roles_.push_back({static_cast<vtk::Role>(role), association, *name, {}});
  }
}

std::string PieceSchema::opening(const char* type) const {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"{}\" byte_order=\"{}\" header_type=\"{}\">\n",
      type, xml_escaped(version_), std::endian::native == std::endian::big ? "BigEndian" : "LittleEndian",
      word_ == 8 ? "UInt64" : "UInt32");
}

template <class Write>
void PieceSchema::write_section(Section section, const Write& write) const {
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    if (arrays_[k].section == section)
      write(arrays_[k].source == Source::texts ? "Array" : "DataArray", arrays_[k], k);
  }
}

std::string PieceSchema::head(GlobalIndex vertices, GlobalIndex cells,
                              const std::vector<Offset>& sizes) const {
  std::vector<Offset> begins(1, 0);
  for (const Offset size : sizes) begins.push_back(begins.back() + word_ + size);
  std::string text = opening("UnstructuredGrid") + "  <UnstructuredGrid>\n";
  if (!fields_.empty()) text += "    " + fields_ + "\n";
  text += fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", vertices, cells);
  for (std::size_t s = 0; s < kSections.size(); ++s) {
    const auto section = static_cast<Section>(s);
    text += fmt::format("      <{}{}>\n", kSections[s],
                        section == Section::points_data  ? points_data_
                        : section == Section::cells_data ? cells_data_
                                                         : "");
    write_section(section, [&](std::string_view tag, const PieceArray& array, std::size_t k) {
      text +=
          fmt::format("        <{}{} format=\"appended\" offset=\"{}\"", tag, array.attributes, begins[k]);
      text += array.inside.empty() ? "/>\n" : fmt::format(">{}</{}>\n", array.inside, tag);
    });
    text += fmt::format("      </{}>\n", kSections[s]);
  }
  text += "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_";
  return text;
}

std::string PieceSchema::fields_alone() const {
  return opening("UnstructuredGrid") + "<UnstructuredGrid>" + fields_ + "</UnstructuredGrid></VTKFile>\n";
}

std::string PieceSchema::index(const std::vector<std::string>& files) const {
  std::string text =
      opening("PUnstructuredGrid") + fmt::format("  <PUnstructuredGrid GhostLevel=\"{}\">\n", ghosts_);
  for (const Section section : {Section::points_data, Section::cells_data, Section::points}) {
    const std::string_view name = kSections[static_cast<std::size_t>(section)];
    text += fmt::format("    <P{}{}>\n", name,
                        section == Section::points_data  ? points_data_
                        : section == Section::cells_data ? cells_data_
                                                         : "");
    write_section(section, [&](std::string_view tag, const PieceArray& array, std::size_t /*k*/) {
      text += fmt::format("      <P{}{}/>\n", tag, array.attributes);
    });
    text += fmt::format("    </P{}>\n", name);
  }
  for (const std::string& file : files)
    text += fmt::format("    <Piece Source=\"{}\"/>\n", xml_escaped(file));
  return text + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace meshorder::distributed
