// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/moved_file.hpp"

#include "base/checksum.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/appended_arrays.hpp"
#include "distributed/files/file_rows.hpp"
#include "distributed/files/shared_file.hpp"
#include "distributed/files/text_store.hpp"
#include "distributed/order/cell_order.hpp"
#include "io/stream/base64.hpp"
#include "io/stream/read_limits.hpp"
#include "io/vtk/vtu_compressor.hpp"
#include "io/vtk/vtu_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

using Role = FilePart::Role;

constexpr std::string_view kEndOfHead = "</AppendedData></VTKFile>";
constexpr Offset kChunk = Offset{1} << 24;  // bytes that are copied at a time

/// Copies bytes begin … end − 1 of a file to another; only the root copies.
void copy_bytes(const Communicator& communicator, const SharedFile& in, Offset begin, Offset end,
                const SharedFile& out, Offset to) {
  std::vector<std::byte> bytes;
  for (Offset at = begin; at < end; at += kChunk) {
    if (communicator.is_root()) bytes.resize(static_cast<std::size_t>(std::min(kChunk, end - at)));
    in.read(at, bytes);
    out.write(to + at - begin, bytes);
  }
}

/// Maps positions of bytes in an old file to positions in a new one.
class NewPlaces {
 public:
  /// Takes the position of the first byte after the XML in each file.
  NewPlaces(Offset old_begin, Offset new_begin) : moves_{{old_begin, new_begin}} {}

  /// Adds a move: bytes of the old file from `old_begin` to the next move are in the new file from
  /// `new_begin` on. Calls must have ascending arguments.
  void add(Offset old_begin, Offset new_begin) { moves_.emplace_back(old_begin, new_begin); }

  /// Returns the first byte after the XML in the new file.
  [[nodiscard]] Offset first_byte() const { return moves_.front().second; }
  /// Returns the new offset for an old one. O(log arrays).
  [[nodiscard]] Offset of_offset(Offset old) const {
    const Offset at = moves_.front().first + old;
    const auto behind = std::upper_bound(moves_.begin(), moves_.end(), at,
                                         [](Offset byte, const auto& move) { return byte < move.first; });
    const auto& [old_begin, new_begin] = *(behind - 1);
    return new_begin + at - old_begin - first_byte();
  }

 private:
  std::vector<std::pair<Offset, Offset>> moves_;  ///< ascending
};

/// Returns, on all ranks, the checksum that both files of an XDMF mesh contain. It equals the checksum that
/// the writer of whole meshes computes.
std::uint64_t checksum_of_xdmf(const Communicator& communicator, GlobalIndex vertices, const FilePart& part,
                               const std::vector<std::byte>& points, const Rows& cells) {
  Checksum sum;
  sum.add(vertices);
  add_in_rank_order(communicator, sum, [&] {
    const std::vector<double> coordinates = numbers_of<double>(points, part.type);
    const auto width = static_cast<std::size_t>(part.components);
    for (std::size_t k = 0; k < coordinates.size(); k += width) {
      Point point{};
      for (std::size_t x = 0; x < width; ++x) point[x] = coordinates[k + x];
      sum.add(point);
    }
  });
  add_in_rank_order(communicator, sum, [&] {
    for (Offset c = 0; c < cells.size(); ++c) sum.add_all(cells[c]);
  });
  return sum.value();
}

/// Returns an array of a file's appended data as base64, beginning with a word that gives its size.
std::string as_text(const std::string& path, const vtk::VtuDocument& document, Offset first_byte,
                    const vtk::VtuElement& element) {
  constexpr std::uint8_t kByte = 3;  // number type
  FilePart part{.type = kByte};
  std::vector<Offset> bounds;
  part.rows = AppendedArrays(path, document, first_byte, 1).place(element, part, bounds);
  const Communicator alone(MPI_COMM_SELF);
  const std::vector<std::byte> values =
      read_values(alone, SharedFile(alone, path, path, SharedFile::Use::read),
                  {path, std::string(element.text_of("Name"))}, document.encoding().compressor, part, bounds,
                  0, part.rows);
  return to_base64(vtk::vtu_words({values.size()}, document.encoding()) +
                   std::string(reinterpret_cast<const char*>(values.data()), values.size()));
}

