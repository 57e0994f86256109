// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// VTK's legacy files: https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html
//
// VTK's own writer is not used: in text it keeps 11 digits of a double, and it cuts ids to 32 bits.
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/vtk/vtk.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

namespace meshorder::vtk {
namespace {

/// Returns a name or string with unusual characters written as %XX, as VTK does.
std::string encoded(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 33 || code > 126 || c == '"' || c == '%') {
      result += fmt::format("%{:02X}", code);
    } else {
      result += c;
    }
  }
  return result;
}

/// Returns the section of a POLYDATA file for cells of this type, or −1.
int polydata_section(std::uint8_t type) {
  switch (type) {
    case 1:
    case 2:
      return 0;
    case 3:
    case 4:
      return 1;
    case 5:
    case 7:
    case 9:
      return 2;
    case 6:
      return 3;
    default:
      return -1;
  }
}

/// Returns whether the cells are in the order of POLYDATA's sections and have the types that the sections
/// imply.
bool fits_polydata(const Cells& cells, const std::vector<std::uint8_t>& types) {
  int last = 0;
  for (Index c = 0; c < cells.size(); ++c) {
    const int section = polydata_section(types[c]);
    const int vertices = cells.vertex_count(c);
    const bool ambiguous = (types[c] == 2 && vertices == 1) || (types[c] == 4 && vertices == 2) ||
                           (types[c] == 7 && (vertices == 3 || vertices == 4));
    if (section < last || ambiguous) return false;
    last = section;
  }
  return true;
}

class LegacyWriter {
 public:
  LegacyWriter(const Mesh& mesh, const FilePath& path, Notes& notes)
      : from_(mesh, notes, NamePlace::legacy),
        layout_(from_.metadata.legacy.value_or(LegacyLayout{})),
        out_(path) {
    for (const ArrayRole& role : from_.metadata.roles)
      roles_.try_emplace({role.association, role.array}, &role);
  }

  void write() {
    choose_layout();
    out_.print("# vtk DataFile Version {}\n{}\n{}\nDATASET {}\n", layout_.version,
               layout_.title.substr(0, 255), layout_.binary ? "BINARY" : "ASCII",
               layout_.polydata ? "POLYDATA" : "UNSTRUCTURED_GRID");
    if (!from_.metadata.fields.empty()) {
      out_.print("FIELD FieldData {}\n", from_.metadata.fields.size());
      for (const DataArray& field : from_.metadata.fields) write_field_array(field, {});
    }
    write_points();
    write_cells();
    write_data();
    out_.commit();
  }

 private:
  void choose_layout() {
    const auto numbers =
        from_.mesh.cell_count() +
        static_cast<std::int64_t>(from_.mesh.cells.vertices.size() + from_.metadata.polyhedra.numbers.size());
    if (numbers > kMaxIndex) layout_.version = "5.1";  // older versions count with 32 bits
    offsets_ = layout_.version.front() == '5';
    layout_.polydata = layout_.polydata && fits_polydata(from_.mesh.cells, from_.types);
    if (from_.metadata.legacy && from_.metadata.legacy->polydata && !layout_.polydata) {
      from_.notes.push_back(
          "the file becomes an UNSTRUCTURED_GRID: POLYDATA cannot hold these cells in this order");
    }
    note_xml_parts();
  }

  void note_xml_parts() {
    for (const ArrayRole& role : from_.metadata.roles) {
      const bool known = std::any_of(kLegacyAttributes.begin(), kLegacyAttributes.end(),
                                     [&](const LegacyAttribute& a) { return a.role == role.role; });
      if (known) continue;
      from_.notes.push_back(fmt::format("the array '{}' loses its role: legacy files have no {}", role.array,
                                        kXmlRoles[static_cast<std::size_t>(role.role)]));
    }
    for (const auto& [array, fact] : from_.metadata.facts) {
      if (fact.xml_information.empty()) continue;
      from_.notes.push_back(fmt::format(
          "not written (legacy files store it differently): the information of the array '{}'", fact.array));
    }
  }

