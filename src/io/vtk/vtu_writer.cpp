// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Writer of VTK's XML files of unstructured grids:
// https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
//
// VTK's own writer (9.1) is not used: it writes names with & or < as they are, which is not XML, crashes on
// pedigree ids that are strings, and does not notice a full disk when it closes a file.
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/stream/base64.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_compressor.hpp"
#include "io/vtk/vtu_document.hpp"
#include "io/vtu.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

namespace meshorder::vtk {
namespace {

using Mode = VtuEncoding::Mode;
using Compressor = VtuEncoding::Compressor;

using Numbers =
    std::variant<std::span<const double>, std::span<const float>, std::span<const std::int8_t>,
                 std::span<const std::uint8_t>, std::span<const std::int16_t>, std::span<const std::uint16_t>,
                 std::span<const std::int32_t>, std::span<const std::uint32_t>, std::span<const std::int64_t>,
                 std::span<const std::uint64_t>, std::span<const char>>;

/// An array of the file: its tag and its numbers; for strings, the codes of their characters.
struct Array {
  std::string tag;  // tag without its format attribute and its end
  Numbers numbers;
  std::string information;
  std::vector<std::string> compressed;  // blocks of appended arrays
  std::uint64_t offset = 0;
};

/// An element of the file that holds arrays.
struct ArraySection {
  std::string_view name;
  std::string attributes;
  std::vector<Array> arrays;
};

class VtuWriter {
 public:
  VtuWriter(const Mesh& mesh, const FilePath& path, Notes& notes)
      : from_(mesh, notes, NamePlace::xml),
        encoding_(from_.metadata.vtu.value_or(VtuEncoding{})),
        out_(path) {
    if (VtuCompressor::available(encoding_.compressor)) return;
    if (encoding_.mode != Mode::ascii)
      notes.push_back(fmt::format("written without compression: this build of meshorder lacks {} ({}=ON)",
                                  VtuCompressor::library(encoding_.compressor),
                                  VtuCompressor::option(encoding_.compressor)));
    encoding_.compressor = Compressor::none;
  }

  void write() {
    note_legacy_parts();
    collect();
    choose_headers();
    if (appended()) place();
    write_header();
    for (const ArraySection& section : sections_) write_section(section);
    out_.write("    </Piece>\n  </UnstructuredGrid>\n");
    if (appended()) write_appended();
    out_.write("</VTKFile>\n");
    out_.commit();
  }

 private:
  [[nodiscard]] bool appended() const {
    return encoding_.mode == Mode::appended_base64 || encoding_.mode == Mode::appended_raw;
  }
  [[nodiscard]] bool coded() const { return encoding_.mode != Mode::appended_raw; }
  [[nodiscard]] std::size_t header_size() const { return encoding_.wide_headers ? 8 : 4; }

  void note_legacy_parts() {
    if (from_.metadata.legacy) {
      for (const auto& table : from_.metadata.legacy->lookup_tables)
        from_.notes.push_back("not written (VTU cannot hold it): the lookup table '" + table.name + "'");
    }
    for (const auto& [array, fact] : from_.metadata.facts) {
      if (!fact.information.empty())
        from_.notes.push_back("not written (VTU files store it differently): the information of the array '" +
                              fact.array + "'");
    }
  }

  // ---- arrays

  void collect() {
    if (!from_.metadata.fields.empty()) {
      ArraySection& fields = sections_.emplace_back(ArraySection{"FieldData", "", {}});
      for (const DataArray& field : from_.metadata.fields) fields.arrays.push_back(array_of(field, {}));
    }
    collect_data(Association::vertices);
    collect_data(Association::cells);
    sections_.push_back({"Points", "", {points()}});
    sections_.push_back({"Cells", "", cells()});
  }

  void collect_data(Association association) {
    ArraySection section{
        association == Association::vertices ? "PointData" : "CellData", roles(association), {}};
    for (const DataArray* array : from_.arrays) {
      if (array->association == association) section.arrays.push_back(array_of(*array, association));
    }
    sections_.push_back(std::move(section));
  }

  /// Returns the attributes that name the arrays with roles.
  [[nodiscard]] std::string roles(Association association) const {
    std::string result;
    for (std::size_t role = 0; role < kXmlRoles.size(); ++role) {
      const ArrayRole* const found = from_.role(association, static_cast<Role>(role));
      if (found != nullptr) result += fmt::format(" {}=\"{}\"", kXmlRoles[role], xml_escaped(found->array));
    }
    return result;
  }