/// Returns the <FieldData> of a file with all values inline.
std::string fields_with_values(const std::string& head, const std::string& path) {
  TextStore store(head + std::string(kEndOfHead));
  const FilePath in_store(path, store);
  const ReadScope scope(in_store);
  count_file(in_store, std::filesystem::file_size(path));
  const vtk::VtuDocument file(in_store);
  const vtk::VtuElement* const fields = file.root().child("UnstructuredGrid")->child("FieldData");
  if (fields == nullptr) return "";
  std::string text = "<FieldData>";
  for (const vtk::VtuElement& element : fields->children) {
    if (element.text_of("format") != "appended") {
      text += file.source(element);
      continue;
    }
    std::string attributes;
    for (const vtk::VtuAttribute& own : element.attributes) {
      if (own.name != "format" && own.name != "offset")
        attributes += fmt::format(" {}=\"{}\"", own.name, xml_escaped(own.value));
    }
    text += fmt::format("<{0}{1} format=\"binary\">{2}</{0}>", element.name, attributes,
                        as_text(path, file, std::ssize(head), element));
  }
  return text + "</FieldData>";
}

}  // namespace

MovedFile::MovedFile(const Communicator& communicator, const FileHead& head, const DistributedOrder& order)
    : communicator_(communicator),
      head_(head),
      file_(communicator, head),
      order_(order),
      slice_([&] {
        MeshSlice slice = file_.empty_slice();
        file_.read_shapes(slice);
        return slice;
      }()),
      vertices_(communicator, slice_.vertices, order.new_vertices),
      new_cells_(places_by_dimension(communicator, slice_, order.cells)),
      cell_mover_(communicator, slice_.cells, new_cells_) {}

/// Returns the cells in this rank's range of new places, with the new numbers of their vertices. Reads the
/// cells at the first call.
Rows& MovedFile::cells() {
  if (cells_) return *cells_;
  file_.read_cells(slice_);
  slice_.shapes = {};
  Rows rows = std::move(slice_.cell_vertices);
  {
    const Halo halo(communicator_, slice_.vertices, rows.entries);
    const std::vector<GlobalIndex> new_numbers = halo.fetch(order_.new_vertices);
    for (GlobalIndex& number : rows.entries) number = new_numbers[halo.position(number)];
  }
  return cells_.emplace(cell_mover_.moved(std::move(rows)));
}

/// Returns the rows of a part in this rank's range of new places.
std::vector<std::byte> MovedFile::rows(const FilePart& part) {
  const int rank = communicator_.rank();
  if (part.role == Role::connectivity) {
    const Rows& moved = cells();
    return communicator_.together([&] { return bytes_of(moved.entries, part.type); });
  }
  if (part.role == Role::offsets) {
    const Rows& moved = cells();
    const GlobalIndex first_entry =
        Layout::of_sizes(communicator_.gathered(std::ssize(moved.entries))).begin(rank);
    return communicator_.together([&] {
      std::vector<GlobalIndex> ends(moved.offsets.begin() + 1, moved.offsets.end());
      for (GlobalIndex& end : ends) end += first_entry;
      return bytes_of(ends, part.type);
    });
  }
  const bool on_vertices = part.association == Association::vertices;
  const Layout& layout = on_vertices ? slice_.vertices : slice_.cells;
  const std::vector<std::byte> values = file_.rows(part, layout.begin(rank), layout.end(rank));
  return (on_vertices ? vertices_ : cell_mover_).moved(values, part.row_size());
}

MeshSlice MovedFile::slice() {
  MeshSlice slice = file_.empty_slice();
  file_.read_points(slice);
  file_.read_shapes(slice);
  slice.points = moved_values(communicator_, vertices_, slice.points);
  slice.shapes = moved_values(communicator_, cell_mover_, slice.shapes);
  slice.cell_vertices = communicator_.together([&] { return cells(); });
  return slice;
}