  // ---- numbers

  template <class Stored, class Number>
  void write_binary(std::span<const Number> numbers) {
    constexpr std::size_t kAtOnce = 1 << 16;
    std::string bytes;
    for (std::size_t begin = 0; begin < numbers.size(); begin += kAtOnce) {
      const auto part = numbers.subspan(begin, std::min(kAtOnce, numbers.size() - begin));
      bytes.resize(part.size() * sizeof(Stored));
      char* place = bytes.data();
      for (const Number number : part)
        place = put_number(place, static_cast<Stored>(number), std::endian::big);
      out_.write(bytes);
    }
    out_.write("\n");
  }

  template <class Stored, class Number>
  void write_numbers(std::span<const Number> numbers, std::size_t in_line) {
    if (layout_.binary) return write_binary<Stored>(numbers);
    write_lines(out_, numbers.size(), in_line, [&](Text& line, std::string_view before, std::size_t i) {
      line.number(before, static_cast<Stored>(numbers[i]));
    });
  }

  void write_text_value(const std::string& text) {
    if (!layout_.binary) {
      out_.print("{}\n", encoded(text));
      return;
    }
    // the first two bits say how many bytes encode the length
    const std::uint64_t length = text.size();
    if (length < 1U << 6U) {
      out_.binary(static_cast<std::uint8_t>(0xC0U | length));
    } else if (length < 1U << 14U) {
      out_.binary(static_cast<std::uint16_t>(0x8000U | length), std::endian::big);
    } else if (length < 1U << 30U) {
      out_.binary(static_cast<std::uint32_t>(0x40000000U | length), std::endian::big);
    } else {
      out_.binary(length, std::endian::big);
    }
    out_.write(text);
  }

  // ---- arrays

  /// Returns the number type of an array: its type in the file that was read if that type can hold the
  /// values, else the usual type.
  [[nodiscard]] std::string type_of(const DataArray& array, std::optional<Association> association) const {
    const ArrayFacts* facts = find_facts(from_.metadata, association, array.name);
    std::string usual(kLegacyTypeNames[array.values.index()]);
    if (facts == nullptr || facts->type.empty()) return usual;
    const auto is = [&](std::string_view name) { return same_but_for_case(facts->type, name); };
    if (const auto* wide = std::get_if<std::vector<std::int64_t>>(&array.values)) {
      const bool may_be_ids = is("vtkIdType") && fit_32_bits(*wide);
      return is("long") || is("long_long") || may_be_ids ? facts->type : usual;
    }
    const bool kept =
        (is("unsigned_long") && std::holds_alternative<std::vector<std::uint64_t>>(array.values)) ||
        (is("utf8_string") && are_texts(array.values)) ||
        (is("signed_char") && std::holds_alternative<std::vector<std::int8_t>>(array.values));
    return kept ? facts->type : usual;
  }

  void write_values(const DataArray& array, const std::string& type, std::optional<Association> association) {
    std::visit(
        [&](const auto& values) {
          using Number = typename std::decay_t<decltype(values)>::value_type;
          if constexpr (std::is_same_v<Number, std::string>) {
            for (const std::string& text : values) write_text_value(text);
            out_.write("\n");
          } else if (same_but_for_case(type, "vtkIdType")) {
            write_numbers<std::int32_t>(std::span(values), 9);
          } else {
            write_numbers<Number>(std::span(values), 9);
          }
        },
        array.values);
    write_metadata(array, association, array.name);
  }