  Array array_of(const DataArray& array, std::optional<Association> association) {
    Array result;
    const bool text = are_texts(array.values);
    const ArrayFacts* facts = find_facts(from_.metadata, association, array.name);
    result.tag =
        fmt::format("<{} type=\"{}\"", text ? "Array" : "DataArray", kXmlTypeNames[array.values.index()]);
    if (facts != nullptr && facts->type == "vtkIdType" &&
        std::holds_alternative<std::vector<std::int64_t>>(array.values))
      result.tag += " IdType=\"1\"";
    result.tag += fmt::format(" Name=\"{}\"", xml_escaped(array.name));
    if (array.components != 1) result.tag += fmt::format(" NumberOfComponents=\"{}\"", array.components);
    for (std::size_t i = 0; i < array.component_names.size(); ++i) {
      if (!array.component_names[i].empty())
        result.tag += fmt::format(" ComponentName{}=\"{}\"", i, xml_escaped(array.component_names[i]));
    }
    if (!association) result.tag += fmt::format(" NumberOfTuples=\"{}\"", row_count(array));
    if (facts != nullptr) result.information = facts->xml_information;
    std::visit(
        [&](const auto& values) {
          using Number = typename std::decay_t<decltype(values)>::value_type;
          if constexpr (std::is_same_v<Number, std::string>) {
            // each text ends with a zero
            auto characters = std::make_shared<std::string>();
            for (const std::string& value : values)
              characters->append(value.substr(0, value.find('\0'))).push_back('\0');
            texts_.push_back(characters);
            result.numbers = std::span<const char>(*characters);
          } else {
            result.numbers = std::span<const Number>(values);
          }
        },
        array.values);
    return result;
  }

  Array points() {
    Numbers numbers = from_.coordinates();
    if (from_.points_are_floats()) {
      float_points_.assign(from_.coordinates().begin(), from_.coordinates().end());
      numbers = std::span<const float>(float_points_);
    }
    Array result = named("Points", numbers);
    result.tag += " NumberOfComponents=\"3\"";
    return result;
  }

  /// Returns the arrays of the cells. VTK requires the same number type for vertices and ends.
  std::vector<Array> cells() {
    const Cells& cells = from_.cells();
    Numbers vertices = std::span<const std::int32_t>(cells.vertices);
    Numbers ends = std::span<const std::int64_t>(cells.offsets).subspan(1);
    if (cells.offsets.back() <= kMaxIndex) {
      ends_.assign(cells.offsets.begin() + 1, cells.offsets.end());
      ends = std::span<const std::int32_t>(ends_);
    } else {
      wide_vertices_.assign(cells.vertices.begin(), cells.vertices.end());
      vertices = std::span<const std::int64_t>(wide_vertices_);
    }
    std::vector<Array> result{named("connectivity", vertices), named("offsets", ends),
                              named("types", std::span<const std::uint8_t>(from_.types))};
    if (from_.metadata.polyhedra.are_by_face) {
      add_polyhedra_by_face(result);
    } else if (!from_.metadata.polyhedra.empty()) {
      add_streams_of_faces(result);
    }
    return result;
  }

  static Array named(std::string_view name, Numbers numbers) {
    Array array;
    array.tag = fmt::format("<DataArray type=\"{}\" Name=\"{}\"", kXmlTypeNames[numbers.index()], name);
    array.numbers = numbers;
    return array;
  }

  /// Adds the faces of polyhedra as VTK wrote them up to 9.3.
  void add_streams_of_faces(std::vector<Array>& cells) {
    const Polyhedra& polyhedra = from_.metadata.polyhedra;
    for (Index c = 0; c < from_.mesh.cell_count(); ++c) {
      face_numbers_[1].push_back(from_.types[c] == kPolyhedron ? polyhedra.starts[c + 1] : -1);
    }
    cells.push_back(named("faces", std::span<const std::int32_t>(polyhedra.numbers)));
    cells.push_back(named("faceoffsets", std::span<const std::int64_t>(face_numbers_[1])));
  }