GridRows MovedFile::grid() {
  GridRows grid;
  grid.vertices = slice_.vertices;
  grid.cells = slice_.cells;
  grid.rows = [this](std::size_t k) {
    return rows(*std::find_if(head_.parts.begin(), head_.parts.end(),
                              [&](const FilePart& part) { return part.number == k; }));
  };
  grid.cell_vertices = std::move(cells());
  communicator_.at_root([&] {
    grid.xml = head_.mold;
    if (head_.facts.kind == FileFacts::Kind::vtkhdf) return;
    grid.xml = head_.xml.text() + std::string(kEndOfHead);
    grid.fields = fields_with_values(head_.xml.text(), head_.path);
  });
  return grid;
}

std::string MovedFile::new_data(const std::string& name) const {
  if (head_.facts.kind != FileFacts::Kind::xdmf) return {};
  return communicator_
      .broadcast(communicator_.at_root([&] { return std::vector{head_.files->data_of(name)}; }))
      .front();
}

void MovedFile::write(const SliceFile& file) {
  if (head_.facts.kind == FileFacts::Kind::xdmf) return write_xdmf(file);
  SharedFile out(communicator_, file.path, file.name, SharedFile::Use::write);
  const SharedFile& in = file_.file();

  // write the XML last: it has the offsets of arrays whose compressed sizes are not known yet
  const bool is_vtkhdf = head_.facts.kind == FileFacts::Kind::vtkhdf;
  const bool is_raw = head_.facts.encoding.compressor == VtuEncoding::Compressor::none;
  Offset from = head_.facts.first_byte;
  Offset to = communicator_.broadcast(std::vector<Offset>{is_raw ? from : head_.xml.most_bytes()}).front();
  NewPlaces places(from, to);
  for (const FilePart& part : head_.parts) {
    copy_bytes(communicator_, in, from, part.at, out, to);
    to += part.at - from;
    from = part.at + part.stored;
    std::vector<std::byte> values = rows(part);
    places.add(part.at, to);
    to += is_vtkhdf ? write_raw(communicator_, out, to, values)
                    : write_values(communicator_, out, head_.facts.encoding, to, std::move(values),
                                   vtk::VtuCompressor::kBlock);
    places.add(from, to);
  }
  copy_bytes(communicator_, in, from, head_.facts.bytes, out, to);
  const std::string xml = communicator_.at_root([&] {
    if (is_vtkhdf) return std::string();
    return head_.xml.with_offsets([&](Offset offset) { return places.of_offset(offset); },
                                  places.first_byte());
  });
  out.write(0, std::as_bytes(std::span(xml)));
  out.close();
}

void MovedFile::write_xdmf(const SliceFile& file) {
  // compute the checksum first, because both files begin with it
  const FilePart& points = file_.part(FilePart::Role::points);
  const std::vector<std::byte> moved_points = rows(points);
  const std::uint64_t checksum =
      checksum_of_xdmf(communicator_, head_.facts.vertices, points, moved_points, cells());
  const std::string xml = communicator_.at_root(
      [&] { return head_.files->write_without_values(file.name, file.data, checksum); });
  const std::vector<Offset> places = communicator_.broadcast(
      communicator_.at_root([&] { return head_.files->places_in(file.data, file.name_of_data); }));

  SharedFile data(communicator_, file.data, file.name_of_data, SharedFile::Use::write);
  for (const FilePart& part : head_.parts) {
    const bool are_points = part.role == FilePart::Role::points;
    write_raw(communicator_, data, places[part.number], are_points ? moved_points : rows(part));
  }
  data.close();
  SharedFile document(communicator_, file.path, file.name, SharedFile::Use::write);
  document.write(0, std::as_bytes(std::span(xml)));
  document.close();
}

}  // namespace meshorder::distributed