  void write_metadata(const DataArray& array, std::optional<Association> association, std::string_view name) {
    const ArrayFacts* facts = find_facts(from_.metadata, association, name);
    const bool information = facts != nullptr && !facts->information.empty();
    if (array.component_names.empty() && !information) return;
    out_.write("METADATA\n");
    if (!array.component_names.empty()) {
      out_.write("COMPONENT_NAMES\n");
      for (Index i = 0; i < array.components; ++i) {
        out_.print("{}\n", i < index_size(array.component_names) ? encoded(array.component_names[i]) : "");
      }
    }
    if (information) {
      const std::string begun = "\n" + facts->information;
      std::size_t keys = 0;
      for (auto at = begun.find("\nNAME "); at != std::string::npos; at = begun.find("\nNAME ", at + 1))
        ++keys;
      out_.print("INFORMATION {}\n{}", keys, facts->information);
    }
    out_.write("\n");
  }

  void write_field_array(const DataArray& array, std::optional<Association> association) {
    const std::string type = type_of(array, association);
    out_.print("{} {} {} {}\n", encoded(array.name), array.components, row_count(array), type);
    write_values(array, type, association);
  }

  // ---- points and cells

  void write_points() {
    const bool floats = from_.points_are_floats();
    out_.print("POINTS {} {}\n", from_.mesh.vertex_count(), floats ? "float" : "double");
    if (floats) {
      write_numbers<float>(from_.coordinates(), 3);
    } else {
      write_numbers<double>(from_.coordinates(), 3);
    }
    write_metadata({}, {}, kPoints);
  }

  void write_cells() {
    // before file version 5.1, VTK numbered the nodes of some hexahedra differently
    const Cells& cells =
        from_.cells_with_faces(layout_.version != "5.1" && std::any_of(from_.types.begin(), from_.types.end(),
                                                                       is_higher_order_hexahedron));
    if (!layout_.polydata) {
      write_section("CELLS", cells, 0, cells.size());
      out_.print("CELL_TYPES {}\n", from_.types.size());
      write_numbers<std::int32_t>(std::span<const std::uint8_t>(from_.types), 1);
      return;
    }
    Index begin = 0;
    for (int section = 0; section < 4; ++section) {
      Index end = begin;
      while (end < cells.size() && polydata_section(from_.types[end]) == section) ++end;
      if (end > begin) write_section(kPolydataSections[static_cast<std::size_t>(section)], cells, begin, end);
      begin = end;
    }
  }

  void write_section(std::string_view name, const Cells& cells, Index begin, Index end) {
    const Offset first = cells.offsets[begin];
    const Offset size = cells.offsets[end] - first;
    const std::span<const Index> vertices(cells.vertices.data() + first, static_cast<std::size_t>(size));
    if (offsets_) {
      std::vector<Offset> offsets(cells.offsets.begin() + begin, cells.offsets.begin() + end + 1);
      for (Offset& offset : offsets) offset -= first;
      out_.print("{} {} {}\nOFFSETS vtktypeint64\n", name, offsets.size(), size);
      write_numbers<std::int64_t>(std::span<const Offset>(offsets), 9);
      out_.write("CONNECTIVITY vtktypeint64\n");
      write_numbers<std::int64_t>(vertices, 9);
      return;
    }
    out_.print("{} {} {}\n", name, end - begin, size + end - begin);
    if (!layout_.binary) {
      return write_rows(out_, end - begin, [&](Text& row, Index i) {
        row.integer("", cells.vertex_count(begin + i));
        for (const Index v : cells[begin + i]) row.integer(" ", v);
        row.write("\n");
      });
    }
    for (Index c = begin; c < end; ++c) {
      const std::span<const Index> cell = cells[c];
      char* at = out_.room((1 + cell.size()) * sizeof(std::int32_t));
      at = put_number(at, cells.vertex_count(c), std::endian::big);
      for (const Index v : cell) at = put_number(at, v, std::endian::big);
      out_.written(at);
    }
    out_.write("\n");
  }

  // ---- data

