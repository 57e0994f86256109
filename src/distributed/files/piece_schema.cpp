// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/piece_schema.hpp"

#include "base/text.hpp"
#include "distributed/files/text_store.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

using Role = FilePart::Role;
using Source = PieceArray::Source;

constexpr std::string_view kPointIds = "GlobalPointIds";
constexpr std::string_view kCellIds = "GlobalCellIds";
constexpr std::string_view kGhostType = "vtkGhostType";
constexpr std::string_view kPart = "part";
constexpr std::string_view kGlobalIds = "GlobalIds";  // VTK's name of the role

/// Tags of a piece's sections, in their order.
constexpr std::array<std::string_view, 4> kSections{"PointData", "CellData", "Points", "Cells"};

/// Returns the index of an array's section in `kSections`.
std::size_t section_of(const PieceArray& array) {
  return (array.role == Role::data ? 0U : 2U) + (array.is_on_vertices() ? 0U : 1U);
}

/// Returns the attributes of an element, except those in `left_out`, as text for a tag.
template <std::size_t N>
std::string attributes_without(const vtk::VtuElement& element,
                               const std::array<std::string_view, N>& left_out) {
  std::string text;
  for (const vtk::VtuAttribute& own : element.attributes) {
    if (std::find(left_out.begin(), left_out.end(), own.name) == left_out.end())
      text += fmt::format(" {}=\"{}\"", own.name, xml_escaped(own.value));
  }
  return text;
}

bool is_of_pieces(std::string_view name, Association association) {
  return name == kGhostType || name == kPart ||
         name == (association == Association::vertices ? kPointIds : kCellIds);
}

/// Returns an array that only the pieces have.
PieceArray added(Association association, Source source, std::string_view type, std::string_view name,
                 std::string_view more = "") {
  const auto* const known = std::find(vtk::kXmlTypeNames.begin(), vtk::kXmlTypeNames.end(), type);
  return {{.association = association, .type = static_cast<std::uint8_t>(known - vtk::kXmlTypeNames.begin())},
          source,
          std::string(name),
          fmt::format(" type=\"{}\"{} Name=\"{}\"", type, more, name),
          {}};
}

/// Returns the pieces' array for the k-th array of the mesh's file, which is `element` in this section.
PieceArray taken(const vtk::VtuDocument& file, const vtk::VtuElement& element, std::size_t section,
                 std::size_t k) {
  constexpr std::array<std::string_view, 5> kOfValues{"format", "offset", "RangeMin", "RangeMax",
                                                      "NumberOfTuples"};
  constexpr std::uint8_t kInt32 = 6;
  PieceArray array;
  array.association = section % 2 == 0 ? Association::vertices : Association::cells;
  array.type = static_cast<std::uint8_t>(element.number_type());
  array.components = static_cast<Index>(file.components(element));
  array.number = k;
  array.name = element.text_of("Name");
  array.attributes = attributes_without(element, kOfValues);
  if (size_of_type(array.type) == 0) {
    array.source = Source::texts;
    array.type = kInt32;
  }
  if (section >= 2) array.role = array.is_on_vertices() ? Role::points : Role::types;
  if (array.role == Role::types && array.name == "connectivity") {
    array.role = Role::connectivity;
    array.source = Source::connectivity;
  } else if (array.role == Role::types && array.name == "offsets") {
    array.role = Role::offsets;
    array.source = Source::offsets;
  }
  for (const vtk::VtuElement& information : element.children) array.inside += file.source(information);
  return array;
}

}  // namespace