  /// Adds the faces of polyhedra as VTK writes them since 9.4; polyhedra do not share faces.
  void add_polyhedra_by_face(std::vector<Array>& cells) {
    auto& [corners, corner_ends, faces, face_ends] = face_numbers_;
    for (Index c = 0; c < from_.mesh.cell_count(); ++c) {
      const auto add = [&corners = corners, &corner_ends = corner_ends,
                        &faces = faces](std::span<const Index> face) {
        corners.insert(corners.end(), face.begin(), face.end());
        corner_ends.push_back(std::ssize(corners));
        faces.push_back(std::ssize(faces));
      };
      for_faces(from_.metadata.polyhedra[c], add);
      face_ends.push_back(std::ssize(faces));
    }
    constexpr std::array kNames{"face_connectivity", "face_offsets", "polyhedron_to_faces",
                                "polyhedron_offsets"};
    for (std::size_t k = 0; k < kNames.size(); ++k)
      cells.push_back(named(kNames[k], std::span<const std::int64_t>(face_numbers_[k])));
  }

  // ---- bytes

  static std::uint64_t byte_count(const Array& array) {
    return std::visit([](const auto& numbers) { return std::uint64_t{numbers.size_bytes()}; }, array.numbers);
  }

  static std::uint64_t block_count(const Array& array) {
    return (byte_count(array) + VtuCompressor::kBlock - 1) / VtuCompressor::kBlock;
  }

  /// Returns the bytes of a block of an array, in the byte order of the file; `room` stores them if the
  /// machine has another byte order.
  std::span<const char> block_of(const Array& array, std::uint64_t block, std::vector<char>& room) const {
    return std::visit(
        [&](const auto& numbers) {
          using Number = typename std::decay_t<decltype(numbers)>::value_type;
          constexpr std::size_t kAtOnce = VtuCompressor::kBlock / sizeof(Number);
          const std::size_t begin = block * kAtOnce;
          const auto part = numbers.subspan(begin, std::min(kAtOnce, numbers.size() - begin));
          if (encoding_.order == std::endian::native || sizeof(Number) == 1)
            return std::span<const char>(reinterpret_cast<const char*>(part.data()), part.size_bytes());
          room.resize(part.size_bytes());
          char* at = room.data();
          for (const Number number : part) at = put_number(at, number, encoding_.order);
          return std::span<const char>(room);
        },
        array.numbers);
  }

  [[nodiscard]] std::vector<std::string> compressed(const Array& array) const {
    std::vector<std::string> blocks(block_count(array));
    const VtuCompressor compressor(encoding_.compressor);
    parallel_loop(blocks.size(), [&](std::size_t b) {
      std::vector<char> room;
      blocks[b] = compressor.compress(block_of(array, b, room));
    });
    return blocks;
  }

  /// Returns the header of compressed blocks: the number of blocks, the size of a full block, the size of the
  /// last block if it is shorter (else 0), and the compressed size of each block.
  [[nodiscard]] std::string block_header(const Array& array, const std::vector<std::string>& blocks) const {
    std::vector<std::uint64_t> values{blocks.size(), VtuCompressor::kBlock,
                                      byte_count(array) % VtuCompressor::kBlock};
    for (const std::string& block : blocks) values.push_back(block.size());
    return vtu_words(values, encoding_);
  }

  void write_bytes(const Array& array) {
    if (encoding_.compressor != Compressor::none) {
      const std::vector<std::string> blocks = appended() ? array.compressed : compressed(array);
      write_coded([&](const auto& put) { put(block_header(array, blocks)); });
      write_coded([&](const auto& put) {
        for (const std::string& block : blocks) put(block);
      });
    } else {
      write_coded([&](const auto& put) {
        put(vtu_words({byte_count(array)}, encoding_));
        std::vector<char> room;
        for (std::uint64_t b = 0; b < block_count(array); ++b) put(block_of(array, b, room));
      });
    }
  }

  /// Writes the bytes that `produce` puts, raw or as one base64 text.
  template <class Produce>
  void write_coded(const Produce& produce) {
    if (!coded()) {
      produce([&](std::span<const char> bytes) { out_.write({bytes.data(), bytes.size()}); });
      return;
    }
    Base64Encoder base64;
    produce([&](std::span<const char> bytes) { out_.write(base64.put(bytes)); });
    out_.write(base64.finish());
  }

  /// Writes numbers as text, six in a line.
  void write_text(const Array& array) {
    std::visit(
        [&](const auto& numbers) {
          using Number = std::decay_t<decltype(numbers[0])>;
          using Shown = std::conditional_t<std::is_same_v<Number, char>, unsigned char, Number>;
          write_lines(out_, numbers.size(), 6, [&](Text& line, std::string_view before, std::size_t i) {
            line.number(before, static_cast<Shown>(numbers[i]));
          });
        },
        array.numbers);
  }

  // ---- the file