  void write_data() {
    // points first, unless the first array is of cells
    std::array order{Association::vertices, Association::cells};
    if (!from_.arrays.empty() && from_.arrays.front()->association == Association::cells)
      std::swap(order[0], order[1]);
    for (const Association association : order) {
      std::vector<const DataArray*> own;
      std::copy_if(from_.arrays.begin(), from_.arrays.end(), std::back_inserter(own),
                   [&](const DataArray* array) { return array->association == association; });
      const bool tables = std::any_of(layout_.lookup_tables.begin(), layout_.lookup_tables.end(),
                                      [&](const auto& table) { return table.association == association; });
      if (own.empty() && !tables) continue;
      out_.print("{} {}\n", association == Association::vertices ? "POINT_DATA" : "CELL_DATA",
                 item_count(from_.mesh, association));
      write_arrays(own, association);
      for (const auto& table : layout_.lookup_tables) {
        if (table.association == association)
          out_.print("LOOKUP_TABLE {} {}\n{}{}", table.name, table.size, table.content,
                     layout_.binary ? "\n" : "");
      }
    }
  }

  /// Writes each array that has a role under the role's keyword, and each run of other arrays as a FIELD.
  void write_arrays(const std::vector<const DataArray*>& arrays, Association association) {
    for (std::size_t i = 0; i < arrays.size();) {
      if (write_attribute(*arrays[i])) {
        ++i;
        continue;
      }
      std::size_t end = i + 1;
      while (end < arrays.size() && attribute_of(*arrays[end]).first == nullptr) ++end;
      out_.print("FIELD FieldData {}\n", end - i);
      for (; i < end; ++i) write_field_array(*arrays[i], association);
    }
  }

  /// Returns the keyword and the role of an array; both null if it has no role or does not fit the keyword.
  [[nodiscard]] std::pair<const LegacyAttribute*, const ArrayRole*> attribute_of(
      const DataArray& array) const {
    if (array.name.empty()) return {};
    const auto found = roles_.find({array.association, array.name});
    if (found == roles_.end()) return {};
    const ArrayRole* const role = found->second;
    const bool text = are_texts(array.values);
    if (text && role->role != Role::pedigree_ids) return {};
    if (role->role == Role::texture_coordinates && array.components > 3) return {};
    if (role->role == Role::color_scalars) {
      const bool fits = layout_.binary ? std::holds_alternative<std::vector<std::uint8_t>>(array.values)
                                       : std::holds_alternative<std::vector<float>>(array.values);
      if (!fits) return {};
    }
    const auto attribute =
        std::find_if(kLegacyAttributes.begin(), kLegacyAttributes.end(), [&](const LegacyAttribute& a) {
          return a.role == role->role && (a.components == 0 || a.components == array.components);
        });
    if (attribute == kLegacyAttributes.end()) return {};
    return {&*attribute, role};
  }

  bool write_attribute(const DataArray& array) {
    const auto [attribute, role] = attribute_of(array);
    if (attribute == nullptr) return false;
    const std::string type = type_of(array, array.association);
    out_.print("{} {}", attribute->keyword, encoded(array.name));
    switch (attribute->role) {
      case Role::scalars:
        out_.print(" {} {}\nLOOKUP_TABLE {}\n", type, array.components,
                   role->lookup_table.empty() ? "default" : role->lookup_table);
        break;
      case Role::color_scalars:
        out_.print(" {}\n", array.components);
        break;
      case Role::texture_coordinates:
        out_.print(" {} {}\n", array.components, type);
        break;
      default:
        out_.print(" {}\n", type);
    }
    write_values(array, type, array.association);
    return true;
  }

  WriteContext from_;
  LegacyLayout layout_;
  OutputFile out_;
  std::map<std::pair<Association, std::string_view>, const ArrayRole*> roles_;  // roles by their arrays
  bool offsets_ = false;  // whether cells are given by offsets, as since version 5
};

void write_legacy(const Mesh& mesh, const FilePath& path, Notes& notes) {
  LegacyWriter(mesh, path, notes).write();
}

}  // namespace
}  // namespace meshorder::vtk

meshorder::Format meshorder::vtk_format() {
  return {"VTK", {".vtk"}, false, vtk::read_legacy, vtk::write_legacy, vtk::holds};
}