PieceSchema::PieceSchema(const std::string& xml, std::string fields, int ghosts)
    : fields_(std::move(fields)), ghosts_(ghosts) {
  TextStore store(xml);
  const vtk::VtuDocument file(FilePath("mesh.vtu", store));
  version_ = file.root().text_of("version");
  if (version_.empty()) version_ = "0.1";
  word_ = file.encoding().wide_headers ? 8 : 4;
  has_order_of_vtk_9_ = file.version() >= 21;
  const vtk::VtuElement* const of_file = file.root().child("UnstructuredGrid")->child("FieldData");
  if (fields_.empty() && of_file != nullptr) fields_ = file.source(*of_file);
  std::size_t number = 0;
  for (const vtk::VtuElement& section : file.root().child("UnstructuredGrid")->child("Piece")->children) {
    const auto known = static_cast<std::size_t>(std::find(kSections.begin(), kSections.end(), section.name) -
                                                kSections.begin());
    const Association association = known % 2 == 0 ? Association::vertices : Association::cells;
    if (known < 2) {
      attributes_.at(known) = attributes_without(section, std::array{kGlobalIds});
      add_roles(section, association);
    }
    for (const vtk::VtuElement& element : section.children) {
      const std::size_t k = number++;
      if (known == kSections.size()) continue;
      if (known < 2 && is_of_pieces(element.text_of("Name"), association)) {
        replaced_.push_back(
            fmt::format("on {} '{}'", known == 0 ? "points" : "cells", element.text_of("Name")));
        continue;
      }
      arrays_.push_back(taken(file, element, known, k));
    }
  }
  for (const Association association : {Association::vertices, Association::cells}) {
    const std::string_view ids = association == Association::vertices ? kPointIds : kCellIds;
    arrays_.push_back(added(association, Source::global_ids, "Int64", ids, " IdType=\"1\""));
    arrays_.push_back(added(association, Source::ghost_type, "UInt8", kGhostType));
    arrays_.push_back(added(association, Source::part, "Int32", kPart));
    roles_.push_back({vtk::Role::global_ids, association, std::string(ids), {}});
    attributes_.at(association == Association::vertices ? 0 : 1) +=
        fmt::format(" {}=\"{}\"", kGlobalIds, ids);
  }
  std::stable_sort(arrays_.begin(), arrays_.end(),
                   [](const PieceArray& a, const PieceArray& b) { return section_of(a) < section_of(b); });
}

/// Adds the roles of a section's arrays, except that of global ids: pieces have global ids of their own.
void PieceSchema::add_roles(const vtk::VtuElement& section, Association association) {
  for (std::size_t role = 0; role < vtk::kXmlRoles.size(); ++role) {
    const std::string_view name = section.text_of(vtk::kXmlRoles[role]);
    if (name.empty() || vtk::kXmlRoles[role] == kGlobalIds) continue;
    roles_.push_back({static_cast<vtk::Role>(role), association, std::string(name), {}});
  }
}

std::string PieceSchema::opening(const char* type) const {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"{}\" byte_order=\"{}\" header_type=\"{}\">\n",
      type, xml_escaped(version_), std::endian::native == std::endian::big ? "BigEndian" : "LittleEndian",
      word_ == 8 ? "UInt64" : "UInt32");
}

template <class Element>
std::string PieceSchema::section_text(std::size_t section, std::string_view indent, std::string_view prefix,
                                      const Element& element) const {
  std::string text =
      fmt::format("{}<{}{}{}>\n", indent, prefix, kSections.at(section), attributes_.at(section));
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    if (section_of(arrays_[k]) != section) continue;
    const char* const tag = arrays_[k].source == Source::texts ? "Array" : "DataArray";
    text += fmt::format("{}  {}\n", indent, element(tag, arrays_[k], k));
  }
  return text + fmt::format("{}</{}{}>\n", indent, prefix, kSections.at(section));
}

std::string PieceSchema::head(GlobalIndex vertices, GlobalIndex cells,
                              const std::vector<Offset>& sizes) const {
  std::vector<Offset> begins(1, 0);
  for (const Offset size : sizes) begins.push_back(begins.back() + word_ + size);
  std::string text = opening("UnstructuredGrid") + "  <UnstructuredGrid>\n";
  if (!fields_.empty()) text += "    " + fields_ + "\n";
  text += fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", vertices, cells);
  for (std::size_t section = 0; section < kSections.size(); ++section) {
    text += section_text(
        section, "      ", "", [&](std::string_view tag, const PieceArray& array, std::size_t k) {
          const std::string end = array.inside.empty() ? "/>" : fmt::format(">{}</{}>", array.inside, tag);
          return fmt::format("<{}{} format=\"appended\" offset=\"{}\"{}", tag, array.attributes, begins[k],
                             end);
        });
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
  for (std::size_t section = 0; section < 3; ++section) {  // all but the cells
    text +=
        section_text(section, "    ", "P", [](std::string_view tag, const PieceArray& array, std::size_t) {
          return fmt::format("<P{}{}/>", tag, array.attributes);
        });
  }
  for (const std::string& file : files)
    text += fmt::format("    <Piece Source=\"{}\"/>\n", xml_escaped(file));
  return text + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace meshorder::distributed