  void choose_headers() {
    for (const ArraySection& section : sections_) {
      for (const Array& array : section.arrays) {
        if (byte_count(array) > 0xFFFFFFFFU) encoding_.wide_headers = true;
      }
    }
  }

  /// Computes the offsets of appended arrays, which it first compresses if the file has a compressor.
  void place() {
    std::uint64_t offset = 0;
    for (ArraySection& section : sections_) {
      for (Array& array : section.arrays) {
        array.offset = offset;
        const auto length = [&](std::uint64_t bytes) { return coded() ? base64_length(bytes) : bytes; };
        if (encoding_.compressor == Compressor::none) {
          offset += length(header_size() + byte_count(array));
          continue;
        }
        array.compressed = compressed(array);
        std::uint64_t bytes = 0;
        for (const std::string& block : array.compressed) bytes += block.size();
        offset += length((3 + array.compressed.size()) * header_size()) + length(bytes);
      }
    }
  }

  void write_header() {
    // polyhedra by face need version 2.3, VTK 9's order of nodes 2.1 or later, wide headers 1.0 or later
    const bool order = std::any_of(from_.types.begin(), from_.types.end(), is_higher_order_hexahedron);
    out_.print(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"{}\" byte_order=\"{}\" "
        "header_type=\"{}\"",
        from_.metadata.polyhedra.are_by_face ? "2.3"
        : order                              ? "2.2"
        : encoding_.wide_headers             ? "1.0"
                                             : "0.1",
        encoding_.order == std::endian::big ? "BigEndian" : "LittleEndian",
        encoding_.wide_headers ? "UInt64" : "UInt32");
    if (encoding_.compressor != Compressor::none)
      out_.print(" compressor=\"{}\"", kCompressors[static_cast<std::size_t>(encoding_.compressor)]);
    out_.write(">\n  <UnstructuredGrid>\n");
  }

  void write_section(const ArraySection& section) {
    if (section.name == "PointData")
      out_.print("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", from_.mesh.vertex_count(),
                 from_.mesh.cell_count());
    const std::string_view indent = section.name == "FieldData" ? "    " : "      ";
    out_.print("{}<{}{}>\n", indent, section.name, section.attributes);
    for (const Array& array : section.arrays) {
      out_.print("        {} format=\"", array.tag);
      if (appended()) {
        out_.print("appended\" offset=\"{}\"", array.offset);
        if (array.information.empty()) {
          out_.write("/>\n");
          continue;
        }
        out_.write(">\n");
      } else if (encoding_.mode == Mode::ascii) {
        out_.write("ascii\">\n");
        write_text(array);
      } else {
        out_.write("binary\">\n");
        write_bytes(array);
        out_.write("\n");
      }
      out_.print("{}        </{}>\n", array.information,
                 array.tag.starts_with("<Array") ? "Array" : "DataArray");
    }
    out_.print("{}</{}>\n", indent, section.name);
  }

  void write_appended() {
    out_.print("  <AppendedData encoding=\"{}\">\n_", coded() ? "base64" : "raw");
    for (const ArraySection& section : sections_) {
      for (const Array& array : section.arrays) write_bytes(array);
    }
    out_.write("\n  </AppendedData>\n");
  }

  WriteContext from_;
  VtuEncoding encoding_;
  OutputFile out_;
  std::vector<ArraySection> sections_;

  // numbers of arrays that the writer makes
  std::vector<std::shared_ptr<std::string>> texts_;
  std::vector<float> float_points_;
  std::vector<std::int32_t> ends_;
  std::vector<std::int64_t> wide_vertices_;
  std::array<std::vector<std::int64_t>, 4> face_numbers_;  ///< the numbers of the arrays of polyhedra
};

}  // namespace

void write_vtu(const Mesh& mesh, const FilePath& path, Notes& notes) { VtuWriter(mesh, path, notes).write(); }

}  // namespace meshorder::vtk

void meshorder::write_pvd(std::span<const PvdEntry> entries, const FilePath& path) {
  OutputFile out(path);
  out.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n");
  for (const PvdEntry& entry : entries) {
    if (!std::isfinite(entry.time))
      throw InvalidArgument("collection: the time of '" + entry.file + "' is not finite");
    out.print("    <DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", entry.time,
              xml_escaped(entry.file));
  }
  out.write("  </Collection>\n</VTKFile>\n");
  out.commit();
}

meshorder::Format meshorder::vtu_format() {
  return {"VTU", {".vtu", ".pvtu"}, false, vtk::read_vtu, vtk::write_vtu, vtk::holds};
}
